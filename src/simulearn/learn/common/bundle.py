"""A model in a folder: weights as safetensors, everything else in one JSON.

FOLDER/model.json            kind, architecture, units, training ranges, data, metrics, commit
FOLDER/weights.safetensors   weights and normalisers by name, single precision

The JSON holds the SHA-256 of the weights, so that a pair that does not belong together is refused.
Neither file can run code.
"""

import hashlib
import json
import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError
from safetensors import SafetensorError
from safetensors.numpy import load

from simulearn import __version__
from simulearn.errors import InputError
from simulearn.files import read_text
from simulearn.grid import TrainingRange
from simulearn.learn.common.model import Model, builder, check_kind
from simulearn.material import Identity, Material, load_material
from simulearn.material.reading import is_name

if TYPE_CHECKING:  # reading a bundle needs none of it
    pass

SCHEMA = "simulearn.model/1"
BUNDLES = Path(__file__).parents[1] / "bundles"
DEFAULTS = ("equilibrium", "paper")  # the first of them that is there is what `default` means

POINTER = b"version https://git-lfs.github.com/spec/"
WEIGHTS = ("model-weights", "model")  # code and place of what is wrong with them

UNITS = {"length": "mm", "stress": "MPa", "angle": "rad", "ratio": "signed, + top"}

Range = Annotated[list[float], Field(min_length=2, max_length=2)]


class _Data(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


def _by_name(value: Any) -> Any:
    """Return the contents of a material that an older bundle only names."""
    return load_material(value) if isinstance(value, str) and is_name(value) else value


class Ranges(_Data):
    """What the model was trained on, each as [least, most], mm."""

    dimension: Range
    beam_length: Range


class Source(_Data):
    """The data set it was trained on.

    Attributes:
        name, sha256: of the set.
        trials: how many it has learnt from.
    """

    name: str
    sha256: str
    trials: int


class Card(_Data):
    """What model.json holds.

    Attributes:
        schema_: version of the form.
        name: of the model.
        kind: one of `model.KINDS`.
        version: of the program that wrote it.
        commit: of the program, where it was known.
        architecture: what the kind's `from_arrays` builds the model of.
        weights: SHA-256 of the weights' file.
        units: of everything that goes in and comes out.
        material: that its training designs were made of, with all its contents.
        ranges: of its training designs.
        data: they come from.
        more: further sets that it has learnt from.
        training: the configuration of the run.
        metrics: figures of an evaluation, by data set.
    """

    schema_: Literal["simulearn.model/1"] = Field(alias="schema", default="simulearn.model/1")
    name: str
    kind: str
    version: str = __version__
    commit: str | None = None
    architecture: dict[str, Any]
    weights: str
    units: dict[str, str] = UNITS
    material: Annotated[Material, BeforeValidator(_by_name)]
    ranges: Ranges
    data: Source
    more: list[Source] = []
    training: dict[str, Any] = {}
    metrics: dict[str, Any] = {}

    @property
    def range(self) -> TrainingRange:
        """The training ranges as validation takes them."""
        low = self.ranges
        return TrainingRange(
            dimension=(low.dimension[0], low.dimension[1]),
            beam_length=(low.beam_length[0], low.beam_length[1]),
            thickness=self.material.section.thickness,
        )


@dataclass(frozen=True)
class Bundle:
    """A bundle on disk, its card read and its weights not yet.

    Attributes:
        path: of the folder.
        card: what it holds.
    """

    path: Path
    card: Card

    @cached_property
    def identity(self) -> Identity:
        """Name and digest of the model: of its weights, architecture and material."""
        card = self.card
        contents = {
            "kind": card.kind,
            "architecture": card.architecture,
            "weights": card.weights,
            "physics": card.material.physics,
        }
        text = json.dumps(contents, sort_keys=True, separators=(",", ":"))
        return Identity(name=card.name, digest=hashlib.sha256(text.encode()).hexdigest())

    def _content(self) -> bytes:
        """Return the file of the weights, known to be the card's."""
        file = self.path / "weights.safetensors"
        try:
            content = file.read_bytes()
        except OSError as error:
            raise InputError(f"{file}: cannot be read ({error.strerror})", *WEIGHTS) from error
        if content.startswith(POINTER):
            raise InputError(
                f"{file}: is a Git LFS pointer, not the weights themselves; fetch them with "
                "`git lfs pull`, or download the file itself",
                *WEIGHTS,
            )
        digest = hashlib.sha256(content).hexdigest()
        if digest != self.card.weights:
            raise InputError(
                f"{file}: does not belong to its model.json, or is damaged (SHA-256 "
                f"{digest[:12]}..., not {self.card.weights[:12]}...)",
                *WEIGHTS,
            )
        return content

    def check(self) -> None:
        """Make sure that the weights are there and whole, which is quick; no model is built.

        Raises:
            InputError: they are missing, damaged, or those of another card.
        """
        self._content()

    @cached_property
    def model(self) -> Model:
        """The model.

        Raises:
            InputError: the weights are missing, damaged, or do not fit the card; or a package is
                missing.
        """
        try:
            arrays = load(self._content())
        except SafetensorError as error:
            file = self.path / "weights.safetensors"
            raise InputError(f"{file}: is not a safetensors file: {error}", *WEIGHTS) from error
        build = builder(self.card.kind)
        try:
            return build(self.card.architecture, arrays, self.card.material)
        except InputError as error:
            raise InputError(f"{self.path}: {error}") from error


def shipped() -> list[str]:
    """Return the names of the models that come with SimuLearn."""
    return sorted(path.parent.name for path in BUNDLES.glob("*/model.json"))


def bundle_of(name: Path | str) -> Bundle:
    """Return a bundle: a folder, the name of one that comes with SimuLearn, or "default".

    Raises:
        InputError: there is none, or its card is wrong.
    """
    path = Path(name)
    if str(name) == "default" and not path.exists():
        path = next((BUNDLES / n for n in DEFAULTS if n in shipped()), path)
    elif str(name) in shipped() and not path.exists():
        path = BUNDLES / str(name)
    file = path / "model.json"
    if not file.is_file():
        known = ", ".join(["default", *shipped()])
        raise InputError(f"{name}: is not a model (a folder with model.json), nor one of {known}")
    try:
        data = json.loads(read_text(file))
    except json.JSONDecodeError as error:
        raise InputError(f"{file}: is not valid JSON: {error}") from error
    schema = data.get("schema") if isinstance(data, dict) else None
    if schema != SCHEMA:
        raise InputError(
            f"{file}: is not a model of this version (schema {schema!r}; "
            f"this program reads {SCHEMA!r})"
        )
    try:
        card = Card.model_validate(data)
        check_kind(card.kind)
    except ValidationError as error:
        first = error.errors()[0]
        key = ".".join(map(str, first["loc"]))
        what = "is unknown" if first["type"] == "extra_forbidden" else first["msg"]
        raise InputError(f"{file}: {key}: {what}{_of_version(data)}", "model-card") from error
    except InputError as error:
        raise InputError(f"{file}: {error}{_of_version(data)}", "model-card") from error
    return Bundle(path, card)


def _of_version(data: dict[str, Any]) -> str:
    """Return that a card was written by another version, where that explains what is wrong."""
    wrote = str(data.get("version", ""))[:40]
    if not wrote or wrote == __version__:
        return ""
    if _numbers(wrote) > _numbers(__version__):
        advice = "update it to read newer models"
    else:
        advice = "train the model again"
    return f" (the model is of SimuLearn {wrote}, this is {__version__}: {advice})"


def _numbers(version: str) -> tuple[int, ...]:
    return tuple(int(part) for part in re.findall(r"\d+", version)[:3])

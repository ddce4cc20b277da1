"""A model in a folder: weights as safetensors, everything else in one JSON.

FOLDER/model.json            kind, architecture, units, training ranges, data, metrics, commit
FOLDER/weights.safetensors   weights and normalisers by name, single precision

The JSON holds the SHA-256 of the weights, so that a pair that does not belong together is refused.
Neither file can run code.
"""

import hashlib
import json
import re
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError
from safetensors import SafetensorError
from safetensors.numpy import load, save

from simulearn import __version__
from simulearn.errors import InputError
from simulearn.files import read_text, replacing
from simulearn.grid import TrainingRange
from simulearn.learn.common.model import Model, builder, check_kind
from simulearn.material import Identity, Material, load_material
from simulearn.material.material import is_name

if TYPE_CHECKING:  # reading a bundle needs none of it
    from simulearn.dataset import Dataset

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


def save_bundle(
    path: Path | str,
    model: Model,
    name: str,
    data: "Dataset",
    training: Mapping[str, Any] | None = None,
    metrics: Mapping[str, Any] | None = None,
    more: "Sequence[Dataset]" = (),
) -> Bundle:
    """Write a model to a folder, completely or not at all; one that is there is replaced.

    Args:
        path: of the folder.
        model: what to write.
        name: of the model.
        data: it has learnt from; the training ranges are those of its trials to train on.
        training: the configuration of the run.
        metrics: figures of an evaluation.
        more: further sets that it has learnt from.

    Raises:
        InputError: the folder cannot be written.
    """
    from simulearn.dataset.statistics import beam_lengths

    path = Path(path)
    if path.exists() and not (path / "model.json").is_file() and any(path.iterdir()):
        raise InputError(f"{path}: holds other files; name another folder for the model")
    arrays = {k: np.asarray(v, order="C") for k, v in model.to_arrays().items()}
    content = save(arrays)
    batches = [b.take(~b.test) for b in data.batches]
    batches = [b for b in batches if len(b)]
    lengths = np.concatenate([beam_lengths(b).ravel() for b in batches])
    dimensions = np.concatenate([b.dimensions for b in batches])
    card = Card(
        name=name,
        kind=model.kind,
        commit=_commit(),
        architecture=model.config(),
        weights=hashlib.sha256(content).hexdigest(),
        material=batches[0].material,
        ranges=Ranges(dimension=_range(dimensions), beam_length=_range(lengths)),
        data=_source(data),
        more=[_source(one) for one in more],
        training=dict(training or {}),
        metrics=dict(metrics or {}),
    )
    old: Path | None = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary = Path(tempfile.mkdtemp(prefix=".model-", dir=path.parent))
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror})") from error
    try:
        (temporary / "weights.safetensors").write_bytes(content)
        _write_card(temporary / "model.json", card)
        with suppress(OSError):  # some mounts know no access
            temporary.chmod(0o755)
        if path.exists():
            path.rename(old := temporary.with_name(temporary.name + "-old"))
        temporary.rename(path)
        if old is not None:
            shutil.rmtree(old)
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror})") from error
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
    return Bundle(path, card)


def _source(data: "Dataset") -> Source:
    trials = sum(int((~batch.test).sum()) for batch in data.batches)
    return Source(name=data.config.name, sha256=data.sha256, trials=trials)


def add_metrics(bundle: Bundle, name: str, figures: Mapping[str, Any]) -> Bundle:
    """Add the figures of an evaluation to a bundle's card."""
    metrics = {**bundle.card.metrics, name: dict(figures)}
    card = bundle.card.model_copy(update={"metrics": metrics})
    _write_card(bundle.path / "model.json", card)
    return Bundle(bundle.path, card)


def _write_card(path: Path, card: Card) -> None:
    with replacing(path) as temporary:
        temporary.write_text(card.model_dump_json(indent=1, by_alias=True) + "\n", "utf-8")


def _range(values: NDArray[np.floating]) -> list[float]:
    """Return least and most, rounded outwards to a tenth of a millimetre."""
    return [float(np.floor(values.min() * 10) / 10), float(np.ceil(values.max() * 10) / 10)]


def _commit() -> str | None:
    """Return the commit of the program, where it runs from a checkout."""
    try:
        done = subprocess.run(
            ["git", "rev-parse", "HEAD"],
            cwd=Path(__file__).parent,
            capture_output=True,
            text=True,
            timeout=10,
            check=True,
        )
    except (OSError, subprocess.SubprocessError):
        return None
    return done.stdout.strip() or None

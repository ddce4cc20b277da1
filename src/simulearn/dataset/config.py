"""What a data set is made of: one commented TOML with seed, rules of the designs and the solver."""

import tomllib
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from simulearn.errors import InputError
from simulearn.fea import COARSE, Control, Layout
from simulearn.files import read_text
from simulearn.grid import KindDesign, Kinds, Rules, draw_kind, draw_valid
from simulearn.material import Material, load_material

CONFIGS = Path(__file__).parent / "configs"

Count = Annotated[int, Field(ge=1)]


class _Data(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Solver(_Data):
    """Mesh and convergence settings; the attributes of `fea.Layout` and `fea.Control`."""

    core: Annotated[int, Field(ge=0)] = COARSE.core
    slabs: Annotated[int, Field(ge=4, multiple_of=2)] = COARSE.slabs
    layers: Count = COARSE.layers
    tolerance: Annotated[float, Field(gt=0)] = Control().tolerance
    iterations: Count = Control().iterations
    halvings: Annotated[int, Field(ge=0)] = Control().halvings

    @property
    def layout(self) -> Layout:
        """The layout of the mesh."""
        return Layout(self.core, self.slabs, self.layers)

    @property
    def control(self) -> Control:
        """When an increment has converged."""
        return Control(self.tolerance, self.iterations, self.halvings)


class Config(_Data):
    """A data set: design k of it is the same on every machine.

    Attributes:
        name: what the set is called.
        trials: how many designs.
        seed: of the designs.
        test_every: trials k with (k + 1) divisible by it are kept for testing; 0: none are.
        rules: how designs are drawn.
        kinds: how designs of several kinds and materials are drawn, in place of `rules.cells`;
            none draws lattices of one material.
        solver: mesh and convergence.
    """

    name: Annotated[str, Field(min_length=1)]
    trials: Count
    seed: Annotated[int, Field(ge=0)] = 0
    test_every: Annotated[int, Field(ge=0)] = 5
    rules: Rules = Rules()
    kinds: Kinds | None = None
    solver: Solver = Solver()

    @cached_property
    def material(self) -> Material:
        """The material system of all designs, or the one whose family theirs are of."""
        return load_material(self.rules.material)

    def design(self, k: int) -> KindDesign:
        """Return design k, centred; its kind is "" where all are lattices of one material."""
        if self.kinds is not None:
            return draw_kind(self.kinds, self.rules, self.material, self.seed, k)
        grid, redraws = draw_valid(self.rules, self.seed, k)
        return KindDesign(grid.centred, self.material, "", redraws)

    def is_test(self, k: int) -> bool:
        """Return whether trial k is kept for testing."""
        return self.test_every > 0 and (k + 1) % self.test_every == 0

    def differences(self, other: "Config") -> list[str]:
        """Return where two configurations differ other than in the number of trials."""
        mine, theirs = (_flat(c.model_dump(mode="json")) for c in (self, other))
        return [
            f"{key} is {mine.get(key)}, was {theirs.get(key)}"
            for key in sorted(mine.keys() | theirs.keys())
            if key != "trials" and mine.get(key) != theirs.get(key)
        ]


def shipped() -> list[str]:
    """Return the names of the configurations that come with SimuLearn."""
    return sorted(path.stem for path in CONFIGS.glob("*.toml"))


def read_config(name: Path | str) -> Config:
    """Read a configuration: a TOML file, or the name of one that comes with SimuLearn.

    Raises:
        InputError: it is missing or wrong; the message names the key.
    """
    path = Path(name)
    if str(name) in shipped() and not path.exists():
        path = CONFIGS / f"{name}.toml"
    elif not path.suffix and not path.exists():
        raise InputError(f"{name}: is neither a file nor one of {', '.join(shipped())}")
    try:
        data = tomllib.loads(read_text(path))
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{path}: is not valid TOML: {error}") from error
    config = config_of(data, str(path))
    config.material  # noqa: B018  (an unknown material is refused now and not in the run)
    return config


def config_of(data: Any, where: str) -> Config:
    """Return the configuration of plain data.

    Raises:
        InputError: a key is unknown, missing or wrong.
    """
    try:
        return Config.model_validate(data)
    except ValidationError as error:
        first = error.errors()[0]
        key = ".".join(map(str, first["loc"])) or "the file"
        raise InputError(f"{where}: {key}: {first['msg']}") from error


def _flat(data: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for key, value in data.items():
        if isinstance(value, dict):
            flat |= _flat(value, f"{prefix}{key}.")
        else:
            flat[prefix + key] = value
    return flat

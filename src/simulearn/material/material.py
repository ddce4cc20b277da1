"""A material system as data: everything SimuLearn knows about a print and its bath.

One TOML file holds the section of the beams, the constitutive law, the shrinkage, gravity, creep
and print settings. Nothing of it is repeated in code: another file is another material system.
"""

import tomllib
from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from simulearn.errors import InputError
from simulearn.files import read_text

HERE = Path(__file__).parent

Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]
Poisson = Annotated[float, Field(gt=-1, lt=0.5)]


class _Data(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Section(_Data):
    """Cross-section of a beam, mm: `shell` is the row on each side printed along the beam."""

    width: Positive
    thickness: Positive
    shell: NotNegative

    @model_validator(mode="after")
    def _shell_fits(self) -> Self:
        if 2 * self.shell >= self.width:
            raise ValueError(f"two shells of {self.shell} mm leave no core in {self.width} mm")
        return self


class MarlowData(_Data):
    """Uniaxial test as (nominal strain, nominal stress in MPa) pairs, rising in both."""

    kind: Literal["marlow"]
    poisson: Poisson
    modulus: Positive
    table: tuple[tuple[Positive, Positive], ...] = Field(min_length=2)

    @model_validator(mode="after")
    def _rises(self) -> Self:
        for k, (a, b) in enumerate(zip(self.table, self.table[1:], strict=False)):
            if b[0] <= a[0] or b[1] <= a[1]:
                raise ValueError(f"table[{k + 1}] is {list(b)}; strain and stress must rise")
        return self


class ElasticData(_Data):
    """Neo-Hookean or St Venant-Kirchhoff law by Young's modulus (MPa) and Poisson ratio."""

    kind: Literal["neo-hookean", "st-venant-kirchhoff"]
    poisson: Poisson
    modulus: Positive


class Shrinkage(_Data):
    """Released strains of active half and shell, and the printed-in stresses, MPa."""

    active: NotNegative
    shell: NotNegative
    stress_active: Positive
    stress_passive: NotNegative
    stress_joint: NotNegative

    @property
    def passive(self) -> float:
        """Released strain of the passive half, in the ratio of the printed-in stresses."""
        return self.active * self.stress_passive / self.stress_active

    @property
    def joint(self) -> float:
        """Released strain of a joint, in the ratio of the printed-in stresses."""
        return self.active * self.stress_joint / self.stress_active

    @property
    def stress_shell(self) -> float:
        """Printed-in stress of the shell (MPa), in the ratio of the released strains."""
        return self.stress_active * (self.shell / self.active if self.active else 1.0)


class Calibration(_Data):
    """The measurement that fixes the shrinkage: deg/mm of a free beam of `length` mm."""

    curvature: Positive
    length: Positive


class Gravity(_Data):
    """Effective gravity in the bath: density tonne/mm3, acceleration mm/s2 (towards -z)."""

    density: Positive
    acceleration: NotNegative

    @property
    def body_force(self) -> float:
        """Force per volume towards -z, N/mm3."""
        return self.density * self.acceleration


class Creep(_Data):
    """Findley creep: compliance 1 + amplitude (t / hold)^exponent of the load-driven part."""

    amplitude: NotNegative
    exponent: Annotated[float, Field(gt=0, le=1)]
    hold: Positive


class Bath(_Data):
    """Temperatures of the bath and of resolidification, C."""

    temperature: float
    resolidification: float


class Print(_Data):
    """Settings that the actuation depends on; mm, mm/min, C."""

    layer: Positive
    line_width: Positive
    nozzle: Positive
    temperature: Positive
    bed: NotNegative
    speed_fill: Positive
    speed_shell: Positive
    speed_skirt: Positive
    speed_travel: Positive
    speed_z: Positive
    flow_active: Positive
    flow_passive: Positive
    flow_joint: Positive
    shell_overlap: NotNegative
    infill: Positive
    skirt_distance: NotNegative
    retraction: NotNegative
    retraction_speed: Positive
    fan_first_layer: bool
    fan: bool


class Limits(_Data):
    """Limits of a design, mm."""

    beam_length: Positive
    beam_net_length: Positive
    actuator_length: Positive


class Material(_Data):
    """A material system."""

    name: str
    title: str
    section: Section
    law: Annotated[MarlowData | ElasticData, Field(discriminator="kind")]
    shrinkage: Shrinkage
    calibration: Calibration
    gravity: Gravity
    creep: Creep
    bath: Bath
    print: Print
    limits: Limits


def names() -> list[str]:
    """Return the names of the material systems that come with SimuLearn."""
    return sorted(path.stem for path in HERE.glob("*.toml"))


def load_material(name: str | Path) -> Material:
    """Return a material system by its name, or from a TOML file by its path.

    Raises:
        InputError: the name is unknown, or the file is not a valid material system.
    """
    path = Path(name)
    if path.suffix != ".toml":
        if str(name) not in names():
            known = ", ".join(names())
            raise InputError(
                f'material "{name}" is not known; known are {known}, or give a .toml file'
            )
        path = HERE / f"{name}.toml"
    try:
        return Material.model_validate(tomllib.loads(read_text(path)))
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{path}: is not valid TOML: {error}") from error
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"])
        raise InputError(f"{path}: {where}: {first['msg']}") from error

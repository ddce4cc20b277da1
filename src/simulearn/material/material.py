"""A material system as data: everything SimuLearn knows about a print and its bath.

One TOML file holds the section of the beams, the constitutive law, the shrinkage, gravity, creep
and print settings. Nothing of it is repeated in code: another file is another material system.
"""

import hashlib
import json
from collections.abc import Mapping
from functools import cached_property
from typing import Annotated, Any, Literal, Self

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    SerializerFunctionWrapHandler,
    model_serializer,
    model_validator,
)

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]  # no text and no true
Positive = Annotated[Number, Field(gt=0)]
NotNegative = Annotated[Number, Field(ge=0)]
Poisson = Annotated[Number, Field(gt=-1, le=0.49)]  # beyond, the bricks lock


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


class Laid(_Data):
    """Section that a printer lays, mm, where the beams come out with another one."""

    width: Positive
    thickness: Positive


class _Law(_Data):
    """What every law has: `scale` multiplies all its stresses."""

    poisson: Poisson
    modulus: Positive
    scale: Positive = 1.0

    @property
    def stiffness(self) -> float:
        """Modulus with its scale, MPa."""
        return self.modulus * self.scale


class MarlowData(_Law):
    """Uniaxial test as (nominal strain, nominal stress in MPa) pairs, rising in both."""

    kind: Literal["marlow"]
    table: tuple[tuple[Positive, Positive], ...] = Field(min_length=2)

    @model_validator(mode="after")
    def _rises(self) -> Self:
        for k, (a, b) in enumerate(zip(self.table, self.table[1:], strict=False)):
            if b[0] <= a[0] or b[1] <= a[1]:
                raise ValueError(f"table[{k + 1}] is {list(b)}; strain and stress must rise")
        return self


class ElasticData(_Law):
    """Neo-Hookean or St Venant-Kirchhoff law by Young's modulus (MPa) and Poisson ratio."""

    kind: Literal["neo-hookean", "st-venant-kirchhoff"]


class Shrinkage(_Data):
    """Released strains of active half and shell, and the printed-in stresses, MPa.

    `curl` is what a print curls by of its own: by so much more strain its top shrinks than its
    bottom, in both directions of the plane, linear in between. A beam without an actuator then
    bends, upwards where it is positive, by about `curl` over the thickness.
    """

    active: Annotated[Number, Field(ge=0, lt=1)]
    shell: Annotated[Number, Field(ge=0, lt=1)]
    stress_active: Positive
    stress_passive: NotNegative
    stress_joint: NotNegative
    curl: Annotated[Number, Field(gt=-0.5, lt=0.5)] = 0.0

    @property
    def passive(self) -> float:
        """Released strain of the passive half, in the ratio of the printed-in stresses."""
        return self.active * self.stress_passive / self.stress_active

    @property
    def joint(self) -> float:
        """Released strain of a joint, in the ratio of the printed-in stresses."""
        return self.active * self.stress_joint / self.stress_active

    @property
    def printed(self) -> dict[str, tuple[float, float, float]]:
        """Printed-in stress of each kind of part along its beam, across it and up, MPa."""
        return {
            "joint": (self.stress_joint, self.stress_joint, 0.0),
            "shell": (self.stress_shell, 0.0, 0.0),
            "active": (self.stress_active, 0.0, 0.0),
            "passive": (0.0, self.stress_passive, 0.0),
        }

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
    exponent: Annotated[Number, Field(gt=0, le=1)]
    hold: Positive


class Scatter(_Data):
    """How prints of one design differ: relative standard deviations of all released strains.

    Attributes:
        print: from print to print, the same for all beams of one.
        beam: from beam to beam of one print.
    """

    print: Annotated[Number, Field(ge=0, le=0.5)] = 0.0
    beam: Annotated[Number, Field(ge=0, le=0.5)] = 0.0


class Bath(_Data):
    """Temperatures of the bath and of resolidification, C."""

    temperature: Number
    resolidification: Number


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
    acceleration: Positive = 1000.0  # mm/s2, while printing
    corner_speed: Positive = 8.0  # mm/s, at a right angle
    first_layer_speed: Positive = 1200.0
    first_layer_height: NotNegative = 0.0  # 0: as the other layers
    first_layer_flow: Positive = 1.05  # times the flow of each role
    brim: NotNegative = 4.0  # width; 0: none


class Limits(_Data):
    """Limits of a design, mm."""

    beam_length: Positive
    beam_net_length: Positive
    actuator_length: Positive


class Identity(_Data):
    """What a material, model or data set is called, and the digest of its contents."""

    name: str
    digest: str

    def __str__(self) -> str:
        return f"{self.name} ({self.digest[:12]})"


class Material(_Data):
    """A material system; `digest` tells whether two are the same, names are for people."""

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
    scatter: Scatter = Scatter()
    laid: Laid | None = None

    @model_validator(mode="after")
    def _core_is_laid(self) -> Self:
        if self.laid is not None and 2 * self.section.shell >= self.laid.width:
            shells = f"two shells of {self.section.shell} mm"
            raise ValueError(f"{shells} leave no core in the {self.laid.width} mm that are laid")
        return self

    @model_serializer(mode="wrap")
    def _without_none(self, handler: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """Return the data; what does not say how it is laid has the digest that it always had."""
        data: dict[str, Any] = handler(self)
        if data.get("laid") is None:
            data.pop("laid", None)
        return data

    @property
    def as_laid(self) -> Section:
        """The section of the beams as a printer lays them."""
        if self.laid is None:
            return self.section
        return self.section.model_copy(update=self.laid.model_dump())

    @cached_property
    def digest(self) -> str:
        """SHA-256 of everything but name and title."""
        return _digest(self.model_dump(mode="json", exclude={"name", "title"}))

    @cached_property
    def physics(self) -> str:
        """SHA-256 of what a simulation depends on: section, law, shrinkage, gravity and creep."""
        return _digest(
            self.model_dump(
                mode="json", include={"section", "law", "shrinkage", "gravity", "creep"}
            )
        )

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Return a copy with some values changed; its digests are its own."""
        copy = super().model_copy(update=update, deep=deep)
        for name in ("digest", "physics"):
            copy.__dict__.pop(name, None)
        return copy

    @property
    def identity(self) -> Identity:
        """Name and digest."""
        return Identity(name=self.name, digest=self.digest)


def _digest(contents: dict[str, Any]) -> str:
    text = json.dumps(contents, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()

"""A printer as data: its bed, its limits, how it moves, and the code before and after a print.

What the actuation depends on comes from the material system. A printer may override it under
`print`; the print then has a warning.
"""

from typing import Annotated, Any, Literal, Self

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    Strict,
    TypeAdapter,
    ValidationError,
    field_validator,
    model_validator,
)

from simulearn.grid import Message
from simulearn.material.material import Print

_Coordinate = Annotated[float, Field(ge=-1e4, le=1e4, allow_inf_nan=False)]
_Place = Annotated[tuple[_Coordinate, _Coordinate], Strict(strict=False)]  # TOML has lists
_Box = Annotated[tuple[_Place, _Place], Strict(strict=False)]
_Length = Annotated[float, Field(gt=0, le=1e4, allow_inf_nan=False)]
_Rate = Annotated[float, Field(ge=0.01, le=1e6, allow_inf_nan=False)]
_Speed = Annotated[float, Field(ge=10, le=1e5, allow_inf_nan=False)]
_Acceleration = Annotated[float, Field(ge=1, le=1e6, allow_inf_nan=False)]
_Degrees = Annotated[float, Field(ge=0, le=1000, allow_inf_nan=False)]


Firmware = Literal["marlin", "prusa", "klipper", "reprap", "bambu", "sailfish"]


class _Table(BaseModel):
    model_config = ConfigDict(frozen=True, strict=True, extra="forbid", allow_inf_nan=False)


class Bed(_Table):
    """What can be printed on, mm.

    Attributes:
        width: along x; of a round bed its diameter.
        depth: along y.
        height: how high the nozzle goes.
        origin: where x = y = 0 lies, in the lower left corner or in the middle.
        shape: "rectangle" or "round"; None where a profile does not say.
        excluded: rectangles [[x, y], [x, y]] between two corners in which nothing is printed.
    """

    width: _Length
    depth: _Length
    height: _Length
    origin: Literal["corner", "centre"] = "corner"
    shape: Literal["rectangle", "round"] | None = None
    excluded: list[_Box] = []

    @model_validator(mode="after")
    def _as_wide_as_deep(self) -> Self:
        if self.shape == "round" and self.width != self.depth:
            raise ValueError("a round bed is as deep as it is wide; both are its diameter")
        return self

    @field_validator("excluded")
    @classmethod
    def _areas(cls, given: list[_Box]) -> list[_Box]:
        for k, ((x0, y0), (x1, y1)) in enumerate(given):
            if x0 == x1 or y0 == y1:
                raise ValueError(f"zone {k} has no area; give two corners, [[x, y], [x, y]]")
        return given

    @property
    def round(self) -> bool:
        """Whether it is known to be round."""
        return self.shape == "round"

    @property
    def shape_unclear(self) -> bool:
        """Whether it may be round, and the profile does not say."""
        return self.shape is None and self.origin == "centre" and self.width == self.depth

    @property
    def middle(self) -> tuple[float, float]:
        """Its middle, mm."""
        return self.low[0] + self.width / 2, self.low[1] + self.depth / 2

    def ask_shape(self) -> str:
        """Return what to ask for where the shape matters and is not known."""
        return (
            f"a bed as deep as it is wide with its origin in the middle is often round: write "
            f'shape = "round" or shape = "rectangle" under [bed] (a round one reaches '
            f"{self.width / 2:g} mm from its middle)"
        )

    @property
    def low(self) -> tuple[float, float]:
        """The corner with the least x and y, mm."""
        return (-self.width / 2, -self.depth / 2) if self.origin == "centre" else (0.0, 0.0)

    @property
    def high(self) -> tuple[float, float]:
        """The corner with the greatest x and y, mm."""
        return self.low[0] + self.width, self.low[1] + self.depth


class Reach(_Table):
    """Where start and end code may move, from and to (mm); None: as far as the bed."""

    x: _Place | None = None
    y: _Place | None = None
    z: _Place | None = None

    @field_validator("x", "y", "z")
    @classmethod
    def _upwards(cls, given: tuple[float, float] | None) -> tuple[float, float] | None:
        if given is not None and given[0] >= given[1]:
            raise ValueError(f"goes from {given[0]:g} to {given[1]:g}; the smaller number is first")
        return given


class Extruder(_Table):
    """The filament's diameter (mm), how E is counted, and how far the nozzle lifts to travel."""

    filament: Annotated[float, Field(ge=1.5, le=3.2, allow_inf_nan=False)] = 1.75
    extrusion: Literal["absolute", "relative"] = "relative"
    lift: Annotated[float, Field(ge=0.1, le=20, allow_inf_nan=False)] = 0.5


class Temperatures(_Table):
    """Hottest and coldest nozzle that may print, hottest bed (0: there is no heater), C."""

    nozzle_most: _Degrees
    nozzle_least: _Degrees = 170.0
    bed_most: _Degrees = 0.0


class Motion(_Table):
    """How the machine moves; accelerations and corner speed are written to the file.

    Attributes:
        speed: fastest in x and y, mm/min.
        speed_z: fastest in z, mm/min; lifts are no faster, whatever the material's settings.
        acceleration: while printing, mm/s2.
        acceleration_travel: of travels, mm/s2.
        acceleration_z: mm/s2.
        acceleration_e: of retractions, mm/s2.
        corner_speed: speed at which a right angle is taken, mm/s.
    """

    speed: _Speed
    speed_z: _Speed
    acceleration: _Acceleration
    acceleration_travel: _Acceleration
    acceleration_z: _Acceleration = 100.0
    acceleration_e: _Acceleration = 1000.0
    corner_speed: Annotated[float, Field(ge=0.1, le=1e3, allow_inf_nan=False)] = 8.0


class Heating(_Table):
    """How fast nozzle and bed warm up, C/s."""

    nozzle: _Rate = 2.0
    bed: _Rate = 0.4


class Code(_Table):
    """Code before and after the print; words in braces are filled in (see docs/printers.md).

    Attributes:
        start: before the print.
        end: after it.
        progress: whether the file says how far the print has come (M73).
        limits: whether the file sets accelerations and corner speed.
    """

    start: Annotated[str, Field(max_length=20000)]
    end: Annotated[str, Field(max_length=20000)]
    progress: bool = True
    limits: bool = True


class Printer(_Table):
    """A printer.

    Attributes:
        name: by which it is chosen.
        title: by which people know it.
        firmware: which dialect its code is written in.
        sources: documents and source files that the profile follows.
        tried: who has printed with this profile, and when; empty where nobody has.
        bed: what can be printed on.
        reach: where code may move beyond the bed.
        extruder: filament and how it is counted.
        temperature: limits.
        motion: how fast it moves and accelerates.
        heating: how fast it warms up.
        print: settings that override those of the material.
        code: before and after the print.
    """

    name: Annotated[str, Field(min_length=1, max_length=80)]
    title: Annotated[str, Field(min_length=1, max_length=200)]
    firmware: Firmware = "marlin"
    sources: list[str] = []
    tried: str = ""
    bed: Bed
    reach: Reach = Reach()
    extruder: Extruder = Extruder()
    temperature: Temperatures
    motion: Motion
    heating: Heating = Heating()
    print: dict[str, float | bool] = {}
    code: Code

    @property
    def sets_limits(self) -> bool:
        """Whether the file sets acceleration and corner speed (GPX passes none to Sailfish)."""
        return self.code.limits and self.firmware != "sailfish"

    @property
    def one_acceleration(self) -> bool:
        """Whether the firmware has one acceleration for prints and travels: that of prints."""
        return self.firmware == "klipper"

    @field_validator("print", mode="before")
    @classmethod
    def _overrides(cls, given: Any) -> dict[str, Any]:
        """Return the print settings given, each checked as the material's own is."""
        if not isinstance(given, dict):
            raise ValueError("is not a table of print settings")
        checked = {}
        for key, value in given.items():
            if key not in Print.model_fields:
                known = ", ".join(Print.model_fields)
                raise ValueError(f"{key} is not a print setting; those are {known}")
            setting = TypeAdapter(Print.model_fields[key].rebuild_annotation())
            try:
                checked[key] = setting.validate_python(value, strict=True)
            except ValidationError as error:
                raise ValueError(f"{key}: {error.errors()[0]['msg']}") from error
        return checked


def untried(printer: Printer) -> list[Message]:
    """Return a warning where nobody has run a printer's profile on its machine."""
    if printer.tried.strip():
        return []
    text = (
        f"nobody has run the profile {printer.name} on its machine; before the first print read "
        f"docs/printers.md, and keep a hand on the switch"
    )
    return [Message("untried", "tried", text)]

"""A printer as data: its bed, its limits, how it moves, and the code before and after a print.

A profile is a TOML file. It may begin from another one (`base`) and name only what differs. What
the actuation depends on comes from the material system. A profile may override it under [print];
the print then has a warning.
"""

import re
import tomllib
from pathlib import Path
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

from simulearn.errors import InputError
from simulearn.files import read_text
from simulearn.grid import Message
from simulearn.grid.arrays import shown
from simulearn.material.material import Print

HERE = Path(__file__).parent / "printers"
MOST_BASES = 8
MOST_TEXT = 2**16  # characters of a profile that anybody may send
MOST_DOTS = 300  # on one line of it

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


def printers() -> list[str]:
    """Return the names of the printers that come with SimuLearn."""
    return sorted(path.stem for path in HERE.glob("*.toml"))


def load_printer(name: str | Path) -> Printer:
    """Return a printer by its name, or from a TOML file by its path.

    Raises:
        InputError: the name is unknown, or the file is not a valid profile.
    """
    path = _path(name)
    return _printer(_with_base(path), str(path))


def read_profile(text: str) -> Printer:
    """Return the printer that the text of a profile describes, which may come from anybody.

    Its `base`, if it has one, names a printer that comes with SimuLearn; no file is read otherwise.

    Args:
        text: TOML of at most `MOST_TEXT` characters.

    Raises:
        InputError: it is not a valid profile; `where` is the key, or the line of what is no TOML.
    """
    if len(text) > MOST_TEXT:
        long = f"the profile has {len(text)} characters; at most {MOST_TEXT} are taken"
        raise InputError(long, "profile-too-large", "profile")
    for k, line in enumerate(text.splitlines(), 1):
        if line.count(".") > MOST_DOTS:  # reading tables so deep takes long
            raise InputError(
                f"profile: line {k} has more than {MOST_DOTS} dots; write long code on several "
                "lines, between three quotation marks",
                "profile",
                f"line {k}",
            )
    data = _tables(text, "profile")
    base = data.pop("base", None)
    if base is not None:
        if not isinstance(base, str) or base not in printers():
            known = ", ".join(printers())
            raise InputError(
                f"profile: base: is {shown(base)}; here it is one of {known}", "profile", "base"
            )
        below = _with_base(_path(base))
        data = _merged(_kept(below, data), data)
    return _printer(data, "profile")


def profile_text(name: str) -> str:
    """Return the TOML text of a printer that comes with SimuLearn, to be edited."""
    return read_text(_path(name))


def _printer(data: dict[str, Any], place: str) -> Printer:
    """Return the printer of tables; messages name their place."""
    try:
        return Printer.model_validate(data)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(str(part) for part in first["loc"]) or "profile"
        raise InputError(f"{place}: {where}: {_reason(first)}", "profile", where) from error


def _path(name: str | Path) -> Path:
    path = Path(name)
    if path.suffix == ".toml":
        return path
    if str(name) not in printers():
        known = ", ".join(printers())
        raise InputError(f'printer "{name}" is not known; known are {known}, or give a .toml file')
    return HERE / f"{name}.toml"


def _with_base(path: Path, depth: int = 0) -> dict[str, Any]:
    """Return the tables of a profile over those that it begins from."""
    if depth > MOST_BASES:
        raise InputError(f"{path}: more than {MOST_BASES} profiles begin from one another")
    data = _tables(read_text(path), str(path))
    base = data.pop("base", None)
    if base is None:
        return data
    if not isinstance(base, str):
        raise InputError(f"{path}: base: is not the name of a printer or the path of its file")
    beside = path.parent / base
    below = _with_base(beside if beside.suffix == ".toml" else _path(base), depth + 1)
    return _merged(_kept(below, data), data)


def _kept(below: dict[str, Any], above: dict[str, Any]) -> dict[str, Any]:
    """Return what a profile takes over from the one it begins from.

    That somebody has printed with a profile says nothing about another one, the shape and the zones
    of a bed nothing about one whose origin lies elsewhere, the reach nothing about one of another
    size.
    """
    below = {key: value for key, value in below.items() if key != "tried"}
    old, new = below.get("bed"), above.get("bed")
    if not isinstance(old, dict) or not isinstance(new, dict):
        return below
    if new.get("origin", old.get("origin")) != old.get("origin"):
        old = {key: value for key, value in old.items() if key not in ("shape", "excluded")}
    if new.keys() & {"origin", "width", "depth", "height"}:
        below = {key: value for key, value in below.items() if key != "reach"}
    return below | {"bed": old}


def _tables(text: str, place: str) -> dict[str, Any]:
    """Return the tables of a TOML text; messages name its place."""
    try:
        return tomllib.loads(text)
    except ValueError as error:  # also of a number of thousands of digits
        line = re.search(r"line \d+", str(error))
        where = line[0] if line else "profile"
        raise InputError(f"{place}: is not valid TOML: {error}", "profile", where) from error
    except RecursionError as error:
        text = f"{place}: is not a profile; its tables are nested too deeply"
        raise InputError(text, "profile", "profile") from error


def _merged(below: dict[str, Any], above: dict[str, Any]) -> dict[str, Any]:
    both = dict(below)
    for key, value in above.items():
        old = both.get(key)
        inner = isinstance(old, dict) and isinstance(value, dict)
        both[key] = _merged(old, value) if inner else value  # type: ignore[arg-type]
    return both


def _reason(error: Any) -> str:
    """Return one of pydantic's errors with what was given."""
    if error["type"] == "extra_forbidden":
        return "is not a key of a printer profile"
    if error["type"] == "missing":
        return "is missing"
    if error["type"] == "value_error":
        return str(error["ctx"]["error"])
    try:
        given = repr(error["input"])
    except RecursionError:
        given = "tables in tables"
    given = given if len(given) <= 40 else given[:37] + "..."
    return f"is {given}; {error['msg'][0].lower()}{error['msg'][1:]}"

"""What is known of a machine at a place in its code; None where nothing is."""

from dataclasses import dataclass, field

import shapely

CLEAR = 2.0  # mm above the bed from which a nozzle that heats up does no harm
EVERYTHING = "XYZ"


@dataclass(frozen=True)
class Box:
    """A box that stands on the bed: two corners (x, y), and its height, mm."""

    low: tuple[float, float]
    high: tuple[float, float]
    top: float

    def meets(self, begin: tuple[float, float], end: tuple[float, float]) -> bool:
        """Whether a line on the bed meets it."""
        line = shapely.linestrings([begin, end])
        return bool(shapely.intersects(shapely.box(*self.low, *self.high), line))


@dataclass
class State:
    """A machine's state.

    Attributes:
        at: place of the nozzle by axis, mm.
        least_z: the nozzle is at least so high, mm.
        on_bed: whether homing has left the nozzle on the bed, as far as is known.
        homed: by axis, whether the machine knows where it stands.
        relative: whether X, Y and Z count from the last place.
        e_own: what M82 or M83 last said: whether E counts from its last value.
        e_last: what the last one of M82, M83, G90 and G91 said.
        e: counter of the filament, mm.
        back: how much filament lies drawn back, mm.
        back_known: whether that is all.
        retracted: whether G10 has drawn filament back.
        target: of the nozzle, C.
        bed: target of the bed, C.
        hot: the nozzle has at least this temperature, C.
        cold: below this temperature it moves no filament, C.
        probed: whether the bed has been probed.
        levelled: whether what was probed is made use of.
        macro: the last macro, whose work is not known.
        at_end: axes that homing has left at their switches, of which GPX does not know the places.
        print: what stands on the bed, in the end code; None before the print.
    """

    at: dict[str, float | None] = field(default_factory=lambda: dict.fromkeys(EVERYTHING))
    least_z: float | None = None
    on_bed: bool = False
    homed: dict[str, bool | None] = field(default_factory=lambda: dict.fromkeys(EVERYTHING, False))
    relative: bool | None = False
    e_own: bool | None = False
    e_last: bool | None = False
    e: float | None = None
    back: float = 0.0
    back_known: bool = True
    retracted: bool = False
    target: float | None = 0.0
    bed: float | None = 0.0
    hot: float | None = 0.0
    cold: float = 170.0
    probed: bool = False
    levelled: bool = False
    macro: str = ""
    at_end: frozenset[str] = frozenset()
    print: Box | None = None

    @property
    def heats(self) -> bool:
        """Whether a heater is known to be on."""
        return bool(self.target) or bool(self.bed)

    @property
    def clear(self) -> bool:
        """Whether the nozzle is known to be clear of the bed."""
        return self.least_z is not None and self.least_z >= CLEAR

    def e_relative(self, firmware: str) -> bool | None:
        """Return whether E counts from its last value.

        G90 and G91 set it too in Marlin 2, and leave it alone in RepRapFirmware. In Klipper and GPX
        it is relative where either says so, as in Marlin 1.
        """
        either = True if self.relative or self.e_own else self.e_own
        either = None if self.relative is None and not self.e_own else either
        if firmware == "reprap":
            return self.e_own
        if firmware == "prusa":
            return self.e_last
        if firmware in ("klipper", "sailfish"):
            return either
        return either if either == self.e_last else None

    def lose_place(self) -> None:
        """Forget where the nozzle is: it went to a place of the machine's own choice."""
        self.at = dict.fromkeys(self.at)
        self.least_z, self.on_bed = 0.0, False

    def time_passes(self) -> None:
        """Take a nozzle that was told to cool for as cold as its target."""
        if self.target is not None and self.hot is not None:
            self.hot = min(self.hot, self.target)

    def forget(self, macro: str) -> None:
        """Forget all: a macro may have changed anything."""
        self.at = dict.fromkeys(self.at)
        self.homed = dict.fromkeys(self.at)
        self.least_z = self.relative = self.e_own = self.e_last = None
        self.e = self.target = self.bed = self.hot = None
        self.back_known = self.retracted = self.probed = self.on_bed = False
        self.macro = macro

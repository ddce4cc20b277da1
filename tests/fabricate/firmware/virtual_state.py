"""The state of a machine while it reads a file: modes, place, filament, heat, factors.

A quantity is a number, or NEVER (no line of the file has set it: whatever an earlier print left),
or HIDDEN (a macro may have set it: it cannot be known from the file). Using a quantity that is
NEVER is a danger; one that is HIDDEN is not, but it is counted.
"""

from dataclasses import dataclass, field
from typing import Any

NEVER, HIDDEN = "never", "hidden"
AXES = "XYZ"


def known(value: Any) -> bool:
    """Whether a quantity is a number (or a mode) and not NEVER or HIDDEN."""
    return value is not NEVER and value is not HIDDEN


@dataclass
class State:
    """Everything that a line can change.

    Attributes:
        place: of the nozzle in the machine's own coordinates, mm.
        shift: what G92 and its like added to the file's coordinates, mm.
        homed: whether the machine knows where an axis stands.
        relative: whether X, Y, Z count from the place before.
        e_own: whether E has a mode of its own (M82, M83), as Marlin keeps it.
        e_relative: whether E counts from the place before.
        inches: whether numbers are inches.
        e: counter of the filament, mm.
        back: how much filament lies drawn back, mm.
        retracted: whether G10 has drawn filament back.
        target: of the nozzle, C.
        coldest: what the nozzle may have at least, C.
        bed: target of the bed, C.
        flow: factor of M221, %.
        speed: factor of M220, %.
        fan: 0 to 255.
        levelled: whether the firmware levels by its mesh.
        probed: whether the file has probed the bed.
        limits: acceleration and corner speed as the file has set them, by name.
    """

    place: dict[str, Any] = field(default_factory=lambda: dict.fromkeys(AXES, NEVER))
    shift: dict[str, float] = field(default_factory=lambda: dict.fromkeys(AXES, 0.0))
    homed: dict[str, Any] = field(default_factory=lambda: dict.fromkeys(AXES, False))
    relative: Any = NEVER
    e_own: bool = False
    e_relative: Any = NEVER
    inches: Any = NEVER
    e: Any = NEVER
    back: Any = 0.0
    retracted: Any = False
    target: Any = 0.0
    coldest: Any = 0.0
    bed: Any = 0.0
    flow: Any = NEVER
    speed: Any = NEVER
    fan: Any = NEVER
    levelled: Any = NEVER
    probed: bool = False
    limits: dict[str, float] = field(default_factory=dict)

    def hide(self) -> None:
        """Forget all that a macro may have changed."""
        for axis in AXES:
            self.place[axis] = self.homed[axis] = HIDDEN
        self.relative = self.e_relative = self.inches = self.e = self.back = HIDDEN
        self.retracted = self.target = self.coldest = self.bed = HIDDEN
        self.flow = self.speed = self.fan = self.levelled = HIDDEN

    def hide_place(self) -> None:
        """Forget where the nozzle is: a command has moved it somewhere within reach."""
        for axis in AXES:
            self.place[axis] = HIDDEN

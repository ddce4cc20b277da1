"""How a machine moves: places, filament, and what it meets on its way.

Rules of Klipper's `kinematics/extruder.py` serve as bounds for every firmware: no bead thicker than
four squared nozzles, no more than 50 mm of filament in one place.
"""

from math import hypot, pi
from typing import Any

import numpy as np
from command_words import LIKE_MARLIN
from virtual_limits import Limits
from virtual_state import AXES, HIDDEN, NEVER, State, known
from virtual_trace import Trace

RUBS = 0.2  # mm above the bed below which a nozzle rubs on it
UNLOADS = 20.01  # mm of filament; more comes out of the melt zone
JUMP = 50.0  # mm of filament in one move without a way (Klipper: max_extrude_only_distance)
WIDEST = 4.0  # times the nozzle squared: section of a bead (Klipper: max_extrude_cross_section)
TRICKLE = 1.0  # mm of filament
PURGE = 1.5  # mm of filament on a millimetre of a purge line
TINY = 1e-6


class Mover:
    """The axes and the extruder.

    Attributes:
        printing: whether the first layer has begun.
        beads: x0 y0 x1 y1 z and filament of each move that prints, mm.
        top: of what is printed, mm.
        box: least x and y, greatest x and y of what is printed, mm.
    """

    def __init__(self, limits: Limits, state: State, trace: Trace) -> None:
        self.limits, self.firmware = limits, limits.firmware
        self.state, self.trace, self.danger = state, trace, trace.danger
        self.printing = False
        self.beads: list[tuple[float, ...]] = []
        self.top = 0.0
        self.box = [np.inf, np.inf, -np.inf, -np.inf]
        self.came: tuple[Any, Any] = (NEVER, NEVER)  # where the move began
        self.area = pi * limits.filament**2 / 4

    def move(self, words: dict[str, float | None]) -> None:
        s = self.state
        scale = 25.4 if s.inches is True else 1.0
        if s.inches is True:
            self.danger("inches", "the file is in millimetres")
        elif s.inches is NEVER and self.firmware in ("marlin", "reprap", "bambu"):
            self.danger("inches", "the file has not set millimetres")
        if "F" in words and not (words["F"] or 0) > 0 and self.firmware == "klipper":
            self.danger("speed", "a speed of nought is refused")
        place = s.place
        x0, y0, z0 = place["X"], place["Y"], place["Z"]
        self.came = x0, y0
        for axis in AXES:
            if words.get(axis) is not None:
                self.axis(axis, words[axis] * scale)
        fed = self.feed(words["E"] * scale) if words.get("E") is not None else 0.0
        x1, y1, z1 = place["X"], place["Y"], place["Z"]
        away: Any = HIDDEN
        if known(x1) and known(y1) and known(x0) and known(y0):
            away = hypot(x1 - x0, y1 - y0)
        elif not ("X" in words or "Y" in words):
            away = 0.0
        in_plane = away is HIDDEN or away > TINY
        if fed and fed is not HIDDEN:
            self.extruded(fed, away, z1)
        if in_plane and known(z0) and known(z1) and (fed == 0 or fed is HIDDEN):
            self.travelled(x0, y0, z0, x1, y1, z1, away)
        elif self.beads and "Z" in words and known(z1) and known(x1) and known(y1):
            self.lowered(x1, y1, z1)

    def axis(self, axis: str, value: float) -> None:
        s = self.state
        if s.homed[axis] is False or s.homed[axis] is NEVER:
            self.danger("not-homed", f"{axis} moves before it is homed")
        if s.relative is NEVER:
            self.danger("mode", "the file has not said whether places are absolute")
        if s.relative is HIDDEN:
            self.trace.hidden += 1
            s.place[axis] = HIDDEN
            return
        if not s.relative:
            value += s.shift[axis]
        elif known(s.place[axis]):
            value += s.place[axis]
        elif s.place[axis] is HIDDEN:
            self.trace.hidden += 1
            return
        elif axis == "Z" and value >= 0:
            return
        else:
            self.danger("reach", f"{axis} moves by {value:g} from a place that is not known")
            return
        least, most = self.limits.reach[AXES.index(axis)]
        if not least - TINY <= value <= most + TINY:
            self.danger("reach", f"{axis} {value:g}; the machine reaches {least:g} to {most:g}")
        s.place[axis] = value

    def e_relative(self) -> Any:
        """Return whether E is relative, as the firmware derives it from both modes."""
        s = self.state
        if self.firmware == "reprap":
            return s.e_relative
        if self.firmware in LIKE_MARLIN:
            return s.e_relative if s.e_own else s.relative
        if s.relative is True or s.e_relative is True:
            return True
        return next((m for m in (s.relative, s.e_relative) if not known(m)), False)

    def feed(self, value: float) -> Any:
        """Count an E and return how much filament it moves."""
        s = self.state
        relative = self.e_relative()
        if relative is NEVER:
            self.danger("e-mode", "the file has not said how E counts")
        if not known(relative):
            self.trace.hidden += 1
            s.e = s.back = HIDDEN
            return HIDDEN
        if relative:
            fed = value
            s.e = s.e + value if known(s.e) else s.e
        elif known(s.e):
            fed, s.e = value - s.e, value
        else:
            if s.e is NEVER:
                self.danger("e-jump", "E is absolute and the file has not set it before")
            self.trace.hidden += 1
            s.e, s.back = value, HIDDEN
            return HIDDEN
        if known(s.flow) and s.flow != 100:
            fed *= s.flow / 100
        return fed

    def extruded(self, fed: float, away: Any, z: Any) -> None:
        s = self.state
        along = away is not HIDDEN and away > TINY
        if self.printing and not self.beads and fed > 0 and along:
            self.begins()
        if s.coldest is HIDDEN:
            self.trace.hidden += 1
        elif s.coldest < self.limits.cold and ((along and fed > TRICKLE) or not self.beads):
            # A nozzle that was just switched off is still warm; it must not smear the print.
            self.danger("cold", f"the nozzle may have {s.coldest:g} C")
        self.trace.fed += fed
        if known(s.back):
            s.back = max(0.0, s.back - fed)
            if s.back > UNLOADS:
                self.danger("unload", f"{s.back:.0f} mm of filament are drawn back")
        elif fed < -UNLOADS:
            self.danger("unload", f"{-fed:.0f} mm of filament are drawn back")
        if away is HIDDEN:
            return
        if away <= TINY:
            if fed > JUMP:
                self.danger("e-jump", f"{fed:.0f} mm of filament in one place")
            return
        self.section(fed, away)
        if self.printing and s.target != 0:
            if fed > 0:
                self.bead(fed, z)
            elif fed < -TINY:
                self.danger("e-jump", f"{-fed:.2f} mm of filament are drawn back along a bead")

    def section(self, fed: float, away: float) -> None:
        """Check that a bead is not thicker than the nozzle can lay; a purge may be."""
        widest = WIDEST * self.limits.nozzle**2
        if self.firmware == "klipper" or self.printing:
            # Klipper lets a tiny amount pass.
            thick = fed * self.area > widest * max(away, self.limits.nozzle)
        else:
            thick = fed > PURGE * away
        if thick:
            self.danger("e-jump", f"{fed:.1f} mm of filament on {away:.1f} mm")

    def bead(self, fed: float, z: Any) -> None:
        x, y = self.state.place["X"], self.state.place["Y"]
        xa, ya = self.came
        if not (known(xa) and known(ya) and known(z) and known(x) and known(y)):
            self.danger("place", "a bead begins at a place that is not known")
            return
        self.beads.append((xa, ya, x, y, z, fed))
        self.top = max(self.top, z)
        box = self.box
        box[0], box[1] = min(box[0], xa, x), min(box[1], ya, y)
        box[2], box[3] = max(box[2], xa, x), max(box[3], ya, y)
        self.on_bed(xa, ya, x, y)

    def on_bed(self, xa: float, ya: float, x: float, y: float) -> None:
        """Check that a bead lies on the bed and in no excluded zone."""
        (low_x, low_y), (high_x, high_y) = self.limits.bed
        if not (low_x <= min(xa, x) and max(xa, x) <= high_x) or not (
            low_y <= min(ya, y) and max(ya, y) <= high_y
        ):
            self.danger("bed", f"a bead leads to {x:g}, {y:g}")
        if self.limits.round_bed:
            radius, cx, cy = (high_x - low_x) / 2, (low_x + high_x) / 2, (low_y + high_y) / 2
            if hypot(x - cx, y - cy) > radius or hypot(xa - cx, ya - cy) > radius:
                self.danger("bed", f"a bead leads to {x:g}, {y:g} beside the round bed")
        for corners in self.limits.excluded:
            (u0, u1), (v0, v1) = sorted(c[0] for c in corners), sorted(c[1] for c in corners)
            if _meets(xa, ya, x, y, u0, v0, u1, v1):
                self.danger("excluded", f"a bead leads to {x:g}, {y:g}")

    def travelled(self, x0, y0, z0, x1, y1, z1, away) -> None:
        """Check a move in the plane that does not print."""
        low = min(z0, z1)
        if not self.beads:
            if (away is HIDDEN or away > 2) and max(z0, z1) < RUBS - TINY:
                self.danger("low-travel", f"the nozzle travels {low:g} mm above the bed")
            return
        if low < self.top - TINY and known(x0) and known(x1) and known(y0) and known(y1):
            x_low, y_low, x_high, y_high = self.box
            if _meets(x0, y0, x1, y1, x_low, y_low, x_high, y_high):
                self.danger("hits-print", f"the nozzle travels at {low:g}, the print is higher")

    def lowered(self, x: float, y: float, z: float) -> None:
        x_low, y_low, x_high, y_high = self.box
        if z < self.top - TINY and x_low <= x <= x_high and y_low <= y <= y_high:
            self.danger("hits-print", f"the nozzle goes down to {z:g}, the print is higher")

    def begins(self) -> None:
        """Check the state in which the first bead begins."""
        s = self.state
        self.trace.first = {
            "flow": s.flow,
            "speed": s.speed,
            "relative": s.relative,
            "levelled": s.levelled,
            "back": s.back,
            "coldest": s.coldest,
            "bed": s.bed,
            "fan": s.fan,
            "limits": dict(s.limits),
            "homed": dict(s.homed),
        }
        for name in ("flow", "speed"):
            if (factor := getattr(s, name)) != 100 and factor is not HIDDEN:
                self.danger("factors", f"the factor of the {name} is {factor}")
        if s.relative is True:
            self.danger("relative", "the first bead begins in relative places")
        if any(s.shift.values()):
            self.danger("origin", f"the origin is shifted by {s.shift}")
        if s.probed and s.levelled is False:
            self.danger("not-levelled", "the bed was probed, and levelling is not active")
        if (known(s.back) and s.back > 0.02) or s.retracted is True:
            self.danger("drawn-back", f"{s.back} mm of filament are drawn back")
        if s.coldest is not HIDDEN and s.coldest < self.limits.printing - 1:
            self.danger("cold", f"the first bead begins at {s.coldest} C")


def _meets(x0, y0, x1, y1, x_low, y_low, x_high, y_high) -> bool:
    """Whether a line from one place to another meets a rectangle (Liang and Barsky, 1984)."""
    begin, end = 0.0, 1.0
    for p, q in (
        (x0 - x1, x0 - x_low),
        (x1 - x0, x_high - x0),
        (y0 - y1, y0 - y_low),
        (y1 - y0, y_high - y0),
    ):
        if p == 0:
            if q < 0:
                return False
        elif p < 0:
            begin = max(begin, q / p)
        else:
            end = min(end, q / p)
    return begin <= end

"""What firmwares do differently, and the lines that set a machine's limits and factors.

Read in the sources: Marlin 2.1 (`gcode/parser.cpp`, `gcode.h`, `config/M200-M205.cpp`), Prusa Buddy
6 (the same files, `Configuration_MK4.h`), Klipper 0.13 (`klippy/gcode.py`, `toolhead.py`,
`extras/gcode_move.py`, `kinematics/extruder.py`), RepRapFirmware 3 (`GCodes2.cpp`), GPX 2.6.8
(`gpx.c`). Bambu Lab's firmware is not public; what its maker's slicer writes is of Marlin's kind.
"""

from dataclasses import dataclass
from math import sqrt

from simulearn.fabricate.printer import Printer
from simulearn.fabricate.settings import Settings


@dataclass(frozen=True)
class Dialect:
    """How a firmware reads code.

    Attributes:
        title: what people call it.
        cold: below this temperature it moves no filament, C.
        longest: characters of a line, without its comment; None: no limit that matters.
        lower_case: whether it reads commands in small letters.
        several: whether it reads several commands on a line.
        parentheses: whether what stands in parentheses is a comment.
        exact: whether it compares commands as texts, so that G01 is not G1.
        macros: whether a word of its owner's making may be a command.
        touches: above this temperature its nozzle oozes onto the bed that it touches to find it,
            C; None where a probe or a switch finds the bed.
    """

    title: str
    cold: float = 170.0
    longest: int | None = None
    lower_case: bool = True
    several: bool = False
    parentheses: bool = False
    exact: bool = False
    macros: bool = False
    touches: float | None = None


DIALECTS = {
    "marlin": Dialect("Marlin", longest=95, lower_case=False),
    "prusa": Dialect("Prusa's firmware", longest=95, lower_case=False, touches=175.0),
    "bambu": Dialect("Bambu Lab's firmware", lower_case=False, touches=150.0),
    "klipper": Dialect("Klipper", exact=True, macros=True),
    "reprap": Dialect("RepRapFirmware", cold=160.0, longest=255, several=True, parentheses=True),
    "sailfish": Dialect("GPX", several=True, parentheses=True),
}
FACTORS = ("M220 S100", "M221 S100")  # of speed and flow, in every dialect alike
# Marlin refuses junction deviations outside of this range (M205 J), mm.
LEAST_DEVIATION, MOST_DEVIATION = 0.01, 0.3


def limits(settings: Settings, printer: Printer) -> list[str]:
    """Return the lines that set acceleration and corner speed as the print assumes them.

    Args:
        settings: acceleration (mm/s2) and corner speed (mm/s).
        printer: its firmware, and acceleration along Z and of the filament.
    """
    if printer.firmware == "sailfish":
        return ["; acceleration and corner speed are the machine's own: GPX passes none on"]
    if not printer.code.limits:
        return ["; acceleration and corner speed are the machine's own: code.limits is false"]
    prints, travels = f"{settings.acceleration:g}", f"{settings.acceleration_travel:g}"
    corner = f"{settings.corner_speed:g}"
    if printer.firmware == "klipper":
        # One acceleration for prints and travels. A ratio of 0 lets short strokes reach their
        # speed; Klipper before 2024 does not know the word and passes over it.
        return [
            f"SET_VELOCITY_LIMIT ACCEL={prints} SQUARE_CORNER_VELOCITY={corner} "
            "MINIMUM_CRUISE_RATIO=0"
        ]
    if printer.firmware == "reprap":
        jerk = f"{60 * settings.corner_speed:g}"  # mm/min
        return [f"M204 P{prints} T{travels}", f"M566 X{jerk} Y{jerk}"]
    motion = printer.motion
    lines = [
        f"M204 P{prints} R{motion.acceleration_e:g} T{travels}",
        f"M205 X{corner} Y{corner}{_deviation(settings, printer)}",
    ]
    if printer.firmware in ("prusa", "bambu"):  # M204 goes no higher than M201, low in theirs
        most = f"{max(settings.acceleration, settings.acceleration_travel):g}"
        z, e = f"{motion.acceleration_z:g}", f"{motion.acceleration_e:g}"
        lines.insert(0, f"M201 X{most} Y{most} Z{z} E{e}")
    return lines


def _deviation(settings: Settings, printer: Printer) -> str:
    """Return the junction deviation that takes right angles at the corner speed, for M205.

    Marlin is built with jerk (X, Y) or with junction deviation (J) and passes over the other.
    v^2 = a J s / (1 - s) with s = sin 45 degrees (Jeon's rule, in Marlin's `planner.cpp`).
    """
    if printer.firmware != "marlin":
        return ""
    deviation = settings.corner_speed**2 / settings.acceleration * (sqrt(2) - 1)
    return f" J{min(max(deviation, LEAST_DEVIATION), MOST_DEVIATION):.3f}"

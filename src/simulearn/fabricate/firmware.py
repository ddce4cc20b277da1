"""What differs between firmwares: how accelerations and corner speeds are set.

Sources: Marlin 2.1 (M204.cpp, M205_M566.cpp, planner.cpp), Prusa-Firmware-Buddy (the same files),
Klipper (toolhead.py), RepRapFirmware 3 (GCodes2.cpp), BambuStudio (X1 Carbon profiles), GPX 2.6.
"""

from math import sqrt

from simulearn.fabricate.printer import Printer
from simulearn.fabricate.settings import Settings

# What Marlin takes for a junction deviation, mm.
LEAST_DEVIATION, MOST_DEVIATION = 0.01, 0.3


def limits(settings: Settings, printer: Printer) -> list[str]:
    """Return the lines that set accelerations (mm/s2) and the speed at a right angle (mm/s).

    Where a firmware keeps one acceleration for prints and travels, it is that of the print. Of a
    Bambu only the acceleration is set, of a Replicator (GPX) nothing can be.
    """
    print_, travel = settings.acceleration, settings.acceleration_travel
    corner = settings.corner_speed
    if printer.firmware == "klipper":
        return [
            f"SET_VELOCITY_LIMIT ACCEL={print_:g} SQUARE_CORNER_VELOCITY={corner:g} "
            f"MINIMUM_CRUISE_RATIO=0"
        ]
    if printer.firmware == "reprap":  # jerk in mm/min
        return [f"M204 P{print_:g} T{travel:g}", f"M566 X{60 * corner:g} Y{60 * corner:g}"]
    if printer.firmware == "prusa":
        return [f"M204 P{print_:g} T{travel:g}", f"M205 X{corner:g} Y{corner:g}"]
    if printer.firmware == "bambu":
        return [f"M204 S{print_:g}"]
    if printer.firmware == "sailfish":
        return ["; accelerations are the machine's own: GPX has no command for them"]
    # A build of Marlin knows either jerk or the deviation at a junction, and passes over the other.
    deviation = (sqrt(2) - 1) * corner**2 / print_
    deviation = min(max(deviation, LEAST_DEVIATION), MOST_DEVIATION)
    return [
        f"M204 P{print_:g} T{travel:g}",
        f"M205 X{corner:g} Y{corner:g}",
        f"M205 J{deviation:.4f}",
    ]


def factors(printer: Printer) -> list[str]:
    """Return the lines that set the factors of speed and flow to 100 per cent."""
    if printer.firmware == "sailfish":
        return ["; factors of speed and flow are set on the machine: GPX has no command for them"]
    return ["M220 S100", "M221 S100"]

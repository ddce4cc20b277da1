"""Commands that must not stand in start or end code, and why."""

import re

from simulearn.errors import InputError
from simulearn.fabricate.commands import Command
from simulearn.fabricate.printer import Printer

ORIGIN = "moves the origin, and with it the print"
SETTINGS = "changes the machine's own settings"
STOPS = "stops the print"
OTHER = "prints or writes another file"
UNLOADS = "unloads the filament, which would be missing in the next print"
ALWAYS = {
    "G20": "counts in inches, and files are in millimetres",
    "G52": ORIGIN,
    "M206": ORIGIN,
    "M428": ORIGIN,
    "SET_GCODE_OFFSET": ORIGIN,
    "SET_KINEMATIC_POSITION": ORIGIN,
    "M851": "moves the probe, and with it the height of the print",
    "M92": "changes how far the machine moves",
    "M350": "changes how far the machine moves",
    "M502": SETTINGS,
    "FORCE_MOVE": "moves a motor without regard to the machine's limits",
    "G2": "is an arc, and an arc (G2, G3) cannot be checked; use straight moves",
    "G3": "is an arc, and an arc (G2, G3) cannot be checked; use straight moves",
    "G5": "is a curve, which cannot be checked; use straight moves",
    "M600": "waits for other filament",
    "M702": UNLOADS,
    "T255": UNLOADS,
    "UNLOAD_FILAMENT": UNLOADS,
    "M112": STOPS,
    "M81": "switches the machine off, whose nozzle is still hot",
    "M997": "restarts the machine",
    "M999": "restarts the machine",
    "RESTART": "restarts the machine",
    "FIRMWARE_RESTART": "restarts the machine",
    "SAVE_CONFIG": "restarts the machine",
    "CANCEL_PRINT": STOPS,
    "M524": STOPS,
    "M23": OTHER,
    "M24": OTHER,
    "M28": OTHER,
    "M30": OTHER,
    "M32": OTHER,
    "M37": OTHER,
    "SDCARD_PRINT_FILE": OTHER,
    "SDCARD_RESET_FILE": OTHER,
}
# The coordinate systems G54 to G59.3, and what else of G92 there is (G92.1 and the like).
SYSTEM = re.compile(r"G(5[4-9](\.\d+)?|92\.\d+)")
COLDEST = 150.0  # C; M302 must not allow filament to be moved below it


def check(command: Command, printer: Printer, where: str) -> None:
    """Make sure that a command may stand in start or end code.

    Raises:
        InputError: it may not.
    """
    reason = _reason(command, printer, where)
    if reason:
        raise InputError(f"{where}: {reason}; leave it out")


def _reason(command: Command, printer: Printer, where: str) -> str:
    name, words = command.name, command.words
    if name in ALWAYS:
        return f"{name} {ALWAYS[name]}"
    if SYSTEM.fullmatch(name):
        return f"{name} {ORIGIN}"
    if name in ("G10", "G92"):  # G10 alone draws filament back
        for axis in "LXYZ" if name == "G10" else "XYZ":
            if axis in words:
                hint = "" if name == "G10" else "; only G92 E is allowed"
                return f"{name} {axis}{words[axis]} {ORIGIN}{hint}"
    if name == "M200" and (command.number("D", where) or command.number("S", where)):
        return "M200 changes how E is counted; D0 alone is allowed"
    if name == "M302":
        least = command.number("S", where)
        if command.number("P", where) or (least is not None and least < COLDEST) or not words:
            return f"M302 allows cold filament to be moved; S{COLDEST:g} or more is allowed"
    if name == "M620" and words.get("S", "").startswith("255"):
        return f"M620 S255 {UNLOADS}"
    if name in ("M0", "M1", "M2") and printer.firmware == "reprap" and "code.start" in where:
        return f"{name} {STOPS}"
    return ""

"""Moves in start and end code: within reach, of axes that are homed, of filament that is hot."""

from math import hypot, pi

from simulearn.errors import InputError
from simulearn.fabricate.commands import GLUED, Command
from simulearn.fabricate.printer import Printer
from simulearn.fabricate.state import State

ROUNDING = 1e-6
RUBS = 0.2  # mm above the bed below which a nozzle rubs on it
MOST_BACK = 20.0  # mm of filament; further back it leaves the melt zone and is unloaded
MOST_AT_ONCE = 50.0  # mm of filament without a move; Klipper refuses more
MOST_LEFT = 1.0  # mm of filament that end code may feed beyond what is drawn back
WIDEST = 4.0  # times the nozzle squared: section of a bead above which Klipper refuses
NOZZLE = 0.4  # mm, where a profile does not say


def move(command: Command, state: State, printer: Printer, where: str) -> None:
    """Follow a straight move.

    Raises:
        InputError: it leads out of reach, or from where nothing is known, or moves filament that is
            cold, or too much of it.
    """
    if GLUED.search(command.text.replace(command.name, "", 1)):
        # 1E5 is X1 and E5 to some printers, 100000 to others.
        raise InputError(
            f"{where}: printers differ in how they read {command.text}; put a space before E"
        )
    for letter in "XYZEF":
        if command.words.get(letter) == "":
            raise InputError(f"{where}: {letter} is not a number in {command.text}")
    before = dict(state.at)
    for axis in "XYZ":
        value = command.number(axis, where)
        if value is not None:
            _axis(axis, value, state, printer, where)
    for letter in "FIJ":
        value = command.number(letter, where)
        if letter == "F" and value is not None and value <= 0:
            raise InputError(f"{where}: F{command.words['F']} is no speed")
    _homed(command, state, printer, where)
    _on_bed(command, state, printer, where)
    _over_print(before, state, where)
    value = command.number("E", where)
    if state.on_bed and value is None and (command.words.keys() & {"X", "Y"}):
        raise InputError(
            f"{where}: moves across the bed with the nozzle on it, as far as is known after "
            f"homing; write a move in Z before it, as G0 Z5"
        )
    if value is not None:
        _feed(value, _length(command, before, state), state, printer, where)


def reach(printer: Printer) -> dict[str, tuple[float, float]]:
    """Return from where to where code may move, by axis, mm."""
    bed, given = printer.bed, printer.reach
    return {
        "X": given.x or (bed.low[0], bed.high[0]),
        "Y": given.y or (bed.low[1], bed.high[1]),
        "Z": given.z or (0.0, bed.height),
    }


def _axis(axis: str, value: float, state: State, printer: Printer, where: str) -> None:
    least, most = reach(printer)[axis]
    before = state.at[axis]
    if state.relative is None:
        raise InputError(
            f"{where}: whether {axis}{value:g} is absolute or relative is not known after a "
            f"macro; write G90 or G91 before it"
        )
    if state.relative and before is None:
        if axis == "Z" and value >= 0:  # up is safe from anywhere
            state.least_z = None if state.least_z is None else state.least_z + value
            state.on_bed = state.on_bed and value < RUBS
            return
        raise InputError(
            f"{where}: {axis}{value:g} is relative to a place that is not known here; "
            f"move there in absolute numbers (G90) first"
        )
    if state.relative and before is not None:
        value += before
    if not least - ROUNDING <= value <= most + ROUNDING:
        raise InputError(
            f"{where}: leads to {axis} {value:g} mm; {printer.name} reaches {least:g} to {most:g}"
        )
    state.at[axis] = value
    if axis == "Z":
        state.least_z = value
        state.on_bed = value < RUBS


def _homed(command: Command, state: State, printer: Printer, where: str) -> None:
    for axis in "XYZ":
        if not command.words.get(axis) or state.homed[axis] is not False:
            continue
        if axis == "Z" and state.relative and _rises(command, state, printer):
            continue
        hint = "home it first (G28)"
        if printer.firmware == "sailfish":
            hint = "write M132 X Y Z A B after homing"
        raise InputError(f"{where}: {axis} moves before the machine knows where it is; {hint}")


def _rises(command: Command, state: State, printer: Printer) -> bool:
    """Return whether an axis that is not homed may lift the nozzle: only before homing."""
    if state.print is not None:
        return False
    if printer.firmware == "reprap":
        return "H" in command.words
    return printer.firmware != "klipper"


def _on_bed(command: Command, state: State, printer: Printer, where: str) -> None:
    """Make sure that a move stays on a round bed."""
    x, y, bed = state.at["X"], state.at["Y"], printer.bed
    moved = command.words.get("X") or command.words.get("Y")
    if not moved or x is None or y is None or printer.reach.x or printer.reach.y:
        return
    away, most = hypot(x - bed.middle[0], y - bed.middle[1]), bed.width / 2
    if away <= most + ROUNDING:
        return
    text = f"{where}: leads {away:.1f} mm away from the middle of the bed"
    if bed.round:
        raise InputError(f"{text}, which is round; {printer.name} reaches {most:g} mm")
    if bed.shape_unclear:
        raise InputError(f"{text}; {bed.ask_shape()}")


def _over_print(before: dict[str, float | None], state: State, where: str) -> None:
    """Make sure that the nozzle does not come down where the print stands."""
    box, z = state.print, state.at["Z"]
    heights = [height for height in (before["Z"], z) if height is not None]
    if box is None or not heights or min(heights) >= box.top - ROUNDING:
        return
    places = [(at["X"], at["Y"]) for at in (before, state.at)]
    known = [(x, y) for x, y in places if x is not None and y is not None]
    if len(known) < len(places) or box.meets(*known):
        raise InputError(
            f"{where}: leads down to Z {min(heights):g} mm where the print stands, which is "
            f"{box.top:g} mm high"
        )


def _length(command: Command, before: dict[str, float | None], state: State) -> float | None:
    """Return how far a move leads in the plane, mm; None where its beginning is not known."""
    steps = []
    for axis in "XY":
        old, new = before[axis], state.at[axis]
        if command.words.get(axis) and (old is None or new is None):
            return None
        steps.append((new or 0.0) - (old or 0.0) if command.words.get(axis) else 0.0)
    return hypot(*steps)


def _feed(value: float, length: float | None, state: State, printer: Printer, where: str) -> None:
    """Follow the filament of a move."""
    relative = state.e_relative(printer.firmware)
    if relative is None:
        after = (
            f"after {state.macro}" if state.macro else "after G90 or G91, which differs by version"
        )
        raise InputError(
            f"{where}: whether E{value:g} is absolute or relative is not known {after}; write M82 "
            f"or M83 before it"
        )
    if relative:
        fed = value
        state.e = None if state.e is None else state.e + value
    elif state.e is None:
        raise InputError(
            f"{where}: E{value:g} is absolute, and where E stands is not known; write G92 E0 "
            f"before it"
        )
    else:
        fed, state.e = value - state.e, value
    if not fed:
        return
    if state.hot is not None and state.hot < state.cold:
        raise InputError(
            f"{where}: moves filament before the nozzle is hot; write M109 S{{temperature}} "
            f"before it"
        )
    if state.print is not None and fed > state.back + MOST_LEFT:
        raise InputError(
            f"{where}: feeds {fed:g} mm of filament after the print, and the heaters are off; "
            f"leave it out"
        )
    state.back = max(0.0, state.back - fed)
    if state.back > MOST_BACK:
        raise InputError(
            f"{where}: draws back {state.back:g} mm of filament in all, out of the hot end; at "
            f"most {MOST_BACK:g} mm may be"
        )
    _amount(fed, length, printer, where)


def _amount(fed: float, length: float | None, printer: Printer, where: str) -> None:
    """Make sure that a move feeds no more than a machine takes."""
    if length is None:
        return
    if length <= ROUNDING:
        if fed > MOST_AT_ONCE:
            raise InputError(
                f"{where}: feeds {fed:g} mm of filament in one place; at most {MOST_AT_ONCE:g} mm "
                f"are taken at once"
            )
        return
    if printer.firmware != "klipper":
        return
    area = pi * printer.extruder.filament**2 / 4
    nozzle = float(printer.print.get("nozzle", NOZZLE))
    most = WIDEST * nozzle**2 / area  # mm of filament for each mm
    if fed > most * max(length, nozzle):
        raise InputError(
            f"{where}: feeds {fed:g} mm of filament on {length:g} mm; Klipper takes at most "
            f"{most * length:.3g} mm there"
        )

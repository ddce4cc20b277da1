"""The code before and after a print: words in braces filled in, every line checked as state.

A profile's code goes to the printer as it stands. What it does is followed in the dialect of the
printer's firmware (see machine.py): the start code begins in millimetres and absolute coordinates,
with E as the profile counts it; the end code begins at the place of the last move, with E relative.
Where a line of the start code lets a hot nozzle wait on the bed, a lift is written before it.
"""

import re
import unicodedata
from dataclasses import dataclass, replace

from simulearn.errors import InputError
from simulearn.fabricate import heat
from simulearn.fabricate.commands import Command, commands
from simulearn.fabricate.firmware import DIALECTS
from simulearn.fabricate.machine import Machine
from simulearn.fabricate.moves import Moves
from simulearn.fabricate.placeholders import fill, fill_comment
from simulearn.fabricate.printer import Printer
from simulearn.fabricate.settings import Settings
from simulearn.fabricate.state import Box, State
from simulearn.fabricate.toolpath import Toolpath
from simulearn.grid import Message

ZERO = re.compile(r"[A-Za-z]\s*0\d")
LIFT = 10.0  # mm above the bed, where a nozzle heats up


@dataclass(frozen=True)
class Frame:
    """What a profile's code may name: see docs/printers.md.

    Attributes:
        low: least x and y of what is printed, mm.
        high: greatest x and y.
        top: height of what is printed, mm.
        last: x, y and z of the nozzle after the print, mm.
    """

    low: tuple[float, float]
    high: tuple[float, float]
    top: float
    last: tuple[float, float, float]


def frame_of(path: Toolpath, moves: Moves) -> Frame:
    """Return where a toolpath is printed."""
    low, high = path.bounds.tolist()
    return Frame(tuple(low), tuple(high), path.layers[-1].z, tuple(moves.places[-1].tolist()))


@dataclass(frozen=True)
class Script:
    """Start or end code.

    Attributes:
        lines: as they go to the printer.
        state: of the machine after the last of them.
        messages: what may be wrong with them.
    """

    lines: list[str]
    state: State
    messages: list[Message]


def start_code(printer: Printer, settings: Settings, frame: Frame) -> Script:
    """Return a printer's start code.

    Args:
        printer: whose code.
        settings: how it prints.
        frame: where it prints.

    Raises:
        InputError: a word is not known, or a line does what it must not.
    """
    relative = printer.extruder.extrusion == "relative"
    ended = end_code(printer, settings, frame).state
    state = State(
        e_own=relative,
        e_last=relative,
        e=None if printer.firmware == "sailfish" else 0.0,
        back=ended.back if ended.back_known else settings.retraction,
        cold=heat.cold_limit(printer),
    )
    script = _script(printer, settings, frame, "start", state)
    _ready(script.state, printer)
    return script


def end_code(printer: Printer, settings: Settings, frame: Frame) -> Script:
    """Return a printer's end code; arguments and errors as those of the start code."""
    state = State(
        at=dict(zip("XYZ", frame.last, strict=True)),
        least_z=frame.last[2],
        homed=dict.fromkeys("XYZ", True),
        e_own=True,
        e_last=True,
        e=0.0,
        back=settings.retraction,
        hot=settings.temperature,
        print=Box(frame.low, frame.high, frame.top),
        cold=heat.cold_limit(printer),
    )
    script = _script(printer, settings, frame, "end", state)
    _pushed_back(script.state, f"{printer.name}: code.end")
    return script


def code_messages(printer: Printer, settings: Settings, frame: Frame) -> list[Message]:
    """Return what may be wrong with a printer's code; none where it is refused, which says more."""
    try:
        start = start_code(printer, settings, frame)
        return [*start.messages, *end_code(printer, settings, frame).messages]
    except InputError:
        return []


def lift(settings: Settings, printer: Printer) -> str:
    """Return the move that takes the nozzle off the bed, in absolute coordinates."""
    return f"G0 Z{min(LIFT, printer.bed.height):g} F{settings.speed_z:g}"


def _script(printer: Printer, settings: Settings, frame: Frame, which: str, state: State) -> Script:
    words = _words(printer, settings, frame)
    machine = Machine(printer, replace(state))
    lines = []
    for k, line in enumerate(getattr(printer.code, which).strip("\n").splitlines(), 1):
        where = f"{printer.name}: code.{which}, line {k}"
        code, mark, comment = line.partition(";")
        _ascii(code, where)
        code = fill(code, words, where).rstrip()
        for command in _commands(code, printer, where):
            if which == "start" and _lifts(command, machine.state, printer, where):
                lines += _off_bed(machine, settings, where)
            machine.run(command, where)
            _in_dialect(command, printer, where)
        comment = _plain(fill_comment(comment, words))
        lines.append(f"{code} {mark}{comment}".strip() if mark else code)
    return Script(lines, machine.state, machine.messages)


def _words(printer: Printer, settings: Settings, frame: Frame) -> dict[str, str]:
    """Return the words that code may name, as they are filled in."""
    bed = printer.bed
    numbers = {
        "temperature": settings.temperature,
        "bed": settings.bed,
        "nozzle": settings.nozzle,
        "filament": settings.filament,
        "layer": settings.layer,
        "min_x": frame.low[0],
        "min_y": frame.low[1],
        "max_x": frame.high[0],
        "max_y": frame.high[1],
        "size_x": frame.high[0] - frame.low[0],
        "size_y": frame.high[1] - frame.low[1],
        "top": frame.last[2],
        "bed_min_x": bed.low[0],
        "bed_min_y": bed.low[1],
        "bed_max_x": bed.high[0],
        "bed_max_y": bed.high[1],
        "bed_max_z": bed.height,
    }
    return {name: f"{x:.3f}".rstrip("0").rstrip(".") for name, x in numbers.items()}


def _commands(code: str, printer: Printer, where: str) -> list[Command]:
    """Return the commands of a line, all of which the firmware reads."""
    dialect = DIALECTS[printer.firmware]
    found = commands(code, dialect)
    if dialect.longest and len(code.strip()) > dialect.longest:
        raise InputError(
            f"{where}: has {len(code.strip())} characters; {dialect.title} reads {dialect.longest}"
        )
    return found if dialect.several or len(found) < 2 else _one(found, dialect.title, where)


def _one(found: list[Command], firmware: str, where: str) -> list[Command]:
    names = " and ".join(command.name for command in found)
    raise InputError(f"{where}: {names} stand on one line, of which {firmware} does only the first")


def _in_dialect(command: Command, printer: Printer, where: str) -> None:
    dialect = DIALECTS[printer.firmware]
    if not dialect.lower_case and command.is_code and command.text[0].islower():
        raise InputError(
            f"{where}: {dialect.title} does not read small letters; write {command.text.upper()}"
        )
    if dialect.exact and command.is_code and ZERO.match(command.text):
        raise InputError(
            f"{where}: {dialect.title} does not know {command.text.split()[0]}; write "
            f"{command.name}"
        )


def _lifts(command: Command, state: State, printer: Printer, where: str) -> bool:
    """Return whether a command lets a hot nozzle wait on the bed."""
    low = state.least_z is not None and not state.clear
    return low and command.name in heat.COMMANDS and heat.waits(command, state, printer, where)


def _off_bed(machine: Machine, settings: Settings, where: str) -> list[str]:
    """Return the lines that lift the nozzle, and follow them."""
    state, printer = machine.state, machine.printer
    if not state.homed["Z"] or state.relative is None:
        raise InputError(
            f"{where}: heats the nozzle while it touches the bed; write a move off the bed before "
            f"it, as G90 and {lift(settings, printer)}"
        )
    line = lift(settings, printer)
    for command in commands(line, DIALECTS[printer.firmware]):
        machine.run(command, where)
    return [f"{line} ; SimuLearn: off the bed before the nozzle waits hot"]


def _ready(state: State, printer: Printer) -> None:
    """Make sure that a print can begin in a state."""
    where = f"{printer.name}: code.start"
    if printer.firmware == "sailfish" and None in state.at.values():
        raise InputError(
            f"{where}: where the axes are is not known to GPX; write G28, M132 X Y Z A B, and a "
            f"move to X, Y and Z in absolute numbers (G90)"
        )
    for axis, homed in state.homed.items():
        if homed is False:
            raise InputError(f"{where}: does not home {axis}; write G28 into it")
    if printer.firmware in ("marlin", "prusa") and state.probed and not state.levelled:
        better = "G29 A" if printer.firmware == "prusa" else "M420 S1"
        raise InputError(
            f"{where}: probes the bed (G29), but homing (G28) switches levelling off; write "
            f"{better} after both"
        )
    _pushed_back(state, where)


def _pushed_back(state: State, where: str) -> None:
    """Make sure that the next moves do not begin with filament that G10 has drawn back."""
    if state.retracted:
        raise InputError(
            f"{where}: draws filament back (G10) and does not push it back (G11); write G1 E-2, "
            f"which is followed, or both"
        )


def _ascii(code: str, where: str) -> None:
    """Make sure that a line's code has only what printers read."""
    for column, letter in enumerate(code, 1):
        if letter != "\t" and not (letter.isascii() and letter.isprintable()):
            shown = letter if letter.isprintable() else f"U+{ord(letter):04X}"
            raise InputError(
                f"{where}, column {column}: {shown} is nothing that printers read; use plain ASCII"
            )


def _plain(comment: str) -> str:
    """Return a comment in ASCII: letters without their accents, no other characters."""
    text = unicodedata.normalize("NFKD", comment.replace("\t", " "))
    return "".join(c for c in text if c.isascii() and c.isprintable()).rstrip()

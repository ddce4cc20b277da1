"""The code before and after a print: words in braces filled in, run on a machine that is checked.

A profile's code goes to the printer as it stands. The file sets millimetres, absolute coordinates
and how E is counted before the start code; the end code begins in absolute coordinates at the place
of the last move, with E at zero.
"""

import re
import unicodedata
from dataclasses import dataclass

from simulearn.errors import InputError
from simulearn.fabricate import placeholders
from simulearn.fabricate.command import commands
from simulearn.fabricate.machine import Machine
from simulearn.fabricate.printer import Printer
from simulearn.fabricate.settings import Settings
from simulearn.grid import Message

FACTORS = {"M220": "speed", "M221": "flow"}
COMMENT = re.compile(r"(;.*)")


@dataclass(frozen=True)
class Frame:
    """What a profile's code may name: see docs/printers.md.

    Attributes:
        low: least x and y of what is printed, mm.
        high: greatest x and y.
        last: x, y and z of the nozzle after the print, mm.
        height: of the print, mm.
    """

    low: tuple[float, float]
    high: tuple[float, float]
    last: tuple[float, float, float]
    height: float


def start_code(printer: Printer, settings: Settings, frame: Frame) -> tuple[list[str], Machine]:
    """Return the lines of a printer's start code, and the machine as they leave it.

    Args:
        printer: whose code.
        settings: how it prints.
        frame: where it prints.

    Raises:
        InputError: a word is not known, or a line would break something.
    """
    machine = Machine(printer)
    lines = _run(printer, settings, frame, "start", machine)
    machine.finish(f"{printer.name}: code.start")
    return lines, machine


def end_code(printer: Printer, settings: Settings, frame: Frame) -> list[str]:
    """Return the lines of a printer's end code.

    Args:
        printer: whose code.
        settings: how it prints.
        frame: where it prints.

    Raises:
        InputError: a word is not known, or a line would break something.
    """
    machine = Machine(printer, frame.last, frame.height, settings.retraction)
    return _run(printer, settings, frame, "end", machine)


def factor_warnings(printer: Printer) -> list[Message]:
    """Return a warning for each factor of speed or flow that the start code sets."""
    messages = []
    for k, line in enumerate(_lines(printer.code.start), 1):
        where = f"{printer.name}: code.start, line {k}"
        if not any(factor in line.upper() for factor in FACTORS):
            continue
        for command in commands(_parts(line)[0], where):
            share = command.value("S", where) if command.head in FACTORS else None
            if share is not None and share != 100:
                what = FACTORS[command.head]
                text = (
                    f"the start code of {printer.name} sets the {what} to {share:g} % (line {k}); "
                    f"it is set to 100 before the print, as the curl was measured"
                )
                messages.append(Message("factor", "code.start", text))
    return messages


def _run(
    printer: Printer, settings: Settings, frame: Frame, which: str, machine: Machine
) -> list[str]:
    words = {key: _number(value) for key, value in _words(printer, settings, frame).items()}
    lines = []
    for k, line in enumerate(_lines(getattr(printer.code, which)), 1):
        where = f"{printer.name}: code.{which}, line {k}"
        code, comment = _parts(line)
        for place, letter in enumerate(code.replace("\t", " "), 1):
            if not (letter.isascii() and letter.isprintable()):
                raise InputError(
                    f"{where}: character {place} is {letter!r}, which printers cannot read; use "
                    f"plain ASCII"
                )
        code = placeholders.filled(code, words, where)
        lines += machine.run(code, where)
        lines.append((code + _plain(comment)).rstrip())
    return lines


def _lines(text: str) -> list[str]:
    return text.strip("\n").splitlines()


def _parts(line: str) -> tuple[str, str]:
    """Return a line's code and its comment."""
    code, comment, _ = (*COMMENT.split(line, maxsplit=1), "", "")[:3]
    return code, comment


def _plain(comment: str) -> str:
    """Return a comment in ASCII: letters without accents, what is left as question marks."""
    apart = unicodedata.normalize("NFKD", comment.replace("°", " "))
    kept = "".join(c for c in apart if not unicodedata.combining(c))
    return "".join(c if c.isascii() and c.isprintable() else "?" for c in kept.replace("\t", " "))


def _words(printer: Printer, settings: Settings, frame: Frame) -> dict[str, float]:
    bed = printer.bed
    return {
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


def _number(value: float) -> str:
    text = f"{value:.3f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text

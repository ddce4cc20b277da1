"""The code before and after a print: words in braces filled in, and nothing that leaves the bed.

A profile's code goes to the printer as it stands. Each move in it is checked in the mode that
holds there: the file sets absolute coordinates (G90) before the start code, and the end code begins
in them at the place of the last move. What a macro does cannot be read; so after one the place and
the mode are unknown until the code sets them.
"""

import re
from dataclasses import dataclass

from simulearn.errors import InputError
from simulearn.fabricate.printer import Printer
from simulearn.fabricate.settings import Settings

WORD = re.compile(r"\{(\w*)\}")
TOKEN = re.compile(r"([A-Z])\s*([^\sA-Z]*)", re.IGNORECASE)
MOVE = re.compile(r"[Gg]0*[01](?![\d.])")
ARC = re.compile(r"[Gg]0*[23](?![\d.])")
GLUED = re.compile(r"[\d.][Ee][-+]?\d")
NUMBER = re.compile(r"^[Nn]\d+\s*")
COMMAND = re.compile(r"(?=\b[GgMm]\d)")
HEAD = re.compile(r"([GM])\s*0*(\d+(?:\.\d+)?)", re.IGNORECASE)
SHOWN = ("M117", "M118")  # their text is shown, not done
ORIGIN = "moves the origin, and with it the print"
FORBIDDEN = {
    "G20": "counts in inches, and files are in millimetres",
    "G52": ORIGIN,
    "M206": ORIGIN,
    "M428": ORIGIN,
    "M851": "moves the probe, and with it the height of the print",
    "M92": "changes how far the machine moves",
    "M200": "changes how E is counted",
    "SET_GCODE_OFFSET": ORIGIN,
}
# The coordinate systems G54 to G59.3, and what else of G92 there is (G92.1 and the like).
SYSTEM = re.compile(r"G(5[4-9](\.\d+)?|92\.\d+)")
ROUNDING = 1e-6


@dataclass(frozen=True)
class Frame:
    """What a profile's code may name: see docs/gcode.md.

    Attributes:
        low: least x and y of what is printed, mm.
        high: greatest x and y.
        last: x, y and z of the nozzle after the print, mm.
    """

    low: tuple[float, float]
    high: tuple[float, float]
    last: tuple[float, float, float]


def filled(printer: Printer, settings: Settings, frame: Frame, which: str) -> list[str]:
    """Return the lines of a printer's start or end code, with its words filled in.

    Args:
        printer: whose code.
        settings: how it prints.
        frame: where it prints.
        which: "start" or "end".

    Raises:
        InputError: a word is not known, or a line moves where the printer cannot.
    """
    text = getattr(printer.code, which)
    bed = printer.bed
    words = {
        "temperature": settings.temperature,
        "bed": settings.bed,
        "nozzle": settings.nozzle,
        "filament": settings.filament,
        "layer": settings.layer,
        "min_x": frame.low[0],
        "min_y": frame.low[1],
        "max_x": frame.high[0],
        "max_y": frame.high[1],
        "top": frame.last[2],
        "bed_min_x": bed.low[0],
        "bed_min_y": bed.low[1],
        "bed_max_x": bed.high[0],
        "bed_max_y": bed.high[1],
        "bed_max_z": bed.height,
    }
    lines = []
    checked = _Checked(printer)
    if which == "end":
        checked.at = dict(zip("XYZ", frame.last, strict=True))
    for k, line in enumerate(text.strip("\n").splitlines(), 1):
        where = f"{printer.name}: code.{which}, line {k}"
        if not (line.isascii() and line.replace("\t", " ").isprintable()):
            raise InputError(f"{where}: has a character that printers cannot read; use plain ASCII")
        for word in WORD.findall(line):
            if word not in words:
                known = ", ".join(words)
                raise InputError(f"{where}: {{{word}}} is not known; words are {known}")
        line = WORD.sub(lambda match: f"{words[match[1]]:.3f}".rstrip("0").rstrip("."), line)
        checked.read(line, where)
        lines.append(line.rstrip())
    return lines


class _Checked:
    """Follows where a profile's code moves, and refuses what leaves the printer's reach."""

    def __init__(self, printer: Printer) -> None:
        self.printer = printer
        self.at: dict[str, float | None] = {"X": None, "Y": None, "Z": None}
        self.relative: bool | None = False  # None where it is not known
        bed = printer.bed
        self.reach = {
            "X": (bed.low[0], bed.high[0]),
            "Y": (bed.low[1], bed.high[1]),
            "Z": (0.0, bed.height),
        }

    def read(self, line: str, where: str) -> None:
        """Check a line.

        Raises:
            InputError: it moves where the printer cannot, or a number is none.
        """
        code = re.sub(r"\(.*?\)", "", line.split(";", 1)[0]).strip()
        code = NUMBER.sub("", code)
        if code.upper().startswith(SHOWN):
            return
        for command in COMMAND.split(code):
            self._read(command.strip(), where)

    def _read(self, code: str, where: str) -> None:
        if not code:
            return
        match = HEAD.match(code)
        head = f"{match[1]}{match[2]}".upper() if match else code.split()[0].upper()
        words = [(axis.upper(), text) for axis, text in TOKEN.findall(HEAD.sub("", code, count=1))]
        if head in FORBIDDEN:
            raise InputError(f"{where}: {head} {FORBIDDEN[head]}; leave it out")
        if SYSTEM.fullmatch(head):
            raise InputError(f"{where}: {head} {ORIGIN}; leave it out")
        if head in ("G90", "G91"):
            self.relative = head == "G91"
        elif head == "G28":
            self.at = dict.fromkeys(self.at)
        elif head == "G10":  # alone it draws filament back
            for axis, text in words:
                if axis in "LXYZ":
                    raise InputError(f"{where}: G10 {axis}{text} {ORIGIN}; leave it out")
        elif head == "G92":
            for axis, text in words:
                if axis in self.at:
                    raise InputError(f"{where}: G92 {axis}{text} {ORIGIN}; only G92 E is allowed")
        elif not match:
            self.relative = None
            self.at = dict.fromkeys(self.at)
        elif ARC.match(code):
            raise InputError(f"{where}: an arc (G2, G3) cannot be checked; use straight moves")
        elif MOVE.match(code):
            self._move(MOVE.sub("", code, count=1), where)

    def _move(self, rest: str, where: str) -> None:
        if GLUED.search(rest):  # 1E5 is X1 and E5 to some printers, 100000 to others
            raise InputError(
                f"{where}: printers differ in how they read {rest.strip()}; put a space before E"
            )
        for axis, text in TOKEN.findall(rest):
            axis = axis.upper()
            if axis not in "XYZEFIJ":
                continue
            try:
                value = float(text)
            except ValueError as error:
                raise InputError(f"{where}: {axis}{text} is not a number") from error
            if not abs(value) <= 1e6:  # NaN compares false
                raise InputError(f"{where}: {axis}{text} is not a number a printer can use")
            if axis not in self.reach:
                continue
            if self.relative is None:
                raise InputError(
                    f"{where}: whether {axis}{text} is absolute or relative is not known after a "
                    f"macro; write G90 or G91 before it"
                )
            if self.relative:
                before = self.at[axis]
                if before is None and axis == "Z" and value >= 0:
                    continue  # up is safe from anywhere
                if before is None:
                    raise InputError(
                        f"{where}: {axis}{text} is relative to a place that is not known here; "
                        f"move there in absolute numbers (G90) first"
                    )
                value += before
            least, most = self.reach[axis]
            if not least - ROUNDING <= value <= most + ROUNDING:
                raise InputError(
                    f"{where}: leads to {axis} {value:g} mm; {self.printer.name} reaches "
                    f"{least:g} to {most:g}"
                )
            self.at[axis] = value

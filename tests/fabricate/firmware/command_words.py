"""How each firmware splits a line into commands and their parameters.

Read in the sources: Marlin 2.1 and Prusa Buddy `gcode/parser.cpp` (capitals only, the first command
of a line, a parameter without a number is there without a value), Klipper `klippy/gcode.py`
(letters of either case, one command, its number compared as text), RepRapFirmware `GCodeBuffer`
(several commands on a line, comments in parentheses too), GPX `gpx.c` (as RepRapFirmware).
What is public of Bambu Lab's firmware says that it began as Marlin; it is read as Marlin reads.
"""

import re
from typing import NamedTuple

FIRMWARES = ("marlin", "prusa", "klipper", "reprap", "bambu", "sailfish")
LIKE_MARLIN = ("marlin", "prusa", "bambu")
LONGEST = {"marlin": 95, "prusa": 95, "reprap": 255}  # characters of a line without its comment
TEXT = ("M117", "M118", "M23", "M28", "M30", "M32", "M98", "M550")  # their argument is text

PARAMETER = re.compile(r"([A-Z])\s*([-+]?(?:\d+\.?\d*|\.\d+))?")
HEAD = re.compile(r"([GMT])\s*(\d+)(?:\.(\d+))?")
KLIPPER = re.compile(r"([A-Z_]+|[A-Z*])")
PARENTHESES = re.compile(r"\(.*?\)")
NUMBERED = re.compile(r"N\s*-?\d+\s*")
NEXT = re.compile(r"(?=(?<![A-Z])[GM]\s*\d)")


class Command(NamedTuple):
    """A command: its name (G1, M104, G29.2, PRINT_START) and its parameters."""

    name: str
    words: dict[str, float | None]
    rest: str


def commands(line: str, firmware: str) -> list[Command]:
    """Return what a firmware does of a line; nothing of what it does not understand."""
    code = line.split(";", 1)[0]
    if firmware == "klipper":
        return _klipper(code)
    if firmware in ("reprap", "sailfish"):
        code = PARENTHESES.sub("", code).upper()
    code = NUMBERED.sub("", code.strip(), count=1) if code.strip()[:1] == "N" else code.strip()
    code = code.split("*", 1)[0].rstrip()
    if not code:
        return []
    if firmware in LIKE_MARLIN:
        return _one(code)
    if code.split()[0] in TEXT:
        return _one(code)
    found = []
    for part in NEXT.split(code):
        found += _one(part.strip()) if part.strip() else []
    return found


def _one(code: str) -> list[Command]:
    match = HEAD.match(code)
    if not match:
        return [Command(code.split()[0], {}, code)]
    letter, number, sub = match[1], int(match[2]), match[3]
    name = f"{letter}{number}" + (f".{int(sub)}" if sub and int(sub) else "")
    rest = code[match.end() :].strip()
    if name in TEXT:
        return [Command(name, {}, rest)]
    words = {key: float(text) if text else None for key, text in PARAMETER.findall(rest)}
    return [Command(name, words, rest)]


def _klipper(code: str) -> list[Command]:
    upper = code.strip().upper()
    if not upper:
        return []
    parts = KLIPPER.split(upper)
    if parts[1:2] == ["N"]:
        parts = parts[2:]
        parts[0] = ""
    name = "".join(parts[:3]).strip()
    if not re.fullmatch(r"[A-Z]\d+(\.\d+)?", name):
        word = upper.split()[0]
        words = {}
        for key, text in re.findall(r"([A-Z_]+)=(\S+)", upper):
            try:
                words[key] = float(text)
            except ValueError:
                words[key] = None
        return [Command(word, words, code.strip())]
    words: dict[str, float | None] = {}
    for k in range(3, len(parts) - 1, 2):
        try:
            words[parts[k]] = float(parts[k + 1])
        except ValueError:
            words[parts[k]] = None
    return [Command(name, words, code.strip()[len(name) :].strip())]

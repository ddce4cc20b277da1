"""Path data as runs of straight lines and runs of curves."""

import math
import re
from collections.abc import Sequence
from typing import NamedTuple

import svgelements

from simulearn.drawings.svg.curves import Arc, Bezier, Point

_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_COMMAND = re.compile(r"([MmLlHhVvCcSsQqTtAaZz])([^MmLlHhVvCcSsQqTtAaZz]*)")
_SPACE = " \t\r\n\f"
_BETWEEN = rf"[{_SPACE},]*+"
_ARC = re.compile(  # possessive, so that no number is taken apart; the flags need no space
    rf"{_BETWEEN}((?>{_NUMBER.pattern}))" * 3
    + rf"{_BETWEEN}([01])" * 2
    + rf"{_BETWEEN}((?>{_NUMBER.pattern}))" * 2
)
_COUNTS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}


class Straight(NamedTuple):
    """A polyline: at least two points."""

    points: list[Point]


class Bent(NamedTuple):
    """Curves of one kind, one after the other."""

    kind: str
    pieces: list[Bezier | Arc]


Run = Straight | Bent


class Pen:
    """Collects runs while a path is drawn."""

    def __init__(self) -> None:
        self.runs: list[Run] = []
        self.at: Point = (0.0, 0.0)
        self.first: Point = (0.0, 0.0)
        self.fresh = True  # the next stroke begins a run of its own

    def move(self, to: Point) -> None:
        """Begin anew at a point."""
        self.at = self.first = to
        self.fresh = True

    def line(self, to: Point) -> None:
        """Draw a straight line to a point."""
        last = None if self.fresh or not self.runs else self.runs[-1]
        if isinstance(last, Straight):
            last.points.append(to)
        else:
            self.runs.append(Straight([self.at, to]))
        self.at, self.fresh = to, False

    def curve(self, piece: Bezier | Arc) -> None:
        """Draw a curve, or a line where it is straight."""
        if piece.straight():
            if piece.end != self.at:
                self.line(piece.end)
            return
        last = None if self.fresh or not self.runs else self.runs[-1]
        if isinstance(last, Bent) and last.kind == piece.kind:
            last.pieces.append(piece)
        else:
            self.runs.append(Bent(piece.kind, [piece]))
        self.at, self.fresh = piece.end, False

    def close(self) -> None:
        """Draw a straight line to where the pen began."""
        if self.at != self.first:
            self.line(self.first)
        self.at, self.fresh = self.first, True

    def arc(self, rx: float, ry: float, angle: float, large: bool, sweep: bool, to: Point) -> None:
        """Draw an elliptical arc; the arguments are those of the command A."""
        if to == self.at:
            return
        if rx == 0.0 or ry == 0.0:
            self.line(to)
            return
        try:
            arc = svgelements.Arc(self.at, abs(rx), abs(ry), angle % 360.0, large, sweep, to)
        except ArithmeticError:  # radii so small or large that their squares are 0 or infinite
            self.line(to)
            return
        centre = (float(arc.center.x), float(arc.center.y))
        u = (float(arc.prx.x) - centre[0], float(arc.prx.y) - centre[1])
        v = (float(arc.pry.x) - centre[0], float(arc.pry.y) - centre[1])
        x, y = self.at[0] - centre[0], self.at[1] - centre[1]
        uu, vv = u[0] ** 2 + u[1] ** 2, v[0] ** 2 + v[1] ** 2
        if uu == 0.0 or vv == 0.0:
            self.line(to)
            return
        start = math.atan2((x * v[0] + y * v[1]) / vv, (x * u[0] + y * u[1]) / uu)
        self.curve(Arc("elliptical arc", centre, u, v, start, float(arc.sweep), to))


def path(data: str) -> tuple[list[Run], str]:
    """Return the runs of path data, and what is wrong with it where it cannot be read to the end.

    As the standard asks, all before the error is drawn.
    """
    pen = Pen()
    begin = _COMMAND.search(data)
    head = data[: begin.start()] if begin else data
    if head.strip(_SPACE):
        return [], f"begins with {head.strip()[:12]!r}, not with M"
    handle: Point | None = None  # the last control point, for S and T
    smooth = ""
    first = True
    for command, text in _COMMAND.findall(data):
        letter, relative = command.upper(), command.islower()
        if first and letter != "M":
            return [], f"begins with {command}, not with M"
        groups, junk = _arguments(letter, text)
        if letter == "Z" or (not groups and not junk):
            if letter != "Z":
                return pen.runs, f"has {command} without numbers"
            pen.close()
            smooth = ""
        for k, group in enumerate(groups):
            x0, y0 = pen.at if relative else (0.0, 0.0)
            if letter == "M" and k == 0:
                pen.move((group[0] + x0, group[1] + y0))
            elif letter in "ML":
                pen.line((group[0] + x0, group[1] + y0))
            elif letter == "H":
                pen.line((group[0] + x0, pen.at[1]))
            elif letter == "V":
                pen.line((pen.at[0], group[0] + y0))
            elif letter == "A":
                rx, ry, angle, large, sweep, x, y = group
                pen.arc(rx, ry, angle, bool(large), bool(sweep), (x + x0, y + y0))
            else:
                points = [(x + x0, y + y0) for x, y in zip(group[::2], group[1::2], strict=True)]
                kind = "C" if letter in "CS" else "Q"
                if letter in "ST":
                    mirrored = handle if smooth == kind and handle else pen.at
                    points.insert(0, (2 * pen.at[0] - mirrored[0], 2 * pen.at[1] - mirrored[1]))
                handle, smooth = points[-2], kind
                name = "cubic Bezier" if kind == "C" else "quadratic Bezier"
                pen.curve(Bezier(name, (pen.at, *points)))
                pen.at = points[-1]
                continue
            smooth = ""
        if junk:
            return pen.runs, f"cannot be read from {junk[:12]!r} on"
        first = False
    return pen.runs, ""


def _arguments(letter: str, text: str) -> tuple[list[Sequence[float]], str]:
    """Return the groups of numbers after a command, and what follows them that is none."""
    count = _COUNTS[letter]
    groups: list[Sequence[float]] = []
    if count == 0:
        return groups, text.strip(_SPACE + ",")
    place = 0
    if letter == "A":
        while match := _ARC.match(text, place):
            groups.append([float(number) for number in match.groups()])
            place = match.end()
        return groups, text[place:].strip(_SPACE + ",")
    numbers, junk = numbers_of(text)
    whole = len(numbers) - len(numbers) % count
    groups = [numbers[k : k + count] for k in range(0, whole, count)]
    if whole < len(numbers) and not junk:
        junk = " ".join(f"{number:g}" for number in numbers[whole:])
    return groups, junk


def numbers_of(text: str) -> tuple[list[float], str]:
    """Return the numbers of a text up to the first thing that is none, and the rest from there."""
    numbers: list[float] = []
    place = 0
    for match in _NUMBER.finditer(text):
        between = text[place : match.start()].strip(_SPACE)
        if between not in ("", ","):
            return numbers, text[place:].strip(_SPACE + ",")
        numbers.append(float(match.group()))
        place = match.end()
    return numbers, text[place:].strip(_SPACE + ",")

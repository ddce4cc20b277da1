"""What is found in an SVG file, collected and counted."""

from collections import Counter

import numpy as np

from simulearn.drawings.drawing import Curve, Drawing, LeftOut, Line
from simulearn.drawings.svg.curves import Matrix, apply, flattened
from simulearn.drawings.svg.page import Page
from simulearn.drawings.svg.path import Bent, Run
from simulearn.drawings.svg.tree import Element
from simulearn.errors import InputError

MOST_SEGMENTS = 200_000
FARTHEST = 1e9  # units; no drawing reaches there
MOST_PROBLEMS = 5  # listed one by one


class Collected:
    """Lines, curves, what is left out and remarks."""

    def __init__(self) -> None:
        self._lines: list[Line] = []
        self._curves: list[Curve] = []
        self._left: Counter[tuple[str, str, str]] = Counter()
        self._remarks: Counter[str] = Counter()
        self._problems: list[str] = []
        self._segments = 0

    def add(
        self, runs: list[Run], element: Element, matrix: Matrix, layer: str, colour: str | None
    ) -> None:
        """Add the runs of a shape, transformed."""
        for run in runs:
            if isinstance(run, Bent):
                self._count(len(run.pieces))
                points = [apply(matrix, point) for piece in run.pieces for point in piece.around]
            else:
                self._count(len(run.points) - 1)
                points = [apply(matrix, point) for point in run.points]
            if not all(abs(x) < FARTHEST and abs(y) < FARTHEST for x, y in points):
                self.leave_out(element.tag, layer, "has a coordinate that is no place")
            elif isinstance(run, Bent):
                self._curves.append(_curve(run, matrix, layer, colour, element.name))
            elif len(set(points)) < 2:
                self.leave_out(element.tag, layer, "has no length")
            else:
                places = np.array([(x, y, 0.0) for x, y in points])
                self._lines.append(Line(places, layer, colour, element.name))

    def leave_out(self, kind: str, layer: str, reason: str) -> None:
        """Count one thing that is not read."""
        self._left[kind, layer, reason] += 1

    def tell(self, message: str) -> None:
        """Tell a sentence once; `{}` in it stands for how many things are meant, with the verb."""
        self._remarks[message] += 1

    def problem(self, message: str) -> None:
        """Tell one thing that is wrong in the file."""
        self._problems.append(message)

    def drawing(self, page: Page, messages: list[str]) -> Drawing:
        """Return all as a drawing."""
        return Drawing(
            "SVG",
            self._lines,
            self._curves,
            [
                LeftOut(kind, count, layer, reason)
                for (kind, layer, reason), count in self._left.items()
            ],
            page.unit,
            page.guess,
            messages=messages + self._messages(page.corner),
        )

    def _count(self, segments: int) -> None:
        self._segments += segments
        if self._segments > MOST_SEGMENTS:
            raise InputError(f"has more than {MOST_SEGMENTS:,} lines", "too-large")

    def _messages(self, corner: tuple[float, float] | None) -> list[str]:
        messages = self._problems[:MOST_PROBLEMS]
        if len(self._problems) > MOST_PROBLEMS:
            more = len(self._problems) - MOST_PROBLEMS
            messages.append(f"{more} more parts of the file cannot be read.")
        messages += [text.format(_are(n, "thing")) for text, n in self._remarks.items()]
        filled = sum(n for (_, _, why), n in self._left.items() if why.startswith("is filled"))
        if filled:
            messages.append(
                f"{_are(filled, 'shape')} left out, as filled without a stroke. Lines that were "
                "turned into outlines have no axis to follow: save the drawing with its strokes."
            )
        outside = sum(_outside(line, corner) for line in self._lines) if corner else 0
        if outside:
            messages.append(f"{_are(outside, 'line')} outside of the page, but read all the same.")
        return messages


def _curve(run: Bent, matrix: Matrix, layer: str, colour: str | None, where: str) -> Curve:
    return Curve(run.kind, lambda chord: flattened(run.pieces, matrix, chord), layer, colour, where)


def _are(count: int, thing: str) -> str:
    return f"1 {thing} is" if count == 1 else f"{count} {thing}s are"


def _outside(line: Line, corner: tuple[float, float]) -> bool:
    low, high = line.points.min(axis=0)[:2], line.points.max(axis=0)[:2]
    slack = 1e-3 * max(corner)
    return bool((high < -slack).any() or (low > np.array(corner) + slack).any())

"""What a reader collects from a drawing, within bounds of time and memory."""

from collections import Counter
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from simulearn.drawings.drawing import Curve, LeftOut, Line, Points
from simulearn.errors import InputError

# Far more than a grid that can be printed needs.
MAX_SEGMENTS = 200_000
MAX_ENTITIES = 500_000
MAX_DEPTH = 64

TOO_LARGE = 1e100  # no coordinate; also what programs write for a number that was never set

Matrix = NDArray[np.float64]


def exploded(
    name: str,
    contents: Callable[[str], tuple[int, list[tuple[str, int]]]],
    sizes: dict[str, int],
    depth: int = 0,
) -> int:
    """Return how many things a block comes to, those of the blocks in it counted.

    Args:
        name: of the block.
        contents: returns for a block how many things it holds, and the blocks among them with how
            often each is placed.
        sizes: those that are known, to which new ones are added.
        depth: of the nesting.
    """
    if name not in sizes:
        sizes[name] = 0  # for a block that contains itself
        count, placed = contents(name)
        for inner, times in placed if depth < MAX_DEPTH else ():
            count += times * (1 + exploded(inner, contents, sizes, depth + 1))
        sizes[name] = count
    return sizes[name]


class Collected:
    """Lines, curves and what is left out.

    Attributes:
        lines: straight things.
        curves: curved things.
        messages: remarks, each once.
    """

    def __init__(self) -> None:
        self.lines: list[Line] = []
        self.curves: list[Curve] = []
        self.messages: list[str] = []
        self._left_out: Counter[tuple[str, str, str]] = Counter()
        self._entities = self._segments = 0

    @property
    def left_out(self) -> list[LeftOut]:
        """All that is not read, counted by kind, layer and reason."""
        return [LeftOut(k, n, layer, why) for (k, layer, why), n in self._left_out.items()]

    def visit(self) -> None:
        """Count a thing that is looked at.

        Raises:
            InputError: they are too many.
        """
        self._entities += 1
        self.refuse_above(self._entities)

    def refuse_above(self, count: int) -> None:
        """Refuse a drawing that comes to too many things.

        Raises:
            InputError: they are too many.
        """
        if count > MAX_ENTITIES:
            raise InputError(
                f"the drawing has more than {MAX_ENTITIES:,} objects, blocks counted as often as"
                " they are placed; keep only the lines of the grid",
                "too-large",
            )

    def leave(self, kind: str, layer: str, reason: str) -> None:
        """Count a thing that is not read."""
        self._left_out[kind, layer, reason] += 1

    def say(self, remark: str) -> None:
        """Add a remark, if it is a new one."""
        if remark not in self.messages:
            self.messages.append(remark)

    def line(
        self, points: Points, matrix: Matrix, kind: str, layer: str, colour: str | None, where: str
    ) -> None:
        """Add a straight thing.

        Args:
            points: (n, 3) before it is placed.
            matrix: (4, 4) that places it, for points as rows.
            kind: in the words of its format.
            layer: as in `Line`.
            colour: as in `Line`.
            where: as in `Line`.

        Raises:
            InputError: the drawing has too many.
        """
        placed = _placed(points, matrix)
        if len(placed) < 2:
            self.leave(kind, layer, "has no length")
        elif not (np.abs(placed) < TOO_LARGE).all():
            self.leave(kind, layer, "has coordinates that are no numbers")
        else:
            self._segment(len(placed) - 1)
            self.lines.append(Line(placed, layer, colour, where))

    def curve(
        self,
        flatten: Callable[[float], Points],
        matrix: Matrix,
        kind: str,
        layer: str,
        colour: str | None,
        where: str,
    ) -> None:
        """Add a curved thing.

        Args:
            flatten: as in `Curve`, before it is placed.
            matrix: as in `line`.
            kind: as in `Curve`.
            layer: as in `Curve`.
            colour: as in `Curve`.
            where: as in `Curve`.

        Raises:
            InputError: the drawing has too many.
        """
        self._segment(1)
        if not (np.abs(matrix) < TOO_LARGE).all():
            self.leave(kind, layer, "has coordinates that are no numbers")
            return
        scale = float(np.linalg.norm(matrix[:3, :3], 2)) or 1.0

        def flattened(distance: float) -> Points:
            try:
                return _placed(flatten(distance / scale), matrix)
            except (ArithmeticError, ValueError, RecursionError):
                text = f"{where} is a curve that cannot be made into lines; draw it anew"
                raise InputError(text, "curve-broken", where) from None

        self.curves.append(Curve(kind, flattened, layer, colour, where))

    def _segment(self, count: int) -> None:
        self._segments += count
        if self._segments > MAX_SEGMENTS:
            raise InputError(
                f"the drawing has more than {MAX_SEGMENTS:,} line segments; keep only the lines of"
                " the grid",
                "too-large",
            )


def _placed(points: Points, matrix: Matrix) -> Points:
    return points @ matrix[:3, :3] + matrix[3, :3]

"""Curves in space, as polylines: closest points."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError, Message
from simulearn.rigid import Place
from simulearn.surfaces.tree import Tree

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Curve:
    """A polyline.

    Attributes:
        points: (N, 3) mm, N at least 2, no two successive ones at one place; a closed one ends
            where it begins.
        warnings: what was mended or guessed when it was read.
    """

    points: Array
    warnings: tuple[Message, ...] = ()

    def __post_init__(self) -> None:
        """Take arrays as they are needed.

        Raises:
            InputError: there are not two points.
        """
        object.__setattr__(self, "points", np.ascontiguousarray(self.points, np.float64))
        if len(self.points) < 2:
            raise InputError("a curve has at least two points", "curve-empty", "curve")

    def closest(self, points: NDArray[Any]) -> tuple[Array, Array, Indices]:
        """Return the points of the curve that are closest to others.

        Args:
            points: (N, 3) mm; not finite ones have no closest point.

        Returns:
            The closest points (N, 3) mm, unit tangents (N, 3), and the pieces (N,) they lie on; of
            a point that is not finite NaN, NaN and -1.
        """
        places, pieces = self._tree.closest(points)
        along = np.diff(self.points, axis=0)
        tangents = along / np.linalg.norm(along, axis=1, keepdims=True)
        return places, np.where(pieces[:, None] >= 0, tangents[pieces], np.nan), pieces

    def distance(self, points: NDArray[Any]) -> Array:
        """Return how far points (N, 3) mm are from the curve (N,) mm."""
        away: Array = np.linalg.norm(points - self.closest(points)[0], axis=1)
        return away

    @property
    def size(self) -> float:
        """Diagonal of its box, mm."""
        return float(np.linalg.norm(np.ptp(self.points, axis=0)))

    def placed(self, place: Place) -> "Curve":
        """Return the curve after a rigid motion."""
        return replace(self, points=place(self.points))

    def scaled(self, factor: float) -> "Curve":
        """Return the curve so many times as large, about the origin."""
        return replace(self, points=self.points * factor)

    @cached_property
    def _tree(self) -> Tree:
        # A piece is a triangle without width, whose closest points are exact, too.
        ends = self.points[:-1], self.points[1:], self.points[1:]
        return Tree.of(np.stack(ends, axis=1))

"""Triangles in a tree of boxes, so that few of them are looked at for each point."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Tree:
    """Triangles, which may be lines or points, and boxes around them.

    Attributes:
        corners: (T, 3, 3) mm of the triangles, those of a leaf one after the other.
        order: (T,) their own numbers.
        starts: (leaves + 1,) the first triangle of each leaf, and T.
        boxes: (nodes, 2, 3) mm.
        depth: how often they are halved.
    """

    corners: Array
    order: Indices
    starts: Indices
    boxes: Array
    depth: int

    @classmethod
    def of(cls, corners: Array) -> "Tree":
        """Return the tree of triangles with corners (T, 3, 3) mm, at least one."""
        from simulearn.surfaces.kernels.tree import build, depth_of  # loads the compiler

        depth = depth_of(len(corners))
        order, starts, boxes = build(np.ascontiguousarray(corners, np.float64), depth)
        return cls(corners[order], order, starts, boxes, depth)

    def closest(self, points: NDArray[Any]) -> tuple[Array, Indices]:
        """Return the closest points (N, 3) mm to points (N, 3), and their triangles (N,).

        Of a point that is not finite they are NaN and -1.
        """
        from simulearn.surfaces.kernels.closest import closest_points  # loads the compiler

        places, triangles = closest_points(
            _rows(points), self.corners, self.order, self.starts, self.boxes, self.depth
        )
        return places, triangles

    def windings(self, points: NDArray[Any]) -> Indices:
        """Return how often the triangles go around points (N, 3): (N,)."""
        from simulearn.surfaces.kernels.closest import windings  # loads the compiler

        counts: Indices = windings(_rows(points), self.corners, self.starts, self.boxes, self.depth)
        return counts


def _rows(points: NDArray[Any]) -> Array:
    return np.ascontiguousarray(points, np.float64).reshape(-1, 3)

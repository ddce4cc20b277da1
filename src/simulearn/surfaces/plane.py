"""Planes."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.rigid import Place

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Plane:
    """A plane without end.

    Attributes:
        point: (3,) mm, on it.
        normal: (3,) of length 1.
    """

    point: Array
    normal: Array

    @classmethod
    def of(cls, point: Any, normal: Any) -> "Plane":
        """Return the plane through a point (3,) mm, across a normal (3,) of any length above 0."""
        n = np.asarray(normal, np.float64)
        return cls(np.asarray(point, np.float64), n / np.linalg.norm(n))

    def closest(self, points: NDArray[Any]) -> tuple[Array, Array, NDArray[np.int64]]:
        """Return the points of the plane that are closest to others (N, 3) mm.

        Returns:
            The closest points (N, 3) mm, the plane's normal (N, 3), and 0 (N,) for its only face.
        """
        points = np.asarray(points, np.float64)
        height = (points - self.point) @ self.normal
        normals = np.broadcast_to(self.normal, points.shape).copy()
        return points - height[:, None] * self.normal, normals, np.zeros(len(points), np.int64)

    def placed(self, place: Place) -> "Plane":
        """Return the plane after a rigid motion."""
        return Plane(place(self.point), place.turn @ self.normal)

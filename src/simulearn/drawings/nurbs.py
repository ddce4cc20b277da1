"""Spline curves of CAD files: which of them are straight, and chords for the others."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from simulearn.drawings.collecting import TOO_LARGE
from simulearn.drawings.drawing import Points

# More chords than a curve in a drawing of beams can need.
_MAX_CHORDS = 20_000
# Where a chord is compared with its curve; not only in the middle, where an S crosses its chord.
_BETWEEN = np.array([0.25, 0.5, 0.75])


@dataclass(frozen=True, eq=False)
class Nurbs:
    """A rational B-spline curve.

    Attributes:
        degree: of its polynomials.
        knots: (n + degree + 1,).
        points: (n, 4) control points x w, y w, z w, w.
    """

    degree: int
    knots: NDArray[np.float64]
    points: NDArray[np.float64]

    def __post_init__(self) -> None:
        """Refuse what is no curve.

        Raises:
            ValueError: its numbers do not fit together.
        """
        fits = len(self.knots) == len(self.points) + self.degree + 1 > 2 * self.degree > 0
        numbers = np.concatenate((self.knots, self.points.ravel()))
        if not (fits and (np.abs(numbers) < TOO_LARGE).all()):
            raise ValueError("the numbers of a spline do not fit together")
        first, last = self._ends()
        if (np.diff(self.knots) < 0).any() or first >= last or (self.points[:, 3] <= 0).any():
            raise ValueError("the numbers of a spline do not fit together")

    def straight(self, tolerance: float) -> Points | None:
        """Return the corners of a curve that is a polyline, or None for one that is curved.

        Straight is what has its control points on a line, one behind the other, between the knots
        that the curve runs through.

        Args:
            tolerance: largest distance of a control point from the line.
        """
        control = self.points[:, :3] / self.points[:, 3:]
        corners = [0, *self._corners(), len(control) - 1]
        if not all(_is_straight(control[a : b + 1], tolerance) for a, b in pairwise(corners)):
            return None
        found = control[corners]
        first, last = self._ends()
        if first > self.knots[0] or last < self.knots[-1]:  # it does not reach its last points
            found[[0, -1]] = self._at(np.array([first, last]))
        return found

    def flatten(self, distance: float) -> Points:
        """Return points (n, 3) on the curve whose chords are nowhere farther from it.

        Args:
            distance: largest distance between curve and chord.
        """
        size = float(np.linalg.norm(np.ptp(self.points[:, :3] / self.points[:, 3:], axis=0)))
        distance = max(distance, 1e-6 * size)
        first, last = self._ends()
        inner = self.knots[(self.knots > first) & (self.knots < last)]
        at = np.unique(np.concatenate(([first], inner, [last])))
        while len(at) < _MAX_CHORDS:
            start, length = at[:-1], np.diff(at)
            ends = self._at(at)
            chord = np.diff(ends, axis=0)
            squared = np.maximum((chord**2).sum(axis=1), 1e-300)
            far = np.zeros(len(chord))
            for part in _BETWEEN:
                aside = self._at(start + part * length) - ends[:-1]
                along = np.clip((aside * chord).sum(axis=1) / squared, 0, 1)
                off = np.linalg.norm(aside - along[:, None] * chord, axis=1)
                far = np.maximum(far, off)
            coarse = far > distance
            if not coarse.any():
                break
            at = np.sort(np.concatenate((at, (start + length / 2)[coarse])))
        return self._at(at)

    def _ends(self) -> tuple[float, float]:
        """First and last parameter: a curve that closes on itself has knots beyond them."""
        return float(self.knots[self.degree]), float(self.knots[len(self.points)])

    def _at(self, parameters: NDArray[np.float64]) -> Points:
        from scipy.interpolate import BSpline

        found = BSpline(self.knots, self.points, self.degree)(parameters)
        return found[:, :3] / found[:, 3:]

    def _corners(self) -> list[int]:
        """Inner control points that the curve runs through, as it has full knots there."""
        degree, knots = self.degree, self.knots
        inner = range(degree + 1, len(self.points))
        return [
            i - 1 for i in inner if knots[i] == knots[i + degree - 1] and knots[i] > knots[i - 1]
        ]


def _is_straight(points: Points, tolerance: float) -> bool:
    along = points[-1] - points[0]
    length = float(np.linalg.norm(along))
    if not length > 0:
        return False
    near = min(tolerance, 1e-3 * length)
    steps = (points - points[0]) @ along / length
    aside = points - points[0] - np.outer(steps, along / length)
    on_line = np.linalg.norm(aside, axis=1).max() <= near
    return bool(on_line and (np.diff(steps) >= -near).all())

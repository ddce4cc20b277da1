"""The strip as a curve: a centre line of smooth curvature with the same thickness all along.

Curvature is piecewise linear over the length, between KNOTS places; the line starts somewhere in
some direction. The outline of such a strip runs half a thickness to both sides and straight across
the ends. All these numbers are fitted to the points of the outline that were measured, in least
squares of their distances from it, which averages hundreds of points where a skeleton has only
pixels.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.spatial import cKDTree

Array = NDArray[np.float64]

KNOTS = 16  # of the curvature
STEPS = 240  # of the centre line
SMOOTH = 0.1  # weight of changes of curvature that no point asks for, mm
ROBUST = 0.08  # mm, from where on a point counts less
CORNER = 0.7  # mm from a corner of the strip, where blur rounds the outline


@dataclass(frozen=True, eq=False)
class Curve:
    """A strip as it lies.

    Attributes:
        start: (2,) mm of the middle of its first end.
        heading: direction there, radians.
        length: along the centre line, mm.
        thickness: mm.
        curvature: (KNOTS,) 1/mm, + to the left, over the length.
    """

    start: Array
    heading: float
    length: float
    thickness: float
    curvature: Array

    @cached_property
    def angle(self) -> Array:
        """(STEPS + 1,) directions of the centre line, radians."""
        bend = np.interp(np.linspace(0, KNOTS - 1, STEPS + 1), np.arange(KNOTS), self.curvature)
        turned = np.cumsum((bend[1:] + bend[:-1]) / 2) * self.length / STEPS
        return self.heading + np.concatenate([[0.0], turned])

    @cached_property
    def line(self) -> Array:
        """(STEPS + 1, 2) points of the centre line, mm."""
        middle = (self.angle[1:] + self.angle[:-1]) / 2
        move = self.length / STEPS * np.stack([np.cos(middle), np.sin(middle)], axis=1)
        return self.start + np.concatenate([[[0.0, 0.0]], np.cumsum(move, axis=0)])

    def beside(self, aside: float) -> Array:
        """Return the points (STEPS + 1, 2) so far (mm) to the left of the centre line."""
        return self.line + aside * np.stack([-np.sin(self.angle), np.cos(self.angle)], axis=1)

    @property
    def outline(self) -> Array:
        """(N, 2) points around the strip, mm, counter-clockwise."""
        half = self.thickness / 2
        return np.concatenate([self.beside(-half), self.beside(half)[::-1]])

    @property
    def hollow(self) -> int:
        """The side that is hollow: 1 left, -1 right."""
        start, end = self.line[0], self.line[-1]
        across = np.array([start[1] - end[1], end[0] - start[0]])
        off = (self.line - start) @ across
        return -1 if off[np.argmax(np.abs(off))] > 0 else 1

    def along_and_aside(self, points: Array) -> tuple[Array, Array]:
        """Return how far points (N, 2) are along the centre line and to its left, mm.

        Before and behind the strip the line goes straight on.
        """
        near = cKDTree(self.line).query(points)[1]
        angle = self.angle[near]
        away = points - self.line[near]
        ahead = away[:, 0] * np.cos(angle) + away[:, 1] * np.sin(angle)
        aside = away[:, 1] * np.cos(angle) - away[:, 0] * np.sin(angle)
        return near * (self.length / STEPS) + ahead, aside

    def distances(self, points: Array) -> Array:
        """Return the distances (N,) of points from the outline, + outside, mm."""
        along, aside = self.along_and_aside(points)
        over = np.abs(along - self.length / 2) - self.length / 2
        out = np.abs(aside) - self.thickness / 2
        outside = np.hypot(np.maximum(over, 0), np.maximum(out, 0))
        return outside + np.minimum(np.maximum(over, out), 0)


@dataclass(frozen=True, eq=False)
class Fit:
    """A strip fitted to points of an outline.

    Attributes:
        curve: the strip.
        used: (N,) whether a point was used.
        residual: root mean square distance of these, mm.
    """

    curve: Curve
    used: NDArray[np.bool_]
    residual: float


def fit_curve(points: Array, middle: Array, thickness: float) -> Fit:
    """Return the strip whose outline is nearest to points.

    Args:
        points: (N, 2) of the outline, mm.
        middle: (M, 2) along the middle of the strip, roughly, mm.
        thickness: roughly, mm.
    """
    guess = _first_guess(middle, thickness)
    used = np.ones(len(points), bool)
    for _ in range(3):
        guess = _ended(guess, points)
        scales = np.concatenate([[1, 1, 0.05, 1, 0.3], np.full(KNOTS, 0.01)])
        numbers = least_squares(
            _residuals,
            guess,
            _derivatives,
            x_scale=scales,
            loss="soft_l1",
            f_scale=ROBUST,
            args=(points[used],),
            ftol=1e-6,
            xtol=1e-6,
            max_nfev=60,
        ).x
        guess, curve = numbers, _curve(numbers)
        along, aside = curve.along_and_aside(points)
        from_end = np.minimum(np.abs(along), np.abs(along - curve.length))
        from_side = np.abs(np.abs(aside) - curve.thickness / 2)
        distance = np.abs(curve.distances(points))
        far = max(0.3, 4 * float(np.median(distance)))
        used = (np.maximum(from_end, from_side) > CORNER) & (distance < far)
    off = curve.distances(points[used])
    return Fit(curve, used, float(np.sqrt((off**2).mean())))


def _ended(numbers: Array, points: Array) -> Array:
    """Return the numbers of a strip with its ends where those of the outline are.

    A strip that is too long has no points beside its ends to pull them in.
    """
    curve = _curve(numbers)
    along, aside = curve.along_and_aside(points)
    across = np.abs(aside) < 0.35 * curve.thickness  # only the ends of an outline are there
    first = across & (along < curve.length / 2)
    last = across & (along >= curve.length / 2)
    if not first.any() or not last.any():
        return numbers
    begin, end = float(np.median(along[first])), float(np.median(along[last]))
    at = (np.linspace(begin, end, KNOTS) / curve.length).clip(0, 1)
    bend = np.interp(at, np.linspace(0, 1, KNOTS), curve.curvature)
    part = np.clip(begin / curve.length, 0, 1) * STEPS
    near = int(part)
    heading = curve.angle[near]
    ahead = begin - near * curve.length / STEPS
    start = curve.line[near] + ahead * np.array([np.cos(heading), np.sin(heading)])
    return np.concatenate([start, [heading, end - begin, curve.thickness], bend])


def _curve(numbers: Array) -> Curve:
    x, y, heading, length, thickness = numbers[:5]
    return Curve(np.array([x, y]), float(heading), float(length), float(thickness), numbers[5:])


def _residuals(numbers: Array, points: Array) -> Array:
    curve = _curve(numbers)
    return np.concatenate([curve.distances(points), SMOOTH * curve.length**2 * _rough(curve)])


def _rough(curve: Curve) -> Array:
    return np.diff(curve.curvature, 2) / KNOTS**2


def _derivatives(numbers: Array, points: Array) -> Array:
    """Return the derivatives (N, 5 + KNOTS) of the residuals.

    A point's distance changes as the line next to it moves across, or an end along.
    """
    curve = _curve(numbers)
    moved = np.empty((len(numbers), *curve.line.shape))
    for k, step in enumerate(np.array([1e-4, 1e-4, 1e-6, 1e-4, 1e-4, *[1e-7] * KNOTS])):
        other = numbers.copy()
        other[k] += step
        moved[k] = (_curve(other).line - curve.line) / step
    near = cKDTree(curve.line).query(points)[1]
    along, aside = curve.along_and_aside(points)
    over = np.abs(along - curve.length / 2) - curve.length / 2
    at_end = over > np.abs(aside) - curve.thickness / 2
    last = along > curve.length / 2
    near = np.where(at_end, np.where(last, STEPS, 0), near)
    angle = curve.angle[near]
    ahead = np.stack([np.cos(angle), np.sin(angle)], axis=1) * np.where(last, 1, -1)[:, None]
    across = np.stack([-np.sin(angle), np.cos(angle)], axis=1) * np.sign(aside)[:, None]
    normal = np.where(at_end[:, None], ahead, across)
    table = -np.einsum("knd,nd->nk", moved[:, near], normal)
    table[~at_end, 4] -= 0.5
    smooth = np.zeros((KNOTS - 2, len(numbers)))
    smooth[:, 5:] = np.diff(np.eye(KNOTS), 2, axis=0)
    smooth *= curve.length**2 / KNOTS**2
    smooth[:, 3] = 2 * curve.length * _rough(curve)
    return np.concatenate([table, SMOOTH * smooth])


def _first_guess(middle: Array, thickness: float) -> Array:
    step = np.linalg.norm(np.diff(middle, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(step)])
    # The first and last points lie within the strip, half a piece from its ends.
    length = float(along[-1] + step.mean())
    x, y = (np.polynomial.Polynomial.fit(along, axis, min(6, len(middle) - 2)) for axis in middle.T)
    at = np.linspace(0, along[-1], KNOTS)
    dx, dy, ddx, ddy = x.deriv()(at), y.deriv()(at), x.deriv(2)(at), y.deriv(2)(at)
    bend = (dx * ddy - dy * ddx) / np.maximum(dx**2 + dy**2, 1e-6) ** 1.5
    heading = float(np.arctan2(dy[0], dx[0]))
    start = np.array([x(0.0), y(0.0)]) - step.mean() / 2 * np.array(
        [np.cos(heading), np.sin(heading)]
    )
    bend = np.clip(bend, -0.1, 0.1)
    return np.concatenate([start, [heading, length, thickness], bend])

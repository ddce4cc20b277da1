"""Curves of SVG, and how finely they become chords."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Point = tuple[float, float]
Matrix = tuple[float, float, float, float, float, float]  # x' = a x + c y + e, y' = b x + d y + f

MOST_POINTS = 2000  # of one curve piece, however small the chord
STRAIGHT = 5e-4  # a Bezier that leaves its chord by less than this share of it is a line


class Bezier(NamedTuple):
    """A quadratic or cubic Bezier curve; `kind` is what SVG calls it."""

    kind: str
    controls: tuple[Point, ...]

    @property
    def around(self) -> tuple[Point, ...]:
        """Points that it lies between."""
        return self.controls

    @property
    def end(self) -> Point:
        """Where it ends."""
        return self.controls[-1]

    def flatten(self, matrix: Matrix, chord: float) -> NDArray[np.float64]:
        """Return points (n, 2) after a transform, chords no farther than `chord` from it."""
        points = np.array([apply(matrix, point) for point in self.controls])
        degree = len(points) - 1
        # chord error of a parameter step h is at most h^2 / 8 times the second derivative
        bend = degree * (degree - 1) * np.abs(np.diff(points, 2, axis=0)).max(axis=0)
        t = np.linspace(0.0, 1.0, _steps(float(np.hypot(*bend)), chord) + 1)[:, None]
        weights = [
            math.comb(degree, k) * t**k * (1.0 - t) ** (degree - k) for k in range(degree + 1)
        ]
        return np.asarray(sum(w * p for w, p in zip(weights, points, strict=True)))

    def straight(self) -> bool:
        """Return whether it is its chord, as far as one can see."""
        (x0, y0), (x1, y1) = self.controls[0], self.controls[-1]
        dx, dy = x1 - x0, y1 - y0
        square = dx * dx + dy * dy
        if square == 0.0:
            return all(control == self.controls[0] for control in self.controls)
        for x, y in self.controls[1:-1]:
            along = ((x - x0) * dx + (y - y0) * dy) / square
            aside = ((x - x0) * dy - (y - y0) * dx) / square
            if abs(aside) > STRAIGHT or not -STRAIGHT <= along <= 1.0 + STRAIGHT:
                return False
        return True


class Arc(NamedTuple):
    """A part of an ellipse: centre + u cos t + v sin t, t from `start` over `sweep` (rad)."""

    kind: str
    centre: Point
    u: Point
    v: Point
    start: float
    sweep: float
    end: Point

    @property
    def around(self) -> tuple[Point, ...]:
        """Points that it lies between."""
        (x, y), (a, b), (c, d) = self.centre, self.u, self.v
        return tuple(
            (x + s * a + t * c, y + s * b + t * d) for s in (-1.0, 1.0) for t in (-1.0, 1.0)
        )

    def flatten(self, matrix: Matrix, chord: float) -> NDArray[np.float64]:
        """Return points (n, 2) after a transform, chords no farther than `chord` from it."""
        turned = (*matrix[:4], 0.0, 0.0)
        centre = np.array(apply(matrix, self.centre))
        u, v = np.array(apply(turned, self.u)), np.array(apply(turned, self.v))
        bend = self.sweep**2 * float(np.linalg.norm(np.array([u, v]), 2))
        t = self.start + self.sweep * np.linspace(0.0, 1.0, _steps(bend, chord) + 1)[:, None]
        return np.asarray(centre + u * np.cos(t) + v * np.sin(t))

    def straight(self) -> bool:
        """Return whether it is its chord, as far as one can see: never."""
        return False


def _steps(bend: float, chord: float) -> int:
    if not bend > 0.0:
        return 1
    return int(min(max(math.ceil(math.sqrt(bend / (8.0 * max(chord, 1e-300)))), 1), MOST_POINTS))


def apply(matrix: Matrix, point: Point) -> Point:
    """Return a point after a transform."""
    a, b, c, d, e, f = matrix
    x, y = point
    return a * x + c * y + e, b * x + d * y + f


def flattened(pieces: Sequence[Bezier | Arc], matrix: Matrix, chord: float) -> NDArray[np.float64]:
    """Return the points (n, 3) of curves one after the other, as `Curve.flatten` wants them."""
    parts = [piece.flatten(matrix, chord) for piece in pieces]
    flat = np.concatenate([parts[0], *(part[1:] for part in parts[1:])])
    return np.column_stack([flat, np.zeros(len(flat))])

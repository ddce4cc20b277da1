"""Directions: of a face to be one in space, of two faces to have an angle between them.

They are lengths, too: how far the corners of a face are off when it is turned by what is missing.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.inverse.kinds import Wanted
from simulearn.inverse.vertex import Face, Vertex

Array = NDArray[np.float64]

ARROW = 15.0  # mm, length of lines that show a direction
STRAIGHT = 1e-6  # of a sine, below which two directions have no plane


@dataclass(frozen=True, eq=False)
class Direction(Wanted):
    """A face is to have a direction.

    Attributes:
        face: that is to be turned.
        direction: (3,) of length 1.
        kind: its name.
    """

    face: Face
    direction: Array
    kind: str = "direction"

    def names(self, vertices: Sequence[Vertex]) -> tuple[str, ...]:
        """Return the face's name."""
        return (self.face.name,)

    def away(self, points: Array) -> Array:
        """Return the difference of directions times the radius of the face."""
        off: Array = self.face.radius * (self.face.direction(points) - self.direction)
        return off[:, None]

    def pulled(self, points: Array, pull: Array) -> Array:
        """Return the derivative by the vertices of the face."""
        return self.face.pulled(points, self.face.radius * pull[0])

    def lines(self, points: Array) -> Array:
        """Return an arrow from the face in the direction."""
        middle = points.mean(axis=0)
        return np.stack([middle, middle + ARROW * self.direction])[None]

    def degrees(self, points: Array) -> Array:
        """Return the angle between the face's direction and the one that is wanted."""
        return np.degrees(_angle(self.face.direction(points), self.direction))[None]


@dataclass(frozen=True, eq=False)
class Angle(Wanted):
    """The directions of two faces are to have an angle between them.

    Attributes:
        faces: two of them, whose vertices follow each other.
        angle: 0 to pi.
        kind: its name.
    """

    faces: tuple[Face, Face]
    angle: float
    kind: str = "angle"

    def names(self, vertices: Sequence[Vertex]) -> tuple[str, ...]:
        """Return the names of both."""
        return (" and ".join(face.name for face in self.faces),)

    def away(self, points: Array) -> Array:
        """Return by how much the angle is too large, times the mean radius of the faces."""
        one, other = self._directions(points)
        off: Array = self._radius * (_angle(one, other) - self.angle)
        return off[:, None, None]

    def pulled(self, points: Array, pull: Array) -> Array:
        """Return the derivative by the vertices of both faces."""
        one, other = self._directions(points)
        sine = max(float(np.sin(_angle(one, other))), STRAIGHT)
        by = -self._radius * float(pull[0, 0]) / sine
        first = self._split
        return np.concatenate(
            [
                self.faces[0].pulled(points[:first], by * (other - (one @ other) * one)),
                self.faces[1].pulled(points[first:], by * (one - (one @ other) * other)),
            ]
        )

    def lines(self, points: Array) -> Array:
        """Return arrows in the directions of both faces."""
        middles = [part.mean(axis=0) for part in (points[: self._split], points[self._split :])]
        ends = zip(middles, self._directions(points), strict=True)
        return np.stack([np.stack([m, m + ARROW * direction]) for m, direction in ends])

    def degrees(self, points: Array) -> Array:
        """Return by how much the angle is off."""
        return np.abs(np.degrees(_angle(*self._directions(points)) - self.angle))[None]

    @property
    def _split(self) -> int:
        return len(self.faces[0].vertices)

    @property
    def _radius(self) -> float:
        return (self.faces[0].radius + self.faces[1].radius) / 2

    def _directions(self, points: Array) -> tuple[Array, Array]:
        one = self.faces[0].direction(points[..., : self._split, :])
        return one, self.faces[1].direction(points[..., self._split :, :])


def _angle(one: Array, other: Array) -> Array:
    """Return the angles (...) between unit vectors (..., 3), exact for small ones, too."""
    sine = np.linalg.norm(np.cross(one, other), axis=-1)
    angle: Array = np.arctan2(sine, (one * other).sum(axis=-1))
    return angle

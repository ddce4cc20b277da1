"""What can be wanted of vertices: to be at points, near sets of points, or so far apart.

Each kind says how far its goals are from being met, as vectors in mm: for a set the vector from its
closest point to the vertex. Their differences from design to design are what least squares need:
the vector p - q(p) hardly changes while p slides along a surface. By how much the length of such a
vector changes, it says with q held, which is exact (the envelope theorem).
"""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from simulearn.inverse.vertex import Vertex

Array = NDArray[np.float64]


class Set(Protocol):
    """Points in space that others can be near to: a surface, curve or plane."""

    def closest(self, points: Array) -> tuple[Array, Array, NDArray[np.int64]]:
        """Return the closest points (N, 3) mm to points (N, 3), and more about them."""
        ...


class Wanted(ABC):
    """Goals of one kind: g of them, about n vertices.

    Attributes:
        kind: its name.
    """

    kind: str

    @abstractmethod
    def names(self, vertices: Sequence[Vertex]) -> tuple[str, ...]:
        """Return what each of the g goals is about, given the n vertices."""

    @abstractmethod
    def away(self, points: Array) -> Array:
        """Return how far goals are from being met: (T, g, c) mm, given points (T, n, 3) mm.

        The length of the c numbers is the distance of a goal.
        """

    @abstractmethod
    def pulled(self, points: Array, pull: Array) -> Array:
        """Return the derivative (n, 3) by points (n, 3) of the sum of pull (g, c) times `away`.

        Pull is in the direction of `away`; what is nearest is held.
        """

    @abstractmethod
    def lines(self, points: Array) -> Array:
        """Return lines (k, 2, 3) mm from points (n, 3) to where they should be."""

    def degrees(self, points: Array) -> Array | None:
        """Return by how many degrees (g,) directions are off at points (n, 3); None without any."""
        return None

    def begun(self, points: Array) -> "Wanted":
        """Return the goals of a search whose first design has points (n, 3) mm."""
        return self


@dataclass(frozen=True, eq=False)
class AtPoints(Wanted):
    """Vertices are to come to points.

    Attributes:
        targets: (n, 3) mm.
        kind: the name of the goals that they come from.
    """

    targets: Array
    kind: str = "point"

    def names(self, vertices: Sequence[Vertex]) -> tuple[str, ...]:
        """Return the vertices' names."""
        return tuple(map(str, vertices))

    def away(self, points: Array) -> Array:
        """Return the vectors from the targets."""
        return points - self.targets

    def pulled(self, points: Array, pull: Array) -> Array:
        """Return the pull."""
        return pull

    def lines(self, points: Array) -> Array:
        """Return lines to the targets."""
        return np.stack([points, self.targets], axis=1)


@dataclass(frozen=True, eq=False)
class OnSet(Wanted):
    """Vertices are to come to a surface, a curve or a plane, anywhere.

    Attributes:
        set: that they are to be on.
        kind: its name.
        slide: whether they may come to any point of it; if not, to the one that is closest at the
            beginning.
    """

    set: Set
    kind: str
    slide: bool = True

    def names(self, vertices: Sequence[Vertex]) -> tuple[str, ...]:
        """Return the vertices' names."""
        return tuple(map(str, vertices))

    def away(self, points: Array) -> Array:
        """Return the vectors from the closest points."""
        return points - self._closest(points)

    def pulled(self, points: Array, pull: Array) -> Array:
        """Return the pull: where it is along the distance, the closest point does not matter."""
        return pull

    def lines(self, points: Array) -> Array:
        """Return lines to the closest points."""
        return np.stack([points, self._closest(points)], axis=1)

    def begun(self, points: Array) -> Wanted:
        """Return goals at the closest points of the first design, where vertices may not slide."""
        return self if self.slide else AtPoints(self._closest(points), self.kind)

    def _closest(self, points: Array) -> Array:
        return self.set.closest(points.reshape(-1, 3))[0].reshape(points.shape)


@dataclass(frozen=True, eq=False)
class Apart(Wanted):
    """Two vertices are to be so far apart.

    Attributes:
        distance: mm, more than 0.
        kind: its name.
    """

    distance: float
    kind: str = "distance"

    def names(self, vertices: Sequence[Vertex]) -> tuple[str, ...]:
        """Return the names of both."""
        return (" to ".join(map(str, vertices)),)

    def away(self, points: Array) -> Array:
        """Return by how much they are too far apart."""
        away: Array = np.linalg.norm(points[:, 1] - points[:, 0], axis=-1) - self.distance
        return away[:, None, None]

    def pulled(self, points: Array, pull: Array) -> Array:
        """Return the pull along the line between them."""
        along = points[1] - points[0]
        along = along / max(float(np.linalg.norm(along)), 1e-12) * pull[0, 0]
        return np.stack([-along, along])

    def lines(self, points: Array) -> Array:
        """Return the line between them."""
        return points[None]


def sized(vectors: Any) -> Array:
    """Return the lengths (...) of vectors (..., c)."""
    length: Array = np.linalg.norm(vectors, axis=-1)
    return length

"""Points and faces of a grid that move with it, in the last frame."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SECTIONS = ("start", "middle", "end")
TINY = 1e-12  # mm or mm2, a vector without a direction


@dataclass(frozen=True)
class Vertex:
    """A point of a grid that moves with it.

    Attributes:
        part: what it belongs to.
        index: of the joint or beam.
        section: of a beam: 0 start, 1 middle, 2 end.
        corner: of the joint (0 to 7) or the section (0 to 3), in the order of a Result; None for
            their mean, the centre.
    """

    part: Literal["joint", "beam"]
    index: int
    corner: int | None = None
    section: int = 0

    def of(self, joints: Any, sections: Any) -> Any:
        """Return the place (..., 3) of the vertex.

        Args:
            joints: (..., J, 8, 3) corners of the joints; an array of NumPy or JAX.
            sections: (..., B, 3, 4, 3) corners of the beams' sections.
        """
        if self.part == "joint":
            corners = joints[..., self.index, :, :]
        else:
            corners = sections[..., self.index, self.section, :, :]
        return corners.mean(-2) if self.corner is None else corners[..., self.corner, :]

    def __str__(self) -> str:
        names = [f"{self.part} {self.index}"]
        if self.part == "beam":
            names.append(SECTIONS[self.section])
        names.append("centre" if self.corner is None else f"corner {self.corner}")
        return ", ".join(names)


@dataclass(frozen=True)
class Face:
    """A face of a grid, or the course of a beam: what has a direction.

    The direction is that of a vector, or of the cross product of two. A vector is a sum of
    vertices, each so many times.

    Attributes:
        name: for people.
        vertices: n of them.
        radius: mm, root mean square distance of the vertices from their middle in the flat grid; a
            turn by an angle moves them by so much times the angle.
        first: (n,) of the first vector.
        second: (n,) of the second one; None where there is one alone.
    """

    name: str
    vertices: tuple[Vertex, ...]
    radius: float
    first: tuple[int, ...]
    second: tuple[int, ...] | None = None

    def direction(self, points: Array) -> Array:
        """Return the unit vectors (..., 3) at places (..., n, 3) of the vertices."""
        along = self._along(points)
        unit: Array = along / np.maximum(np.linalg.norm(along, axis=-1, keepdims=True), TINY)
        return unit

    def pulled(self, points: Array, pull: Array) -> Array:
        """Return the derivative by places (n, 3) of the product of the direction and pull (3,)."""
        along = self._along(points)
        length = max(float(np.linalg.norm(along)), TINY)
        unit = along / length
        across = (pull - (pull @ unit) * unit) / length
        if self.second is None:
            return np.outer(self.first, across)
        one, other = (np.array(sums) @ points for sums in (self.first, self.second))
        return np.outer(self.first, np.cross(other, across)) + np.outer(
            self.second, np.cross(across, one)
        )

    def _along(self, points: Array) -> Array:
        one: Array = np.einsum("n,...nc->...c", self.first, points)
        if self.second is None:
            return one
        return np.cross(one, np.einsum("n,...nc->...c", self.second, points))

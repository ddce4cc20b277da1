"""Goals: where some vertices of the morphed grid are wanted, and how far from there they are.

A vertex is a corner or the centre of a joint, or a corner or the centre of a beam's section; the
frame that counts is the last. The error of a design is the weighted mean distance over its goals.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


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
            names.append(("start", "middle", "end")[self.section])
        names.append("centre" if self.corner is None else f"corner {self.corner}")
        return ", ".join(names)


@dataclass(frozen=True, eq=False)
class Goals:
    """Vertices and their targets.

    Attributes:
        vertices: G of them.
        targets: (G, 3) mm, seen from the fixed joint.
        weights: (G,) not negative; they add up to 1.
    """

    vertices: tuple[Vertex, ...]
    targets: Array
    weights: Array

    @classmethod
    def of(
        cls, vertices: Sequence[Vertex], targets: Array, weights: Array | None = None
    ) -> "Goals":
        """Return goals with weights (G,) of any scale; all the same if not given."""
        parts = np.ones(len(vertices)) if weights is None else np.asarray(weights, float)
        return cls(tuple(vertices), np.asarray(targets, float), parts / parts.sum())

    @classmethod
    def centres(cls, targets: Array) -> "Goals":
        """Return the goals that the centres of all joints come to targets (J, 3)."""
        return cls.of([Vertex("joint", k) for k in range(len(targets))], targets)

    def __len__(self) -> int:
        return len(self.vertices)

    def points(self, joints: Array, sections: Array) -> Array:
        """Return where the vertices are: (..., G, 3), given corners as `Vertex.of` takes them."""
        return np.stack([vertex.of(joints, sections) for vertex in self.vertices], axis=-2)

    def matrix(self, joints: int, beams: int) -> Array:
        """Return what makes the points (G, 3) of all corners: (G, 8 J + 12 B).

        Corners are those of joints (J, 8), then those of sections (B, 3, 4), one after the other.
        """
        eye = np.eye(8 * joints + 12 * beams)
        split = 8 * joints
        of_joints = eye[:split].reshape(joints, 8, -1)
        return self.points(of_joints, eye[split:].reshape(beams, 3, 4, -1))

    def distances(self, points: Array) -> Array:
        """Return the distances (..., G) mm of points (..., G, 3) from their targets."""
        away: Array = np.linalg.norm(points - self.targets, axis=-1)
        return away

    def error(self, points: Array) -> Array:
        """Return the weighted mean distance (...) mm of points (..., G, 3)."""
        mean: Array = self.distances(points) @ self.weights
        return mean

    def shifted(self, by: Array) -> "Goals":
        """Return the goals with their targets moved by (G, 3) mm."""
        return replace(self, targets=self.targets + by)

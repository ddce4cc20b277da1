"""Goals: where some vertices of the morphed grid are wanted, and how far from there they are.

A vertex is a corner or the centre of a joint, or a corner or the centre of a beam's section; the
frame that counts is the last. What is wanted of vertices is of several kinds (`kinds`, `turning`,
`clear`); each goal has a distance in mm. The error of a design is the weighted mean distance over
its goals.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from simulearn.inverse.kinds import AtPoints, OnSet, Wanted, sized
from simulearn.inverse.pose import fitted, moved, starts
from simulearn.inverse.vertex import Vertex
from simulearn.rigid import Place
from simulearn.surfaces import Surface

__all__ = ["Goals", "Part", "Vertex"]

Array = NDArray[np.float64]

ANCHORS = 6  # places of a surface on which a shape is laid to begin with
STEP = 1e-3  # mm, for derivatives of what has a pose of its own


@dataclass(frozen=True, eq=False)
class Part:
    """Goals of one kind.

    Attributes:
        wanted: of the vertices.
        vertices: n of them.
        weights: (g,) of the goals.
    """

    wanted: Wanted
    vertices: tuple[Vertex, ...]
    weights: Array

    @property
    def names(self) -> tuple[str, ...]:
        """What each of the g goals is about."""
        return self.wanted.names(self.vertices)


@dataclass(frozen=True, eq=False)
class Goals:
    """G goals about V vertices.

    Attributes:
        parts: goals by their kinds; the vertices of all follow each other.
        offset: (V, 3) mm, from where vertices will be to where an engine has them.
        pose: the rigid motion at which the best one is looked for, where the shape may be placed
            anywhere; None where it is seen from the fixed joint.
        shapes: how many shapes the goals are of, each with the same ones and a motion of its own.
    """

    parts: tuple[Part, ...]
    offset: Array
    pose: Place | None = None
    shapes: int = 1

    @classmethod
    def of(
        cls, vertices: Sequence[Vertex], targets: Array, weights: Array | None = None
    ) -> "Goals":
        """Return goals at points with weights (V,) of any scale; all the same if not given."""
        share = np.ones(len(vertices)) if weights is None else np.asarray(weights, float)
        wanted = AtPoints(np.asarray(targets, float))
        return cls.together([Part(wanted, tuple(vertices), share)])

    @classmethod
    def centres(cls, targets: Array) -> "Goals":
        """Return the goals that the centres of all joints come to targets (J, 3)."""
        return cls.of([Vertex("joint", k) for k in range(len(targets))], targets)

    @classmethod
    def together(cls, parts: Sequence[Part], pose: Place | None = None) -> "Goals":
        """Return goals with weights of any scale as one."""
        total = sum(float(part.weights.sum()) for part in parts)
        scaled = tuple(replace(part, weights=part.weights / total) for part in parts)
        count = sum(len(part.vertices) for part in parts)
        return cls(scaled, np.zeros((count, 3)), pose)

    def __len__(self) -> int:
        return sum(len(part.weights) for part in self.parts)

    @property
    def vertices(self) -> tuple[Vertex, ...]:
        """V of them."""
        return tuple(vertex for part in self.parts for vertex in part.vertices)

    @property
    def weights(self) -> Array:
        """(G,) not negative; they add up to 1."""
        return np.concatenate([part.weights for part in self.parts])

    @property
    def names(self) -> tuple[str, ...]:
        """What each of the G goals is about."""
        return tuple(name for part in self.parts for name in part.names)

    @property
    def kinds(self) -> tuple[str, ...]:
        """The kind of each of the G goals."""
        return tuple(part.wanted.kind for part in self.parts for _ in part.weights)

    @property
    def targets(self) -> Array:
        """(K, 3) mm, the targets of those goals that are points."""
        found = [
            part.wanted.targets + self.offset[at]
            for part, at in self.slices()
            if isinstance(part.wanted, AtPoints)
        ]
        return np.concatenate([np.zeros((0, 3)), *found])

    def slices(self) -> Iterator[tuple[Part, slice]]:
        """Yield the parts, and where their vertices are among all."""
        begin = 0
        for part in self.parts:
            yield part, slice(begin, begin + len(part.vertices))
            begin += len(part.vertices)

    def points(self, joints: Array, sections: Array) -> Array:
        """Return where the vertices are: (..., V, 3), given corners as `Vertex.of` takes them."""
        return np.stack([vertex.of(joints, sections) for vertex in self.vertices], axis=-2)

    def matrix(self, joints: int, beams: int) -> Array:
        """Return what makes the points (V, 3) of all corners: (V, 8 J + 12 B).

        Corners are those of joints (J, 8), then those of sections (B, 3, 4), one after the other.
        """
        eye = np.eye(8 * joints + 12 * beams)
        split = 8 * joints
        of_joints = eye[:split].reshape(joints, 8, -1)
        return self.points(of_joints, eye[split:].reshape(beams, 3, 4, -1))

    def residual(self, points: Array) -> Array:
        """Return how far the goals are from being met, for least squares.

        Args:
            points: (..., V, 3) mm.

        Returns:
            (..., N) mm, vectors scaled by the roots of the weights; NaN where points are.
        """
        return self._over(self._residual, self._placed, points)

    def distances(self, points: Array) -> Array:
        """Return the distances (..., G) mm of the goals at points (..., V, 3)."""
        return self._over(self._distances, self._placed, points)

    def error(self, points: Array) -> Array:
        """Return the weighted mean distance (...) mm at points (..., V, 3)."""
        mean: Array = self.distances(points) @ self.weights
        return mean

    def apart(self, one: Array, other: Array) -> float:
        """Return the weighted mean distance mm of vertices (V, 3) in two shapes."""
        shares = [
            np.full(len(part.vertices), part.weights.sum() / len(part.vertices))
            if len(part.vertices) != len(part.weights)
            else part.weights
            for part in self.parts
        ]
        return float(sized(one - other) @ np.concatenate(shares))

    def shifted(self, by: Array) -> "Goals":
        """Return the goals met by points (V, 3) mm so much farther."""
        return replace(self, offset=self.offset + by)

    def repeated(self, count: int) -> "Goals":
        """Return the goals of so many shapes together, those of one after those of another."""
        parts = tuple(replace(part, weights=part.weights / count) for part in self.parts)
        offset = np.tile(self.offset, (count, 1))
        return replace(self, parts=parts * count, offset=offset, shapes=count)

    def begun(self, points: Array) -> "Goals":
        """Return the goals of a search whose first design has points (V, 3) mm.

        Vertices that may not slide get the target that they keep, and a free pose its beginning.
        """
        here = points - self.offset
        goals = self if self.pose is None else replace(self, pose=self._first_pose(here))
        placed = goals._placed(points[None])[0]
        parts = [replace(part, wanted=part.wanted.begun(placed[at])) for part, at in goals.slices()]
        return replace(goals, parts=tuple(parts))

    def place(self, points: Array) -> Place:
        """Return the motion that brings a shape with points (V, 3) mm to where it is compared."""
        if self.pose is None:
            return Place()
        turn, shift = self._poses((points - self.offset)[None])
        return Place(turn[0], shift[0])

    def placed(self, points: Array) -> Array:
        """Return points (V, 3) mm of a shape where they are compared."""
        return self._placed(points[None])[0]

    def lines(self, points: Array) -> Array:
        """Return lines (K, 2, 3) mm from where points (V, 3) are placed to where they should be."""
        placed = self.placed(points)
        found = [part.wanted.lines(placed[at]) for part, at in self.slices()]
        return np.concatenate([np.zeros((0, 2, 3)), *found])

    def degrees(self, points: Array) -> list[float | None]:
        """Return by how many degrees goals are off that are directions, at points (V, 3) mm."""
        placed = self.placed(points)
        found: list[float | None] = []
        for part, at in self.slices():
            off = part.wanted.degrees(placed[at])
            found += [None] * len(part.weights) if off is None else off.tolist()
        return found

    def slope(self, points: Array, soft: float = 1e-9) -> tuple[float, Array]:
        """Return the error at points (V, 3) mm and its derivative (V, 3) by them.

        Args:
            points: of one shape.
            soft: mm; a distance d counts as sqrt(d2 + soft2) - soft.
        """
        if self.pose is None:
            return self._slope(points - self.offset, soft)
        # The best motion is best in squares and not in the mean: it changes with the points, too.
        steps = STEP * np.eye(points.size).reshape(-1, *points.shape)
        every = np.concatenate([points[None], points + steps, points - steps])
        values = np.sqrt(self.distances(every) ** 2 + soft**2) @ self.weights - soft
        up, down = np.split(values[1:], 2)
        return float(values[0]), ((up - down) / (2 * STEP)).reshape(points.shape)

    def _slope(self, placed: Array, soft: float) -> tuple[float, Array]:
        value, slope = 0.0, np.zeros_like(placed)
        for part, at in self.slices():
            away = part.wanted.away(placed[None, at])[0]
            length = np.sqrt((away**2).sum(axis=-1) + soft**2)
            value += float(part.weights @ (length - soft))
            slope[at] += part.wanted.pulled(placed[at], (part.weights / length)[:, None] * away)
        return value, slope

    def _over(
        self, measure: Callable[[Array], Array], place: Callable[[Array], Array], points: Array
    ) -> Array:
        """Return a measure (..., M) of points (..., V, 3) in their places."""
        flat = points.reshape(-1, *points.shape[-2:])
        values = measure(place(flat))
        values[~np.isfinite(flat).all(axis=(1, 2))] = np.nan
        return values.reshape(*points.shape[:-2], values.shape[-1])

    def _residual(self, placed: Array) -> Array:
        found = [
            part.wanted.away(placed[:, at]) * np.sqrt(part.weights)[:, None]
            for part, at in self.slices()
        ]
        return np.concatenate([part.reshape(len(placed), -1) for part in found], axis=1)

    def _distances(self, placed: Array) -> Array:
        found = [sized(part.wanted.away(placed[:, at])) for part, at in self.slices()]
        return np.concatenate(found, axis=1)

    def _placed(self, points: Array) -> Array:
        """Return points (T, V, 3) less the offset, after the best motion where there is one."""
        here = points - self.offset
        if self.pose is None:
            return here
        one = replace(self, parts=self.parts[: len(self.parts) // self.shapes], shapes=1)
        each = here.reshape(-1, here.shape[1] // self.shapes, 3)
        return moved(each, *one._poses(each)).reshape(here.shape)

    def _poses(self, here: Array, starts: Sequence[Place] = ()) -> tuple[Array, Array]:
        assert self.pose is not None
        first = starts or [self.pose] * len(here)
        turn, shift = (np.stack([getattr(p, name) for p in first]) for name in ("turn", "shift"))
        return fitted(here, self._residual, turn, shift)

    def _first_pose(self, here: Array) -> Place:
        """Return the best motion of the first design, found from many beginnings."""
        places = [Place()]
        for part, at in self.slices():
            if isinstance(part.wanted, AtPoints) and len(part.vertices) > 2:
                places.append(Place.fitting(here[at], part.wanted.targets))
            elif isinstance(part.wanted, OnSet) and isinstance(part.wanted.set, Surface):
                surface = part.wanted.set
                places += starts(here, *surface.spread(ANCHORS))
        many = np.repeat(here[None], len(places), axis=0)
        turn, shift = self._poses(many, places)
        errors = self._distances(moved(many, turn, shift)) @ self.weights
        k = int(errors.argmin())
        return Place(turn[k], shift[k])

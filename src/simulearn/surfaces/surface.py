"""Surfaces made of triangles: closest points, normals, and which side of a closed one is inside."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError, Message
from simulearn.rigid import Place
from simulearn.surfaces.tree import Tree

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangles in space.

    Attributes:
        vertices: (V, 3) mm.
        faces: (T, 3) their corners among the vertices, seen from outside counter-clockwise.
        warnings: what was mended or guessed when they were read.
        places: (K, 3) mm where that was, by the code of a warning.
    """

    vertices: Array
    faces: Indices
    warnings: tuple[Message, ...] = ()
    places: Mapping[str, Array] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Take arrays as they are needed.

        Raises:
            InputError: there are no triangles.
        """
        object.__setattr__(self, "vertices", np.ascontiguousarray(self.vertices, np.float64))
        object.__setattr__(self, "faces", np.ascontiguousarray(self.faces, np.int64))
        if not len(self.faces):
            raise InputError("a surface has at least one triangle", "surface-empty", "surface")

    def closest(self, points: NDArray[Any]) -> tuple[Array, Array, Indices]:
        """Return the points of the surface that are closest to others.

        Args:
            points: (N, 3) mm; not finite ones have no closest point.

        Returns:
            The closest points (N, 3) mm, unit normals (N, 3) of their faces, and the faces (N,); of
            a point that is not finite NaN, NaN and -1.
        """
        places, faces = self._tree.closest(points)
        normals = np.where(faces[:, None] >= 0, self.normals[faces], np.nan)
        return places, normals, faces

    def distance(self, points: NDArray[Any]) -> Array:
        """Return how far points (N, 3) mm are from the surface (N,) mm."""
        away: Array = np.linalg.norm(points - self.closest(points)[0], axis=1)
        return away

    def signed_distance(self, points: NDArray[Any]) -> Array:
        """Return how far points (N, 3) mm are outside of a closed surface (N,) mm, < 0 inside.

        Inside is what the surface goes around once or more, so bodies may overlap.

        Raises:
            InputError: the surface is not closed.
        """
        return np.where(self.inside(points), -1.0, 1.0) * self.distance(points)

    def inside(self, points: NDArray[Any]) -> NDArray[np.bool_]:
        """Return which of the points (N, 3) mm are inside of a closed surface.

        Raises:
            InputError: the surface is not closed.
        """
        if not self.closed:
            text = "the surface is not closed; only a closed one has an inside"
            raise InputError(text, "surface-open", "surface")
        inside: NDArray[np.bool_] = self._tree.windings(points) > 0
        return inside

    @cached_property
    def closed(self) -> bool:
        """Whether each edge joins as many faces that run along it as against it."""
        ends = np.concatenate([self.faces[:, [0, 1]], self.faces[:, [1, 2]], self.faces[:, [2, 0]]])
        low, high = ends.min(axis=1), ends.max(axis=1)
        _, edge = np.unique(low * len(self.vertices) + high, return_inverse=True)
        runs = np.where(ends[:, 0] < ends[:, 1], 1.0, -1.0)
        return not np.bincount(edge, runs).any()

    @cached_property
    def normals(self) -> Array:
        """(T, 3) unit normals of the faces."""
        a, b, c = np.moveaxis(self.vertices[self.faces], 1, 0)
        across = np.cross(b - a, c - a)
        normals: Array = across / np.linalg.norm(across, axis=1, keepdims=True)
        return normals

    @property
    def box(self) -> Array:
        """(2, 3) lower and upper corner, mm."""
        used = self.vertices[np.unique(self.faces)]
        return np.stack([used.min(axis=0), used.max(axis=0)])

    @property
    def size(self) -> float:
        """Diagonal of its box, mm."""
        return float(np.linalg.norm(np.diff(self.box, axis=0)))

    def spread(self, count: int) -> tuple[Array, Array]:
        """Return places (count, 3) mm that are spread over the surface by area, and normals."""
        a, b, c = np.moveaxis(self.vertices[self.faces], 1, 0)
        area = np.cumsum(np.linalg.norm(np.cross(b - a, c - a), axis=1))
        at = np.searchsorted(area, (np.arange(count) + 0.5) / count * area[-1])
        return (a + b + c)[at] / 3, self.normals[at]

    def placed(self, place: Place) -> "Surface":
        """Return the surface after a rigid motion."""
        places = {code: place(points) for code, points in self.places.items()}
        return replace(self, vertices=place(self.vertices), places=places)

    def scaled(self, factor: float) -> "Surface":
        """Return the surface so many times as large, about the origin."""
        places = {code: points * factor for code, points in self.places.items()}
        return replace(self, vertices=self.vertices * factor, places=places)

    @cached_property
    def _tree(self) -> Tree:
        return Tree.of(self.vertices[self.faces])

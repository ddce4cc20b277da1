"""How far two convex pieces are apart, or how deep they are in each other.

Two convex bodies are apart where their shadows are on some line; for polyhedra the lines to try are
normals of faces and cross products of edges (the separating axis theorem: Gottschalk, Lin, Manocha,
OBBTree, SIGGRAPH 1996). Where they are not, the shortest move that would separate them is along one
of these lines: that is the depth. The cuts between the pieces of a beam are no faces of it, so that
a move along a beam is not counted.
"""

from math import sqrt
from typing import Any

import numpy as np

from simulearn.collisions.kernels.vectors import cross
from simulearn.native import native

Array = Any

ALONG = 0.7  # cosine from which a direction is along a beam
ACROSS = 1e-6  # sine from which two edges are not parallel


@native(entry=False)
def shadows_apart(a: Array, b: Array, x: float, y: float, z: float) -> float:
    """Return the distance of two bodies' (8, 3) shadows on a line; negative: how they overlap."""
    low_a = low_b = np.inf
    high_a = high_b = -np.inf
    for c in range(8):
        place = x * a[c, 0] + y * a[c, 1] + z * a[c, 2]
        low_a, high_a = min(low_a, place), max(high_a, place)
        place = x * b[c, 0] + y * b[c, 1] + z * b[c, 2]
        low_b, high_b = min(low_b, place), max(high_b, place)
    return max(low_b - high_a, low_a - high_b)


@native(entry=False)
def is_along(kind: int, edges: Array, x: float, y: float, z: float) -> bool:
    """Return whether a direction is along the beam that a piece with these edges belongs to."""
    axis = edges[2]
    return kind == 3 and abs(x * axis[0] + y * axis[1] + z * axis[2]) > ALONG


@native(entry=False)
def separation(pieces: Any, a: int, i: int, b: int, j: int) -> float:
    """Return how far piece i of body a and piece j of body b are apart, mm; negative: the depth.

    The distance is at least what is returned.
    """
    p, q = pieces.corners[a, i], pieces.corners[b, j]
    e, f = pieces.edges[a, i], pieces.edges[b, j]
    m, n = pieces.kinds[a], pieces.kinds[b]
    apart = depth = -np.inf
    for k in range(m + n + m * n):  # normals of a, normals of b, cross products of edges
        if k < m + n:
            normal = pieces.normals[a, i, k] if k < m else pieces.normals[b, j, k - m]
            x, y, z = normal[0], normal[1], normal[2]
        else:
            u, v = e[(k - m - n) // n], f[(k - m - n) % n]
            x, y, z = cross(u, v)
            size = sqrt(x * x + y * y + z * z)
            if size < ACROSS:
                continue
            x, y, z = x / size, y / size, z / size
        value = shadows_apart(p, q, x, y, z)
        apart = max(apart, value)
        if value > depth and not (is_along(m, e, x, y, z) or is_along(n, f, x, y, z)):
            depth = value
    return apart if apart > 0.0 else depth

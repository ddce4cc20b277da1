"""How far two convex pieces are apart, or how deep they are in each other.

Two convex bodies are apart where their shadows are on some line; for polyhedra the lines to try are
normals of faces and cross products of edges (the separating axis theorem: Gottschalk, Lin, Manocha,
OBBTree, SIGGRAPH 1996). Where they are not, the shortest move that would separate them is along one
of these lines: that is the depth. The cuts between the pieces of a beam are no faces of it: a move
along a beam leads into its next piece and is not counted, unless it leads beyond its end.
"""

from math import sqrt
from typing import Any

import numpy as np

from simulearn.collisions.kernels.vectors import cross, minus, unit
from simulearn.native import native

Array = Any

ALONG = 0.7  # cosine from which a direction is along a beam
ACROSS = 1e-6  # sine from which two edges are not parallel
RING = (0, 1, 3, 2)  # corners of a section, around


@native(entry=False, allocates=False)
def shadows_apart(a: Array, b: Array, x: float, y: float, z: float) -> Any:
    """Return the distances by which the second of two bodies (8, 3) lies ahead and behind.

    Along a direction; negative: how far it would have to move there to be free.
    """
    low_a = low_b = np.inf
    high_a = high_b = -np.inf
    for c in range(8):
        place = x * a[c, 0] + y * a[c, 1] + z * a[c, 2]
        low_a, high_a = min(low_a, place), max(high_a, place)
        place = x * b[c, 0] + y * b[c, 1] + z * b[c, 2]
        low_b, high_b = min(low_b, place), max(high_b, place)
    return low_b - high_a, low_a - high_b


@native(entry=False, allocates=False)
def leads_on(pieces: Any, body: int, k: int, x: float, y: float, z: float) -> bool:
    """Return whether a direction leads from piece k of a beam into the next one."""
    if pieces.kinds[body] != 3:
        return False
    axis = pieces.edges[body, k, 2]
    along = x * axis[0] + y * axis[1] + z * axis[2]
    return (along > ALONG and k < pieces.counts[body] - 1) or (along < -ALONG and k > 0)


@native(entry=False, allocates=False)
def along_line(pieces: Any, a: int, i: int, b: int, j: int, x: float, y: float, z: float) -> Any:
    """Return the distance of two pieces along a line, and that by moves that count."""
    ahead, behind = shadows_apart(pieces.corners[a, i], pieces.corners[b, j], x, y, z)
    counted = -np.inf
    if not (leads_on(pieces, a, i, x, y, z) or leads_on(pieces, b, j, -x, -y, -z)):
        counted = ahead
    if behind > counted and not (
        leads_on(pieces, a, i, -x, -y, -z) or leads_on(pieces, b, j, x, y, z)
    ):
        counted = behind
    return max(ahead, behind), counted


@native(entry=False, allocates=False)
def along_lines(
    pieces: Any, a: int, i: int, b: int, j: int, first: Array, normals: int, second: Array,
    others: int, edges: Any,
) -> Any:  # fmt: skip
    """Return the most that two pieces are apart along some lines, and that by moves that count.

    Args:
        pieces: of bodies.
        a: a body.
        i: its piece.
        b: another body.
        j: its piece.
        first: normals (N, 3) of the one.
        normals: how many count.
        second: of the other.
        others: how many of these count.
        edges: edges (N, 3) of the one, how many count, and the same of the other.
    """
    apart = depth = -np.inf
    e, m, f, n = edges
    for k in range(normals + others + m * n):
        if k < normals + others:
            normal = first[k] if k < normals else second[k - normals]
            x, y, z = normal[0], normal[1], normal[2]
        else:
            k -= normals + others
            x, y, z = cross(e[k // n], f[k % n])
            size = sqrt(x * x + y * y + z * z)
            if size < ACROSS:
                continue
            x, y, z = x / size, y / size, z / size
        value, counted = along_line(pieces, a, i, b, j, x, y, z)
        apart, depth = max(apart, value), max(depth, counted)
    return apart, depth


@native(entry=False, allocates=False)
def separation(pieces: Any, a: int, i: int, b: int, j: int) -> float:
    """Return how far piece i of body a and piece j of body b are apart, mm; negative: the depth.

    The distance is at least what is returned. Pieces of beams are taken as boxes along the axis.
    """
    m, n = pieces.kinds[a], pieces.kinds[b]
    edges = (pieces.edges[a, i], m, pieces.edges[b, j], n)
    apart, depth = along_lines(
        pieces, a, i, b, j, pieces.normals[a, i], m, pieces.normals[b, j], n, edges
    )
    return apart if apart > 0.0 else depth


@native(entry=False, allocates=False)
def set_sides(pieces: Any, body: int, k: int, normals: Array, edges: Array) -> None:
    """Set normals (6, 3) and edges (12, 3) of a piece as its corners have them."""
    x = pieces.corners[body, k]
    beam = pieces.kinds[body] == 3
    for s in range(4):
        a = RING[s] if beam else s
        b = RING[(s + 1) % 4] if beam else (s + 1) % 4
        normal = unit(cross(minus(x[b + 4], x[a]), minus(x[a + 4], x[b])))
        along = unit(minus(x[a + 4], x[a]))
        before, after = unit(minus(x[b], x[a])), unit(minus(x[b + 4], x[a + 4]))
        for i in range(3):
            normals[s, i], edges[s, i] = normal[i], along[i]
            edges[4 + s, i], edges[8 + s, i] = before[i], after[i]
    for end in range(2):
        low = 4 * end
        c, d = (3, 2) if beam else (2, 3)
        cap = unit(cross(minus(x[low + c], x[low]), minus(x[low + d], x[low + 1])))
        for i in range(3):
            normals[4 + end, i] = cap[i]


@native(entry=False, allocates=False)
def exact(pieces: Any, a: int, i: int, b: int, j: int, value: float) -> float:
    """Return the separation of two pieces that overlap, by their sides as they are.

    A box along the axis is not what the corners of a piece span where it tapers, twists or ends in
    an oblique cut. The sides only ever lessen the depth.

    Args:
        pieces: of bodies.
        a: a body.
        i: its piece.
        b: another body.
        j: its piece.
        value: the separation by boxes.
    """
    room = pieces.sides
    set_sides(pieces, a, i, room[0], room[1])
    set_sides(pieces, b, j, room[2], room[3])
    edges = (room[1], 12, room[3], 12)
    apart, depth = along_lines(pieces, a, i, b, j, room[0], 6, room[2], 6, edges)
    return apart if apart > 0.0 else max(value, depth)

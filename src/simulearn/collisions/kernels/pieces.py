"""Bodies as convex pieces: a beam is a row of short boxes along its axis, a joint is one prism.

A piece has eight corners, the normals of its faces and the directions of its edges, and a sphere
around it. A piece of a beam has three of each, the last being along the beam; a joint five.
"""

from math import sqrt
from typing import Any, NamedTuple

import numpy as np

from simulearn.collisions.kernels.axis import PIECES, set_sections
from simulearn.collisions.kernels.vectors import cross, dot, minus, plus, section_frame, unit
from simulearn.native import native

Array = Any


class Pieces(NamedTuple):
    """Room for the pieces of N bodies, P of each at most.

    Attributes:
        corners: (N, P, 8, 3) mm.
        normals: (N, P, 5, 3) of faces, unit length.
        edges: (N, P, 5, 3) directions, unit length.
        spheres: (N, P, 4) centre and radius, mm.
        kinds: (N,) how many normals and edges a piece has: 3 of a beam, 5 of a joint.
        counts: (N,) of pieces.
        sections: (P + 1, 4, 3) of a beam, mm.
        given: (S, 4, 3) its sections between two frames, mm.
        sides: (4, 12, 3) for normals and edges of two pieces as their corners have them.
    """

    corners: Array
    normals: Array
    edges: Array
    spheres: Array
    kinds: Array
    counts: Array
    sections: Array
    given: Array
    sides: Array


@native(entry=False)
def make_pieces(bodies: int, sections: int) -> Any:
    """Return room for bodies that are beams of so many given sections, or joints."""
    most = count_of(sections)
    return Pieces(
        np.zeros((bodies, most, 8, 3)),
        np.zeros((bodies, most, 5, 3)),
        np.zeros((bodies, most, 5, 3)),
        np.zeros((bodies, most, 4)),
        np.zeros(bodies, np.int64),
        np.zeros(bodies, np.int64),
        np.zeros((most + 1, 4, 3)),
        np.zeros((sections, 4, 3)),
        np.zeros((4, 12, 3)),
    )


@native(entry=False, allocates=False)
def count_of(sections: int) -> int:
    """Return the number of pieces of a beam."""
    return PIECES if sections == 3 else sections - 1


@native(entry=False, allocates=False)
def set_beam(
    first: Array, second: Array, share: float, ratio: float, skew: Array, pieces: Any, body: int
) -> None:
    """Set the pieces of a beam between two frames' sections (S, 4, 3)."""
    given, rows = pieces.given, pieces.sections
    for s in range(len(first)):
        for c in range(4):
            for i in range(3):
                given[s, c, i] = first[s, c, i] + share * (second[s, c, i] - first[s, c, i])
    if len(given) == 3:
        set_sections(given, ratio, skew, rows)
    else:
        for s in range(len(given)):
            for c in range(4):
                for i in range(3):
                    rows[s, c, i] = given[s, c, i]
    pieces.kinds[body] = 3
    pieces.counts[body] = count_of(len(given))
    corners = pieces.corners[body]
    centre, left, up = section_frame(rows[0])
    for k in range(pieces.counts[body]):
        after, left_after, up_after = section_frame(rows[k + 1])
        along = unit(minus(after, centre))
        across, high = unit(plus(left, 1.0, left_after)), unit(plus(up, 1.0, up_after))
        edges = (across, high, along)
        normals = (unit(cross(high, along)), unit(cross(along, across)), cross(across, high))
        for d in range(3):
            for i in range(3):
                pieces.edges[body, k, d, i] = edges[d][i]
                pieces.normals[body, k, d, i] = normals[d][i]
        for c in range(4):
            for i in range(3):
                corners[k, c, i] = rows[k, c, i]
                corners[k, 4 + c, i] = rows[k + 1, c, i]
        set_sphere(corners[k], pieces.spheres[body, k])
        centre, left, up = after, left_after, up_after


@native(entry=False, allocates=False)
def set_joint(first: Array, second: Array, share: float, pieces: Any, body: int) -> None:
    """Set the one piece of a joint between two frames' corners (8, 3)."""
    x = pieces.corners[body, 0]
    edges, normals = pieces.edges[body, 0], pieces.normals[body, 0]
    for c in range(8):
        for i in range(3):
            x[c, i] = first[c, i] + share * (second[c, i] - first[c, i])
    up = unit(cross(side_of(x, 0, 2), side_of(x, 1, 3)))
    for i in range(3):
        normals[4, i] = edges[4, i] = up[i]
    for k in range(4):
        side = unit(side_of(x, k, (k + 1) % 4))
        out = unit(cross(side, up))
        for i in range(3):
            edges[k, i], normals[k, i] = side[i], out[i]
    pieces.kinds[body], pieces.counts[body] = 5, 1
    set_sphere(x, pieces.spheres[body, 0])


@native(entry=False, allocates=False)
def side_of(corners: Array, a: int, b: int) -> Any:
    """Return the way from vertical edge a of a joint (8, 3) to b, twice."""
    below, above = minus(corners[b], corners[a]), minus(corners[b + 4], corners[a + 4])
    return plus(below, 1.0, above)


@native(entry=False, allocates=False)
def set_sphere(corners: Array, sphere: Array) -> None:
    """Set centre and radius (4,) of the sphere around the corners (8, 3) of a piece."""
    for i in range(3):
        total = 0.0
        for c in range(8):
            total += corners[c, i]
        sphere[i] = total / 8
    most = 0.0
    for c in range(8):
        away = minus(corners[c], sphere)
        most = max(most, dot(away, away))
    sphere[3] = sqrt(most)

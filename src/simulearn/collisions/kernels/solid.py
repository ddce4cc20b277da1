"""Bodies against an obstacle of triangles: the entry from Python.

A piece meets the obstacle where a triangle runs into it; of a closed obstacle also where a corner
or the centre of the piece lies inside, which the winding number says: the sum of the solid angles
of all triangles (Jacobson, Kavan, Sorkine-Hornung, Robust inside-outside segmentation using
generalized winding numbers, SIGGRAPH 2013).
"""

from math import atan2, pi
from typing import Any

import numpy as np

from simulearn.collisions.kernels.axis import set_skew
from simulearn.collisions.kernels.pairs import Bends, keep, set_body
from simulearn.collisions.kernels.pieces import make_pieces, set_sphere
from simulearn.collisions.kernels.separation import separation
from simulearn.collisions.kernels.vectors import cross, dot, length, minus, plus, unit
from simulearn.native import native

Array = Any

TRIANGLE = 4  # normals and edges of a triangle as a piece: one edge is there twice


@native(entry=False)
def set_triangle(triangle: Array, pieces: Any, body: int) -> None:
    """Set the one piece of a triangle (3, 3)."""
    corners = pieces.corners[body, 0]
    edges, normals = pieces.edges[body, 0], pieces.normals[body, 0]
    for c in range(8):
        for i in range(3):
            corners[c, i] = triangle[c % 3, i]
    first, second = minus(triangle[1], triangle[0]), minus(triangle[2], triangle[0])
    up = unit(cross(first, second))
    for i in range(3):
        normals[3, i] = up[i]
    for k in range(TRIANGLE):
        side = unit(minus(triangle[(k + 1) % 3], triangle[k % 3]))
        out = cross(side, up)
        for i in range(3):
            edges[k, i] = side[i]
            if k < 3:
                normals[k, i] = out[i]
    pieces.kinds[body], pieces.counts[body] = TRIANGLE, 1
    set_sphere(corners, pieces.spheres[body, 0])


@native(entry=False)
def winding(point: Any, triangles: Array) -> float:
    """Return how often triangles (N, 3, 3) wind around a point: 1 inside, 0 outside.

    Source: van Oosterom, Strackee, The solid angle of a plane triangle, 1983.
    """
    total = 0.0
    for n in range(len(triangles)):
        a, b, c = (
            minus(triangles[n, 0], point),
            minus(triangles[n, 1], point),
            minus(triangles[n, 2], point),
        )
        x, y, z = length(a), length(b), length(c)
        below = x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y
        total += atan2(dot(a, cross(b, c)), below)
    return abs(total) / (2 * pi)


@native(entry=False)
def distance(point: Any, triangles: Array) -> float:
    """Return the distance of a point from the nearest of triangles (N, 3, 3).

    Source: Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
    """
    least = np.inf
    for n in range(len(triangles)):
        a, b, c = triangles[n, 0], triangles[n, 1], triangles[n, 2]
        up = cross(minus(b, a), minus(c, a))
        size = length(up)
        inside = size > 0.0
        for k in range(3):
            here, there = triangles[n, k], triangles[n, (k + 1) % 3]
            side, away = minus(there, here), minus(point, here)
            if dot(cross(side, away), up) < 0.0 or not inside:
                inside = False
                square = dot(side, side)
                t = min(max(dot(side, away) / square, 0.0), 1.0) if square > 0.0 else 0.0
                least = min(least, length(plus(away, -t, side)))
        if inside:
            least = min(least, abs(dot(minus(point, a), up)) / size)
    return least


@native(entry=False)
def depth_in(
    pieces: Any, body: int, k: int, triangles: Array, spheres: Array, closed: bool
) -> float:
    """Return how deep piece k of a body is in an obstacle, mm; 0 where it is outside."""
    deep = 0.0
    sphere = pieces.spheres[body, k]
    for n in range(len(triangles)):
        away = minus(sphere, spheres[n])
        reach = sphere[3] + spheres[n, 3]
        if dot(away, away) < reach * reach:
            set_triangle(triangles[n], pieces, 1)
            deep = max(deep, -separation(pieces, body, k, 1, 0))
    if closed:
        for c in range(9):
            point = (sphere[0], sphere[1], sphere[2])
            if c < 8:
                corner = pieces.corners[body, k, c]
                point = (corner[0], corner[1], corner[2])
            if winding(point, triangles) > 0.5:
                deep = max(deep, distance(point, triangles))
    return deep


@native()
def find_in_solid(
    joints: Array, sections: Array, ratios: Array, triangles: Array, closed: bool, least: float,
    found: Array,
) -> int:  # fmt: skip
    """Set a row for each body that is in an obstacle in some frame; return how many there are.

    Args:
        joints: (F, J, 8, 3) mm, corners of the joints.
        sections: (F, B, S, 4, 3) mm, corners of the beams' sections.
        ratios: (B,) of the actuators.
        triangles: (N, 3, 3) mm.
        closed: whether they are the surface of a body.
        least: mm; what is not deeper is no collision.
        found: (B + J, 10) is set as `pairs.find_pairs` does, with -1 in place of the other body.
    """
    frames, beams, given = sections.shape[:3]
    pieces = make_pieces(2, given)
    skews = np.zeros((beams, 3, 2))
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    spheres = np.empty((len(triangles), 4))
    for n in range(len(triangles)):
        set_triangle(triangles[n], pieces, 1)
        for i in range(4):
            spheres[n, i] = pieces.spheres[1, 0, i]
        for c in range(3):
            for i in range(3):
                low[i] = min(low[i], triangles[n, c, i])
                high[i] = max(high[i], triangles[n, c, i])
    for b in range(beams):
        if given == 3:
            set_skew(sections[0, b], skews[b])
    bends = Bends(ratios, skews)
    count = 0
    row, place = np.zeros(10), np.empty(3)
    for body in range(beams + joints.shape[1]):
        row[5], row[6] = -1.0, 0.0
        for f in range(frames):
            set_body(body, sections, joints, bends, f, f, 0.0, pieces, 0)
            for k in range(pieces.counts[0]):
                sphere = pieces.spheres[0, k]
                outside = False
                for i in range(3):
                    outside |= sphere[i] + sphere[3] < low[i] or sphere[i] - sphere[3] > high[i]
                if outside:
                    continue
                deep = depth_in(pieces, 0, k, triangles, spheres, closed)
                if deep > least:
                    for i in range(3):
                        place[i] = sphere[i]
                    keep(row, f, 0.0, f, deep, place)
        if row[6] > 0.0:
            row[0], row[1], row[2] = 0.0, body, -1.0
            for c in range(10):
                found[count, c] = row[c]
            count += 1
    return count

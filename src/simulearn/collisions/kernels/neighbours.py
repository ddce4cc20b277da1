"""Bodies that are joined: a joint and its beams, and two beams of one joint.

They touch where they are joined. So the pieces that begin within a beam's width of the joint are
not compared with each other. Most joined bodies are told apart by a plane through their joint,
without looking at pieces.
"""

from typing import Any

import numpy as np

from simulearn.collisions.kernels.vectors import (
    dot,
    length,
    minus,
    plus,
    section_frame,
    unit,
)
from simulearn.native import inlined, native

Array = Any

CLEAR = 3.0  # mm between the far halves of two beams, so that a plane may turn between two frames
STILL = 0.955  # cosine of the angle by which it may turn (.3 rad); in a snap it may turn over


@native(entry=False, allocates=False)
def common_joint(ends: Array, a: int, b: int) -> Any:
    """Return the joint that two beams share, -1 if none, and which ends of them it is at."""
    for i in range(2):
        for j in range(2):
            if ends[a, i] == ends[b, j]:
                return ends[a, i], i, j
    return -1, 0, 0


@native(entry=False, allocates=False)
def set_near(sections: Array, count: int, near: Array) -> None:
    """Set how many of a beam's pieces (2,) begin within its width of its start and its end.

    Args:
        sections: (S, 4, 3) of the beam in the first frame.
        count: of its pieces.
        near: is set.
    """
    many = len(sections)
    _, left, _ = section_frame(sections[0])
    width = 2 * length(left)
    if many == 3:
        start, _, _ = section_frame(sections[0])
        end, _, _ = section_frame(sections[2])
        piece = length(minus(end, start)) / count
        near[0] = near[1] = min(count, int(width / piece) + 1)
        return
    for side in range(2):
        begun, k = 0.0, 0
        here, _, _ = section_frame(sections[0 if side == 0 else many - 1])
        while k < count and begun < width:
            k += 1
            there, _, _ = section_frame(sections[k if side == 0 else many - 1 - k])
            begun += length(minus(there, here))
            here = there
        near[side] = k


@inlined
def up_of(joint: Array) -> Any:
    """Return the direction of a joint (8, 3) from bottom to top."""
    total = (0.0, 0.0, 0.0)
    for c in range(4):
        total = plus(total, 1.0, minus(joint[4 + c], joint[c]))
    return unit(total)


@inlined
def vector(rows: Array, f: int, b: int, r: int, k: int) -> Any:
    """Return vector k (centre, half width, half thickness) of row r of a hull in frame f."""
    return rows[f, b, r, k, 0], rows[f, b, r, k, 1], rows[f, b, r, k, 2]


@inlined
def face_of(faces: Array, f: int, b: int, end: int) -> Any:
    """Return the normal of a beam's end in frame f, from its joint into the beam."""
    return faces[f, b, end, 0], faces[f, b, end, 1], faces[f, b, end, 2]


@inlined
def least_along(rows: Array, f: int, b: int, end: int, n: Any, reach: float) -> Any:
    """Return where a beam begins along a direction, and where its far half does; mm.

    Args:
        rows: (F, B, R, 3, 3) of hulls.
        f: the frame.
        b: the beam.
        end: the one that is near.
        n: the direction.
        reach: of all rows, if it will do that the beam begins there or beyond; else 0.
    """
    many = rows.shape[2]
    low = far = np.inf
    for k in range(many):
        r = k if end == 0 else many - 1 - k
        place = dot(n, vector(rows, f, b, r, 0)) - reach
        if k == 0 or reach == 0.0:
            place += reach - abs(dot(n, vector(rows, f, b, r, 1)))
            place -= abs(dot(n, vector(rows, f, b, r, 2)))
        low = min(low, place)
        if k >= many // 2:
            far = min(far, place)
    return low, far


@inlined
def beams_apart(
    hulls: Any, f: int, a: int, i: int, b: int, j: int, joint: Array, least: float, normal: Array
) -> bool:
    """Return whether a plane through the joint of two beams has one on either side in a frame.

    The plane halves the angle of the joint's two faces, or that of the ways to the beams' middles.

    Args:
        hulls: of the beams.
        f: the frame.
        a: one beam.
        i: its end at the joint.
        b: the other beam.
        j: its end at the joint.
        joint: (8, 3) corners of the joint in the frame.
        least: mm by which they may overlap at the joint.
        normal: (3,) of the plane, is set.
    """
    n = unit(minus(face_of(hulls.faces, f, a, i), face_of(hulls.faces, f, b, j)))
    if not is_parted(n, hulls, f, a, i, b, j, least):
        rows, middle, up = hulls.rows, hulls.rows.shape[2] // 2, up_of(joint)
        between = minus(vector(rows, f, a, middle, 0), vector(rows, f, b, middle, 0))
        n = unit(plus(between, -dot(between, up), up))
        if not is_parted(n, hulls, f, a, i, b, j, least):
            return False
    normal[0], normal[1], normal[2] = n
    return True


@inlined
def is_parted(n: Any, hulls: Any, f: int, a: int, i: int, b: int, j: int, least: float) -> bool:
    """Return whether planes of a normal part two beams, and their far halves by more."""
    back = (-n[0], -n[1], -n[2])
    for rough in range(1, -1, -1):
        low, low_far = least_along(hulls.rows, f, a, i, n, rough * hulls.reach[f, a])
        high, high_far = least_along(hulls.rows, f, b, j, back, rough * hulls.reach[f, b])
        if low + high > -least and low_far + high_far > CLEAR:
            return True
    return False


@inlined
def joint_apart(
    hulls: Any, f: int, a: int, end: int, joint: Array, least: float, normal: Array
) -> bool:
    """Return whether a beam's hull lies beyond the face of its own joint in a frame.

    Args:
        hulls: of the beams.
        f: the frame.
        a: the beam.
        end: its end at the joint.
        joint: (8, 3) corners of the joint in the frame.
        least: mm by which they may overlap.
        normal: (3,) of the face, is set.
    """
    n = face_of(hulls.faces, f, a, end)
    normal[0], normal[1], normal[2] = n
    high = -np.inf
    for c in range(8):
        high = max(high, n[0] * joint[c, 0] + n[1] * joint[c, 1] + n[2] * joint[c, 2])
    for rough in range(1, -1, -1):
        low, _ = least_along(hulls.rows, f, a, end, n, rough * hulls.reach[f, a])
        if low - high > -least:
            return True
    return False

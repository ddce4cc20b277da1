"""Bodies that are joined: a joint and its beams, and two beams of one joint.

They touch where they are joined. So the pieces that begin within a beam's width of the joint are
not compared with each other. Most joined bodies are told apart by a plane through their joint,
without looking at pieces.
"""

from typing import Any

import numpy as np

from simulearn.collisions.kernels.vectors import (
    cross,
    dot,
    length,
    minus,
    plus,
    section_frame,
    unit,
)
from simulearn.native import native

Array = Any

CLEAR = 3.0  # mm between the far halves of two beams, so that a plane may turn between two frames
STILL = 0.955  # cosine of the angle by which it may turn (.3 rad); in a snap it may turn over


@native(entry=False)
def common_joint(ends: Array, a: int, b: int) -> Any:
    """Return the joint that two beams share, -1 if none, and which ends of them it is at."""
    for i in range(2):
        for j in range(2):
            if ends[a, i] == ends[b, j]:
                return ends[a, i], i, j
    return -1, 0, 0


@native(entry=False)
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


@native(entry=False)
def up_of(joint: Array) -> Any:
    """Return the direction of a joint (8, 3) from bottom to top."""
    total = (0.0, 0.0, 0.0)
    for c in range(4):
        total = plus(total, 1.0, minus(joint[4 + c], joint[c]))
    return unit(total)


@native(entry=False)
def vector(hulls: Array, f: int, b: int, r: int, k: int) -> Any:
    """Return vector k (centre, half width, half thickness) of row r of a hull in frame f."""
    return hulls[f, b, r, k, 0], hulls[f, b, r, k, 1], hulls[f, b, r, k, 2]


@native(entry=False)
def row_of(hulls: Array, f: int, b: int, r: int, n: Any) -> Any:
    """Return where row r of a beam's hull lies along a direction: its centre and reach."""
    across, up = vector(hulls, f, b, r, 1), vector(hulls, f, b, r, 2)
    return dot(n, vector(hulls, f, b, r, 0)), abs(dot(n, across)) + abs(dot(n, up))


@native(entry=False)
def outward(hulls: Array, f: int, b: int, end: int) -> Any:
    """Return the normal of a beam's end, from its joint into the beam."""
    r = 0 if end == 0 else hulls.shape[2] - 1
    n = unit(cross(vector(hulls, f, b, r, 1), vector(hulls, f, b, r, 2)))
    return n if end == 0 else (-n[0], -n[1], -n[2])


@native(entry=False)
def beams_apart(
    hulls: Array, f: int, a: int, i: int, b: int, j: int, joint: Array, least: float, normal: Array
) -> bool:
    """Return whether a plane through the joint of two beams has one on either side in a frame.

    The plane halves the angle of the joint's two faces, or that of the ways to the beams' middles.

    Args:
        hulls: (F, B, R, 3, 3) of the beams.
        f: the frame.
        a: one beam.
        i: its end at the joint.
        b: the other beam.
        j: its end at the joint.
        joint: (8, 3) corners of the joint in the frame.
        least: mm by which they may overlap at the joint.
        normal: (3,) of the plane, is set.
    """
    n = unit(minus(outward(hulls, f, a, i), outward(hulls, f, b, j)))
    if not is_parted(n, hulls, f, a, i, b, j, least):
        up = up_of(joint)
        middle = hulls.shape[2] // 2
        between = minus(vector(hulls, f, a, middle, 0), vector(hulls, f, b, middle, 0))
        n = unit(plus(between, -dot(between, up), up))
        if not is_parted(n, hulls, f, a, i, b, j, least):
            return False
    normal[0], normal[1], normal[2] = n
    return True


@native(entry=False)
def is_parted(n: Any, hulls: Array, f: int, a: int, i: int, b: int, j: int, least: float) -> bool:
    """Return whether planes of a normal part two beams, and their far halves by more."""
    rows = hulls.shape[2]
    low = low_far = np.inf
    high = high_far = -np.inf
    for r in range(rows):
        place, reach = row_of(hulls, f, a, r if i == 0 else rows - 1 - r, n)
        low = min(low, place - reach)
        if r >= rows // 2:
            low_far = min(low_far, place - reach)
        place, reach = row_of(hulls, f, b, r if j == 0 else rows - 1 - r, n)
        high = max(high, place + reach)
        if r >= rows // 2:
            high_far = max(high_far, place + reach)
    return low - high > -least and low_far - high_far > CLEAR


@native(entry=False)
def joint_apart(
    hulls: Array, f: int, a: int, end: int, joints: Array, j: int, least: float, normal: Array
) -> bool:
    """Return whether a beam's hull lies beyond the face of its own joint in a frame.

    Args:
        hulls: (F, B, R, 3, 3) of the beams.
        f: the frame.
        a: the beam.
        end: its end at the joint.
        joints: (F, J, 8, 3) corners of the joints.
        j: the joint.
        least: mm by which they may overlap.
        normal: (3,) of the face, is set.
    """
    n = outward(hulls, f, a, end)
    normal[0], normal[1], normal[2] = n
    low, high = np.inf, -np.inf
    for r in range(hulls.shape[2]):
        place, reach = row_of(hulls, f, a, r, n)
        low = min(low, place - reach)
    for c in range(8):
        corner = joints[f, j, c, 0], joints[f, j, c, 1], joints[f, j, c, 2]
        high = max(high, dot(n, corner))
    return low - high > -least

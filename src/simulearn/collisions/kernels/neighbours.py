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
def row_of(hull: Array, r: int, n: Any) -> Any:
    """Return where a row of a hull (R, 3, 3) lies along a direction: its centre and reach."""
    row = hull[r]
    return dot(n, row[0]), abs(dot(n, row[1])) + abs(dot(n, row[2]))


@native(entry=False)
def beams_apart(
    first: Array, i: int, second: Array, j: int, joint: Array, least: float, normal: Array
) -> bool:
    """Return whether a plane through the joint of two beams has one on either side.

    Args:
        first: (R, 3, 3) hull of a beam.
        i: its end at the joint.
        second: of the other beam.
        j: its end at the joint.
        joint: (8, 3) corners of the joint.
        least: mm by which they may overlap at the joint.
        normal: (3,) of the plane, is set.
    """
    rows = len(first)
    middle = rows // 2
    up = up_of(joint)
    between = minus(first[middle, 0], second[middle, 0])
    between = plus(between, -dot(between, up), up)
    size = length(between)
    if size < 1e-9:
        return False
    n = (between[0] / size, between[1] / size, between[2] / size)
    normal[0], normal[1], normal[2] = n
    low = low_far = np.inf
    high = high_far = -np.inf
    for r in range(rows):
        place, reach = row_of(first, r if i == 0 else rows - 1 - r, n)
        low = min(low, place - reach)
        if r >= middle:
            low_far = min(low_far, place - reach)
        place, reach = row_of(second, r if j == 0 else rows - 1 - r, n)
        high = max(high, place + reach)
        if r >= middle:
            high_far = max(high_far, place + reach)
    return low - high > -least and low_far - high_far > CLEAR


@native(entry=False)
def joint_apart(beam: Array, end: int, joint: Array, least: float, normal: Array) -> bool:
    """Return whether a beam's hull (R, 3, 3) lies beyond the face of its own joint (8, 3).

    The normal (3,) of the face is set.
    """
    rows = len(beam)
    face = beam[0 if end == 0 else rows - 1]
    n = unit(cross(face[1], face[2]))
    if end == 1:
        n = (-n[0], -n[1], -n[2])
    normal[0], normal[1], normal[2] = n
    low, high = np.inf, -np.inf
    for r in range(rows):
        place, reach = row_of(beam, r, n)
        low = min(low, place - reach)
    for c in range(8):
        high = max(high, dot(n, joint[c]))
    return low - high > -least

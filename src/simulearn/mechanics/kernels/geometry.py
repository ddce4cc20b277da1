"""The flat grid in numbers, and the corners of a grid in any state.

Formulas: `mechanics.topology.flat_geometry` and `mechanics.corners`.
"""

from math import atan2, cos, hypot, pi, sin
from typing import Any, NamedTuple

import numpy as np

from simulearn.mechanics.kernels.elements import ACROSS, PLANE, THICKNESS, UP, quadratic
from simulearn.native import native

Array = Any


class Geometry(NamedTuple):
    """The flat grid in numbers; see `mechanics.topology.FlatGeometry`. Frames are (2, B, 9)."""

    centre: Array
    corners: Array
    area: Array
    face: Array
    frame: Array
    reach: Array
    skew: Array
    length: Array
    middle: Array
    section: Array


@native()
def set_geometry(
    geometry: Any, joints: Array, ends: Array, before: Array, after: Array, parts: Array,
    part: Array, side: Array, width: float, thickness: float,
) -> None:  # fmt: skip
    """Set the flat grid whose axes meet at joints (J, 2), mm; its section is width x thickness."""
    count, beams = len(joints), ends.shape[1]
    angle = np.zeros(2 * beams)
    corner = np.zeros((count, 4, 2))
    for end in range(2):
        for b in range(beams):
            x = joints[ends[1 - end, b], 0] - joints[ends[end, b], 0]
            y = joints[ends[1 - end, b], 1] - joints[ends[end, b], 1]
            far = hypot(x, y)
            angle[end * beams + b] = atan2(y, x)
            frame = geometry.frame[end, b]
            frame[0], frame[1], frame[2] = x / far, -y / far, 0.0
            frame[3], frame[4], frame[5] = y / far, x / far, 0.0
            frame[6], frame[7], frame[8] = 0.0, 0.0, 1.0
            geometry.length[b] = far
    for j in range(count):
        for k in range(4):
            first, second = before[j, k], after[j, k]
            gap = (angle[second] - angle[first]) % (2 * pi)
            if first == second:
                gap = 2 * pi
            gap /= parts[j, k]
            bisector = angle[first] + gap * (part[j, k] + 0.5)
            out = width / 2 / sin(gap / 2)
            corner[j, k, 0], corner[j, k, 1] = out * cos(bisector), out * sin(bisector)
        for m in range(2):
            middle = (corner[j, 0, m] + corner[j, 1, m] + corner[j, 2, m] + corner[j, 3, m]) / 4
            geometry.centre[j, m] = joints[j, m] + middle
            for k in range(4):
                geometry.corners[j, k, m] = geometry.corners[j, 4 + k, m] = corner[j, k, m] - middle
        geometry.centre[j, 2] = 0.0
        for k in range(8):
            geometry.corners[j, k, 2] = -thickness / 2 if k < 4 else thickness / 2
        c = geometry.corners[j]
        geometry.area[j] = (
            abs(
                (c[2, 0] - c[0, 0]) * (c[3, 1] - c[1, 1])
                - (c[2, 1] - c[0, 1]) * (c[3, 0] - c[1, 0])
            )
            / 2
        )
    for b in range(beams):
        for m in range(3):
            geometry.middle[b, m] = 0.0
        for end in range(2):
            j, frame, at = ends[end, b], geometry.frame[end, b], side[end, b]
            right, left = corner[j, at], corner[j, (at + 1) % 4]
            reach = (right[0] + left[0]) / 2 * frame[0] + (right[1] + left[1]) / 2 * frame[3]
            geometry.reach[end, b] = reach
            geometry.skew[end, b] = (left[0] - right[0]) * frame[0] + (left[1] - right[1]) * frame[
                3
            ]
            geometry.length[b] -= reach
            for m in range(2):
                place = joints[j, m] + reach * frame[3 * m]
                geometry.face[end, b, m] = place - geometry.centre[j, m]
                geometry.middle[b, m] += place / 2
            geometry.face[end, b, 2] = 0.0
        x = (geometry.skew[0, b] + geometry.skew[1, b]) / 4  # half the middle section's own skew
        for k in range(4):
            sign = -1.0 if k % 2 == 0 else 1.0
            geometry.section[b, k, 0] = sign * x
            geometry.section[b, k, 1] = sign * width / 2
            geometry.section[b, k, 2] = -thickness / 2 if k < 2 else thickness / 2


@native()
def set_corners(
    geometry: Any, section: Array, ends: Array, fixed: int, side: Array, released: Array,
    warping: Array, R: Array, p: Array, begin: int, joints: Array, sections: Array,
) -> None:  # fmt: skip
    """Set the corners of joints and sections in space.

    Args:
        geometry: the flat grid.
        section: (B + 1, coefficients) of the beams, and of joints.
        ends: (2, B) joint of each half.
        fixed: the fixed joint, whose lower half stays.
        side: (2, B) side of its joint that each half leaves.
        released: (F,) fraction.
        warping: (F, 2, B, 24) of the corners at the joint, then at the middle, in the half's axes.
        R: (F, J + B, 9) rotations of joints and middles.
        p: (F, J + B, 3) mm, their places.
        begin: the first frame that counts.
        joints: (F, J, 8, 3) mm, to set.
        sections: (F, B, 3, 4, 3) mm, to set.
    """
    count, beams = len(geometry.area), ends.shape[1]
    local, touched = np.zeros((count, 8, 3)), np.zeros((count, 8))
    for f in range(begin, len(released)):
        s = released[f]
        joint = section[beams]
        plane, thick = 1 + quadratic(joint, PLANE, s), 1 + quadratic(joint, THICKNESS, s)
        for j in range(count):
            for k in range(8):
                touched[j, k] = 0.0
                for m in range(3):
                    local[j, k, m] = 0.0
        for end in range(2):
            for b in range(beams):
                j, frame, own = ends[end, b], geometry.frame[end, b], warping[f, end, b]
                for k in range(4):
                    at = (side[end, b] + k % 2) % 4 + 4 * (k // 2)
                    touched[j, at] += 1.0
                    for m in range(3):
                        for i in range(3):
                            local[j, at, m] += frame[3 * m + i] * own[3 * k + i]
        for j in range(count):
            for k in range(8):
                for m in range(3):
                    grown = geometry.corners[j, k, m] * (thick if m == 2 else plane)
                    local[j, k, m] = grown + local[j, k, m] / max(touched[j, k], 1.0)
                for m in range(3):
                    joints[f, j, k, m] = p[f, j, m] + (
                        R[f, j, 3 * m] * local[j, k, 0]
                        + R[f, j, 3 * m + 1] * local[j, k, 1]
                        + R[f, j, 3 * m + 2] * local[j, k, 2]
                    )
                    if j == fixed and k < 4:
                        joints[f, j, k, m] = geometry.centre[j, m] + geometry.corners[j, k, m]
        for b in range(beams):
            across, up = 1 + quadratic(section[b], ACROSS, s), 1 + quadratic(section[b], UP, s)
            for k in range(4):
                for m in range(3):
                    for end in range(2):
                        corner = k if end == 0 else (k ^ 1)
                        at = (side[end, b] + corner % 2) % 4 + 4 * (corner // 2)
                        sections[f, b, 2 * end, k, m] = joints[f, ends[end, b], at, m]
                x = geometry.section[b, k, 0]
                y, z = geometry.section[b, k, 1] * across, geometry.section[b, k, 2] * up
                one, two = warping[f, 0, b], warping[f, 1, b]
                here, there = 12 + 3 * k, 12 + 3 * (k ^ 1)
                x += (one[here] - two[there]) / 2
                y += (one[here + 1] - two[there + 1]) / 2
                z += (one[here + 2] + two[there + 2]) / 2
                i = count + b
                for m in range(3):
                    sections[f, b, 1, k, m] = p[f, i, m] + (
                        R[f, i, 3 * m] * x + R[f, i, 3 * m + 1] * y + R[f, i, 3 * m + 2] * z
                    )

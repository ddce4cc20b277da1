"""The frames of a grid by beam mechanics, each from the ones before: the entry from Python."""

from math import sqrt
from typing import Any, NamedTuple

import numpy as np

from simulearn.mechanics.kernels.assembly import Weights
from simulearn.mechanics.kernels.elements import PLANE, quadratic, set_half_beams
from simulearn.mechanics.kernels.equilibrium import make_space, solve
from simulearn.mechanics.kernels.rotations import (
    inverse_left,
    matrix_product,
    matrix_product_t,
    rotation_vector,
)
from simulearn.native import native

Array = Any

# What is record of each frame.
MOTION, NEGATIVE, WIDEST, FACTORS, STEPS, ASTRAY, MOVED, INFO = range(8)


class Frames(NamedTuple):
    """What acts in each frame.

    Attributes:
        released: (F,) fraction; the first frame is where the path begins.
        gravity: (F,) multiples of gravity.
        order: (F,) of the polynomial that continues the path: 0, 1 or 2.
        corrections: (F, 2, B, 12) twist of the rest, logarithm of factors on the stiffness.
        corrected: whether there are corrections.
    """

    released: Array
    gravity: Array
    order: Array
    corrections: Array
    corrected: bool


@native(entry=False)
def set_weights(
    weights: Any, layout: Any, geometry: Any, section: Array, load: Array, s: float, gravity: float
) -> None:
    """Set what bodies carry: load is (body force N/mm3, section mm2, thickness mm)."""
    body, area, thick = load[0] * gravity, load[1], load[2]
    for j in range(len(geometry.area)):
        weights.joint[j] = body * thick * geometry.area[j]
        weights.joint_volume[j] = thick * geometry.area[j]
        for k in range(3):
            weights.lever[j, k] = 0.0
    plane = 1 + quadratic(section[len(geometry.length)], PLANE, s)
    for b in range(len(geometry.length)):
        half = geometry.length[b] / 2
        line = body * area
        weights.middle[b] = half * line
        weights.middle_volume[b] = half * area
        share, couple = half * line / 2, half * half * line / 12
        for end in range(2):
            j = layout.ends[end, b]
            weights.joint[j] += share
            weights.joint_volume[j] += half * area / 2
            for k in range(3):
                weights.lever[j, k] += (
                    share * plane * geometry.face[end, b, k]
                    + couple * geometry.frame[end, b, 3 * k]
                )


@native(entry=False)
def continue_path(R: Array, p: Array, k: int, order: int, new_R: Array, new_p: Array) -> None:
    """Set the poses that would follow those of frames before k, by a polynomial of their motion."""
    a, b, c, d = np.empty(9), np.empty(9), np.empty(9), np.empty(9)
    for i in range(p.shape[1]):
        if order == 0:
            for m in range(9):
                new_R[i, m] = R[k - 1, i, m]
            for m in range(3):
                new_p[i, m] = p[k - 1, i, m]
            continue
        # last = R2^T R3; new = R3 last, or R3 last last before^T
        _turn(R[k - 2, i], R[k - 1, i], a)
        matrix_product(R[k - 1, i], a, b)
        if order == 1:
            for m in range(9):
                new_R[i, m] = b[m]
            for m in range(3):
                new_p[i, m] = 2 * p[k - 1, i, m] - p[k - 2, i, m]
        else:
            _turn(R[k - 3, i], R[k - 2, i], c)
            matrix_product(b, a, d)
            matrix_product_t(d, c, new_R[i])
            for m in range(3):
                new_p[i, m] = 3 * p[k - 1, i, m] - 3 * p[k - 2, i, m] + p[k - 3, i, m]


@native(entry=False)
def _turn(a: Array, b: Array, c: Array) -> None:
    """Set c = a^T b."""
    for i in range(3):
        for j in range(3):
            c[3 * i + j] = a[i] * b[j] + a[3 + i] * b[3 + j] + a[6 + i] * b[6 + j]


@native(entry=False)
def follow_guide(
    R: Array, p: Array, guide_R: Array, guide_p: Array, k: int, new_R: Array, new_p: Array
) -> None:
    """Set the poses of a guide in frame k, moved on as the two frames before let expect."""
    last, before, a, b = np.empty(9), np.empty(9), np.empty(9), np.empty(9)
    for i in range(p.shape[1]):
        matrix_product_t(R[k - 1, i], guide_R[k - 1, i], last)
        matrix_product(last, guide_R[k, i], a)
        older = max(k - 2, 0)
        matrix_product_t(R[older, i], guide_R[older, i], before)
        _turn(before, a, b)
        matrix_product(last, b, new_R[i])
        for m in range(3):
            new_p[i, m] = (
                guide_p[k, i, m]
                + 2 * (p[k - 1, i, m] - guide_p[k - 1, i, m])
                - (p[older, i, m] - guide_p[older, i, m])
            )


@native(entry=False)
def orthogonal(R: Array) -> None:
    """Take what rounding has left off rotations (N, 9): one step of Newton's polar iteration."""
    a, b = np.empty(9), np.empty(9)
    for i in range(len(R)):
        _turn(R[i], R[i], a)
        for k in range(9):
            a[k] = (3.0 if k % 4 == 0 else 0.0) - a[k]
        matrix_product(R[i], a, b)
        for k in range(9):
            R[i, k] = b[k] / 2


@native(entry=False)
def furthest(a: Array, b: Array) -> float:
    """Return the largest distance between points (N, 3), mm."""
    most = 0.0
    for i in range(len(a)):
        square = 0.0
        for k in range(3):
            square += (a[i, k] - b[i, k]) ** 2
        if not square <= most:
            most = square
    return sqrt(most)


@native()
def follow(
    layout: Any, geometry: Any, section: Array, load: Array, ratio: Array, frames: Any,
    guide_R: Array, guide_p: Array, guided: Array, begin: int, begun_near: bool, descend: bool,
    shove: float,
    tolerance: Array, most: int, far: Array, R: Array, p: Array, info: Array, twists: Array,
) -> int:  # fmt: skip
    """Find the states of frames, each from the ones before, up to one that is not plain.

    Args:
        layout: topology.
        geometry: the flat grid.
        section: (B + 1, coefficients) of the beams, and of joints.
        load: body force N/mm3, section mm2, thickness mm.
        ratio: (B,) signed actuator ratios.
        frames: what acts in each.
        guide_R: (F, N, 9) rotations near which those are expected.
        guide_p: (F, N, 3) mm, the same of places.
        guided: (F,) whether they are given for a frame and the two before.
        begin: first frame to find.
        begun_near: whether the frame before is near the first.
        descend: whether to descend from the frame before.
        shove: how far to go along the softest mode first, mm.
        tolerance: (F,) of the last motion, mm.
        most: factorisations in a frame.
        far: (F,) distance from where a frame is expected that is not plain, mm.
        R: (F, N, 9) rotations of joints and middles: frame 0 is given.
        p: (F, N, 3) mm, their places.
        info: (F, INFO) to set.
        twists: (F, 2, B, 6) to set: how far halves are from the section model's rest.

    Returns:
        The first frame that is not plain (without equilibrium, unstable, or far from where it was
        expected), or how many frames there are.
    """
    joints, beams = len(layout.place), len(ratio)
    space = make_space(joints, beams, len(layout.columns) - 1, layout.blocks, layout.deepest)
    weights = Weights(
        np.zeros(joints), np.zeros((joints, 3)), np.zeros(beams), np.zeros(joints), np.zeros(beams)
    )
    expected = np.empty((joints + beams, 3))
    for k in range(begin, len(frames.released)):
        s = frames.released[k]
        set_half_beams(
            space.half_beams, space.rest, section, layout.ends, layout.fixed, geometry.length,
            ratio, geometry.face, geometry.frame, geometry.reach, s, frames.corrections[k],
            frames.corrected,
        )  # fmt: skip
        set_weights(weights, layout, geometry, section, load, s, frames.gravity[k])
        if guided[k]:
            follow_guide(R, p, guide_R, guide_p, k, R[k], p[k])
        else:
            continue_path(R, p, k, frames.order[k], R[k], p[k])
        orthogonal(R[k])
        for i in range(joints + beams):  # the fixed joint stays
            for m in range(3):
                expected[i, m] = p[k, i, m]
        record = info[k]
        near = guided[k] or frames.order[k] > 0 or begun_near
        motion, negative, widest, count, cheap = solve(
            layout, weights, space, R[k], p[k], tolerance[k], most, near, descend, shove,
            k == len(frames.released) - 1,
        )  # fmt: skip
        record[MOTION], record[NEGATIVE], record[WIDEST] = motion, negative, widest
        record[FACTORS], record[STEPS] = count, cheap
        record[ASTRAY] = furthest(p[k], expected)
        record[MOVED] = furthest(p[k], p[k - 1])
        if frames.corrected:  # twists are from the rest that the section model has
            set_half_beams(
                space.half_beams, space.rest, section, layout.ends, layout.fixed,
                geometry.length, ratio, geometry.face, geometry.frame, geometry.reach, s,
                frames.corrections[k], k < 0,
            )  # fmt: skip
        half_twists(layout, space.rest, geometry, section, s, R[k], p[k], twists[k])
        plain = motion <= tolerance[k] and negative == 0
        if not plain or not record[ASTRAY] <= far[k]:
            return k
    return len(frames.released)


@native(entry=False)
def half_twists(
    layout: Any,
    rest: Array,
    geometry: Any,
    section: Array,
    s: float,
    R: Array,
    p: Array,
    twists: Array,
) -> None:
    """Set how far the halves' middles have left their places at rest: (2, B, 6)."""
    joints = len(layout.place)
    plane = 1 + quadratic(section[layout.ends.shape[1]], PLANE, s)
    face, home, relative, middle = np.empty(9), np.empty(9), np.empty(9), np.empty(9)
    for end in range(2):
        for b in range(layout.ends.shape[1]):
            j, m = layout.ends[end, b], joints + b
            pose, at = rest[end, b], geometry.face[end, b]
            matrix_product(R[j], geometry.frame[end, b], face)
            matrix_product(face, pose, home)
            for i in range(9):
                middle[i] = R[m, i] if end == 0 or i % 3 == 2 else -R[m, i]
            _turn(home, middle, relative)
            d0 = d1 = d2 = 0.0
            for i in range(3):
                place = p[m, i] - p[j, i]
                for n in range(3):
                    place -= plane * R[j, 3 * i + n] * at[n] + face[3 * i + n] * pose[9 + n]
                d0 += home[3 * i] * place
                d1 += home[3 * i + 1] * place
                d2 += home[3 * i + 2] * place
            a, c, e, square = rotation_vector(
                relative[0], relative[1], relative[2], relative[3], relative[4], relative[5],
                relative[6], relative[7], relative[8],
            )  # fmt: skip
            k, _, _ = inverse_left(square)
            x, y, z = c * d2 - e * d1, e * d0 - a * d2, a * d1 - c * d0
            twist = twists[end, b]
            twist[0] = d0 - x / 2 + k * (c * z - e * y)
            twist[1] = d1 - y / 2 + k * (e * x - a * z)
            twist[2] = d2 - z / 2 + k * (a * y - c * x)
            twist[3], twist[4], twist[5] = a, c, e

"""Wrenches and stiffness of a grid: half-beams gathered, middles eliminated, joints assembled.

Motions and wrenches are about the origin, in the axes of space, as in `mechanics.forces`.
"""

from typing import Any, NamedTuple

import numpy as np

from simulearn.mechanics.kernels.halves import (
    AT_MIDDLE,
    FIRST,
    SAA,
    SAB,
    SBB,
    SECOND,
    WRENCH,
    clear,
    energy,
    gather,
    pull,
    stiffen,
    twist,
)
from simulearn.mechanics.kernels.lanes import (
    A1,
    A2,
    A4,
    A5,
    A6,
    A7,
    A8,
    LANES,
    WIDE,
    add,
    add_applied,
    add_applied_t,
    add_cross,
    add_product,
    add_product_t,
    inverse,
    negatives,
    transposed,
)
from simulearn.native import native

Array = Any

# Rows of the workspace beyond those of `halves`.
MAA, MAB, MBB, INVERSE, CARRIED, OUT, TURNED, TURNING = np.arange(28, 36)
PAB, PBA, PBB = np.arange(36, 42, 2)  # of both ends; PAA is SAA
BLOCK, ROWS = np.arange(42, 44)
# Rows that each chunk of sixteen beams keeps for steps with the same factors.
FOLLOW, SOFT, FORCE, MOTION, KEPT = np.array([0, 8, 11, 12, 14])  # FOLLOW: aa, ab, ba, bb

NONE, GAUSS_NEWTON, EXACT = np.arange(3)  # which stiffness


class Layout(NamedTuple):
    """The topology of a grid, in the order in which its joints are eliminated.

    Attributes:
        ends: (2, B) joint of each half.
        fixed: the fixed joint.
        place: (J,) place of each joint in that order, -1 for the fixed one.
        columns, rows, targets: see `joints.factorise`.
        slot: (B,) block that couples the ends of each beam, -1 where one is fixed.
        blocks: how many blocks there are.
        deepest: most blocks below a diagonal.
    """

    ends: Array
    fixed: int
    place: Array
    columns: Array
    rows: Array
    targets: Array
    slot: Array
    blocks: int
    deepest: int


class Weights(NamedTuple):
    """What bodies carry at one multiple of gravity.

    Attributes:
        joint: (J,) N.
        lever: (J, 3) first moment of it in the joint's axes, N mm.
        middle: (B,) N.
        joint_volume, middle_volume: (J,), (B,) mm3, for damped steps.
    """

    joint: Array
    lever: Array
    middle: Array
    joint_volume: Array
    middle_volume: Array


GYRATION = 25.0  # mm2, of what turns with a body


@native(entry=False)
def evaluate(
    layout: Layout, weights: Weights, half_beams: Array, w: Array, kept: Array, R: Array, p: Array,
    force: Array, blocks: Array, stiffness: int, damping: float,
) -> Any:  # fmt: skip
    """Find the wrenches out of balance in a state; with a stiffness, also assemble that.

    Args:
        layout: topology.
        weights: loads.
        half_beams: (chunks, 2, HALF_BEAM, WIDE) elements.
        w: (ROWS, WIDE) workspace.
        kept: (chunks, KEPT, WIDE) what steps need.
        R: (J + B, 9) rotations of joints, then middles.
        p: (J + B, 3) mm, their places.
        force: (J, 6) to set: on joints.
        blocks: (blocks, 36) to set: stiffness of the free joints.
        stiffness: which.
        damping: resistance to motion, N/(mm mm3), added to the stiffness.

    Returns:
        Energy, largest square of an angle of a half, negative pivots of the middles.
    """
    ends, place = layout.ends, layout.place
    joints, beams = len(place), ends.shape[1]
    total, widest, negative = 0.0, 0.0, 0
    for j in range(joints):
        for k in range(6):
            force[j, k] = 0.0
    if stiffness != NONE:
        for i in range(len(blocks)):
            for k in range(36):
                blocks[i, k] = 0.0
    for chunk in range(len(half_beams)):
        first = chunk * LANES
        lanes = min(LANES, beams - first)
        own, keep = half_beams[chunk], kept[chunk]
        for end in range(2):
            gather(w, R, p, ends[end], first, end, joints)
            widest = max(widest, twist(w, own[end], FIRST, lanes))
            pull(w, own[end], FIRST, end)
            total += energy(w, lanes)
            if stiffness != NONE:
                stiffen(w, own[end], FIRST, end, stiffness == EXACT)
        out = keep[FORCE]
        for n in range(6 * LANES):
            out[n] = w[WRENCH, n] + w[WRENCH + 1, n]
        for n in range(lanes):
            weight = weights.middle[first + n]
            total += weight * w[AT_MIDDLE, A2 + n]
            out[A2 + n] += weight
            out[LANES * 3 + n] += weight * w[AT_MIDDLE, A1 + n]
            out[A4 + n] -= weight * w[AT_MIDDLE, n]
            for end in range(2):
                row = force[ends[end, first + n]]
                for k in range(6):
                    row[k] -= w[WRENCH + end, LANES * k + n]
        if stiffness != NONE:
            negative += eliminate(
                layout, weights, w, keep, blocks, first, lanes, stiffness == EXACT, damping
            )
    for j in range(joints):
        x = p[j]
        r, lever, weight = R[j], weights.lever[j], weights.joint[j]
        l0 = weight * x[0] + r[0] * lever[0] + r[1] * lever[1] + r[2] * lever[2]
        l1 = weight * x[1] + r[3] * lever[0] + r[4] * lever[1] + r[5] * lever[2]
        l2 = weight * x[2] + r[6] * lever[0] + r[7] * lever[1] + r[8] * lever[2]
        total += l2
        force[j, 2] += weight
        force[j, 3] += l1
        force[j, 4] -= l0
        i = place[j]
        if stiffness != NONE and i >= 0:
            block = blocks[i]
            if stiffness == EXACT:
                block[1 * 6 + 3] += weight / 2
                block[0 * 6 + 4] -= weight / 2
                block[3 * 6 + 1] += weight / 2
                block[4 * 6 + 0] -= weight / 2
                block[3 * 6 + 3] -= l2
                block[4 * 6 + 4] -= l2
                block[3 * 6 + 5] += l0 / 2
                block[5 * 6 + 3] += l0 / 2
                block[4 * 6 + 5] += l1 / 2
                block[5 * 6 + 4] += l1 / 2
            if damping > 0.0:
                add_mass(block, x, damping * weights.joint_volume[j])
    return total, widest, negative


@native(entry=False)
def add_mass(block: Array, x: Array, mass: float) -> None:
    """Add the resistance of a body at x to motions about the origin."""
    a, b, c = mass * x[0], mass * x[1], mass * x[2]
    for k in range(3):
        block[7 * k] += mass
    block[0 * 6 + 4] += c
    block[0 * 6 + 5] -= b
    block[1 * 6 + 3] -= c
    block[1 * 6 + 5] += a
    block[2 * 6 + 3] += b
    block[2 * 6 + 4] -= a
    block[4 * 6 + 0] += c
    block[5 * 6 + 0] -= b
    block[3 * 6 + 1] -= c
    block[5 * 6 + 1] += a
    block[3 * 6 + 2] += b
    block[4 * 6 + 2] -= a
    square = x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + GYRATION
    for i in range(3):
        for j in range(3):
            block[6 * (3 + i) + 3 + j] -= mass * x[i] * x[j]
        block[7 * (3 + i)] += mass * square


@native(entry=False)
def eliminate(
    layout: Layout, weights: Weights, w: Array, keep: Array, blocks: Array, first: int,
    lanes: int, exact: bool, damping: float,
) -> int:  # fmt: skip
    """Eliminate the middles of sixteen beams; return how many of their pivots are negative."""
    at = w[AT_MIDDLE]
    for k in range(3):
        row, x, y = w[MAA + k], w[SAA + 2 * k], w[SAA + 2 * k + 1]
        for n in range(WIDE):
            row[n] = x[n] + y[n]
    if exact or damping > 0.0:
        ab, bb, aa = w[MAB], w[MBB], w[MAA]
        for n in range(LANES):
            beam = min(first + n, layout.ends.shape[1] - 1)
            weight = weights.middle[beam] if exact else 0.0
            x, y, z = at[n], at[A1 + n], at[A2 + n]
            ab[A1 * 3 + n] += weight / 2
            ab[A1 + n] -= weight / 2
            bb[n] -= weight * z
            bb[A4 + n] -= weight * z
            bb[A2 + n] += weight * x / 2
            bb[A6 + n] += weight * x / 2
            bb[A5 + n] += weight * y / 2
            bb[A7 + n] += weight * y / 2
            mass = damping * weights.middle_volume[beam]
            square = x * x + y * y + z * z + GYRATION
            aa[n] += mass
            aa[A4 + n] += mass
            aa[A8 + n] += mass
            ab[A1 + n] += mass * z
            ab[A2 + n] -= mass * y
            ab[A1 * 3 + n] -= mass * z
            ab[A5 + n] += mass * x
            ab[A6 + n] += mass * y
            ab[A7 + n] -= mass * x
            bb[n] += mass * (square - x * x)
            bb[A4 + n] += mass * (square - y * y)
            bb[A8 + n] += mass * (square - z * z)
            bb[A1 + n] -= mass * x * y
            bb[A1 * 3 + n] -= mass * x * y
            bb[A2 + n] -= mass * x * z
            bb[A6 + n] -= mass * x * z
            bb[A5 + n] -= mass * y * z
            bb[A7 + n] -= mass * y * z
    # The inverse of the middles' stiffness, by blocks of three.
    negative = negatives(w, MAA, lanes)
    inverse(w, MAA, w, INVERSE)
    clear(w, CARRIED)
    add_product(w, INVERSE, w, MAB, 1.0, w, CARRIED)
    add_product_t(w, MAB, w, CARRIED, -1.0, w, MBB)
    negative += negatives(w, MBB, lanes)
    inverse(w, MBB, keep, SOFT + 2)
    clear(keep, SOFT + 1)
    add_product(w, CARRIED, keep, SOFT + 2, -1.0, keep, SOFT + 1)
    transposed(w, CARRIED, w, OUT)
    x, y = w[INVERSE], keep[SOFT]
    for n in range(WIDE):
        y[n] = x[n]
    add_product(keep, SOFT + 1, w, OUT, -1.0, keep, SOFT)
    for end in range(2):
        # P: the stiffness and half of how wrenches turn.
        aa, ab, ba, bb = SAA + end, PAB + end, PBA + end, PBB + end
        clear(w, TURNED)
        clear(w, TURNING)
        if exact:
            add_cross(w, WRENCH + end, FIRST, 0.5, w, TURNED)
            add_cross(w, WRENCH + end, SECOND, 0.5, w, TURNING)
        transposed(w, SAB + end, w, ba)
        add(w, TURNED, 1.0, w, ba)
        x, y, z = w[SAB + end], w[TURNED], w[ab]
        for n in range(WIDE):
            z[n] = x[n] + y[n]
        x, y, z = w[SBB + end], w[TURNING], w[bb]
        for n in range(WIDE):
            z[n] = x[n] + y[n]
        f = FOLLOW + 4 * end
        for k in range(4):
            clear(keep, f + k)
        add_product(keep, SOFT, w, aa, 1.0, keep, f)
        add_product(keep, SOFT + 1, w, ba, 1.0, keep, f)
        add_product(keep, SOFT, w, ab, 1.0, keep, f + 1)
        add_product(keep, SOFT + 1, w, bb, 1.0, keep, f + 1)
        add_product_t(keep, SOFT + 1, w, aa, 1.0, keep, f + 2)
        add_product(keep, SOFT + 2, w, ba, 1.0, keep, f + 2)
        add_product_t(keep, SOFT + 1, w, ab, 1.0, keep, f + 3)
        add_product(keep, SOFT + 2, w, bb, 1.0, keep, f + 3)
    for end in range(2):
        f, aa, ab, ba, bb = FOLLOW + 4 * end, SAA + end, PAB + end, PBA + end, PBB + end
        # What joints feel of their own motion: S - P^T follow.
        x = w[BLOCK]
        for block in range(3):
            y = w[(SAA if block == 0 else (SAB if block == 1 else SBB)) + end]
            for n in range(WIDE):
                x[n] = y[n]
            if block == 0:
                add_product_t(w, aa, keep, f, -1.0, w, BLOCK)
                add_product_t(w, ba, keep, f + 2, -1.0, w, BLOCK)
            elif block == 1:
                add_product_t(w, aa, keep, f + 1, -1.0, w, BLOCK)
                add_product_t(w, ba, keep, f + 3, -1.0, w, BLOCK)
            else:
                add_product_t(w, ab, keep, f + 1, -1.0, w, BLOCK)
                add_product_t(w, bb, keep, f + 3, -1.0, w, BLOCK)
            top, left = (3 if block == 2 else 0), (0 if block == 0 else 3)
            for n in range(lanes):
                i = layout.place[layout.ends[end, first + n]]
                if i >= 0:
                    target = blocks[i]
                    for r in range(3):
                        for c in range(3):
                            value = x[LANES * (3 * r + c) + n]
                            target[6 * (top + r) + left + c] += value
                            if block == 1:
                                target[6 * (left + c) + top + r] += value
    # And of each other's: -P0^T follow1.
    for block in range(4):
        top, left = block // 2, block % 2
        clear(w, BLOCK)
        add_product_t(w, SAA if top == 0 else PAB, keep, FOLLOW + 4 + left, -1.0, w, BLOCK)
        add_product_t(w, PBA if top == 0 else PBB, keep, FOLLOW + 6 + left, -1.0, w, BLOCK)
        x = w[BLOCK]
        for n in range(lanes):
            slot = layout.slot[first + n]
            if slot >= 0:
                target = blocks[slot]
                a = layout.place[layout.ends[0, first + n]]
                below = a > layout.place[layout.ends[1, first + n]]
                for r in range(3):
                    for c in range(3):
                        value = x[LANES * (3 * r + c) + n]
                        if below:
                            target[6 * (3 * top + r) + 3 * left + c] += value
                        else:
                            target[6 * (3 * left + c) + 3 * top + r] += value
    return negative


@native(entry=False)
def condense(layout: Layout, kept: Array, force: Array, right: Array) -> None:
    """Set the right side (n, 6) of the free joints, minus what is out of balance there."""
    ends, place = layout.ends, layout.place
    for j in range(len(place)):
        if place[j] >= 0:
            for k in range(6):
                right[place[j], k] = -force[j, k]
    for chunk in range(len(kept)):
        first, keep = chunk * LANES, kept[chunk]
        lanes = min(LANES, ends.shape[1] - first)
        for end in range(2):
            f, row = FOLLOW + 4 * end, MOTION + 1
            clear(keep, row)
            add_applied_t(keep, f, keep, FORCE, FIRST, -1.0, keep, row, FIRST)
            add_applied_t(keep, f + 2, keep, FORCE, SECOND, -1.0, keep, row, FIRST)
            add_applied_t(keep, f + 1, keep, FORCE, FIRST, -1.0, keep, row, SECOND)
            add_applied_t(keep, f + 3, keep, FORCE, SECOND, -1.0, keep, row, SECOND)
            taken = keep[row]
            for n in range(lanes):
                i = place[ends[end, first + n]]
                if i >= 0:
                    for k in range(6):
                        right[i, k] += taken[LANES * k + n]


@native(entry=False)
def expand(layout: Layout, kept: Array, right: Array, motion: Array, loaded: float) -> None:
    """Set the motions (J + B, 6) of joints and middles, given those of free joints (n, 6).

    Args:
        layout: topology.
        kept: of the factors.
        right: (n, 6).
        motion: to set.
        loaded: 1 to add what middles move between held joints, else 0.
    """
    ends, place = layout.ends, layout.place
    joints = len(place)
    for j in range(joints):
        for k in range(6):
            motion[j, k] = right[place[j], k] if place[j] >= 0 else 0.0
    for chunk in range(len(kept)):
        first, keep = chunk * LANES, kept[chunk]
        beams = ends.shape[1]
        lanes = min(LANES, beams - first)
        clear(keep, MOTION)
        add_applied(keep, SOFT, keep, FORCE, FIRST, -loaded, keep, MOTION, FIRST)
        add_applied(keep, SOFT + 1, keep, FORCE, SECOND, -loaded, keep, MOTION, FIRST)
        add_applied_t(keep, SOFT + 1, keep, FORCE, FIRST, -loaded, keep, MOTION, SECOND)
        add_applied(keep, SOFT + 2, keep, FORCE, SECOND, -loaded, keep, MOTION, SECOND)
        for end in range(2):
            f, row = FOLLOW + 4 * end, MOTION + 1
            x = keep[row]
            for n in range(LANES):
                joint = ends[end, min(first + n, beams - 1)]
                for k in range(6):
                    x[LANES * k + n] = motion[joint, k]
            add_applied(keep, f, keep, row, FIRST, 1.0, keep, MOTION, FIRST)
            add_applied(keep, f + 1, keep, row, SECOND, 1.0, keep, MOTION, FIRST)
            add_applied(keep, f + 2, keep, row, FIRST, 1.0, keep, MOTION, SECOND)
            add_applied(keep, f + 3, keep, row, SECOND, 1.0, keep, MOTION, SECOND)
        x = keep[MOTION]
        for n in range(lanes):
            for k in range(6):
                motion[joints + first + n, k] = x[LANES * k + n]

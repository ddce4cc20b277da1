"""Equilibrium by Newton's method, and the descent to a stable one by damped steps.

Far from equilibrium steps are Gauss-Newton's, which go downhill; near it the stiffness is exact.
Old factors are used again where they do. All is one kernel with one place where wrenches are
reached: what a kernel calls is compiled into it, so that several would cost several times as much.
"""

from math import inf, isfinite
from typing import Any, NamedTuple

import numpy as np

from simulearn.mechanics.kernels.assembly import (
    EXACT,
    FORCE,
    GAUSS_NEWTON,
    KEPT,
    NONE,
    ROWS,
    condense,
    evaluate,
    expand,
)
from simulearn.mechanics.kernels.halves import HALF_BEAM
from simulearn.mechanics.kernels.joints import factorise, substitute
from simulearn.mechanics.kernels.lanes import LANES, WIDE
from simulearn.mechanics.kernels.rotations import copy, move
from simulearn.native import native

Array = Any

LONGEST = 15.0  # mm, that anything may move in one step
NEAR = 3.0  # mm, the motion below which the stiffness is exact
CLOSE = 1.0  # mm, the motion below which old factors are tried
AGAIN = 6  # steps with the same factors, at most
FREE = 8  # steps that may lead uphill: bending at first stretches
SLOW = 0.3  # of the step before; where a step is longer, new factors are needed
SADDLE = 0.1  # mm, the motion below which an unstable equilibrium is accepted as one
STALE = 0.3  # mm, the motion after which factors do not show whether a state is stable

DAMPING = 1e-3  # N/(mm mm3), at first in a descent
GENTLE = 1e-12  # N/(mm mm3), below which steps are not damped any more
HALTED = 1e3  # N/(mm mm3), beyond which a descent has failed
LEAST = 1e-11  # N/(mm mm3), the first that is tried to make a stiffness positive
SOFTEST = 12  # inverse iterations for the softest mode

# What is done next with the wrenches of a state.
STEP, AGAIN_STEP, SHORTEN, PUSH, FALL, WEIGH, JUDGE = range(7)


class Space(NamedTuple):
    """Workspace of one design; arrays by their use in `assembly.evaluate` and `joints`."""

    w: Array
    kept: Array
    half_beams: Array
    rest: Array
    force: Array
    blocks: Array
    scratch: Array
    right: Array
    motion: Array
    start_rotations: Array
    start_places: Array


@native(entry=False)
def make_space(joints: int, beams: int, free: int, blocks: int, deepest: int) -> Any:
    """Return the workspace of a grid."""
    chunks = (beams + LANES - 1) // LANES
    return Space(
        np.zeros((ROWS, WIDE)),
        np.zeros((chunks, KEPT, WIDE)),
        np.zeros((chunks, 2, HALF_BEAM, WIDE)),
        np.zeros((2, beams, 12)),
        np.zeros((joints, 6)),
        np.zeros((blocks, 36)),
        np.zeros((max(deepest, 1), 36)),
        np.zeros((free, 6)),
        np.zeros((joints + beams, 6)),
        np.zeros((joints + beams, 9)),
        np.zeros((joints + beams, 3)),
    )


@native(entry=False)
def longest(p: Array, motion: Array) -> float:
    """Return how far motions about the origin lead, to first order, along an axis at most, mm."""
    most = 0.0
    for i in range(len(p)):
        x, m = p[i], motion[i]
        a = abs(m[0] + m[4] * x[2] - m[5] * x[1])
        b = abs(m[1] + m[5] * x[0] - m[3] * x[2])
        c = abs(m[2] + m[3] * x[1] - m[4] * x[0])
        far = max(a, max(b, c))
        if not far <= most:  # also where it is not a number
            most = far
    return most


@native(entry=False)
def power(layout: Any, space: Any) -> float:
    """Return how the energy changes along the motion, to first order."""
    total, joints = 0.0, len(layout.place)
    for j in range(joints):
        if layout.place[j] >= 0:
            for k in range(6):
                total += space.force[j, k] * space.motion[j, k]
    for b in range(layout.ends.shape[1]):
        for k in range(6):
            x = space.kept[b // LANES, FORCE, LANES * k + b % LANES]
            total += x * space.motion[joints + b, k]
    return total


@native(entry=False)
def upwards(joints: int, p: Array, motion: Array) -> float:
    """Return 1 where the joint that moves most moves up (level: along +x, else +y), or -1."""
    sign, most = 1.0, 0.0
    for j in range(joints):
        x, m = p[j], motion[j]
        for k in range(3):
            if k == 0:
                moves = m[2] + m[3] * x[1] - m[4] * x[0]
            elif k == 1:
                moves = m[0] + m[4] * x[2] - m[5] * x[1]
            else:
                moves = m[1] + m[5] * x[0] - m[3] * x[2]
            if abs(moves) > 1.001 * most:
                most, sign = abs(moves), (1.0 if moves > 0 else -1.0)
    return sign


@native(entry=False)
def solve(
    layout: Any, weights: Any, space: Any, R: Array, p: Array, tolerance: float, most: int,
    near: bool, descend: bool, shove: float, judge: bool,
) -> Any:  # fmt: skip
    """Find an equilibrium, in place.

    A descent follows the energy down to a stable one, as in a viscous bath. Its steps are those
    of backward Euler for the flow with resistance c: (K + c M) du = -g. A step is taken where
    K + c M is positive and the energy falls; c falls as steps succeed.

    Args:
        layout: topology.
        weights: loads.
        space: workspace, its elements set.
        R: rotations.
        p: places, mm.
        tolerance: of the last motion, mm.
        most: factorisations at most.
        near: whether the poses are near equilibrium.
        descend: whether to descend.
        shove: how far to go along the softest mode first, mm.
        judge: whether to find the stability at the end whatever the factors are.

    Returns:
        The last motion (mm, infinite where there is none), the negative pivots there, the
        largest square of an angle of a half, how many factorisations and other steps were made.
    """
    joints = len(layout.place)
    before = NEAR / 2 if near else inf
    negative, since, widest, count, cheap, failed, again = 0, inf, 0.0, 0, 0, 0, 0
    damping, energy, share, slope = LEAST if shove > 0.0 else DAMPING, inf, 1.0, 0.0
    blocked = 0.0  # resistance that was not enough, of late
    descending, downhill, known = descend, False, False
    doing = PUSH if shove > 0.0 else (FALL if descend else STEP)
    while True:
        exact = doing in (PUSH, FALL, JUDGE) or before < NEAR
        stiffness = EXACT if exact and not downhill else GAUSS_NEWTON
        if doing in (AGAIN_STEP, SHORTEN, WEIGH):
            stiffness = NONE
        c = damping if doing == PUSH or (doing == FALL and damping > GENTLE) else 0.0
        total, widest, pivots = evaluate(
            layout, weights, space.half_beams, space.w, space.kept, R, p, space.force, space.blocks,
            stiffness, c,
        )  # fmt: skip
        if stiffness != NONE:
            pivots += factorise(
                space.blocks, layout.columns, layout.rows, layout.targets, space.scratch
            )
            count += 1
        if doing == JUDGE:
            negative = pivots
            break
        if doing == WEIGH:  # whether the energy has fallen
            if total <= energy + 1e-9 * (1.0 + abs(energy)):
                if damping / 4 > blocked:
                    damping /= 4
                blocked /= 2
            else:
                copy(space.start_rotations, R)
                copy(space.start_places, p)
                blocked = max(damping, GENTLE)
                damping = 4 * blocked
            doing = FALL
            if count >= most or damping > HALTED:
                before = inf
                break
            continue
        if doing == SHORTEN:  # back from beyond the lowest point to where that may lie
            beyond = power(layout, space) * share
            part = 0.0
            if beyond > -slope / 4:
                copy(space.start_rotations, R)
                copy(space.start_places, p)
                part = share * slope / (slope - beyond)
            for i in range(len(p)):
                move(R, p, i, space.motion[i], part)
            doing = STEP
            if count >= most:
                before = inf if before > tolerance else before
                break
            continue
        if doing == STEP:
            negative, known = pivots, stiffness == EXACT
        if doing == STEP and stiffness == EXACT and pivots > 0 and before > SADDLE:
            downhill = True  # once more, with Gauss-Newton's stiffness
            continue
        downhill = False
        if doing == PUSH and pivots > 0:
            damping *= 4
            if damping > HALTED:
                before = inf
                break
            continue
        if doing == FALL and pivots > 0:
            blocked = max(damping, GENTLE)
            damping = 4 * blocked
            if count >= most or damping > HALTED:
                before = inf
                break
            continue
        rounds = SOFTEST if doing == PUSH else 1
        far = 1.0
        for turn in range(rounds):
            if doing != PUSH:
                condense(layout, space.kept, space.force, space.right)
            else:
                for i in range(len(space.right)):
                    for k in range(6):
                        if turn == 0:
                            start = 1.0 / (1 + (7 * i + 3 * k) % 5) if k < 3 else 0.0
                            space.right[i, k] = start
                        else:
                            space.right[i, k] /= far
            substitute(space.blocks, layout.columns, layout.rows, space.right)
            expand(layout, space.kept, space.right, space.motion, 0.0 if doing == PUSH else 1.0)
            far = longest(p, space.motion)
        if doing == PUSH:
            share = upwards(joints, p, space.motion) * shove / far
            damping = DAMPING
            doing = FALL if descend else STEP
        elif doing == FALL:
            if not far <= LONGEST:
                blocked = max(damping, GENTLE)
                damping = 4 * blocked
                if count >= most or damping > HALTED:
                    before = inf
                    break
                continue
            share, energy = 1.0, total
            copy(R, space.start_rotations)
            copy(p, space.start_places)
            if c == 0.0 and far < CLOSE / 10:  # the rest by plain steps
                descending, doing, before = False, STEP, far
            else:
                doing = WEIGH
        elif not isfinite(far):
            failed += 1
            before = inf
            if failed > 2 or doing == AGAIN_STEP:
                break
            doing = STEP
            continue
        else:
            if doing == STEP:
                share = min(1.0, LONGEST / max(far, 1e-9))
                since = far
                again = 0
                if count > FREE and far > CLOSE:
                    slope = power(layout, space) * share
                    copy(R, space.start_rotations)
                    copy(p, space.start_places)
                    doing = SHORTEN
                elif far <= CLOSE:
                    doing = AGAIN_STEP
            else:
                share = min(1.0, LONGEST / max(far, 1e-9))
                again += 1
                cheap += 1
                if far > SLOW * before or again >= AGAIN:
                    doing = STEP
            before = far
        for i in range(len(p)):
            move(R, p, i, space.motion[i], share)
        if doing in (STEP, AGAIN_STEP) and not descending:
            if before <= tolerance:
                if known and not judge and since < STALE:
                    break
                doing = JUDGE
            elif doing == STEP and count >= most:
                break
    return before, negative, widest, count, cheap

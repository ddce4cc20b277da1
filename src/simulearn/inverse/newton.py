"""Gauss-Newton with discrete steps for the actuators: the default.

Single modifications show how the vertices move with each joint and with each step of an actuator,
which makes a linear model of the grid. For any set of actuator steps the joints' best answer to it
is a damped least-squares problem with a closed form, so that thousands of sets are compared for the
price of a matrix product: a beam search adds one step after another to the most promising sets. The
best few, with three dampings, are simulated, and the best of those is where the next iteration
begins. Actuators are multiples of the step all along: nothing is relaxed or snapped.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count

import numpy as np
from numpy.typing import NDArray

from simulearn.inverse.problem import Advance, Problem, Scored, residual
from simulearn.inverse.relaxing import relaxed, rounded
from simulearn.inverse.space import Space

Array = NDArray[np.float64]

PROBE = 1.0  # mm, that a joint is moved to see what follows
WIDTH = 12  # sets that the beam search keeps
DEPTH = 4  # steps of actuators in one iteration, at most
SETS = 3  # sets of each number of steps that are simulated
DAMPINGS = (0.1, 1.0, 10.0)  # times the present one
LEAST = 1e-4
GAIN, PATIENCE = 0.03, 1  # less is little; so many iterations of little are enough
SHARE = 0.4  # of the actuators are drawn anew to begin again


@dataclass(frozen=True, eq=False)
class Slope:
    """How vertices move with a design, to first order.

    Attributes:
        joints: (N, P) per mm, of N residuals.
        steps: (Q, 2, N) of one step up, one step down; NaN where that is not valid.
    """

    joints: Array
    steps: Array


def newton(problem: Problem, start: Scored) -> Iterator[Advance]:
    """Search from a design; yield what each iteration advance."""
    x, a, begin = start.x, start.a, start
    for k in count():
        if problem.model is not None:
            last = None
            for last in relaxed(problem, x, a):
                yield Advance(f"actuators relaxed, {last[0].error:.2f} mm", complete=False)
            snapped = rounded(problem, *last) if last else None
            if snapped is not None:
                begin = snapped
                yield Advance(f"actuators in steps, {begin.error:.2f} mm")
            elif k:
                begin = problem.best or start
        yield from descent(problem, begin)
        best = problem.best or start
        again = problem.source.random(len(a)) < SHARE
        a = np.where(again, 2 * problem.source.random(len(a)) - 1, best.a)
        x = best.x
        if k == 0 and start.a.any():  # ratios at their limits are a bad place to relax from
            x, a = start.x, 0 * a
        if problem.model is None:
            begin = _nearby(problem, x, problem.space.nearest(x, a), start)


def descent(problem: Problem, start: Scored) -> Iterator[Advance]:
    """Go down from a design until little is gained; yield what each iteration advance."""
    now, damping, idle = start, 1.0, 0
    while idle < PATIENCE:
        slope = probed(problem, now)
        x, a, rate = proposals(problem, now, slope, damping)
        points = problem.points(x, a)
        errors = problem.error(points)
        k = int(errors.argmin())
        idle = 0 if errors[k] < (1 - GAIN) * now.error else idle + 1
        if errors[k] < now.error:
            stepped = round(np.abs(a[k] - now.a).sum() / problem.space.ratio)
            moved = float(np.abs(x[k] - now.x).max(initial=0.0))
            now = Scored(x[k], a[k], points[k], float(errors[k]))
            damping = max(LEAST, damping * rate[k])
            yield Advance(f"{stepped} steps of actuators, joints by up to {moved:.1f} mm")
        else:
            damping *= 30
            yield Advance("nothing better nearby")


def _nearby(problem: Problem, x: Array, a: Array, start: Scored) -> Scored:
    """Return a design to begin again from, or the best there is if that has no answer."""
    nearby = problem.scored(x, a)
    if np.isfinite(nearby.error):
        return nearby
    return problem.best or start


def probed(problem: Problem, now: Scored) -> Slope:
    """Return the slopes at a design, from one batch of single modifications."""
    space = problem.space
    p, q = len(now.x), len(now.a)
    dx = np.concatenate([PROBE * np.eye(p), np.zeros((2 * q, p))])
    da = np.concatenate([np.zeros((p, q)), np.kron(np.eye(q), [[space.ratio], [-space.ratio]])])
    then = residual(problem, problem.points(now.x + dx, now.a + da))
    moved = then - residual(problem, now.points)
    joints = np.nan_to_num(moved[:p].T / PROBE)
    return Slope(joints, moved[p:].reshape(q, 2, moved.shape[1]))


def proposals(
    problem: Problem, now: Scored, slope: Slope, damping: float
) -> tuple[Array, Array, Array]:
    """Return designs (T, P), (T, Q) that the model promises much of, and their dampings (T,)."""
    space, J = problem.space, slope.joints
    r = residual(problem, now.points)
    x, a, rates = [], [], []
    for rate in DAMPINGS:
        gain = np.linalg.solve(J.T @ J + damping * rate * np.eye(J.shape[1]) / len(r), J.T)
        left = np.eye(len(r)) - J @ gain
        for steps in _sets(r, slope.steps, left, space, now.a):
            moved = r + _moved(slope.steps, steps)
            x.append(now.x - gain @ moved)
            a.append(now.a + space.ratio * steps)
            rates.append(rate)
    return np.array(x), np.array(a), np.array(rates)


def _moved(steps: Array, counts: NDArray[np.int64]) -> Array:
    """Return how vertices move (N,) with counts (Q,) of steps."""
    up, down = np.maximum(counts, 0), np.maximum(-counts, 0)
    return np.einsum("q,qn->n", up, np.nan_to_num(steps[:, 0])) + np.einsum(
        "q,qn->n", down, np.nan_to_num(steps[:, 1])
    )


def _sets(r: Array, steps: Array, left: Array, space: Space, a: Array) -> list[NDArray[np.int64]]:
    """Return the sets of steps (Q,) that leave the least, the joints' answer to each included."""
    none = np.zeros(len(steps), dtype=np.int64)
    front, chosen = [none], [none]
    for _ in range(DEPTH):
        wider: dict[bytes, tuple[float, NDArray[np.int64]]] = {}
        for counts in front:
            base = r + _moved(steps, counts)
            for sign, side in ((1, 0), (-1, 1)):
                after = base + steps[:, side]
                values = np.einsum("qn,nm,qm->q", after, left, after)
                for k in np.flatnonzero(np.isfinite(values)):
                    if counts[k] * sign < 0 or abs(a[k] + (counts[k] + sign) * space.ratio) > 1:
                        continue
                    more = counts.copy()
                    more[k] += sign
                    wider[more.tobytes()] = (float(values[k]), more)
        front = [more for _, more in sorted(wider.values(), key=lambda pair: pair[0])[:WIDTH]]
        chosen += front[:SETS]
    return chosen

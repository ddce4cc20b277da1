"""Relaxation: actuators of any length for a while, then the steps nearest in effect.

With ratios as free as the joints, Gauss-Newton with damping comes close to most targets within a
few iterations. Rounding each ratio to the nearest step would throw that away; instead steps are
assigned to one actuator after another by a beam search, where joints and the actuators not yet
assigned answer as the linear model says they can (the closest-vector problem of lattices).

Relaxed points are no designs, so only learned engines can simulate them.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.inverse.problem import Problem, Scored, residual

Array = NDArray[np.float64]

UNIT = 20.0  # mm that count as much as a ratio of 1
PROBE = 1.0  # mm
DAMPINGS = (0.03, 0.3, 3.0, 30.0)  # times the present one
ITERATIONS, GAIN = 10, 0.1  # at most; less gained in one is little
ENOUGH = 0.2  # mm, what rounding adds is more
WIDTH = 64  # partial assignments that the beam search keeps
SIMULATED = 16


@dataclass(frozen=True, eq=False)
class Loose:
    """A relaxed point.

    Attributes:
        z: (P + Q,) joints in mm, then ratios times UNIT.
        points: (V, 3) mm, where vertices come to.
        error: mm.
    """

    z: Array
    points: Array
    error: float


def relaxed(problem: Problem, x: Array, a: Array) -> Iterator[tuple[Loose, Array]]:
    """Go down from a point; yield where it is and the slopes (N, P + Q) there, the last one last.

    Nothing is yielded where the point itself has no answer.
    """
    p, damping = len(x), 1.0
    most = np.r_[np.full(p, np.inf), np.full(len(a), UNIT)]

    def places(z: Array) -> Array:
        return problem.loose(z[:, :p], z[:, p:] / UNIT)

    z = np.r_[x, UNIT * a]
    points = places(z[None])
    now = Loose(z, points[0], float(problem.error(points)[0]))
    if not np.isfinite(now.error):
        return
    for _ in range(ITERATIONS):
        # Inwards where a ratio is at its limit.
        side = np.where(now.z + PROBE > most, -PROBE, PROBE)
        points = places(now.z + np.diag(side))
        J = np.nan_to_num((residual(problem, points) - residual(problem, now.points)).T / side)
        yield now, J
        r, n = residual(problem, now.points), len(now.z)
        rates = damping * np.array(DAMPINGS)
        steps = [np.linalg.solve(J.T @ J + rate * np.eye(n) / len(r), -J.T @ r) for rate in rates]
        z = np.clip(now.z + np.array(steps), -most, most)
        points = places(z)
        errors = problem.error(points)
        k = int(errors.argmin())
        if not errors[k] < now.error:
            damping *= 100
            if damping > 1e4:
                return
            continue
        little = errors[k] > (1 - GAIN) * now.error
        damping = max(1e-4, damping * DAMPINGS[k])
        now = Loose(z[k], points[k], float(errors[k]))
        if little or now.error < ENOUGH:
            yield now, J
            return


def rounded(problem: Problem, loose: Loose, J: Array) -> Scored | None:
    """Return the best of the designs that relaxed ratios may round to; None if none is valid."""
    space = problem.space
    p = len(space.motions)
    x, a = loose.z[:p], loose.z[p:] / UNIT
    options = space.options(x)
    r, width = residual(problem, loose.points), J.shape[1]
    soft = 1e-3 * np.eye(width)
    order = np.argsort([-np.linalg.norm(column) for column in J.T[p:]], kind="stable")
    sets, moved = a[None], r[None]
    for done, q in enumerate(order, 1):
        rest = [*range(p), *(p + order[done:])]  # that still answer
        free = J[:, rest]
        left = np.eye(len(r)) - free @ np.linalg.solve(
            free.T @ free + soft[: len(rest), : len(rest)], free.T
        )
        ratios = np.array(options[q])
        wider = np.repeat(sets, len(ratios), axis=0)
        wider[:, q] = np.tile(ratios, len(sets))
        after = r + (wider - a) @ J[:, p:].T * UNIT
        value = np.einsum("sn,nm,sm->s", after, left, after)
        best = np.argsort(value, kind="stable")[:WIDTH]
        sets, moved = wider[best], after[best]
    free = J[:, :p]
    sets, moved = sets[:SIMULATED], moved[:SIMULATED]
    answer = np.linalg.solve(free.T @ free + soft[:p, :p], free.T @ moved.T).T
    xs = np.concatenate([x - answer, np.repeat(x[None], len(sets), axis=0)])
    steps = np.concatenate([sets, sets])
    points = problem.points(xs, steps)
    errors = problem.error(points)
    k = int(errors.argmin())
    return Scored(xs[k], steps[k], points[k], float(errors[k])) if np.isfinite(errors[k]) else None

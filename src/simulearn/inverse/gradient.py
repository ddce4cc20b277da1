"""Gradient descent through the learned engine: joints slide, actuators are relaxed, then snap.

The derivative of the error by all joints and ratios costs about as much as two simulations
(`learn.equilibrium.slopes`); L-BFGS goes down along it. Then actuators snap to multiples of the
step, joints go on alone, and single steps of actuators are scored until none improves. After that
it begins again from other ratios. What is relaxed is no design yet: only snapped designs are scored
and remembered.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.inverse.goals import Goals
from simulearn.inverse.problem import Advance, Problem, Scored
from simulearn.learn.common.model import Designs, last_frame
from simulearn.learn.equilibrium.model import Equilibrium
from simulearn.learn.equilibrium.prediction import TOLERANCE
from simulearn.learn.equilibrium.slopes import Slopes, slopes

Array = NDArray[np.float64]
Value = Callable[[Array], tuple[float, Array]]  # variables -> value, gradient

SOFT = 1.0  # mm, below which a distance counts as its square, so that the error is smooth
UNIT = 20.0  # mm that count as much as a ratio of 1
RELAXED, SLIDES = 40, 20  # iterations with and without actuators, at most
MEMORY = 10  # pairs that L-BFGS keeps
SHORTEST = 1e-3  # of its first step, where a line search gives up
GAIN = 1e-3  # less in an iteration is little


def gradient(problem: Problem, start: Scored) -> Iterator[Advance]:
    """Search from a design; yield what each iteration advance.

    Raises:
        InputError: the engine cannot be differentiated.
    """
    model = problem.model
    if not isinstance(model, Equilibrium):
        raise InputError(
            "the method gradient needs a learned engine of kind equilibrium or beams, which can "
            "be differentiated; use another method with this engine",
            "engine-not-differentiable",
            "method",
        )
    begin, p = start, len(start.x)
    while True:
        z = np.r_[begin.x, UNIT * begin.a]
        most = np.r_[np.full(p, np.inf), np.full(len(begin.a), UNIT)]
        for lower, value in lbfgs(Relaxed(problem, model, None), z, most, RELAXED):
            z = lower
            problem.going()
            yield Advance(f"relaxed, {value:.2f} mm", complete=False)
        snapped = problem.scored(z[:p], problem.space.nearest(z[:p], z[p:] / UNIT))
        yield Advance(f"actuators in steps, {snapped.error:.2f} mm")
        yield from _polished(problem, model, snapped)
        best = problem.best or start
        drawn = 2 * problem.source.random(len(best.a)) - 1
        share = problem.source.random(len(best.a)) < 0.5
        begin = Scored(best.x, np.where(share, drawn, best.a), best.points, best.error)


def _polished(problem: Problem, model: Equilibrium, now: Scored) -> Iterator[Advance]:
    """Slide joints, then step actuators, in turn, while it helps."""
    p, space = len(now.x), problem.space
    while True:
        x = now.x
        for lower, value in lbfgs(Relaxed(problem, model, now.a), x, np.full(p, np.inf), SLIDES):
            x = lower
            problem.going()
            yield Advance(f"joints alone, {value:.2f} mm", complete=False)
        q = len(now.a)
        a = np.concatenate([now.a[None], now.a + space.ratio * np.vstack([np.eye(q), -np.eye(q)])])
        points = problem.points(np.repeat(x[None], len(a), axis=0), a)
        errors = problem.error(points)
        k = int(errors.argmin())
        if not errors[k] < now.error:
            return
        now = Scored(x, a[k], points[k], float(errors[k]))
        if k == 0:
            return
        yield Advance(f"one actuator stepped, {now.error:.2f} mm")


@dataclass(eq=False)
class Relaxed:
    """The softened error as a function of joints, and of ratios unless they are held.

    Attributes:
        problem: what is wanted.
        model: the simulator.
        held: (Q,) ratios, or None where they are variables, too.
    """

    problem: Problem
    model: Equilibrium
    held: Array | None

    def __call__(self, z: Array) -> tuple[float, Array]:
        """Return value and gradient at x (P,) or x and UNIT a (P + Q,)."""
        space = self.problem.space
        p = len(space.motions)
        x, a = z[:p], self.held if self.held is not None else np.clip(z[p:] / UNIT, -1, 1)
        flat = np.full_like(z, 0.0)
        if space.net(x) is None:
            return np.inf, flat
        slope = fitting_slopes(
            self.model, space.designs(x[None], a[None]), self.problem.goals, SOFT, TOLERANCE
        )
        if not slope.converged[0] or not np.isfinite(slope.cost[0]):
            return np.inf, flat
        flat[:p] = np.einsum("pjc,jc->p", space.motions, slope.flat[0])
        if self.held is None:
            flat[p:] = [slope.actuators[0, list(group)].sum() / UNIT for group in space.groups]
        return float(slope.cost[0]), flat


def fitting_slopes(
    model: Equilibrium,
    designs: Designs,
    goals: Goals,
    soft: float = 1e-9,
    tolerance: float = TOLERANCE,
) -> Slopes:
    """Return the errors of designs, and how they change with joints and ratios.

    Args:
        model: the simulator.
        designs: of one topology.
        goals: what the error is of.
        soft: mm; a distance d counts as sqrt(d2 + soft2) - soft.
        tolerance: of the simulation, mm; see `learn.equilibrium.slopes`.
    """
    pick = goals.matrix(designs.flat.shape[1], len(designs.beams))
    last = last_frame(model, designs)
    points = goals.points(last.joints, last.sections)
    parts = []
    for t in range(len(designs)):
        error, slope = goals.slope(points[t], soft)
        given = (pick, points[t], error, slope)
        parts.append(slopes(model, designs.take([t]), tangent_error, given, tolerance))
    return Slopes(*(np.concatenate(values) for values in zip(*parts, strict=True)))


def tangent_error(joints: Any, sections: Any, given: Any) -> Any:
    """Return an error that changes evenly about known points, for `learn.equilibrium.slopes`."""
    pick, points, error, slope = given
    moved = pick @ jnp.concatenate([joints.reshape(-1, 3), sections.reshape(-1, 3)]) - points
    return error + (slope * moved).sum()


def lbfgs(value: Value, z: Array, most: Array, iterations: int) -> Iterator[tuple[Array, float]]:
    """Go down; yield the variables and the value after each iteration.

    Args:
        value: a function and its gradient; infinite where it has no value.
        z: (N,) where to begin.
        most: (N,) largest size of each variable.
        iterations: at most.

    Source: Nocedal and Wright, Numerical Optimization, 2nd edition, algorithm 7.4; halved steps.
    """
    now, slope = value(z)
    kept: list[tuple[Array, Array]] = []
    for _ in range(iterations):
        direction = -_two_loops(slope, kept)
        if direction @ slope >= 0:
            direction, kept = -slope, []
        length = 1.0 if kept else min(1.0, 10 / max(float(np.abs(direction).max()), 1e-12))
        shortest = SHORTEST * length
        while True:
            if length < shortest:
                return
            new = np.clip(z + length * direction, -most, most)
            then, there = value(new)
            if then < now + 1e-4 * float(slope @ (new - z)):
                break
            length /= 2
        step, change = new - z, there - slope
        if step @ change > 1e-10:
            kept = [*kept, (step, change)][-MEMORY:]
        gained, z, now, slope = now - then, new, then, there
        yield z, now
        if gained < GAIN * now:
            return


def _two_loops(slope: Array, kept: list[tuple[Array, Array]]) -> Array:
    """Return the inverse Hessian, estimated from the last steps, times the gradient."""
    q, shares = slope.copy(), []
    for step, change in reversed(kept):
        share = (step @ q) / (step @ change)
        q -= share * change
        shares.append(share)
    if kept:
        step, change = kept[-1]
        q *= (step @ change) / (change @ change)
    else:
        q *= 10.0
    for (step, change), share in zip(kept, reversed(shares), strict=True):
        q += step * (share - (change @ q) / (step @ change))
    return q

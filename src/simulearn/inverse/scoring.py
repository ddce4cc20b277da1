"""Where the vertices of many designs come to, by any engine.

A learned engine answers a whole batch in one call; others simulate one design after the other. A
design that an engine has no answer for has no place, and a search does without it.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import Cancel
from simulearn.grid import Grid
from simulearn.inverse.goals import Goals
from simulearn.learn.common.model import Designs, last_frame
from simulearn.simulate import Failure, Simulator
from simulearn.simulate.learned import Learned

Array = NDArray[np.float64]
Places = Callable[[Designs], Array]  # designs -> (T, V, 3), NaN where there is no answer


def places(engine: Simulator, goals: Goals, cancel: Cancel | None = None) -> Places:
    """Return the function that gives the places of the goals' vertices in the last frame.

    Args:
        engine: the simulator.
        goals: whose vertices.
        cancel: stops the simulation of a batch; the function raises CancelledError.
    """
    if isinstance(engine, Learned):
        return _together(engine, goals)
    return _one_by_one(engine, goals, cancel)


def colliding(engine: Simulator, cancel: Cancel | None = None) -> Callable[[Designs], bool]:
    """Return the function that says whether parts of a single design run through each other.

    It simulates all frames; a design without an answer does not collide.

    Args:
        engine: the simulator.
        cancel: stops it; the function raises CancelledError.
    """

    def collides(designs: Designs) -> bool:
        (outcome,) = engine.simulate(grids(designs), cancel=cancel)
        return not isinstance(outcome, Failure) and bool(outcome.collisions)

    return collides


def _together(engine: Learned, goals: Goals) -> Places:
    model = engine.bundle.model

    def together(designs: Designs) -> Array:
        engine.require(designs.material)
        last = last_frame(model, designs)
        points = goals.points(last.joints, last.sections)
        answered = last.converged & np.isfinite(points).all(axis=(1, 2))
        return np.where(answered[:, None, None], points, np.nan)

    return together


def _one_by_one(engine: Simulator, goals: Goals, cancel: Cancel | None) -> Places:
    def one_by_one(designs: Designs) -> Array:
        outcomes = engine.simulate(grids(designs), cancel=cancel)
        points = np.full((len(designs), len(goals.vertices), 3), np.nan)
        for t, outcome in enumerate(outcomes):
            if not isinstance(outcome, Failure):
                points[t] = goals.points(outcome.joints[-1], outcome.beams[-1])
            elif outcome.invalid:
                raise outcome.error
        return points

    return one_by_one


def grids(designs: Designs) -> list[Grid]:
    """Return designs as grids."""
    return [
        Grid(flat, designs.beams, ratios, designs.fixed, designs.reference)
        for flat, ratios in zip(designs.flat, designs.actuators, strict=True)
    ]

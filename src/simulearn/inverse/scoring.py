"""Where the vertices of many designs come to, by any engine.

A learned engine answers a whole batch in one call; others simulate one design after the other. A
design that an engine has no answer for has no place, and a search does without it.
"""

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import Cancel
from simulearn.grid import Grid
from simulearn.inverse.goals import Goals
from simulearn.learn.common.model import Designs, last_frame
from simulearn.simulate import Failure, Simulator
from simulearn.simulate.learned import Learned

Array = NDArray[np.float64]
Collides = Callable[[Designs], bool]  # a single design -> whether parts of it collide
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
    return _one_by_one(engine, goals, cancel, {})


def places_and_collisions(
    engine: Simulator, goals: Goals, cancel: Cancel | None = None
) -> tuple[Places, Collides]:
    """Return `places`, and the function that says whether parts of a design collide.

    A learned engine, which gives places by the last frame alone, simulates the design's frames for
    that; others have looked when they gave its places. A design without an answer does not collide.

    Args:
        engine: the simulator.
        goals: whose vertices.
        cancel: stops a simulation; the functions raise CancelledError.
    """
    if isinstance(engine, Learned):
        return _together(engine, goals), partial(_looked_at, engine, cancel)
    known: dict[bytes, bool] = {}

    def collides(designs: Designs) -> bool:
        return known.get(_key(designs, 0), False)

    return _one_by_one(engine, goals, cancel, known), collides


def _looked_at(engine: Simulator, cancel: Cancel | None, designs: Designs) -> bool:
    (outcome,) = engine.simulate(grids(designs), cancel=cancel)
    return not isinstance(outcome, Failure) and bool(outcome.collisions)


def _key(designs: Designs, t: int) -> bytes:
    return designs.flat[t].tobytes() + designs.actuators[t].tobytes()


def _together(engine: Learned, goals: Goals) -> Places:
    model = engine.bundle.model

    def together(designs: Designs) -> Array:
        engine.require(designs.material)
        last = last_frame(model, designs)
        points = goals.points(last.joints, last.sections)
        answered = last.converged & np.isfinite(points).all(axis=(1, 2))
        return np.where(answered[:, None, None], points, np.nan)

    return together


def _one_by_one(
    engine: Simulator, goals: Goals, cancel: Cancel | None, known: dict[bytes, bool]
) -> Places:
    def one_by_one(designs: Designs) -> Array:
        outcomes = engine.simulate(grids(designs), cancel=cancel)
        points = np.full((len(designs), len(goals.vertices), 3), np.nan)
        for t, outcome in enumerate(outcomes):
            if not isinstance(outcome, Failure):
                points[t] = goals.points(outcome.joints[-1], outcome.beams[-1])
                known[_key(designs, t)] = bool(outcome.collisions)
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

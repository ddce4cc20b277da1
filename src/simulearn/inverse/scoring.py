"""Where the vertices of many designs come to, by any engine.

A learned engine answers a whole batch in one call; others simulate one design after the other. A
design that an engine has no answer for has no place, and a search does without it.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import ComputationError, InputError
from simulearn.grid import Grid
from simulearn.inverse.goals import Goals
from simulearn.learn.common.model import Designs, last_frame
from simulearn.simulate import Simulator
from simulearn.simulate.learned import Learned

Array = NDArray[np.float64]
Places = Callable[[Designs], Array]  # designs -> (T, G, 3), NaN where there is no answer
Going = Callable[[], None]  # called between slow simulations; raises to stop them


def places(engine: Simulator, goals: Goals, going: Going = lambda: None) -> Places:
    """Return the function that tells where the vertices of goals are in the last frame.

    Args:
        engine: who answers.
        goals: whose vertices.
        going: called before each single simulation.
    """
    if isinstance(engine, Learned):
        return _together(engine, goals)
    return _one_by_one(engine, goals, going)


def _together(engine: Learned, goals: Goals) -> Places:
    card, model = engine.bundle.card, engine.bundle.model

    def together(designs: Designs) -> Array:
        if designs.material != card.material:
            raise InputError(
                f'material is {designs.material}; the model "{card.name}" has learnt '
                f"{card.material}"
            )
        told = last_frame(model, designs)
        points = goals.points(told.joints, told.sections)
        answered = told.converged & np.isfinite(points).all(axis=(1, 2))
        return np.where(answered[:, None, None], points, np.nan)

    return together


def _one_by_one(engine: Simulator, goals: Goals, going: Going) -> Places:
    def one(grid: Grid) -> Array:
        going()
        try:
            (result,) = engine.simulate([grid])
        except ComputationError:
            return np.full((len(goals), 3), np.nan)
        return goals.points(result.joints[-1], result.beams[-1])

    return lambda designs: np.array([one(grid) for grid in grids(designs)])


def grids(designs: Designs) -> list[Grid]:
    """Return designs as grids."""
    return [
        Grid(flat, designs.beams, ratios, designs.fixed, designs.reference)
        for flat, ratios in zip(designs.flat, designs.actuators, strict=True)
    ]

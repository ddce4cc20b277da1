"""Robust designs: the search goes on with each goal wanted of a few prints at once.

A fixed sample of prints stands for all of them, the same for every design, so that designs differ
by themselves and not by luck. Each goal is there once for each print. The error of a design is thus
its expected error, and a method that takes goals by least squares sees how far prints differ as
well as where they are on average: E|p - t|^2 = |E p - t|^2 + var p.
"""

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import Cancel
from simulearn.grid import Grid
from simulearn.inverse.goals import Goals
from simulearn.inverse.probability import points_of_prints
from simulearn.inverse.problem import Problem, drawing
from simulearn.inverse.scoring import Places, grids
from simulearn.inverse.space import Space
from simulearn.learn.common.model import Designs
from simulearn.material import load_material
from simulearn.simulate import Simulator
from simulearn.simulate.scatter import Draw, even_prints, prints_source
from simulearn.simulate.source import Source

Array = NDArray[np.float64]

PRINTS = 8


def robust_problem(
    space: Space,
    goals: Goals,
    grid: Grid,
    known: Array | None,
    engine: Simulator | None,
    until: float,
    cancel: Cancel | None,
    out_of_time: Cancel | None,
) -> Problem:
    """Return the problem to come close with prints.

    Args:
        space: of the designs.
        goals: what is wanted of the design.
        grid: the design to begin with.
        known: (V, 3) mm, where its vertices are by finite elements; what the simulator of prints
            says elsewhere is moved by the difference.
        engine: that simulates the design; see `simulate.scatter.prints_source`.
        until: when to stop.
        cancel: stops the search.
        out_of_time: stops a batch of designs, when the time is over or the search is stopped.
    """
    material = load_material(grid.material)
    source = prints_source(material, engine)
    draw = even_prints(material, len(grid.beams), PRINTS)
    shift = np.zeros_like(goals.offset)
    if known is not None:
        nominal = Draw([material], np.ones((1, len(grid.beams))))
        shift = np.nan_to_num(known - points_of_prints(grid, goals, nominal, source)[0])
    return Problem(
        space,
        goals.repeated(PRINTS),
        _places(goals, draw, source, shift, out_of_time),
        source=drawing(PRINTS),
        until=until,
        cancel=cancel,
    )


def _places(
    goals: Goals, draw: Draw, source: Source, shift: Array, cancel: Cancel | None
) -> Places:
    def places(designs: Designs) -> Array:
        points = np.empty((len(designs), len(draw) * len(goals.vertices), 3))
        for t, grid in enumerate(grids(designs)):
            there = points_of_prints(grid, goals, draw, source, cancel=cancel)
            points[t] = (there + shift).reshape(-1, 3)
        # A design of which a print has no answer is none that can be relied on.
        points[~np.isfinite(points).all(axis=(1, 2))] = np.nan
        return points

    return places

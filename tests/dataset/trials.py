"""Batches of a few trials by finite elements, in double precision."""

import functools

import numpy as np

from simulearn.dataset import Batch
from simulearn.fea import simulate_grid
from simulearn.grid import Grid, Rules, draw_valid
from simulearn.material import load_material


@functools.cache
def designs(count: int = 2) -> tuple[Grid, ...]:
    """Random single cells."""
    return tuple(draw_valid(Rules(cells=(1, 1)), 3, k)[0].centred for k in range(count))


def solved(grids: tuple[Grid, ...]) -> Batch:
    """The trials of designs of one topology."""
    trials = [simulate_grid(grid, load_material(grid.material)) for grid in grids]
    return Batch(
        beams=grids[0].beams,
        fixed=grids[0].fixed,
        flat=np.stack([grid.joints for grid in grids]),
        actuators=np.stack([grid.actuators for grid in grids]),
        joints=np.stack([trial.joints for trial in trials]),
        sections=np.stack([trial.beams for trial in trials]),
        stress=np.stack([trial.stress for trial in trials]),
        numbers=np.arange(len(grids)),
        test=np.zeros(len(grids), bool),
        material=load_material(grids[0].material),
        reference=grids[0].material,
    )


@functools.cache
def batch() -> Batch:
    return solved(designs())

"""Mechanics and finite elements agree on single beams, of which no training trial consists."""

import numpy as np
import pytest

from simulearn.fea import simulate_grid
from simulearn.fea.bar import bar
from simulearn.learn.common.bundle import bundle_of
from simulearn.learn.common.model import Designs
from simulearn.material import load_material

PLA = load_material("pla-hot-water")


@pytest.mark.parametrize(("length", "ratio"), [(40.0, 1.0), (60.0, 0.5), (80.0, -0.75)])
def test_a_single_beam_ends_where_finite_elements_say(length, ratio):
    grid = bar(length, ratio, PLA)
    trial = simulate_grid(grid, PLA)
    designs = Designs(grid.beams, grid.fixed, grid.joints[None], grid.actuators[None])
    frames = bundle_of("beams").model.rollout(designs)
    assert frames.converged.all()
    far = 1 - grid.fixed
    true, predicted = (np.asarray(x)[:, far].mean(axis=1) for x in (trial.joints, frames.joints[0]))
    moved = np.linalg.norm(true[-1] - true[0])
    off = np.linalg.norm(predicted - true, axis=-1)
    assert moved > 3
    assert off.max() < 0.02 * length

"""Published solutions: bending, shear, curved beams, bilayers, sag, creep, calibration."""

import numpy as np
import pytest

import ladder
from simulearn.fea import simulate_grid
from simulearn.fea.bar import bar, curvature


def test_cantilever_with_end_shear() -> None:
    """Sze, Liu, Lo 2004, section 3.1."""
    assert abs(ladder.end_shear()).max() < 0.01


def test_cantilever_with_end_moment() -> None:
    assert abs(ladder.end_moment(turns=0.25)).max() < 0.01


def test_45_degree_bend() -> None:
    """Bathe and Bolourchi 1979."""
    published = np.array([-13.4, -23.5, 53.4])
    assert np.linalg.norm(ladder.bend_45() - published) < 0.01 * np.linalg.norm(published)


@pytest.mark.parametrize("upper", [1, 2, 3])
def test_timoshenko_bilayer(upper: int) -> None:
    assert ladder.bilayer(upper) == pytest.approx(1, abs=0.01)


def test_sag_of_a_heavy_cantilever() -> None:
    assert ladder.sag() == pytest.approx(1, abs=0.01)


def test_quasi_elastic_creep_agrees_with_step_by_step() -> None:
    quasi, steps = ladder.creep_of_beam()
    assert quasi == pytest.approx(steps, rel=0.01)
    assert steps > 0.1  # mm: it does creep


def test_calibration() -> None:
    gravity = ladder.PLA.gravity.model_copy(update={"acceleration": 0.0})
    free = ladder.PLA.model_copy(update={"gravity": gravity})
    trial = simulate_grid(bar(free.calibration.length, 1.0, free), free)
    bent = curvature(trial.solid, trial.displacements[10])
    assert bent == pytest.approx(free.calibration.curvature, abs=0.02)
    # Without gravity there is nothing that creeps.
    np.testing.assert_allclose(trial.displacements[11], trial.displacements[10], atol=1e-6)

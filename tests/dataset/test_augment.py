"""Turned and mirrored trials are the trials of turned and mirrored designs."""

from dataclasses import replace

import numpy as np
import pytest
import trials

from simulearn.dataset.augment import BINS, mirrored, turned, variants
from simulearn.grid import Grid

ANGLES = (0.7, np.pi / 4, 4.1)


def area(batch):
    a, b = (batch.flat[:, k] - batch.flat[:, 0] for k in (1, 2))
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def assert_same_trial(ours, theirs, stress=1e-7):
    np.testing.assert_allclose(ours.flat, theirs.flat, atol=1e-9)
    np.testing.assert_allclose(ours.joints, theirs.joints, atol=1e-6)
    np.testing.assert_allclose(ours.sections, theirs.sections, atol=1e-6)
    np.testing.assert_allclose(ours.stress, theirs.stress, atol=stress)


@pytest.mark.parametrize("angle", ANGLES)
def test_a_turned_trial_is_the_trial_of_the_turned_design(angle):
    c, s = np.cos(angle), np.sin(angle)
    grids = tuple(
        Grid(g.joints @ np.array([[c, s], [-s, c]]), g.beams, g.actuators, g.fixed)
        for g in trials.designs()
    )
    assert_same_trial(turned(trials.batch(), angle), trials.solved(grids))


def test_a_mirrored_trial_is_the_trial_of_the_mirrored_design():
    grids = tuple(Grid(g.joints * [-1, 1], g.beams, g.actuators, g.fixed) for g in trials.designs())
    assert_same_trial(mirrored(trials.batch()), trials.solved(grids))


def test_mirroring_twice_and_turning_back_change_nothing():
    batch = trials.batch()
    assert_same_trial(mirrored(mirrored(batch)), batch, 1e-12)
    assert_same_trial(turned(turned(batch, 1.3), -1.3), batch, 1e-12)


def test_each_trial_is_turned_by_its_own_angle():
    batch = trials.batch()
    both = turned(batch, np.array([0.3, 2.0]))
    for k, angle in enumerate((0.3, 2.0)):
        assert_same_trial(both.take([k]), turned(batch.take([k]), angle), 1e-12)


def test_stress_keeps_its_principal_values():
    stress = trials.batch().stress
    other = turned(trials.batch(), 0.9).stress

    def invariants(s):
        tensor = s[..., np.array([[0, 3, 4], [3, 1, 5], [4, 5, 2]])]
        return np.linalg.eigvalsh(tensor)

    np.testing.assert_allclose(invariants(other), invariants(stress), atol=1e-12)
    assert abs(other - stress).max() > 0.01


def test_variants_are_one_in_each_bin_and_their_mirror_images():
    batch = trials.batch()
    found = list(variants(batch, seed=4))
    assert len(found) == 2 * BINS
    direction = np.array([v.flat[:, 1] - v.flat[:, 0] for v in found[:BINS]])
    original = batch.flat[:, 1] - batch.flat[:, 0]
    angle = np.arctan2(direction[..., 1], direction[..., 0]) - np.arctan2(*original.T[::-1])
    assert (np.floor(angle % (2 * np.pi) / (2 * np.pi / BINS)) == np.arange(BINS)[:, None]).all()
    again = list(variants(batch, seed=4))
    np.testing.assert_array_equal(found[13].joints, again[13].joints)
    # The corners of a cell go round one way, those of its mirror image the other.
    assert (np.sign(area(found[0])) == -np.sign(area(found[-1]))).all()
    assert all((v.numbers == batch.numbers).all() for v in found)


def test_the_steps_of_a_packed_set_do_not_misnumber_corners():
    """A corner that the design has just above angle 0 may lie just below it in the file."""
    batch = trials.batch()
    moved = replace(batch, joints=np.round(batch.joints / 0.005) * 0.005)
    for angle in ANGLES:
        np.testing.assert_allclose(
            turned(moved, angle).joints, turned(batch, angle).joints, atol=0.01
        )

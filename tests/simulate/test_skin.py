"""The skin: closed, facing outwards, through the corners of the Result, its actuators in place."""

import numpy as np
import pytest

import synthetic
from simulearn.grid import drop_beams, make
from simulearn.simulate import skin


def areas(surface, frame):
    """Area vectors (Q, 3) of the quadrilaterals, mm2."""
    c = surface.vertices[frame][surface.quads]
    return np.cross(c[:, 2] - c[:, 0], c[:, 3] - c[:, 1]) / 2


@pytest.mark.parametrize("solid", [True, False])
@pytest.mark.parametrize("bend", [synthetic.saddle, synthetic.cylinder])
def test_it_is_closed_and_faces_outwards(bend, solid):
    surface = skin(synthetic.result(bend=bend, solid=solid))
    for frame in (0, -1):
        # Of a closed surface the area vectors cancel, and the volume is positive (Gauss).
        flux = areas(surface, frame)
        np.testing.assert_allclose(flux.sum(axis=0), 0, atol=1e-6)
        middles = surface.vertices[frame][surface.quads].mean(axis=1)
        volume = np.einsum("qd,qd->", middles, flux) / 3
        assert volume == pytest.approx(4.0 * 7.2 * (9 * 7.2 + 12 * 57.8), rel=0.06)


def test_it_passes_through_every_corner():
    result = synthetic.result()
    surface = skin(result)
    for frame in (0, 5, 11):
        joints, beams = result.joints[frame], result.beams[frame, :, [0, 2]]
        for corner in np.concatenate([joints.reshape(-1, 3), beams.reshape(-1, 3)]):
            assert np.linalg.norm(surface.vertices[frame] - corner, axis=1).min() < 1e-9


def test_with_and_without_a_solid_it_is_nearly_the_same():
    one, other = (skin(synthetic.result(solid=s)).vertices for s in (True, False))
    assert np.linalg.norm(one - other, axis=-1).max() < 0.2


def test_actuators_are_on_their_half_and_as_long_as_their_ratio():
    result = synthetic.result()  # +0.25 along x, -1 along y
    surface = skin(result)
    area = np.linalg.norm(areas(surface, 0), axis=1)
    middles = surface.vertices[0][surface.quads].mean(axis=1)
    top, bottom = surface.ratio == 0.25, surface.ratio == -1
    assert (middles[top, 2] > 0).all()
    assert (middles[bottom, 2] < 0).all()
    around = 7.2 + 2 * 2.0  # width and half the thickness on both sides, mm
    assert area[top].sum() == pytest.approx(6 * 0.25 * 57.8 * around)
    assert area[bottom].sum() == pytest.approx(6 * 57.8 * around)
    assert set(np.unique(surface.ratio)) == {-1.0, 0.0, 0.25}


def test_joints_know_their_number():
    result = synthetic.result()
    surface = skin(result)
    middles = surface.vertices[0][surface.quads].mean(axis=1)[:, :2]
    for j, place in enumerate(result.grid.joints):
        mine = surface.joint == j
        assert mine.any()
        assert abs(middles[mine] - place).max() < 3.7
    assert (surface.ratio[surface.joint >= 0] == 0).all()


def test_quadrilaterals_are_as_short_as_requested():
    result = synthetic.result()
    for spacing in (1.0, 5.0):
        surface = skin(result, spacing)
        c = surface.vertices[0][surface.quads[surface.joint < 0]]
        along = np.linalg.norm(c[:, [1, 2]] - c[:, [0, 1]], axis=-1).max(axis=-1)
        assert along.max() <= max(spacing, 7.2) + 1e-9


def test_beams_that_are_missing_leave_the_joint_closed():
    grid = drop_beams(make("saddle"), {0})
    surface = skin(synthetic.result(grid.centred))
    np.testing.assert_allclose(areas(surface, -1).sum(axis=0), 0, atol=1e-6)

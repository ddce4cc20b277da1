"""Modules that are alike: turned, mirrored and put in upside down; physics agrees."""

import numpy as np
import pytest

from simulearn.grid import Grid, Rules, draw_valid, lattice
from simulearn.simulate.calls import simulate
from simulearn.tile import alike, from_chart, heights, revolution
from simulearn.tile.alike import MIRROR, orders

PLAIN = lattice((2, 2), 1.0)
SHAPE = np.c_[50 * PLAIN.joints, [3, 1, -8, 5, 0, -2, 12, 6, 4]]  # like itself in no order
TURN = np.linalg.qr(np.random.default_rng(3).standard_normal((3, 3)))[0]
TURN = TURN * np.sign(np.linalg.det(TURN))


def test_a_square_lattice_covers_itself_in_eight_orders_and_an_oblong_one_in_four():
    assert len(orders(PLAIN)) == 8
    assert len(orders(lattice((3, 2)))) == 4
    np.testing.assert_array_equal(orders(PLAIN)[0], np.arange(9))


@pytest.mark.parametrize("k", range(8))
@pytest.mark.parametrize("mirrored", [False, True])
def test_every_turn_and_mirror_image_is_found(k, mirrored):
    order = orders(PLAIN)[k]
    shape = SHAPE * MIRROR if mirrored else SHAPE
    other = shape[order] @ TURN.T + [100, 20, 3]
    kinds, members = alike(np.array([SHAPE, other]), PLAIN, 0.01)
    assert len(kinds) == 1
    assert members[1].mirrored == mirrored
    np.testing.assert_array_equal(members[1].order, order)
    assert members[1].away_mm < 1e-9
    back = members[1].targets(other, kinds[0])
    np.testing.assert_allclose(back, kinds[0], atol=1e-9)


def test_a_tolerance_decides_and_a_kind_is_the_mean_of_its_patches():
    other = SHAPE + np.eye(9, 3) * 0.5
    assert len(alike(np.array([SHAPE, other]), PLAIN, 0.1)[0]) == 2
    kinds, members = alike(np.array([SHAPE, other]), PLAIN, 0.5)
    assert len(kinds) == 1
    assert 0 < members[0].away_mm < 0.3


def test_symmetric_surfaces_have_few_kinds():
    around = from_chart(revolution([[96, 0], [84, 150], [72, 300]]), (5, 3))
    assert len(alike(around.targets, around.lattice, 0.1)[0]) == 3
    dome = from_chart(
        heights(lambda x, y: 60 * np.cos(x / 200) * np.cos(y / 200), (-200, 200), (-200, 200)),
        (4, 4),
    )
    kinds, members = alike(dome.targets, dome.lattice, 0.1)
    assert len(kinds) == 3  # of the eighths of a square: corner, side, middle
    assert any(member.mirrored for member in members)


def test_the_mirrored_grid_takes_the_mirrored_shape():
    grid = draw_valid(Rules(), 31, 4)[0].centred
    mirror = Grid(grid.joints * [-1, 1], grid.beams, grid.actuators, grid.fixed)
    one, other = simulate([grid, mirror], "learned")
    assert np.abs(other.centres[-1] * MIRROR - one.centres[-1]).max() < 0.05

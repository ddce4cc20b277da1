"""The flat grid of mechanics is that of `grid.outline`, for many designs at once."""

import jax
import numpy as np
import pytest

from simulearn.grid import Grid, Rules, draw_valid, make, outline
from simulearn.material import load_material
from simulearn.mechanics.topology import flat_geometry, topologies

SECTION = load_material("pla-hot-water").section


@jax.jit
def flat(topology, joints):
    return flat_geometry(topology, joints, SECTION)


def check(grids: list[Grid]) -> None:
    joints = np.stack([g.joints for g in grids])
    topology = topologies(grids[0].beams, grids[0].fixed, joints)
    for t, grid in enumerate(grids):
        shape = outline(grid, SECTION)
        one = jax.tree.map(lambda x, t=t: x[t], topology)
        np.testing.assert_array_equal(one.side.T, shape.sides)
        geometry = jax.tree.map(np.asarray, flat(one, grid.joints))
        corners = geometry.centre[:, None] + geometry.corners
        np.testing.assert_allclose(corners[:, :4, :2], shape.joints, atol=1e-9)
        ends = geometry.centre[one.ends] + geometry.face
        np.testing.assert_allclose(
            ends[..., :2], shape.beams.mean(axis=2).swapaxes(0, 1), atol=1e-9
        )
        middle = geometry.middle[:, None] + np.einsum(
            "bij,bcj->bci", geometry.frame[0], geometry.section
        )
        np.testing.assert_allclose(middle[:, :2, :2], shape.beams.mean(axis=1), atol=1e-9)


def test_random_designs():
    check([draw_valid(Rules(), 3, k)[0] for k in range(40)])


@pytest.mark.parametrize("cells", [(1, 1), (2, 3)])
def test_other_topologies(cells):
    check([draw_valid(Rules(cells=cells), 3, k)[0] for k in range(5)])


def test_beams_removed():
    for k in range(3):
        check([draw_valid(Rules(removed=(1, 3)), 3, k)[0]])


@pytest.mark.parametrize("name", ["flat", "cone", "saddle"])
def test_ties_are_broken_alike(name):
    check([make(name)])

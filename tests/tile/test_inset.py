"""The inset: modules keep off their borders, on the surface, and beams of neighbours touch."""

import numpy as np
from modules import ring

from simulearn.tile import from_chart, from_quads, heights
from simulearn.tile.inset import with_inset

WIDTH = 7.2


def rims(tiling, module):
    """Return the targets of a module's first and last columns of joints."""
    nx, ny = tiling.cells
    own = tiling.targets[module].reshape(ny + 1, nx + 1, 3)
    return own[:, 0], own[:, -1]


def test_beams_of_neighbours_are_a_width_apart_on_the_surface():
    tiling = with_inset(ring(cells=(2, 2)), WIDTH / 2)
    for m in range(10):
        apart = np.linalg.norm(rims(tiling, m)[1] - rims(tiling, (m + 1) % 10)[0], axis=1)
        np.testing.assert_allclose(apart, WIDTH, rtol=0.005)
    assert tiling.surface.distance(tiling.targets.reshape(-1, 3)).max() < 0.05
    height = tiling.targets[..., 2]
    np.testing.assert_allclose([height.min(), height.max()], [3.6, 46.4], atol=0.05)


def test_normals_follow_the_joints():
    tiling = with_inset(ring(6), WIDTH / 2)
    radial = tiling.targets * [1, 1, 0]
    radial /= np.linalg.norm(radial, axis=-1, keepdims=True)
    assert (radial * tiling.target_normals).sum(-1).min() > 0.9985  # the profile leans by 2.3 deg


def test_skew_corners_keep_the_distance_from_both_borders():
    corners = np.array([[0.0, 0, 0], [80, 0, 0], [40, 70, 0], [120, 70, 0]])
    tiling = with_inset(from_quads(corners, np.array([[0, 1, 3, 2]]), (1, 1)), 4.0)
    low, high = tiling.targets[0, 0], tiling.targets[0, 3]
    side = np.array([40.0, 70.0]) / np.hypot(40, 70)
    assert abs(low[1] - 4) < 1e-6
    assert abs(side[1] * low[0] - side[0] * low[1] - 4) < 1e-6
    np.testing.assert_allclose(low + high, [120, 70, 0], atol=1e-6)


def test_middles_stay_and_none_is_none():
    chart = heights(lambda x, y: 0.002 * x * y, (-60.0, 60.0), (-60.0, 60.0))
    plain = from_chart(chart, (1, 1))
    tiling = with_inset(plain, 3.6)
    np.testing.assert_array_equal(tiling.targets[0, 4], plain.targets[0, 4])
    np.testing.assert_array_equal(with_inset(tiling, 0.0).targets, plain.targets)

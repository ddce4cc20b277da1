"""Flat layouts and turns of patches whose geometry is known."""

import numpy as np

from simulearn.material import load_material
from simulearn.tile import from_chart, heights, revolution
from simulearn.tile.flatten import arcs, flattened, frame, turns
from simulearn.tile.starting import start

CYLINDER = from_chart(revolution([[100.0, 0.0], [100.0, 120.0]], 180.0), (4, 1))


def test_a_cylinder_is_unrolled_and_its_beams_turn_by_their_angle():
    points, normals = CYLINDER.targets[0], CYLINDER.normals[CYLINDER.modules[0]]
    grid = CYLINDER.lattice
    flat = flattened(points, normals, grid)
    arc = 100.0 * np.pi / 8
    np.testing.assert_allclose(flat, grid.joints * [arc, 60.0], atol=0.02)
    along = grid.joints[grid.beams[:, 1], 0] > grid.joints[grid.beams[:, 0], 0]
    np.testing.assert_allclose(arcs(points, normals, grid.beams)[along], arc, rtol=1e-3)
    turn = turns(points, normals, grid.beams)
    np.testing.assert_allclose(turn[along], -np.pi / 8, atol=2e-3)  # away from the outside
    np.testing.assert_allclose(turn[~along], 0, atol=1e-4)


def test_the_frame_stands_on_the_surface():
    axes = frame(CYLINDER.targets[1], CYLINDER.normals[CYLINDER.modules[1]], CYLINDER.lattice)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(axes[1], [0, 0, 1], atol=1e-9)


def test_a_doubly_curved_patch_keeps_the_lengths_of_its_beams():
    dome = from_chart(
        heights(lambda x, y: -(x**2 + y**2) / 400, (-60.0, 60.0), (-60.0, 60.0)), (1, 1)
    )
    points, normals = dome.targets[0], dome.normals[dome.modules[0]]
    flat = flattened(points, normals, dome.lattice)
    lengths = np.linalg.norm(np.diff(flat[dome.lattice.beams], axis=1)[:, 0], axis=1)
    np.testing.assert_allclose(lengths, arcs(points, normals, dome.lattice.beams), rtol=0.03)


def test_the_start_has_actuators_where_the_patch_is_curved():
    material = load_material("pla-hot-water")
    points, normals = CYLINDER.targets[0], CYLINDER.normals[CYLINDER.modules[0]]
    grid = CYLINDER.lattice
    begin = start(points, normals, grid, material, "beams", None)
    joints, ratios = begin.joints, begin.ratios
    along = grid.joints[grid.beams[:, 1], 0] > grid.joints[grid.beams[:, 0], 0]
    assert (ratios[along] < -0.2).all()
    assert (np.abs(ratios[~along]) < 0.1).all()
    assert np.linalg.norm(joints, axis=1).max() < 1.2 * np.hypot(100 * np.pi / 8, 60)
    radius = np.linalg.norm(begin.middles[:, :2], axis=1)
    assert (np.abs(radius[~along] - 100) < 0.5).all()
    assert ((radius[along] > 100) & (radius[along] < 105)).all()  # farther than a circle

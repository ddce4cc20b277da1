"""Closed bodies of grids of every kind: watertight in every frame and in every format."""

import bent
import numpy as np
import pytest
import trimesh

import synthetic
from simulearn import simulate
from simulearn.interop import write_surface
from simulearn.interop.body import OF_JOINT, body
from simulearn.simulate.skin import edges

KINDS = bent.kinds()


def solid_of(shape, frame):
    return trimesh.Trimesh(shape.vertices[frame], shape.triangles, process=False)


# A brick as six tetrahedra around the diagonal from its corner 0 to its corner 6.
TETRAHEDRA = np.array([[0, k, j, 6] for k, j in ((1, 2), (2, 3), (3, 7), (7, 4), (4, 5), (5, 1))])


def volume(bricks):
    """Volume of bricks (n, 8, 3): corners below counter-clockwise, then those above."""
    a, b, c, d = np.moveaxis(bricks[:, TETRAHEDRA], 2, 0)
    return np.einsum("nti,nti->", np.cross(b - a, c - a), d - a) / 6


def sum_of_parts(result, frame):
    """Volume of the joints as bricks and of the beams as rows of bricks."""
    total = volume(result.joints[frame])
    for b in range(len(result.grid.beams)):
        rows = edges(result, b, np.linspace(0, 1, 101))[frame]
        # Right-bottom, left-bottom, right-top, left-top: seen from above, counter-clockwise.
        below = np.stack([rows[:-1, 0], rows[1:, 0], rows[1:, 1], rows[:-1, 1]], axis=1)
        above = np.stack([rows[:-1, 2], rows[1:, 2], rows[1:, 3], rows[:-1, 3]], axis=1)
        total += volume(np.concatenate([below, above], axis=1))
    return total


@pytest.mark.parametrize("solid", [False, True])
@pytest.mark.parametrize("name", KINDS)
def test_bodies_are_watertight_and_as_large_as_their_parts(name, solid):
    result = bent.result(KINDS[name], solid)
    shape = body(result)
    corners = shape.vertices[:, : OF_JOINT * len(result.grid.joints)]
    corners = corners.reshape(12, -1, OF_JOINT, 3)[:, :, :8]
    np.testing.assert_array_equal(corners, result.joints)
    for frame in (0, 6, 11):
        mesh = solid_of(shape, frame)
        assert mesh.is_watertight
        assert mesh.is_winding_consistent
        assert mesh.euler_number == 2 * (len(result.grid.joints) - len(result.grid.beams))
        assert mesh.area_faces.min() > 1e-3
        assert mesh.volume == pytest.approx(sum_of_parts(result, frame), rel=1e-3)
    section = bent.MATERIAL.section
    flat = sum(_area(q[:, :2]) for q in result.joints[0, :, :4]) * section.thickness
    middles = result.beams[0].mean(axis=2)
    lengths = np.linalg.norm(middles[:, 2] - middles[:, 0], axis=1)
    flat += lengths.sum() * section.width * section.thickness
    assert solid_of(shape, 0).volume == pytest.approx(flat, rel=1e-9)


def _area(corners):
    x, y = corners.T
    return abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2


@pytest.mark.parametrize("ending", [".stl", ".obj", ".ply"])
@pytest.mark.parametrize("frame", [0, 4, -1])
def test_files_hold_the_same_body_in_millimetres(tmp_path, ending, frame):
    result = bent.result(KINDS["honeycomb"], solid=True)
    path = tmp_path / f"a{ending}"
    write_surface(result, path, frame)
    mesh = trimesh.load(path)
    shape = body(result)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.volume == pytest.approx(solid_of(shape, frame).volume, rel=1e-5)
    corners = np.concatenate(
        [result.joints[frame].reshape(-1, 3), result.beams[frame].reshape(-1, 3)]
    )
    away = np.linalg.norm(corners[:, None] - mesh.vertices, axis=2).min(axis=1)
    assert away.max() < 1e-3


def test_a_simulated_grid_is_watertight(tmp_path):
    grid = synthetic.square_grid((1, 1), actuators=[1.0, -0.5, 0.25, -1.0])
    for engine in ("fea", "beams", "learned"):
        result = simulate(grid, engine)
        for frame in range(12):
            mesh = solid_of(body(result), frame)
            assert mesh.is_watertight
            assert mesh.is_winding_consistent
            assert mesh.volume == pytest.approx(solid_of(body(result), 0).volume, rel=0.1)

"""Closest points of surfaces, curves and planes are exact; inside of a body is inside."""

import numpy as np
import pytest
import trimesh

from simulearn.errors import InputError
from simulearn.rigid import Place
from simulearn.surfaces import Curve, Plane, Surface

SOURCE = np.random.default_rng(4)


def to_segments(points, starts, ends):
    """Return the distances (N,) of points from the nearest of segments."""
    along = ends - starts
    share = ((points[:, None] - starts) * along).sum(-1) / np.maximum((along**2).sum(-1), 1e-300)
    near = starts + np.clip(share, 0, 1)[..., None] * along
    return np.linalg.norm(points[:, None] - near, axis=-1).min(axis=1)


def to_triangles(points, corners):
    """Return the distances (N,) of points from the nearest of triangles, all looked at."""
    a, b, c = np.moveaxis(corners, 1, 0)
    edges = to_segments(points, np.concatenate([a, b, c]), np.concatenate([b, c, a]))
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    height = ((points[:, None] - a) * normal).sum(-1)
    foot = points[:, None] - height[..., None] * normal
    within = np.ones(height.shape, bool)
    for p, q in ((a, b), (b, c), (c, a)):
        within &= (np.cross(q - p, foot - p) * normal).sum(-1) >= 0
    return np.minimum(edges, np.where(within, np.abs(height), np.inf).min(axis=1))


@pytest.mark.parametrize("count", [1, 2, 5, 64, 700])
def test_closest_points_are_those_of_all_triangles(count):
    corners = SOURCE.normal(size=(count, 1, 3)) * 20 + SOURCE.normal(size=(count, 3, 3)) * 5
    surface = Surface(corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3))
    points = SOURCE.normal(size=(200, 3)) * 30
    near, normals, faces = surface.closest(points)
    away = np.linalg.norm(points - near, axis=1)
    np.testing.assert_allclose(away, to_triangles(points, corners), atol=1e-10)
    assert surface.distance(near).max() < 1e-10
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1)
    heights = ((near - corners[faces, 0]) * normals).sum(axis=1)
    np.testing.assert_allclose(heights, 0, atol=1e-9)


def test_triangles_without_width_are_lines():
    points = np.cumsum(SOURCE.normal(size=(300, 3)), axis=0)
    curve = Curve(points)
    places = SOURCE.normal(size=(500, 3)) * 20
    expected = to_segments(places, points[:-1], points[1:])
    np.testing.assert_allclose(curve.distance(places), expected, atol=1e-10)
    near, tangents, pieces = curve.closest(places)
    along = near - points[pieces]
    assert np.linalg.norm(np.cross(along, tangents), axis=1).max() < 1e-9


def test_a_plane_has_no_end():
    plane = Plane.of([0, 0, 5], [0, 0, 2])
    near, normals, _ = plane.closest(np.array([[1000.0, 0, 9], [0, -3, 1]]))
    np.testing.assert_allclose(near, [[1000, 0, 5], [0, -3, 5]])
    np.testing.assert_allclose(normals, [[0, 0, 1]] * 2)
    turned = plane.placed(Place(np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]), np.ones(3)))
    np.testing.assert_allclose(turned.closest(np.zeros((1, 3)))[0], [[0, -4, 0]])


def test_what_is_not_finite_has_no_closest_point():
    box = trimesh.creation.box()
    near, normals, faces = Surface(box.vertices, box.faces).closest([[np.nan, 0, 0], [0, 0, 9]])
    assert np.isnan(near[0]).all()
    assert np.isnan(normals[0]).all()
    assert faces[0] == -1
    np.testing.assert_allclose(near[1, 2], 0.5)


def test_inside_is_what_a_closed_surface_goes_around():
    box = trimesh.creation.box((2, 2, 2))
    other = trimesh.creation.box((2, 2, 2))
    other.apply_translation([1, 0, 0])  # the bodies overlap
    hollow = trimesh.creation.box((1, 1, 1))
    hollow.invert()
    # Places above corners, edges and faces, too.
    points = SOURCE.integers(-8, 9, (4000, 3)) / 4
    points[:2000] += SOURCE.normal(size=(2000, 3)) / 7
    for parts, inside in (
        ([box], lambda p: (abs(p) < 1).all(axis=1)),
        ([box, hollow], lambda p: (abs(p) < 1).all(axis=1) & (abs(p) > 0.5).any(axis=1)),
        ([box, other], lambda p: (abs(p) < 1).all(axis=1) | (abs(p - [1, 0, 0]) < 1).all(axis=1)),
    ):
        mesh = trimesh.util.concatenate(parts)
        surface = Surface(mesh.vertices, mesh.faces)
        off = surface.distance(points) > 1e-9
        np.testing.assert_array_equal(surface.inside(points)[off], inside(points)[off])
        signed = surface.signed_distance(points)
        np.testing.assert_array_equal(signed[off] < 0, inside(points)[off])


def test_an_open_surface_has_no_inside():
    box = trimesh.creation.box()
    surface = Surface(box.vertices, box.faces[1:])
    assert not surface.closed
    with pytest.raises(InputError, match="not closed"):
        surface.signed_distance(np.zeros((1, 3)))


def test_nothing_is_no_surface_and_a_point_no_curve():
    with pytest.raises(InputError, match="at least one triangle"):
        Surface(np.zeros((3, 3)), np.zeros((0, 3), int))
    with pytest.raises(InputError, match="at least two points"):
        Curve(np.zeros((1, 3)))

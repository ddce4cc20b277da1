"""Surfaces with fewer triangles: near to what they were, sharp where they were, and holes told."""

import numpy as np
import pytest
import trimesh

from simulearn.errors import InputError
from simulearn.surfaces import Surface, mended_surface, simplified


def dish(count):
    """A dish with so many squares a side, 160 mm wide."""
    x, y = np.meshgrid(*[np.linspace(-80, 80, count + 1)] * 2)
    k = np.arange(x.size).reshape(x.shape)
    a, b, c, d = k[:-1, :-1], k[:-1, 1:], k[1:, 1:], k[1:, :-1]
    faces = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    return np.c_[x.ravel(), y.ravel(), (12 * np.cos(x / 40) + y**2 / 300).ravel()], faces


def test_a_small_surface_stays_itself():
    surface = mended_surface(*dish(10))
    assert simplified(surface, 200) == (surface, 0.0)


def test_a_curved_surface_stays_near_and_keeps_its_rim():
    surface = mended_surface(*dish(120))
    small, apart = simplified(surface, 3000)
    assert 1500 < len(small.faces) <= 3000
    assert apart < 0.05
    np.testing.assert_allclose(small.box, surface.box, atol=0.05)
    # What it says of its distance holds for places that it has not looked at.
    places = surface.vertices[surface.faces].mean(axis=1)
    assert small.distance(places).max() < apart + 0.02
    coarse, farther = simplified(surface, 300)
    assert len(coarse.faces) <= 300
    assert apart < farther < 2


def test_a_box_keeps_its_edges_and_corners_and_stays_closed():
    mesh = trimesh.creation.box((100, 80, 30))
    for _ in range(4):
        mesh = mesh.subdivide()
    surface = mended_surface(mesh.vertices, mesh.faces)
    small, apart = simplified(surface, 1000)
    assert len(small.faces) <= 1000 < len(surface.faces)
    assert apart < 1e-6
    assert small.closed


def test_of_crumbs_nothing_is_left():
    rng = np.random.default_rng(3)
    corners = rng.uniform(-100, 100, (500, 1, 3)) + rng.uniform(-0.01, 0.01, (500, 3, 3))
    surface = Surface(corners.reshape(-1, 3), np.arange(1500).reshape(-1, 3))
    with pytest.raises(InputError, match="nothing is left"):
        simplified(surface, 100)


def test_holes_are_told_with_their_places_and_a_rim_is_none():
    vertices, faces = dish(12)
    whole = mended_surface(vertices, faces)
    assert whole.warnings == ()
    gone = [[130, 131], [10, 11]]  # in the middle, and at the rim, where it is a notch
    surface = mended_surface(vertices, np.delete(faces, gone[0] + gone[1], axis=0))
    (message,) = surface.warnings
    assert message.code == "surface-holes"
    assert "a hole" in message.message
    middle = vertices[faces[gone[0]]].mean(axis=(0, 1))
    np.testing.assert_allclose(surface.places["surface-holes"], [middle], atol=2)
    inches = surface.scaled(25.4).places["surface-holes"]
    np.testing.assert_allclose(inches, [25.4 * middle], atol=51)
    two = mended_surface(vertices, np.delete(faces, [*gone[0], 200, 201], axis=0))
    assert "2 holes" in two.warnings[0].message

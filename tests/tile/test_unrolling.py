"""Triangle meshes: patches and tubes get parameters; what has none is reported."""

import numpy as np
import pytest
import trimesh

from simulearn.errors import InputError
from simulearn.surfaces import Surface
from simulearn.surfaces.mending import mended
from simulearn.tile import from_chart, heights, revolution, unrolled
from simulearn.tile.patches import sampled


def surface_of(vertices, faces):
    vertices, faces, _ = mended(np.asarray(vertices, float), np.asarray(faces))
    return Surface(vertices, faces)


def elbow(rings=24, sides=40):
    """A tube around a quarter of a circle."""
    t, p = np.meshgrid(
        np.linspace(0, np.pi / 2, rings), 2 * np.pi * np.arange(sides) / sides, indexing="ij"
    )
    radius = 200 + 60 * np.cos(p)
    points = np.stack([radius * np.cos(t), radius * np.sin(t), 60 * np.sin(p)], axis=-1)
    k = np.arange(rings * sides).reshape(rings, sides)
    a, b = k[:-1], k[1:]
    faces = [[a, b, np.roll(b, -1, axis=1)], [a, np.roll(b, -1, axis=1), np.roll(a, -1, axis=1)]]
    return surface_of(
        points.reshape(-1, 3),
        np.concatenate([np.stack(some, axis=-1).reshape(-1, 3) for some in faces]),
    )


def test_a_patch_has_the_parameters_of_its_heights():
    chart = heights(lambda x, y: 40 * np.cos(x / 150) * np.cos(y / 120), (-150, 150), (-100, 100))
    mesh = sampled(chart)
    found = from_chart(unrolled(mesh), (3, 2), (2, 2), mesh)
    known = from_chart(chart, (3, 2))
    np.testing.assert_allclose(found.points, known.points, atol=3.0)
    assert (found.normals * known.normals).sum(axis=1).min() > 0.99


def test_a_tube_goes_around_once_with_its_outside_outwards():
    mesh = sampled(revolution([[84, 0], [70, 150], [96, 300]]))
    mesh = surface_of(mesh.vertices, mesh.faces)
    tiling = from_chart(unrolled(mesh), (5, 3), (2, 2), mesh)
    assert len(tiling.points) == 10 * 7
    rings = tiling.points.reshape(7, 10, 3)
    assert np.ptp(rings[..., 2], axis=1).max() < 1.0
    sides = np.linalg.norm(rings - np.roll(rings, 1, axis=1), axis=-1)
    assert (sides.max(axis=1) / sides.min(axis=1)).max() < 1.02
    assert (tiling.normals[:, :2] * tiling.points[:, :2]).sum(axis=1).min() > 0


def test_a_bent_tube_has_no_axis_and_is_tiled_all_the_same():
    mesh = elbow()
    tiling = from_chart(unrolled(mesh), (4, 3), (2, 2), mesh)
    assert len(tiling.points) == 8 * 7
    assert mesh.distance(tiling.points).max() < 1e-6
    rings = tiling.points.reshape(7, 8, 3)
    middle = rings.mean(axis=1)
    assert np.abs(np.linalg.norm(middle, axis=1) - 200).max() < 15
    assert ((rings - middle[:, None]) * tiling.normals.reshape(7, 8, 3)).sum(axis=-1).min() > 0


@pytest.mark.parametrize(
    ("mesh", "words"),
    [
        (trimesh.creation.icosphere(2, 50.0), "is closed and has no rim"),
        (trimesh.creation.annulus(20.0, 50.0, 30.0), "has a handle|is closed"),
        (
            trimesh.util.concatenate(
                [
                    trimesh.creation.icosphere(1),
                    trimesh.creation.icosphere(1).apply_translation([5, 0, 0]),
                ]
            ),
            "is in 2 pieces",
        ),
    ],
    ids=["ball", "ring", "two"],
)
def test_what_is_neither_is_reported(mesh, words):
    with pytest.raises(InputError, match=words):
        unrolled(surface_of(mesh.vertices, mesh.faces))

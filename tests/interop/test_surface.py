"""Surfaces: closed, facing outwards, in the units and the colours that their formats ask for."""

import numpy as np
import pytest
import trimesh

import synthetic
from simulearn.interop import write_surface

RESULT = synthetic.result()


def glb(tmp_path, result=RESULT):
    path = tmp_path / "a.glb"
    write_surface(result, path)
    return trimesh.load(path)


@pytest.mark.parametrize("solid", [True, False])
def test_stl_is_one_closed_body_in_millimetres(tmp_path, solid):
    result = synthetic.result(bend=synthetic.cylinder, solid=solid)
    path = tmp_path / "a.stl"
    write_surface(result, path)
    body = trimesh.load(path)
    assert body.is_watertight
    assert body.is_winding_consistent
    # The volume is positive where faces look outwards.
    assert body.volume == pytest.approx(4.0 * 7.2 * (9 * 7.2 + 12 * 57.8), rel=0.01)
    corners = np.concatenate([result.joints[-1].reshape(-1, 3), result.beams[-1].reshape(-1, 3)])
    np.testing.assert_allclose(body.bounds, [corners.min(0), corners.max(0)], atol=0.05)


def test_glb_is_in_metres_with_y_up(tmp_path):
    scene = glb(tmp_path)
    low, high = RESULT.joints[-1].reshape(-1, 3).min(0), RESULT.joints[-1].reshape(-1, 3).max(0)
    morphed = np.concatenate([g.vertices for n, g in scene.geometry.items() if n != "flat"])
    np.testing.assert_allclose(1000 * morphed.min(0), [low[0], low[2], -high[1]], atol=0.05)
    np.testing.assert_allclose(1000 * morphed.max(0), [high[0], high[2], -low[1]], atol=0.05)
    flat = scene.geometry["flat"].vertices
    assert 1000 * abs(flat[:, 1]).max() == pytest.approx(2.0, abs=1e-4)


def test_glb_has_a_mesh_for_each_tone(tmp_path):
    scene = glb(tmp_path)
    names = {"passive", "top 0.25", "bottom 1", "joint", "fixed joint", "flat"}
    assert set(scene.geometry) == names
    colours = {n: tuple(g.visual.material.baseColorFactor) for n, g in scene.geometry.items()}
    assert len(set(colours.values())) == len(names)
    assert all(g.visual.material.metallicFactor == 0 for g in scene.geometry.values())
    red, _, blue = colours["top 0.25"][:3]
    assert red > blue
    red, _, blue = colours["bottom 1"][:3]
    assert blue > red
    assert colours["flat"][3] < 255


def test_glb_is_smooth_along_beams_and_sharp_across(tmp_path):
    rolled = glb(tmp_path, synthetic.result(bend=synthetic.cylinder)).geometry["passive"]
    # A triangle's corners have different normals where the beam bends ...
    turned = rolled.vertex_normals[rolled.faces]
    assert np.linalg.norm(turned[:, 0] - turned[:, 1], axis=1).max() > 0.02
    # ... yet none is far from the triangle's own.
    own = np.einsum("fi,fki->fk", rolled.face_normals, turned)
    assert own.min() > 0.99


def test_endings_may_be_capitals(tmp_path):
    write_surface(RESULT, tmp_path / "a.STL")
    assert trimesh.load(tmp_path / "a.STL", file_type="stl").is_watertight

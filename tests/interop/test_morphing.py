"""GLB that morphs: what the validator of Khronos says, and what a second reader finds in it."""

import json

import bent
import numpy as np
import pygltflib
import pytest
import trimesh

import synthetic
from simulearn.errors import Message
from simulearn.interop import write_morph, write_surface
from simulearn.simulate import FRAMES, skin

KINDS = bent.kinds()
RESULT = bent.result(KINDS["star"])


def values(file, number):
    """Return an accessor's array, and check its bounds."""
    accessor = file.accessors[number]
    view = file.bufferViews[accessor.bufferView]
    kind = {5126: "<f4", 5125: "<u4"}[accessor.componentType]
    width = {"SCALAR": 1, "VEC3": 3}[accessor.type]
    data = file.binary_blob()[view.byteOffset : view.byteOffset + view.byteLength]
    array = np.frombuffer(data, kind).reshape(accessor.count, width)
    if accessor.min:
        np.testing.assert_array_equal(array.min(0), np.array(accessor.min, kind))
        np.testing.assert_array_equal(array.max(0), np.array(accessor.max, kind))
    return array.astype(float)


def written(tmp_path, result=RESULT):
    path = tmp_path / "a.morph.glb"
    write_morph(result, path)
    return pygltflib.GLTF2().load(str(path))


def shape_at(file, time):
    """Return the vertices (n, 3) and normals at a time, as a viewer plays the animation."""
    (animation,) = file.animations
    (sampler,) = animation.samplers
    times = values(file, sampler.input)[:, 0]
    weights = values(file, sampler.output).reshape(len(times), FRAMES - 1)
    now = np.array([np.interp(time, times, column) for column in weights.T])
    assert {c.target.node for c in animation.channels} == set(range(len(file.nodes)))
    places, normals = [], []
    for mesh in file.meshes:
        (primitive,) = mesh.primitives
        for name, found in (("POSITION", places), ("NORMAL", normals)):
            base = values(file, getattr(primitive.attributes, name))
            deltas = [values(file, target[name]) for target in primitive.targets]
            found.append(base + np.einsum("k,kvx->vx", now, deltas))
    return np.concatenate(places), np.concatenate(normals)


@pytest.mark.parametrize("name", ["honeycomb", "with gaps 2"])
@pytest.mark.parametrize("writer", [write_morph, write_surface])
def test_the_validator_finds_nothing(tmp_path, validated, writer, name):
    path = tmp_path / "a.glb"
    writer(bent.result(KINDS[name], solid=True), path)
    issues = validated(path)
    assert issues["numErrors"] == issues["numWarnings"] == 0, issues["messages"]


def test_an_actuator_that_all_but_reaches_the_ends_leaves_no_slivers(tmp_path, validated):
    grid = synthetic.square_grid((1, 1), actuators=[1 - 1e-9, -(1 - 1e-12), 1.0, -0.5])
    path = tmp_path / "a.glb"
    write_morph(bent.result(grid), path)
    assert validated(path)["numErrors"] == 0
    assert len(skin(bent.result(grid)).quads) < 2000


def test_each_frame_is_reached_in_turn_in_metres_with_y_up(tmp_path):
    file = written(tmp_path)
    times = values(file, file.animations[0].samplers[0].input)[:, 0]
    assert len(times) == FRAMES + 2
    for frame in range(FRAMES):
        places, normals = shape_at(file, times[frame + 1])
        x, up, south = 1000 * places.T
        seen = np.stack([x, -south, up], axis=1)
        corners = np.concatenate(
            [RESULT.joints[frame].reshape(-1, 3), RESULT.beams[frame].reshape(-1, 3)]
        )
        away = np.linalg.norm(corners[:, None] - seen, axis=2).min(axis=1)
        assert away.max() < 1e-3
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-5)
    # Still at both ends.
    for two in (times[:2], times[-2:]):
        np.testing.assert_array_equal(*(shape_at(file, time)[0] for time in two))


def test_between_two_frames_vertices_move_on_straight_lines(tmp_path):
    file = written(tmp_path)
    times = values(file, file.animations[0].samplers[0].input)[:, 0]
    a, b = (shape_at(file, time)[0] for time in times[5:7])
    np.testing.assert_allclose(shape_at(file, times[5:7].mean())[0], (a + b) / 2, atol=1e-7)


def test_a_mesh_for_each_tone_with_all_frames_as_named_targets(tmp_path):
    file = written(tmp_path)
    names = [mesh.name for mesh in file.meshes]
    assert len(set(names)) == len(names)
    assert {"joint", "fixed joint", "passive", "bottom 1", "top 0.4"} <= set(names)
    assert [m.name for m in file.materials] == names
    for mesh in file.meshes:
        assert len(mesh.primitives[0].targets) == len(mesh.weights) == FRAMES - 1
        assert mesh.extras["targetNames"][-1] == "after creep"
    assert file.extensionsUsed in (None, [])


def test_what_qualifies_the_answer_stands_in_the_file(tmp_path):
    result = synthetic.result(solid=False)
    warned = Message("far", "beam 3", "unlike what the model has learnt")
    result = type(result)(**{**vars(result), "warnings": (warned,), "bound_mm": 0.8})
    extras = written(tmp_path, result).asset.extras
    assert extras["engine"] == "synthetic"
    assert extras["bound_mm"] == 0.8
    assert extras["warnings"][0]["message"] == warned.message
    assert extras["material"]["name"] == "pla-hot-water"
    assert json.dumps(extras["frames"])[:8] == '["flat",'
    path = tmp_path / "still.glb"
    write_surface(result, path)
    assert trimesh.load(path).metadata["bound_mm"] == 0.8


def test_files_are_of_a_reasonable_size(tmp_path):
    path = tmp_path / "a.morph.glb"
    write_morph(bent.result(synthetic.square_grid((6, 6))), path)
    assert path.stat().st_size < 6e6

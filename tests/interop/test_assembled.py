"""An assembly as GLB: what the validator says, and where a viewer that plays it has its parts."""

import numpy as np
import pygltflib
import pytest
import trimesh
from scipy.spatial.transform import Rotation
from test_morphing import values

import assembling
from simulearn.assembly import Assembly, Obstacle, Part, simulate_assembly
from simulearn.interop import write_assembled
from simulearn.interop.morphing import PAUSE
from simulearn.schedule import FRAMES


@pytest.fixture(scope="module")
def assembled(tmp_path_factory):
    wall = tmp_path_factory.mktemp("wall") / "wall.stl"
    trimesh.creation.box((10, 10, 10)).export(wall)
    around = (Obstacle("wall", wall, assembling.at(0, 0, 90)),)
    return simulate_assembly(assembling.three(obstacles=around), assembling.Rolling())


@pytest.fixture(scope="module")
def path(assembled, tmp_path_factory):
    path = tmp_path_factory.mktemp("glb") / "a.glb"
    write_assembled(assembled, path)
    return path


def sampled(file, node, name, time):
    """Return a property of a node at a time, as a viewer plays it."""
    (animation,) = file.animations
    for channel in animation.channels:
        if (channel.target.node, channel.target.path) == (node, name):
            sampler = animation.samplers[channel.sampler]
            times = values(file, sampler.input)[:, 0]
            rows = values(file, sampler.output).reshape(len(times), -1)
            return np.array([np.interp(time, times, column) for column in rows.T])
    assert name == "translation"
    return np.array(file.nodes[node].translation)


def placed(file, node, time):
    """Return where the vertices (n, 3) of a node are at a time, mm, +z up."""
    weights = sampled(file, node, "weights", time)
    points = []
    for primitive in file.meshes[file.nodes[node].mesh].primitives:
        base = values(file, primitive.attributes.POSITION)
        deltas = [values(file, target["POSITION"]) for target in primitive.targets]
        points.append(base + np.einsum("k,kvx->vx", weights, deltas))
    turn = Rotation.from_quat(file.nodes[node].rotation)
    x, up, south = (
        1000 * (turn.apply(np.concatenate(points)) + sampled(file, node, "translation", time)).T
    )
    return np.stack([x, -south, up], axis=1)


def test_the_validator_finds_nothing(path, validated):
    issues = validated(path)
    assert issues["numErrors"] == issues["numWarnings"] == issues["numInfos"] == 0


def test_parts_are_where_the_timeline_has_them(path, assembled):
    file = pygltflib.GLTF2().load(str(path))
    moments = assembled.timeline
    for time in (0.0, 0.4, 1.0, 2.3, 3.7, moments.seconds):
        _, frames, shifts = moments.at(time)
        for k, part, result in assembled.present:
            before = min(int(frames[k]), FRAMES - 2)
            share = frames[k] - before
            corners = (1 - share) * result.joints[before] + share * result.joints[before + 1]
            wanted = part.place(corners.reshape(-1, 3)) + shifts[k]
            found = placed(file, k, PAUSE + time)
            away = np.linalg.norm(wanted[:, None] - found, axis=2).min(axis=1)
            assert away.max() < 1e-3, (time, part.name)


def test_equal_grids_share_arrays_but_no_mesh_and_keys_are_few(path, assembled):
    file = pygltflib.GLTF2().load(str(path))
    assert [node.name for node in file.nodes] == ["first", "second", "ready", "wall"]
    assert [node.mesh for node in file.nodes] == [0, 1, 2, 3]
    same, other, _, _ = ([p.attributes.POSITION for p in mesh.primitives] for mesh in file.meshes)
    assert same == other
    # Two morph, one of them slides; the shape of the one that is ready is held.
    (animation,) = file.animations
    assert {(c.target.node, c.target.path) for c in animation.channels} == {
        (0, "weights"),
        (1, "weights"),
        (1, "translation"),
        (2, "weights"),
    }
    slide = next(c for c in animation.channels if c.target.path == "translation")
    times = values(file, animation.samplers[slide.sampler].input)[:, 0]
    np.testing.assert_allclose(times, [0, PAUSE + 1, PAUSE + 3, 2 * PAUSE + 5], atol=1e-6)
    assert file.meshes[0].extras["targetNames"][-1] == "after creep"
    assert file.asset.extras["steps"] == ["first", "in"]


def test_a_part_without_a_result_is_left_out_and_named(tmp_path, validated):
    parts = (Part("a", assembling.NARROW), Part("bad", assembling.BROKEN))
    path = tmp_path / "a.glb"
    write_assembled(simulate_assembly(Assembly(parts), assembling.Rolling()), path)
    assert validated(path)["numErrors"] == 0
    assert pygltflib.GLTF2().load(str(path)).asset.extras["without"] == ["bad"]

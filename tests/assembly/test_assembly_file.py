"""The assembly file: what is written is read, and what is wrong is one line with its place."""

import json

import numpy as np
import pytest
import trimesh

import assembling
from simulearn.assembly import (
    Assembly,
    Obstacle,
    Part,
    Step,
    assembly_from_dict,
    read_assembly,
    write_assembly,
)
from simulearn.errors import InputError
from simulearn.grid import write_grid
from simulearn.rigid import Place


@pytest.fixture
def folder(tmp_path):
    write_grid(assembling.SQUARE, tmp_path / "square.json")
    trimesh.creation.box((10, 10, 10)).export(tmp_path / "wall.stl")
    return tmp_path


def written(folder):
    """Return the contents of a file with parts of every kind."""
    file = folder / "square.json"
    parts = (
        Part("a", assembling.SQUARE, assembling.at(1, 2, 3), file=file),
        Part("b", assembling.SQUARE, Place.about_z(30), copy_of="a"),
        Part("c", assembling.NARROW),
    )
    steps = (Step(("a",), name="first"), Step(("b",), 2.0, {"b": (0, 0, 5.0)}, "during"))
    obstacles = (Obstacle("wall", folder / "wall.stl", assembling.at(9), "cm"),)
    assembly = Assembly(parts, steps, obstacles, (("a", "b"),), 2.5, "three")
    write_assembly(assembly, folder / "assembly.json")
    return assembly, json.loads((folder / "assembly.json").read_text())


def test_what_is_written_is_read(folder):
    assembly, data = written(folder)
    read = read_assembly(folder / "assembly.json")
    assert (read.name, read.joined, read.joined_mm) == ("three", (("a", "b"),), 2.5)
    assert read.steps == assembly.steps
    assert [p.name for p in read.parts] == ["a", "b", "c"]
    for mine, theirs in zip(read.parts, assembly.parts, strict=True):
        assert mine.grid.digest == theirs.grid.digest
        assert mine.copy_of == theirs.copy_of
        np.testing.assert_allclose(mine.place.turn, theirs.place.turn, atol=1e-8)
        np.testing.assert_allclose(mine.place.shift, theirs.place.shift, atol=1e-8)
    (wall,) = read.obstacles
    assert (wall.name, wall.unit, wall.file.name) == ("wall", "cm", "wall.stl")
    assert [part.get("grid") for part in data["parts"][:2]] == ["square.json", None]
    assert read.distinct == (0, 0, 2)  # equal grids, whether or not one is called a copy


def test_paths_are_from_the_file_wherever_it_is(folder, monkeypatch):
    written(folder)
    (folder / "deeper").mkdir()
    assembly = read_assembly(folder / "assembly.json")
    write_assembly(assembly, folder / "deeper" / "moved.json")
    data = json.loads((folder / "deeper" / "moved.json").read_text())
    assert data["parts"][0]["grid"] == "../square.json"
    assert data["obstacles"][0]["file"] == "../wall.stl"
    monkeypatch.chdir(folder / "deeper")
    assert read_assembly("moved.json").distinct == (0, 0, 2)


def test_without_steps_all_parts_morph_at_once():
    (step,) = Assembly((Part("a", assembling.SQUARE), Part("b", assembling.NARROW))).order
    assert step.parts == ("a", "b")


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        (["schema"], "simulearn.grid/1", 'schema is "simulearn.grid/1"; this program reads'),
        (["parts"], [], "parts is []; parts are a list"),
        (["colour"], 1, "colour is not a key here; the keys are schema, name, parts"),
        (["parts", 0, "grid"], 3, "parts[0].grid is 3; a grid is the path of a grid file"),
        (["parts", 0, "grid"], "nix.json", "nix.json: there is no such file"),
        (["parts", 0, "grid"], None, "parts[0].grid is missing; a grid is the path"),
        (["parts", 1, "grid"], "square.json", "parts[1].grid stands beside copy_of"),
        (["parts", 1, "copy_of"], "z", 'parts[1].copy_of is "z"; parts with a grid of their own'),
        (["parts", 1, "name"], "a", 'parts[1].name is "a" again'),
        (["parts", 2, "grid", "fixed"], 99, "parts[2].grid: fixed is 99; joints are numbered"),
        (["parts", 0, "place", "turn"], [[1, 0, 0], [0, 1, 0], [0, 0, -1]], "turn is no rotation"),
        (
            ["parts", 0, "place", "turn"],
            [[1, 0], [0, 1]],
            "parts[0].place.turn[0] is [1, 0]; a turn",
        ),
        (["parts", 0, "place", "shift", 1], "x", 'parts[0].place.shift[1] is "x"; a shift is'),
        (["parts", 0, "place", "move"], 1, "move is not a key here; the keys are turn, shift"),
        (["steps", 0, "parts"], ["z"], 'steps[0].parts[0] is "z"; the parts are a, b, c'),
        (["steps", 0, "parts"], [], "steps[0] names no part"),
        (["steps", 1, "parts"], ["a"], 'steps[1].parts[0] is "a" again, after steps[0].parts[0]'),
        (["steps", 0, "seconds"], 0, "steps[0].seconds is 0; seconds are a number"),
        (["steps", 1, "slide", "b"], [0, 1], "steps[1].slide.b is [0, 1]; a slide has"),
        (["steps", 1, "sliding"], "after", 'steps[1].sliding is "after"; sliding is'),
        (["obstacles", 0, "file"], None, "obstacles[0].file is null; a file is the path"),
        (["obstacles", 0, "name"], "a", 'obstacles[0].name is "a", as that of a part'),
        (["joined", 0], ["a", "a"], 'joined[0] is ["a", "a"]; a pair is two parts'),
        (["joined_mm"], -1, "joined_mm is -1; joined_mm is a depth"),
    ],
)
def test_what_is_wrong_is_one_line_with_its_place(folder, path, value, message):
    _, data = written(folder)
    inner = data
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]] = value
    with pytest.raises(InputError) as caught:
        assembly_from_dict(data, folder)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)
    assert caught.value.where


def test_a_copy_is_of_an_original_with_the_same_grid():
    a, b = Part("a", assembling.SQUARE), Part("b", assembling.SQUARE, copy_of="a")
    for other, message in (
        (Part("c", assembling.SQUARE, copy_of="b"), 'copy_of is "b", a copy itself'),
        (Part("c", assembling.NARROW, copy_of="a"), 'copy_of is "a", whose grid is another one'),
    ):
        with pytest.raises(InputError, match=message):
            Assembly((a, b, other))


def test_places_that_were_rounded_are_rotations_again(folder):
    _, data = written(folder)
    data["parts"][1]["place"]["turn"] = np.round(Place.about_z(30).turn, 5).tolist()
    turn = assembly_from_dict(data, folder).parts[1].place.turn
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-14)


def test_data_that_no_file_may_be_opened_for_has_no_paths(folder):
    _, data = written(folder)
    with pytest.raises(InputError, match="is a path; here a grid is an object"):
        assembly_from_dict(data)

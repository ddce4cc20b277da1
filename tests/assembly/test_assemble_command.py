"""The command assemble: files by their endings, tables, failures, and what is wrong."""

import json

import pygltflib
import pytest
import trimesh
from PIL import Image

import assembling
from simulearn.assembly import Assembly, Obstacle, Part, Step, write_assembly
from simulearn.simulate import engines


@pytest.fixture
def rolling(monkeypatch):
    monkeypatch.setattr("simulearn.simulate.engine", lambda *words: assembling.Rolling())


@pytest.fixture
def file(tmp_path):
    wall = tmp_path / "wall.stl"
    trimesh.creation.box((10, 10, 10)).export(wall)
    around = (Obstacle("wall", wall, assembling.at(0, 0, 300)),)
    path = tmp_path / "three.json"
    write_assembly(assembling.three(0.2, obstacles=around, name="three"), path)
    return path


def test_an_assembly_is_written_in_every_format(run, rolling, file, tmp_path):
    targets = [tmp_path / f"a{e}" for e in (".json", ".png", ".strip.png", ".glb", ".gif")]
    words = [word for path in targets for word in ("-o", path)]
    code, out, _ = run("assemble", file, "--view", -50, 30, *words)
    assert code == 0
    assert "first" in out
    assert f"wrote {targets[-1]}" in out
    assert json.loads(targets[0].read_text())["schema"] == "simulearn.assembled/1"
    assert pygltflib.GLTF2().load(str(targets[3])).nodes[0].name == "first"
    for path in (targets[1], targets[2], targets[4]):
        with Image.open(path) as picture:
            assert picture.width > 500


def test_the_machine_form_is_printed(run, rolling, file):
    code, out, err = run("assemble", file, "--json")
    assert (code, err) == (0, "")
    data = json.loads(out)
    assert [part["name"] for part in data["parts"]] == ["first", "second", "ready"]
    assert data["timeline"]["seconds"] == pytest.approx(1)


def test_a_failed_part_is_named_and_the_others_are_written(run, rolling, tmp_path):
    parts = (Part("good", assembling.SQUARE), Part("bad", assembling.BROKEN))
    write_assembly(Assembly(parts, (Step(("good",)),)), tmp_path / "a.json")
    code, _, err = run("assemble", tmp_path / "a.json", "-o", tmp_path / "a.png")
    assert code == 3
    assert "part bad: there is no answer" in err
    assert (tmp_path / "a.png").exists()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["nowhere.json"], "nowhere.json: there is no such file"),
        (["{file}", "-o", "a.xyz"], "a.xyz: the ending is not one of .json .png"),
        (["{file}", "-o", "{file}"], "is what is read"),
        (["{file}", "--engine", "guess"], "guess"),
        (["{file}", "--view", "nan", "0"], "--view is nan 0; it is two angles in degrees"),
    ],
)
def test_what_is_wrong_is_one_line(run, file, words, message):
    code, out, err = run("assemble", *(word.format(file=file) for word in words))
    assert (code, out) == (1, "")
    assert message in err
    assert err.count("\n") == 1


def test_a_wrong_unit_of_an_obstacle_is_named(run, file):
    data = json.loads(file.read_text())
    data["obstacles"][0]["unit"] = "parrots"
    file.write_text(json.dumps(data))
    code, _, err = run("assemble", file)
    assert code == 1
    assert 'obstacles[0].unit is wrong: "parrots" is no unit of length' in err
    assert "--unit" not in err


def test_an_obstacle_is_not_written_over(run, file):
    wall = file.with_name("wall.glb")
    trimesh.creation.box((10, 10, 10)).export(wall)
    file.write_text(file.read_text().replace("wall.stl", "wall.glb"))
    before = wall.read_bytes()
    code, _, err = run("assemble", file, "-o", wall)
    assert code == 1
    assert "wall.glb: is what is read; name another file" in err
    assert wall.read_bytes() == before


def test_a_missing_obstacle_is_said_before_anything_is_simulated(run, file, monkeypatch):
    (file.parent / "wall.stl").unlink()
    monkeypatch.setattr(engines.Engine, "simulate", pytest.fail)
    code, _, err = run("assemble", file)
    assert code == 1
    assert "obstacles[0].file: " in err

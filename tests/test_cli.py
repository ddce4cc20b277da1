"""The command line as a user runs it: what is printed, what is written, and the exit code."""

import dataclasses
import errno
import gc
import io
import json
import logging
import os
import signal
import subprocess
import sys
import time
import warnings
from contextlib import contextmanager
from pathlib import Path

import meshio
import numpy as np
import pytest
import trimesh
from PIL import Image
from rich.console import Console

import synthetic
from simulearn import __version__, cli
from simulearn.errors import ComputationError
from simulearn.grid import grid_from_dict, grid_to_dict, library, make, read_grid
from simulearn.material import read_material
from simulearn.material.reading import HERE
from simulearn.outputs import FILMS, WRITERS
from simulearn.schedule import Snap
from simulearn.simulate import ENGINES, read_json, read_npz
from simulearn.simulate.engines import Engine

SADDLE = grid_to_dict(make("saddle"))
ENDINGS = [ending[1:] for ending in WRITERS if ending not in (*FILMS, ".html")]


@pytest.fixture
def solved(monkeypatch):
    """Let a formula stand in for finite elements; return the grids that it was asked for."""
    grids = []

    def solver(grid, material, progress, cancel):
        grids.append(grid)
        progress(12, 12)
        return synthetic.result(grid)

    monkeypatch.setitem(ENGINES, "fea", lambda: Engine("fea", solver))
    return grids


@pytest.fixture
def failing(monkeypatch):
    """Return a function that makes the solver raise an error."""

    def fail(error):
        def solver(grid, material, progress, cancel):
            raise error

        monkeypatch.setitem(ENGINES, "fea", lambda: Engine("fea", solver))

    return fail


def refused(answer, code=1):
    """Return the one line on stderr of a run that failed."""
    assert answer[0] == code, answer
    assert answer[1] == ""
    (line,) = answer[2].splitlines()
    return line


def written(folder):
    return sorted(path.name for path in folder.iterdir())


# simulate


@pytest.mark.usefixtures("solved")
def test_simulate_prints_where_the_joints_go(run):
    code, out, err = run("simulate", "saddle")
    assert (code, err) == (0, "")
    assert "dimension 91.9 mm" in out
    assert "largest " in out
    assert "33 iterations" in out
    assert "fixed 4" in out


@pytest.mark.usefixtures("solved")
def test_simulate_writes_every_format_at_once(run, tmp_path):
    files = [tmp_path / f"saddle.{ending}" for ending in ENDINGS]
    code, out, err = run("simulate", "saddle", *(word for f in files for word in ("-o", f)))
    assert (code, err) == (0, "")
    assert all(str(file) in out for file in files)  # whole, not broken to the terminal's width
    at = dict(zip(ENDINGS, files, strict=True))
    assert read_json(at["json"]).joints.shape == (12, 9, 8, 3)
    assert read_npz(at["npz"]).stress.shape == (12, 12, 4, 4, 6)
    with Image.open(at["png"]) as picture, Image.open(at["gif"]) as animation:
        assert min(picture.size) > 400
        assert animation.n_frames > 12
    for ending in ("glb", "morph.glb", "stl", "obj", "ply"):
        assert not trimesh.load(at[ending]).is_empty
    assert len(meshio.read(at["vtu"]).points) > 0
    assert written(tmp_path) == sorted([*(file.name for file in files), "saddle_frames"])
    assert len(written(tmp_path / "saddle_frames")) == 12


@pytest.mark.usefixtures("solved")
def test_simulate_gives_machines_the_result(run):
    code, out, err = run("simulate", "saddle", "--json")
    data = json.loads(out)
    assert (code, err) == (0, "")
    assert {"stable", "bound_mm", "snaps", "warnings", "material", "model"} <= set(data)
    assert (data["schema"], data["engine"]) == ("simulearn.result/1", "fea")
    assert np.shape(data["joints"]) == (12, 9, 8, 3)
    assert np.shape(data["beams"]) == (12, 12, 3, 4, 3)
    grid_from_dict(data["grid"])


@pytest.mark.usefixtures("solved")
def test_simulate_tells_machines_what_was_written(run, tmp_path):
    path = tmp_path / "a.npz"
    code, out, _ = run("simulate", "saddle", "--json", "-o", path)
    data = json.loads(out)
    assert code == 0
    assert data["files"] == [str(path)]
    assert data["summary"]["dimension_mm"] == pytest.approx(65 * 2**0.5)


def test_a_file_goes_before_a_library_name(run, solved, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("saddle").write_text(json.dumps(grid_to_dict(make("flat", (1, 1)))))
    assert run("simulate", "saddle")[0] == 0
    assert len(solved[0].joints) == 4


@pytest.mark.usefixtures("solved")
def test_warnings_are_shown_and_do_not_stop(run, tmp_path):
    path = tmp_path / "long.json"
    path.write_text(json.dumps(grid_to_dict(make("saddle", length=120))))
    code, _, err = run("simulate", path)
    assert code == 0
    (line,) = err.splitlines()  # of many alike, one line
    assert line == (
        "warning: beam 0 is 120.00 mm long; the limit is 100 mm "
        "(and 11 more: beams 1, 2, 3, 4, 5, 6, 7, 8, ...)"
    )
    assert len(json.loads(run("validate", path, "--json")[1])["warnings"]) == 12
    assert run("validate", path)[1].count("beam-long") == 1


@pytest.mark.usefixtures("solved")
def test_what_qualifies_an_answer_is_shown(run, monkeypatch):
    def solver(grid, material, progress, cancel):
        return dataclasses.replace(synthetic.result(grid), stable=False, snaps=(Snap(0.944, 10),))

    monkeypatch.setitem(ENGINES, "fea", lambda: Engine("fea", solver))
    code, out, err = run("simulate", "saddle")
    assert code == 0
    assert "unstable balance" in err
    assert "snaps at 94.4% released" in err
    assert "material pla-hot-water (" in out
    assert run("simulate", "saddle", "--json")[2] == ""


@pytest.mark.usefixtures("solved")
def test_a_terminal_says_once_that_something_is_prepared(run, monkeypatch):
    from simulearn import native

    @contextmanager
    def compiling(report):
        report()
        yield

    monkeypatch.setattr(native, "on_compile", compiling)
    assert run("simulate", "saddle")[2].count("once on this machine") == 1
    assert run("simulate", "saddle", "--json")[2] == ""


# simulate, many grids


@pytest.fixture
def choosy(monkeypatch):
    """Let a formula stand in for finite elements; it has no answer for grids of one cell."""

    def solver(grid, material, progress, cancel):
        if len(grid.joints) == 4:
            raise ComputationError("no equilibrium at 27 %", "no-equilibrium", "frame 3", "shorten")
        progress(12, 12)
        return synthetic.result(grid)

    monkeypatch.setitem(ENGINES, "fea", lambda: Engine("fea", solver))


@pytest.mark.usefixtures("choosy")
def test_many_grids_go_to_a_folder_and_a_failure_does_not_stop_the_others(run, tmp_path):
    folder, small, torn = tmp_path / "results", tmp_path / "small.json", tmp_path / "torn.json"
    small.write_text(json.dumps(grid_to_dict(make("flat", (1, 1)))))
    torn.write_text("{")
    words = ("simulate", "saddle", small, "cone", torn, "-o", f"{folder}/")
    code, out, err = run(*words)
    assert code == 3
    assert written(folder) == ["cone.json", "saddle.json", "small.json", "torn.json"]
    assert read_json(folder / "cone.json").grid.dimension > 0
    failure = json.loads((folder / "small.json").read_text())
    assert failure == {
        "schema": "simulearn.failure/1",
        "code": "no-equilibrium",
        "where": "frame 3",
        "message": "no equilibrium at 27 %",
        "hint": "shorten",
    }
    assert json.loads((folder / "torn.json").read_text())["schema"] == "simulearn.failure/1"
    assert out.count("failed (") == 2
    assert max(map(len, out.splitlines()[:-1])) <= 80
    assert "no equilibrium at 27 %; shorten" in err
    # For machines; without a folder everything is printed.
    code, out, err = run(*words, "--json")
    data = json.loads(out)
    assert (code, err, data["failed"]) == (3, "", 2)
    assert [row["name"] for row in data["results"]] == ["saddle", str(small), "cone", str(torn)]
    assert data["results"][0]["file"] == str(folder / "saddle.json")
    assert "joints" not in data["results"][0]
    data = json.loads(run("simulate", "saddle", "cone", "--json")[1])
    assert np.shape(data["results"][1]["joints"]) == (12, 9, 8, 3)


def test_many_good_grids_are_code_0(run, solved, tmp_path):
    assert run("simulate", "saddle", "-o", f"{tmp_path}/one/")[0] == 0
    assert written(tmp_path / "one") == ["saddle.json"]
    assert run("simulate", "saddle", "cone", "saddle", "-o", tmp_path / "two")[0] == 0
    assert written(tmp_path / "two") == ["cone.json", "saddle.json"]
    assert len(solved) == 3


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["saddle", "b/Saddle.json", "-o", "results/"], "would both be written to saddle.json"),
        (["saddle", "cone", "-o", "a.json"], "several grids go to one folder"),
        (["saddle", "cone", "-o", "a/", "-o", "b/"], "several grids go to one folder"),
        (["saddle", "cone", "-o", "b/Saddle.json/"], "cannot be made"),
    ],
)
def test_names_are_checked_before_many_are_computed(
    run, solved, tmp_path, monkeypatch, words, says
):
    monkeypatch.chdir(tmp_path)
    Path("b").mkdir()
    Path("b/Saddle.json").write_text(json.dumps(SADDLE))
    assert says in refused(run("simulate", *words))
    assert not solved


def test_an_interrupt_keeps_what_is_written(run, monkeypatch, tmp_path):
    def solver(grid, material, progress, cancel):
        if len(grid.joints) == 4:
            raise KeyboardInterrupt
        return synthetic.result(grid)

    monkeypatch.setitem(ENGINES, "fea", lambda: Engine("fea", solver, workers=1))
    small = tmp_path / "small.json"
    small.write_text(json.dumps(grid_to_dict(make("flat", (1, 1)))))
    code, _, _ = run("simulate", "saddle", small, "-o", f"{tmp_path}/out/")
    assert code == 130
    assert written(tmp_path / "out") == ["saddle.json"]


@pytest.fixture
def light(tmp_path):
    """The file of a material without weight."""
    path = tmp_path / "light.toml"
    text = (HERE / "pla-hot-water.toml").read_text("utf-8")
    text = text.replace("acceleration = 2182", "acceleration = 0")
    text = text.replace("beam_length = 100", "beam_length = 60")
    path.write_text(text.replace('name = "pla-hot-water"', 'name = "light [red]"'), "utf-8")
    return path


def test_another_material_replaces_the_grids_own(run, monkeypatch, tmp_path, light):
    materials = []

    def solver(grid, material, progress, cancel):
        materials.append(material)
        return synthetic.result(grid)

    monkeypatch.setitem(ENGINES, "fea", lambda: Engine("fea", solver))
    monkeypatch.setattr("simulearn.inverse.search.warm", lambda engine: None)
    small, task = tmp_path / "small.json", tmp_path / "task.json"
    grid = grid_to_dict(make("flat", (1, 1), 50.0))
    small.write_text(json.dumps(grid))
    goal = {"vertex": ["joint", 3, "centre"], "target": [45.0, 45.0, 6.0]}
    data = {"schema": "simulearn.task/1", "grid": grid, "goals": [goal], "engine": "fea"}
    limits = {"seconds": 1, "iterations": 1, "corrections": 0}
    task.write_text(json.dumps(data | {"method": "brute-force", "limits": limits}))
    for words in (
        ["simulate", small],
        ["simulate", small, "saddle", "-o", f"{tmp_path}/out/"],
        ["rank", small, "--engine", "fea"],
        ["rank", task],
        ["optimize", task, "-o", tmp_path / "found"],
    ):
        materials.clear()
        code, out, err = run(*words, "--material", light)
        assert code == 0, err
        assert {material.gravity.acceleration for material in materials} == {0}, words
        assert str(read_material(light).identity) in out.replace("\n", " ") or "-o" in words
    summary = json.loads((tmp_path / "found" / "summary.json").read_text())
    assert summary["material"] == read_material(light).identity.model_dump()
    assert "none.toml" in refused(run("simulate", "saddle", "--material", "none.toml"))
    code, out, err = run("gcode", small, "--printer", "prusa-mk4", "--material", light)
    assert code == 0, err
    assert str(read_material(light).identity) in out
    text = light.read_text().replace("stress_joint = 0.118", "stress_joint = 0.5")
    light.write_text(text.replace("acceleration = 0", "acceleration = 2000"))
    said = run("validate", "saddle", "--material", light, "--model", "default")[1]
    assert "material-not-learnt" in said
    assert "limit is 60 mm" in run("validate", "saddle", "--material", light)[1]
    assert "none.toml" in refused(
        run("gcode", small, "--printer", "prusa-mk4", "--material", "none.toml")
    )


# validate


def test_validate_says_valid(run):
    code, out, err = run("validate", "saddle")
    assert (code, out.strip(), err) == (0, "valid", "")


def test_validate_gives_machines_messages(run, tmp_path):
    path = tmp_path / "grid.json"
    path.write_text(json.dumps(SADDLE | {"joints": [[0, 0], *SADDLE["joints"][:8]]}))
    code, out, _ = run("validate", path, "--json")
    data = json.loads(out)
    assert code == 1
    assert list(data) == ["errors", "warnings"]
    assert all(list(m) == ["code", "where", "message"] for m in data["errors"] + data["warnings"])
    assert run("validate", "saddle", "--json")[:2] == (0, '{"errors": [], "warnings": []}\n')


def test_validate_counts_a_file_that_is_no_grid_among_its_errors(run, tmp_path):
    path = tmp_path / "grid.json"
    path.write_text(json.dumps(SADDLE | {"actuators": [0.5]}))
    code, out, _ = run("validate", path, "--json")
    (error,) = json.loads(out)["errors"]
    assert code == 1
    assert "actuators has 1 ratios for 12 beams" in error["message"]


@pytest.mark.parametrize("command", ["validate", "simulate"])
@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"[[[0, 0, 0], [2, 0, 0]], [[2, 0, 0], [2, 2, 0]]]", "lists of lines and graphs"),
        (b"0\nSECTION\n2\nHEADER\n", "grids of drawings"),
        (b"3D Geometry File Format \xff", "grids of drawings"),
        (json.dumps(SADDLE | {"joints": [[0, 0, 1]] * 9}).encode(), "in any plane"),
    ],
)
def test_a_drawing_is_no_grid_but_can_be_imported(run, solved, tmp_path, command, content, words):
    path = tmp_path / "drawing.txt"
    path.write_bytes(content)
    line = refused(run(command, path))
    assert "`simulearn import` makes" in line
    assert words in line
    assert not solved


@pytest.mark.parametrize("factor", [0.001, 10])
def test_a_grid_of_another_unit_is_one_line_before_anything_is_computed(
    run, solved, tmp_path, factor
):
    path, task = tmp_path / "grid.json", tmp_path / "task.json"
    data = SADDLE | {"joints": [[factor * x, factor * y] for x, y in SADDLE["joints"]]}
    path.write_text(json.dumps(data))
    goal = {"vertex": ["joint", 8, "centre"], "target": [45.0, 45.0, 6.0]}
    task.write_text(json.dumps({"schema": "simulearn.task/1", "grid": data, "goals": [goal]}))
    for words in (
        ["simulate", path],
        ["simulate", path, "--engine", "beams"],
        ["rank", path, "--engine", "beams"],
        ["optimize", task, "--engine", "beams", "-o", tmp_path / "found"],
        ["gcode", path, "--printer", "ender-3", "-o", tmp_path / "a.gcode"],
    ):
        line = refused(run(*words))
        assert "lengths are in mm" in line
        assert "multiply all coordinates by" in line
    assert not solved


# library


def test_library_lists_its_grids(run):
    code, out, _ = run("library")
    assert code == 0
    assert all(name in out for name in library())
    assert json.loads(run("library", "--json")[1]) == library()


def test_library_makes_grids_of_any_size(run, tmp_path):
    path = tmp_path / "cone.json"
    code, out, _ = run("library", "cone", "--cells", "3x2", "--length", "50", "-o", path)
    assert code == 0
    assert str(path) in out
    grid = read_grid(path)
    assert grid_to_dict(grid) == grid_to_dict(make("cone", (3, 2), 50.0))
    assert json.loads(run("library", "cone", "--cells", "3x2", "--length", "50")[1])["fixed"] >= 0


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["pyramid"], 'design "pyramid" is not known; known are flat, cone'),
        (["cone", "--cells", "2by2"], '"2by2"'),
        (["cone", "--cells", "0x2"], '"0x2"'),
        (["cone", "--length", "-5"], "-5"),
        (["cone", "--length", "nan"], "nan"),
        (["cone", "-o", "nowhere/cone.json"], "the folder nowhere does not exist"),
    ],
)
def test_library_refuses(run, tmp_path, monkeypatch, words, says):
    monkeypatch.chdir(tmp_path)
    assert says in refused(run("library", *words))
    assert written(tmp_path) == []


# Wrong input: one line, exit code 1, nothing computed, nothing written


def changed(**keys):
    return json.dumps(SADDLE | keys)


def apart():
    """Two grids that no beam connects."""
    joints = np.array(SADDLE["joints"])
    return json.dumps(
        SADDLE
        | {
            "joints": [*joints.tolist(), *(joints + np.array([300, 0])).tolist()],
            "beams": [*SADDLE["beams"], *(np.array(SADDLE["beams"]) + len(joints)).tolist()],
            "actuators": SADDLE["actuators"] * 2,
        }
    )


WRONG = {
    "bad JSON": ('{"joints": [', "is not valid JSON at line 1"),
    "empty": ("", "is not valid JSON"),
    "not an object": ("[1, 2]", "a grid is an object"),
    "other schema": (changed(schema="simulearn.grid/9"), "schema is"),
    "unknown key": (changed(colour="red"), '"colour" is not a key'),
    "lengths": (changed(actuators=[0.5, 0.5]), "actuators has 2 ratios for 12 beams"),
    "three coordinates": (changed(joints=[[0, 0, 5]] * 9), "joints[0] is"),
    "NaN": (changed(joints=[[float("nan"), 0], *SADDLE["joints"][1:]]), "NaN"),
    "index": (changed(beams=[[0, 99], *SADDLE["beams"][1:]]), "beams[0] is [0, 99]"),
    "ratio": (changed(actuators=[1.3] + [0] * 11), "actuators[0] is 1.3"),
    "fixed": (changed(fixed=9), "fixed is 9"),
    "one place": (changed(joints=[SADDLE["joints"][1], *SADDLE["joints"][1:]]), "joint 1 lies"),
    "disconnected": (apart(), "the grid is in 2 parts"),
    "material": (changed(material="unobtainium"), "unobtainium"),
    "brackets": (changed(material="[/red]"), "[/red]"),
}


@pytest.mark.parametrize("command", ["simulate", "validate"])
@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_grid_is_refused_in_one_line(run, solved, tmp_path, command, case):
    text, says = WRONG[case]
    path = tmp_path / "grid.json"
    path.write_text(text)
    target = ["-o", tmp_path / "out.npz"] if command == "simulate" else []
    code, out, err = run(command, path, *target)
    assert code == 1
    lines = (out + err).splitlines()
    assert says in lines[0]
    assert "Traceback" not in out + err
    if command == "simulate":
        assert len(lines) == 1
        assert not out
    assert not solved
    assert written(tmp_path) == ["grid.json"]


def test_a_missing_file_is_refused(run, tmp_path):
    for command in ("simulate", "validate"):
        assert "there is no such file" in refused(run(command, tmp_path / "none.json"))
        assert "is a folder" in refused(run(command, tmp_path)).replace(
            "Is a directory", "is a folder"
        )


def test_a_binary_file_is_refused(run, tmp_path):
    path = tmp_path / "grid.json"
    path.write_bytes(b"\xff\xfd\x00\x01")
    assert "is not a grid file, which is text" in refused(run("simulate", path))


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("out.xyz", "is not one of .json .npz .csv .png .pdf .svg .gif .html "),
        ("out", "is not one of"),
        ("none/out.json", "the folder none does not exist"),
        ("folder.png", "is a folder"),
        ("/proc/out.json", "cannot be written"),  # not even by root
        ("grid.json", "is what is read"),
    ],
)
def test_outputs_are_checked_before_computing(run, solved, tmp_path, monkeypatch, name, says):
    monkeypatch.chdir(tmp_path)
    Path("folder.png").mkdir()
    Path("grid.json").write_text(json.dumps(SADDLE))
    assert says in refused(run("simulate", "grid.json", "-o", "good.json", "-o", name))
    assert not solved
    assert written(tmp_path) == ["folder.png", "grid.json"]


def test_a_missing_package_is_named_before_computing(run, solved, monkeypatch, tmp_path):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    for ending in ("vtu", "pvd"):
        line = refused(run("simulate", "saddle", "-o", tmp_path / f"a.{ending}"))
        assert "pip install 'simulearn[vtk]'" in line
    assert not solved


def test_an_unknown_engine_is_refused(run, tmp_path):
    line = refused(run("simulate", "saddle", "--engine", "crystal-ball", "-o", tmp_path / "a.json"))
    assert 'engine "crystal-ball" is not known; known are fea, calculix' in line


# Failures on the way: the old file stays, and nothing else


@pytest.mark.usefixtures("solved")
@pytest.mark.parametrize("ending", ENDINGS)
def test_a_full_disk_leaves_what_was_there(run, tmp_path, monkeypatch, ending):
    path = tmp_path / f"a.{ending}"
    path.write_text("before")

    def full(self, target):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "replace", full)
    assert "cannot be written (No space left on device)" in refused(
        run("simulate", "saddle", "-o", path)
    )
    assert path.read_text() == "before"
    assert written(tmp_path) == [path.name]


def test_a_failed_computation_has_its_own_code(run, failing, tmp_path):
    failing(ComputationError("frame 3 of 11: no equilibrium at 27 %"))
    line = refused(run("simulate", "saddle", "-o", tmp_path / "a.json"), code=3)
    assert "frame 3 of 11: no equilibrium at 27 %" in line
    assert written(tmp_path) == []


def test_an_interrupt_says_so(run, failing, tmp_path):
    failing(KeyboardInterrupt())
    line = refused(run("simulate", "saddle", "-o", tmp_path / "a.json"), code=130)
    assert "interrupted" in line
    assert written(tmp_path) == []


def test_an_interrupt_that_a_callback_swallows_comes_again(run, monkeypatch):
    def swallowing(phase, info):
        gc.callbacks.remove(swallowing)
        signal.raise_signal(signal.SIGINT)

    def solver(grid, material, progress, cancel):
        gc.callbacks.append(swallowing)
        gc.collect()
        for _ in range(100):
            time.sleep(0.05)
        pytest.fail("went on")

    monkeypatch.setitem(ENGINES, "fea", lambda: Engine("fea", solver))
    assert "interrupted" in refused(run("simulate", "saddle"), code=130)


@pytest.mark.usefixtures("solved")
def test_a_terminal_gets_a_bar_over_the_frames(run, monkeypatch):
    terminal = Console(stderr=True, force_terminal=True, force_interactive=True)
    monkeypatch.setattr("simulearn.cli.progress.err", terminal)
    code, _, err = run("simulate", "saddle")
    assert code == 0
    assert "12/12" in err
    assert run("simulate", "saddle", "--json")[2] == ""


def test_the_unexpected_is_one_line_too_unless_debugging(run, failing, monkeypatch):
    failing(ZeroDivisionError("[division] by zero\nin two lines"))
    line = refused(run("simulate", "saddle"), code=3)
    assert "ZeroDivisionError: [division] by zero in two lines" in line
    assert "SIMULEARN_DEBUG=1" in line
    monkeypatch.setenv("SIMULEARN_DEBUG", "1")
    with pytest.raises(ZeroDivisionError):
        run("simulate", "saddle")


@pytest.mark.parametrize(
    "words", [["simulat"], ["simulate"], ["simulate", "saddle", "--fast"], ["library", "--length"]]
)
def test_wrong_usage_is_code_2(run, words):
    line = refused(run(*words), code=2)
    assert "--help" in line


def test_version_and_help(run):
    assert run("--version") == (0, f"simulearn {__version__}\n", "")
    code, out, err = run("--help")
    assert (code, err) == (0, "")
    assert all(command in out for command in ("simulate", "validate", "library"))


# Outputs and surroundings that are not as usual


def test_an_interrupt_while_modules_are_imported_is_one_line(run, monkeypatch):
    def interrupted(name, *args, **kwargs):
        if name == "simulearn.cli.program":
            raise KeyboardInterrupt
        return original(name, *args, **kwargs)

    original = __import__
    monkeypatch.setattr("builtins.__import__", interrupted)
    assert run("validate", "saddle") == (130, "", "simulearn: interrupted\n")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="a device of Linux")
@pytest.mark.parametrize("words", [["library", "saddle"], ["validate", "saddle"], ["library"]])
def test_an_output_without_room_is_reported(words):
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "simulearn.cli", *words],
            stdout=full, stderr=subprocess.PIPE, text=True, check=False, timeout=60,
        )  # fmt: skip
    assert done.returncode == 1
    assert done.stderr == ("simulearn: the output cannot be written (No space left on device)\n")


@pytest.mark.skipif(os.name != "posix", reason="pipes of POSIX")
def test_a_reader_that_leaves_is_no_error_to_talk_about():
    reading, writing = os.pipe()
    os.close(reading)
    done = subprocess.run(
        [sys.executable, "-m", "simulearn.cli", "library", "--json"],
        stdout=writing, stderr=subprocess.PIPE, text=True, check=False, timeout=60,
    )  # fmt: skip
    os.close(writing)
    assert done.stderr == ""
    assert done.returncode == 1


def test_a_terminal_without_unicode_is_written_to(monkeypatch):
    monkeypatch.setattr(sys, "argv", ["simulearn", "validate", "grün.json"])
    stream = io.TextIOWrapper(io.BytesIO(), encoding="ascii")
    monkeypatch.setattr(sys, "stderr", stream)
    with pytest.raises(SystemExit) as stop:
        cli.main()
    stream.flush()
    assert stop.value.code == 1
    assert b"gr?n.json: there is no such file" in stream.buffer.getvalue()


def test_what_libraries_say_of_their_own_caches_is_not_shown(run):
    warnings.simplefilter("always")
    run("library")
    with warnings.catch_warnings(record=True) as shown:
        for doing in ("reading", "writing"):
            text = f"Error {doing} persistent compilation cache entry for 'jit_f': OSError: no"
            warnings.warn(text, stacklevel=1)
        warnings.warn("something else", stacklevel=1)
    assert [str(one.message) for one in shown] == ["something else"]
    assert logging.getLogger("matplotlib").level == logging.ERROR


# As its own process


def simulearn(*words, **more):
    return subprocess.run(
        [sys.executable, *words], capture_output=True, text=True, check=False, timeout=300, **more
    )


@pytest.mark.parametrize("words", [["--help"], ["validate", "saddle"], ["library"]])
def test_quick_commands_load_no_solver(words):
    done = simulearn("-X", "importtime", "-m", "simulearn.cli", *words)
    assert done.returncode == 0
    loaded = {line.rsplit("|", 1)[-1].strip() for line in done.stderr.splitlines()}
    assert "simulearn.cli.base" in loaded
    assert loaded.isdisjoint(
        {"jax", "numba", "skfem", "scipy.sparse", "matplotlib", "trimesh", "meshio"}
    )


def test_a_saddle_by_finite_elements(tmp_path):
    path = tmp_path / "saddle.npz"
    done = simulearn("-m", "simulearn.cli", "simulate", "saddle", "--json", "-o", path)
    assert (done.returncode, done.stderr) == (0, "")
    assert json.loads(done.stdout)["engine"] == "fea"
    result = read_npz(path)
    empty = {f.name for f in dataclasses.fields(result) if getattr(result, f.name) is None}
    assert empty == {"model", "bound_mm", "scatter"}
    middle = result.centres[:, result.grid.fixed]
    np.testing.assert_allclose(middle[0], 0, atol=1e-9)
    # The saddle is symmetric under half a turn about its middle.
    last = result.centres[-1]
    np.testing.assert_allclose(last[::-1] * [-1, -1, 1], last, atol=1e-6)


@pytest.mark.parametrize("width", ["80", "40"])
def test_figures_of_a_set_are_whole_on_a_narrow_terminal(run, monkeypatch, width):
    monkeypatch.setenv("COLUMNS", width)
    code, out, _ = run("dataset", "info", Path(__file__).parent / "data" / "sample.h5")
    assert code == 0
    assert "…" not in out
    table = out[out.index("mean") :].splitlines()
    assert max(len(line.rstrip()) for line in table) <= 80
    assert "the paper's dimension: mean 94.44, 3 % 65.64, 96 % 124.39 mm" in out

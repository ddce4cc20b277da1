"""The commands as a user runs them: files, messages, exit codes, stopping and going on."""

import json

import numpy as np
import pytest
import rhino3dm
from PIL import Image

from simulearn.grid import make, read_grid, validate, write_grid
from simulearn.inverse import read_task
from simulearn.material import load_material


@pytest.fixture
def task_file(small, tmp_path):
    path = tmp_path / "task.json"
    path.write_text(json.dumps(small))
    return path


def test_a_search_leaves_grid_figures_history_and_pictures(run, task_file, tmp_path, monkeypatch):
    folder = tmp_path / "found"
    code, out, err = run("optimize", task_file, "-o", folder)
    assert code == 0
    assert "by finite elements; the two shapes are" in out
    assert "1: " in err
    figures = json.loads((folder / "summary.json").read_text())
    for key in ("error_mm", "error_fea_mm", "designs", "iterations", "seconds", "history"):
        assert figures[key] is not None
    assert figures["iterations"] == 3
    assert figures["error_mm"] < figures["start_mm"]
    assert figures["history"][-1]["designs"] == figures["designs"]
    grid = read_grid(folder / "best.json")
    assert validate(grid, load_material(grid.material)).valid
    assert len((folder / "history.csv").read_text().splitlines()) == 1 + len(figures["history"])
    for name in ("error.png", "shape.png", "changing.gif"):
        with Image.open(folder / name) as picture:
            assert np.asarray(picture.convert("L")).std() > 10
    rhino = rhino3dm.File3dm.Read(str(folder / "shape.3dm"))
    assert {"targets", "skeleton", "frames::frame 11"} <= {q.FullPath for q in rhino.Layers}

    # What the files say is so.
    from simulearn.simulate import engine

    goals = read_task(task_file).aims
    for name, error in (("beams", figures["error_mm"]), ("fea", figures["error_fea_mm"])):
        mesh = "fine" if name == "fea" else None  # by which designs are checked
        (result,) = engine(name, mesh=mesh).simulate([grid])
        points = goals.points(result.joints[-1], result.beams[-1])
        assert goals.error(points) == pytest.approx(error, abs=0.05)

    # The same command has nothing to add; more iterations go on. Their pictures are as before.
    monkeypatch.setattr("simulearn.cli.inverse.search_pictures", lambda *_: [])
    again = json.loads(run("optimize", task_file, "-o", folder, "--json")[1])
    assert again["iterations"] == 3
    more = json.loads(run("optimize", task_file, "-o", folder, "--iterations", 5, "--json")[1])
    assert more["iterations"] == 5
    assert more["history"][: len(figures["history"])] == figures["history"]
    code, _, err = run("optimize", task_file, "-o", folder, "--method", "brute-force")
    assert (code, "is the search of another task" in err) == (1, True)
    words = ("--method", "brute-force", "--iterations", 1, "--afresh", "--json")
    assert json.loads(run("optimize", task_file, "-o", folder, *words)[1])["iterations"] == 1


def test_an_interrupt_keeps_the_best(run, task_file, tmp_path, monkeypatch):
    from simulearn.inverse import brute_force
    from simulearn.inverse.problem import Advance

    def stopped(problem, start):
        yield from (Advance("first"), Advance("second"))
        raise KeyboardInterrupt

    monkeypatch.setattr(brute_force, "brute_force", stopped)
    folder = tmp_path / "found"
    words = ("optimize", task_file, "-o", folder, "--method", "brute-force")
    code, _, err = run(*words)
    assert code == 130
    assert "has the best so far, and the same command goes on" in err
    figures = json.loads((folder / "summary.json").read_text())
    assert (figures["interrupted"], figures["iterations"]) == (True, 2)
    assert figures["error_fea_mm"] is None
    assert read_grid(folder / "best.json").fixed == 0


def test_a_ranking_is_reported_drawn_and_picked_from(run, task_file, tmp_path):
    cards, data, after = tmp_path / "cards.png", tmp_path / "all.json", tmp_path / "next.json"
    words = ("rank", task_file, "-o", cards, "-o", data, "--pick", 1, "--to", after)
    code, out, _ = run(*words)
    assert code == 0
    assert "valid modifications, five that differ" in out
    ranking = json.loads(data.read_text())
    assert len(ranking["suggestions"]) == 5
    assert ranking["modifications"][0]["error_mm"] == ranking["suggestions"][0]["error_mm"]
    assert ranking["suggestions"][0]["error_mm"] < ranking["error_mm"]
    with Image.open(cards) as picture:
        assert picture.width == 1750
    begun = read_task(after)
    assert begun.grid == ranking["suggestions"][0]["grid"]
    assert json.loads(run("rank", after, "--json")[1])["error_mm"] == pytest.approx(
        ranking["suggestions"][0]["error_mm"], abs=0.05
    )


def test_a_grid_is_ranked_by_what_moves_it(run, tmp_path):
    path, after = tmp_path / "grid.json", tmp_path / "next.json"
    write_grid(make("twist", (1, 1), 50.0), path)
    words = ("rank", path, "--engine", "beams", "--pick", 2, "--to", after, "--json")
    ranking = json.loads(run(*words)[1])
    moved = [row["moved_mm"] for row in ranking["modifications"]]
    assert moved[0] > moved[-1] > 0
    assert read_grid(after).beams.shape == (4, 2)


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        (["optimize", "none.json"], 1, "there is no such file"),
        (["optimize"], 2, "Missing argument 'TASK'"),
        (["optimize", "task.json", "--method", "magic"], 1, 'method "magic" is not known'),
        (["optimize", "task.json", "--engine", "magic"], 1, 'engine "magic" is not known'),
        (["optimize", "task.json", "--iterations", "0"], 2, "--iterations"),
        (["optimize", "task.json", "--tolerance", "inf"], 2, "--tolerance"),
        (["rank", "task.json", "--tolerance", "1e9"], 2, "--tolerance"),
        (["optimize", "task.json", "--seconds", "inf"], 2, "--seconds"),
        (["rank", "none.json"], 1, "there is no such file"),
        (["rank", "magic"], 1, "is neither a file nor a grid of the library"),
        (["rank", "task.json", "-o", "a.txt"], 1, "the ending is not one of .png"),
        (["rank", "task.json", "--pick", "1"], 1, "--pick and --to go together"),
    ],
)
def test_what_is_wrong_is_one_line(run, task_file, monkeypatch, words, code, message):
    monkeypatch.chdir(task_file.parent)
    answer = run(*words)
    assert answer[0] == code
    assert message in answer[2].splitlines()[-1]


def test_a_wrong_task_names_key_and_place(run, task_file, small):
    small["goals"][1]["target"] = [1, 2, "3"]
    task_file.write_text(json.dumps(small))
    code, _, err = run("optimize", task_file)
    assert code == 1
    assert 'goals[1].target[2] is "3"; a target is [x, y, z], finite numbers in mm' in err

"""The command compare as a user runs it."""

import json

import numpy as np
import printed
import pytest
from PIL import Image

import simulearn.simulate.source as source
from simulearn.grid import write_grid
from simulearn.simulate import ENGINES


@pytest.fixture
def design(monkeypatch, tmp_path):
    monkeypatch.setattr(source, "last_frames", printed.last_frames)
    monkeypatch.setitem(ENGINES, "fea", printed.Simulator)
    path = tmp_path / "own.json"
    write_grid(printed.grid(), path)
    return path


def table(path, hidden, seed=1):
    places = printed.moved(printed.shape(hidden).centres[-1], seed)
    lines = [f"{j},{x:.4f},{y:.4f},{z:.4f}" for j, (x, y, z) in enumerate(places)]
    path.write_text("joint,x,y,z\n" + "\n".join(lines) + "\n")
    return path


def test_a_table_of_joints_is_compared_drawn_and_written(run, design, tmp_path):
    csv = table(tmp_path / "measured.csv", printed.material(strain=1.12))
    files = [tmp_path / name for name in ("a.png", "a.json", "a.csv")]
    code, out, err = run("compare", design, csv, *(w for f in files for w in ("-o", f)))
    assert code == 0, err
    assert "9 of 9 joints measured; mean deviation" in out
    assert "a strain of 1.12 times would explain 100% of the squared deviation" in out
    assert "by the material: 17.0% from print to print" in out
    assert "simulearn calibrate" in out
    data = json.loads(files[1].read_text())
    assert data["schema"] == "simulearn.comparison/1"
    assert data["explanations"][0]["parameter"] == "strain"
    assert data["mean_percent"] == pytest.approx(
        100 * data["mean_mm"] / data["dimension_mm"], abs=1e-4
    )
    off = [joint["deviation_mm"] for joint in data["joints"]]
    assert np.mean(off) == pytest.approx(data["mean_mm"], abs=1e-5)
    assert max(off) == data["worst_mm"] == off[data["worst_joint"]]
    with Image.open(files[0]) as picture:
        assert picture.width == 1440
    # The measured joints that it writes are a measurement that it reads.
    code, out, _ = run("compare", design, files[2], "--json")
    assert code == 0
    again = json.loads(out)
    assert again["mean_mm"] == pytest.approx(data["mean_mm"], abs=1e-3)


def test_errors_are_one_line_each(run, design, tmp_path):
    csv = tmp_path / "measured.csv"

    def refused(*words):
        code, out, err = run("compare", *words)
        assert code == 1
        assert out == ""
        (line,) = err.splitlines()
        return line

    assert "there is no such file" in refused(design, tmp_path / "none.csv")
    csv.write_text("0,1,2,3\n9,1,2,3\n1,2,3,4\n2,3,9,5\n")
    assert "joint 9 is not in the grid" in refused(design, csv)
    csv.write_text("0,1,2,inf\n")
    assert f'{csv}: row 1, column 4 is "inf"' in refused(design, csv)
    assert "--at is" in refused(design, csv, "--at", "side")
    assert "is what is read" in refused(design, csv, "-o", csv)
    assert "the ending is not one of" in refused(design, csv, "-o", tmp_path / "a.stl")
    assert "no unit of length" in refused(design, table(csv, printed.BASE), "--unit", "ell")


def test_a_grid_without_deviation_is_drawn_too(run, design, tmp_path):
    csv = table(tmp_path / "measured.csv", printed.BASE)
    code, out, err = run("compare", design, csv, "-o", tmp_path / "a.png")
    assert code == 0, err
    assert "there is nothing to explain" in out

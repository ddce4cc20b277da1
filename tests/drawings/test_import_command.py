"""The command import as a user types it."""

import json

import pytest
from messy import l_grid, same

from simulearn.cli import main
from simulearn.grid import read_grid

BEAMS = [line.tolist() for line in l_grid()]


def run(monkeypatch, capsys, *arguments):
    monkeypatch.setattr("sys.argv", ["simulearn", "import", *map(str, arguments)])
    with pytest.raises(SystemExit) as end:
        main()
    streams = capsys.readouterr()
    return end.value.code or 0, streams.out, streams.err


def test_a_drawing_becomes_a_grid_file(tmp_path, monkeypatch, capsys):
    file, grid = tmp_path / "beams.json", tmp_path / "grid.json"
    file.write_text(json.dumps({"top 0.5": BEAMS[:2], "passive": [*BEAMS[2:], BEAMS[0][::-1]]}))
    code, out, err = run(monkeypatch, capsys, file, "-o", grid)
    assert (code, err) == (0, "")
    assert same(read_grid(grid), BEAMS)
    assert read_grid(grid).actuators.tolist() == [0.5, 0.5, *[0] * 8]
    assert "mended: 1 line drawn over another one was left out (double)" in out
    assert "the unit is mm" in out
    assert "is fixed, the nearest to the middle" in out


def test_the_machine_form(tmp_path, monkeypatch, capsys):
    file, grid = tmp_path / "beams.json", tmp_path / "grid.json"
    file.write_text(json.dumps({"a": BEAMS, "b": [[[0, 0], [-9, -9]]]}))
    code, out, _ = run(monkeypatch, capsys, file, "-o", grid, "--json")
    data = json.loads(out)
    assert code == 0
    assert set(data) == {"grid", "format", "unit", "layers", "mends", "messages"}
    assert data["mends"][0]["code"] == "stub"
    assert data["layers"][1] == {
        "name": "b", "colour": None, "lines": 1, "taken": True, "ratio": None
    }  # fmt: skip


def test_what_cannot_be_simulated_is_written_with_warnings(tmp_path, monkeypatch, capsys):
    file, grid = tmp_path / "small.json", tmp_path / "grid.json"
    file.write_text(json.dumps([[[x / 30 for x in p] for p in line] for line in BEAMS]))
    code, _, err = run(monkeypatch, capsys, file, "-o", grid)
    assert code == 0
    assert "which is odd, as numbers without a unit are taken as mm" in err
    assert "cannot be simulated yet" in err
    assert len(err.splitlines()) < 8
    assert len(read_grid(grid).beams) == 10


def test_what_is_wrong_is_one_line_with_a_remedy(tmp_path, monkeypatch, capsys):
    file, grid = tmp_path / "beams.json", tmp_path / "grid.json"
    file.write_text(json.dumps({"unit": "um", "lines": BEAMS}))
    code, out, err = run(monkeypatch, capsys, file, "-o", grid)
    assert (code, out) == (1, "")
    assert "the middle beam would be 0.065 mm long" in err
    assert "--unit says which it is, or --width how many mm" in err
    assert len(err.splitlines()) == 1
    assert not grid.exists()


def test_the_drawing_itself_is_never_overwritten(tmp_path, monkeypatch, capsys):
    file, link = tmp_path / "beams.json", tmp_path / "other.json"
    file.write_text(json.dumps(BEAMS))
    link.hardlink_to(file)
    for output in (file, link):
        code, _, err = run(monkeypatch, capsys, file, "-o", output)
        assert code == 1
        assert "is the drawing itself" in err
    assert json.loads(file.read_text()) == BEAMS


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--without", "gaps"], '"gaps" is none of the mends'),
        (["--unit", "furlong"], '"furlong" is no unit of length'),
        (["--layers", "x"], 'there is no layer "x" with lines'),
        (["--material", "steel"], "steel"),
        (["--tolerance", "0"], "the tolerance is 0 mm; it is more than 0"),
    ],
)
def test_options_that_make_no_sense_are_named(tmp_path, monkeypatch, capsys, arguments, words):
    file = tmp_path / "beams.json"
    file.write_text(json.dumps(BEAMS))
    code, _, err = run(monkeypatch, capsys, file, "-o", tmp_path / "g.json", *arguments)
    assert code == 1
    assert words in err
    assert not (tmp_path / "g.json").exists()


def test_a_file_that_does_not_exist(tmp_path, monkeypatch, capsys):
    code, _, err = run(monkeypatch, capsys, tmp_path / "no.dxf", "-o", tmp_path / "g.json")
    assert code == 1
    assert "there is no such file" in err

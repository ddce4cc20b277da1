"""Prints: the same file and facts as the command line makes, and toolpaths to draw."""

import json
from urllib.parse import unquote

import pytest
from asking import Client, problem

from simulearn.grid import grid_to_dict, make
from simulearn.studio.settings import Settings

SADDLE = grid_to_dict(make("saddle"))
SMALL = grid_to_dict(make("flat", (1, 1), 50.0))
PRINT = {"grids": [SMALL], "printer": "ender-3", "names": ["small"]}


@pytest.fixture(scope="module")
def client():
    return Client(Settings())


def test_the_print_is_that_of_the_command_line(client, run, tmp_path):
    (tmp_path / "small.json").write_text(json.dumps(SMALL))
    file = tmp_path / "small.gcode"
    words = ["gcode", tmp_path / "small.json", "--printer", "ender-3", "-o", file, "--json"]
    code, out, _ = run(*words)
    assert code == 0
    body = client.post("/api/gcode", PRINT).json()
    assert body.pop("gcode") == file.read_text()
    assert body.pop("file") == "small.gcode"
    facts = json.loads(out)
    facts.pop("files")
    assert body == facts


def test_the_file_alone(client):
    name = ["Sättel/日本"]
    headers = {"Accept": "text/x.gcode"}
    answer = client.post("/api/gcode", PRINT | {"names": name}, headers=headers)
    assert answer.headers["content-type"].startswith("text/x.gcode")
    assert answer.text.startswith(";")
    header = answer.headers["content-disposition"]
    assert unquote(header.partition("UTF-8''")[2]) == "Sättel-日本.gcode"


def test_a_toolpath_with_its_facts_and_the_bed(client):
    body = client.post("/api/toolpath", PRINT).json()
    assert body["schema"] == "simulearn.toolpath/1"
    assert len(body["layers"]) == body["print"]["layers"]
    assert body["starts"][-1] == len(body["points"]) == len(body["width"])
    assert (body["bed"]["low"], body["bed"]["high"]) == ([0, 0], [220, 220])
    (x0, y0), (x1, y1) = body["print"]["bounds_mm"]
    assert 0 <= x0 < x1 <= 220
    assert 0 <= y0 < y1 <= 220


def test_several_designs_share_a_bed(client):
    body = client.post("/api/gcode", {"grids": [SMALL] * 3, "printer": "ender-3"}).json()
    assert [grid["name"] for grid in body["grids"]] == ["grid 0", "grid 1", "grid 2"]
    assert body["file"] == "3-grids.gcode"
    two = PRINT | {"grids": [SMALL] * 2, "names": ["a", "b"]}
    assert client.post("/api/gcode", two).json()["file"] == "a-b.gcode"


@pytest.mark.parametrize("path", ["/api/gcode", "/api/toolpath"])
@pytest.mark.parametrize(
    ("change", "code"),
    [
        ({"printer": "none"}, "printer-unknown"),
        ({"printer": "/etc/passwd.toml"}, "printer-unknown"),
        ({"names": ["a", "b"]}, "names"),
        ({"grids": []}, "request"),
        ({"grids": [SMALL] * 100}, "request"),
        ({"grids": [SMALL | {"joints": [[0, 0]] * 4}]}, "joints-coincide"),
        ({"grids": [grid_to_dict(make("flat", (6, 6), 65.0))]}, None),  # larger than the bed
        ({"grids": [SMALL | {"material": "/etc/passwd"}]}, "material-path"),
    ],
)
def test_what_cannot_be_printed_says_why(client, path, change, code):
    assert problem(client.post(path, PRINT | change), 422, code)["detail"]


def test_large_designs_are_refused():
    client = Client(Settings(beams=3))
    problem(client.post("/api/gcode", PRINT), 422, "too-large")
    client = Client(Settings(beams_in_all=7))
    problem(
        client.post("/api/toolpath", PRINT | {"grids": [SMALL] * 2, "names": None}),
        422,
        "too-large",
    )

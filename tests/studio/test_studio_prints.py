"""Prints: the same file and facts as the command line makes, and toolpaths to draw."""

import json
from io import BytesIO
from urllib.parse import unquote
from zipfile import ZipFile

import pytest
from asking import Client, problem

from simulearn.fabricate import load_printer, prepare
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


BAMBU = """
base = "bambu-x1"
title = "Bambu Lab X1 Carbon"
firmware = "bambu"
"""


def test_a_package_for_a_bambu_lab_printer(client):
    body = {"grids": [SMALL], "profile": BAMBU, "names": ["small"]}
    answer = client.post("/api/gcode", body | {"format": "gcode.3mf"})
    assert answer.headers["content-type"] == "model/3mf"
    assert 'filename="small.gcode.3mf"' in answer.headers["content-disposition"]
    with ZipFile(BytesIO(answer.content)) as package:
        text = package.read("Metadata/plate_1.gcode").decode()
    assert text == client.post("/api/gcode", body).json()["gcode"]
    assert client.post("/api/profile", {"profile": BAMBU}).json()["formats"][0] == "gcode.3mf"
    assert client.post("/api/profile", {"profile": OWN}).json()["formats"] == ["gcode"]
    wrong = client.post("/api/gcode", PRINT | {"format": "gcode.3mf"})
    assert "Bambu Lab" in problem(wrong, 422)["detail"]
    problem(client.post("/api/gcode", PRINT | {"format": "stl"}), 422, "request")


def test_a_toolpath_with_its_facts_and_the_bed(client):
    body = client.post("/api/toolpath", PRINT).json()
    assert body["schema"] == "simulearn.toolpath/1"
    assert len(body["layers"]) == body["print"]["layers"]
    assert body["starts"][-1] == len(body["points"]) == len(body["width"])
    assert (body["bed"]["low"], body["bed"]["high"]) == ([0, 0], [220, 220])
    assert len(body["drawn"]) == len(body["role"])
    assert not body["drawn"][0]
    assert 0 < sum(body["drawn"]) < len(body["drawn"])
    assert body["print"]["brim"] == (body["roles"].index("brim") in body["role"])
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
        ({"printer": None}, "printer"),
        ({"profile": 'base = "voron"'}, "printer"),  # besides the name
        ({"printer": None, "profile": "bed = 3"}, "profile"),
        ({"printer": None, "profile": 'base = "/etc/passwd.toml"'}, "profile"),
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


OWN = """
base = "voron"
name = "mine"
title = "My printer"
[bed]
shape = "round"
width = 180.0
depth = 180.0
origin = "centre"
excluded = [[[-90.0, -90.0], [-70.0, -70.0]]]
"""


def test_a_print_on_a_printer_of_ones_own(client, tmp_path):
    own = {"grids": [SMALL], "profile": OWN}
    body = client.post("/api/gcode", own).json()
    assert body["printer"] == "mine"
    path = client.post("/api/toolpath", own).json()
    assert path["bed"]["shape"] == "round"
    assert path["bed"]["excluded"] == [[[-90, -90], [-70, -70]]]
    assert path["bed"]["low"] == [-90, -90]
    (tmp_path / "mine.toml").write_text(OWN)  # the same file as the command line makes
    job = prepare([make("flat", (1, 1), 50.0)], load_printer(tmp_path / "mine.toml"), ["grid"])
    assert body["gcode"] == job.gcode


def test_a_profile_is_read_and_its_printer_described(client):
    facts = client.post("/api/profile", {"profile": OWN}).json()
    named = {one["name"]: one for one in client.get("/api/printers").json()["printers"]}
    assert (facts["name"], facts["title"]) == ("mine", "My printer")
    assert facts["bed"]["shape"] == "round"
    other = {"name", "title", "bed", "tried", "sources"}
    assert {k: v for k, v in facts.items() if k not in other} == {
        k: v for k, v in named["voron"].items() if k not in other
    }
    text = client.get("/api/printers/voron").text
    assert client.post("/api/profile", {"profile": text}).json() == named["voron"]
    problem(client.get("/api/printers/none"), 404, "printer-unknown")


@pytest.mark.parametrize(
    ("text", "where"),
    [
        ("", "name"),
        ("x = ", "profile"),
        ('name = "mine"\nname = "yours"\n', "line 2"),
        ('base = "voron"\n[bed]\nwidth = "wide"', "bed.width"),
        ('base = "voron"\n[bed]\nexcluded = [[[0, 0]]]', "bed.excluded.0.1"),
        ('base = "voron"\n[print]\nspeed_fill = -1', "print"),
        ('base = "voron"\nmore = 1', "more"),
        ('base = "../voron.toml"', "base"),
        ("base = 3", "base"),
        ("x = " + "9" * 5000, "profile"),
        ("x = " + "[" * 60_000, "profile"),
        ("x" + ".x" * 30_000 + " = 1", "line 1"),
        ('base = "voron"\nbed' + ".width" * 250 + " = 1", "bed.width"),
        ("# " + "x" * 2**16, "profile"),
        ("[" + "x." * 250 + "x]\n" + "".join(f"{k:x} = 1\n" for k in range(6500)), "name"),
    ],
)
def test_what_is_no_profile_says_where(client, text, where):
    found = problem(client.post("/api/profile", {"profile": text}), 422)
    assert found["code"] in ("profile", "profile-too-large")
    assert found["where"] == where
    assert "profile" in found["detail"]


def test_a_print_of_too_many_strokes_is_refused(client):
    fine = 'base = "modix-big60"\n[print]\nnozzle = 0.2\nlayer = 0.02\nline_width = 0.2'
    large = grid_to_dict(make("flat", (4, 4), 30.0))
    body = {"grids": [large], "profile": fine}
    assert "strokes" in problem(client.post("/api/toolpath", body), 422, "too-large")["detail"]


def test_large_designs_are_refused():
    client = Client(Settings(beams=3))
    problem(client.post("/api/gcode", PRINT), 422, "too-large")
    client = Client(Settings(beams_in_all=7))
    problem(
        client.post("/api/toolpath", PRINT | {"grids": [SMALL] * 2, "names": None}),
        422,
        "too-large",
    )

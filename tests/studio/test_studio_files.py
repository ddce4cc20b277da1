"""Files: what a person opens, whatever it is, and results as files with names of any language."""

import io
import json
import zipfile
from urllib.parse import unquote

import numpy as np
import pytest
from asking import Client, problem

import synthetic
from simulearn.errors import CancelledError
from simulearn.grid import grid_from_dict, grid_to_dict, make
from simulearn.outputs import WRITERS
from simulearn.simulate import ENGINES, outcome_to_dict
from simulearn.simulate.engines import Engine
from simulearn.studio import exports, simulations
from simulearn.studio.downloads import attachment, safe_stem
from simulearn.studio.settings import Settings

SADDLE = grid_to_dict(make("saddle"))
GOAL = {"vertex": ["joint", 0, "centre"], "target": [-60.0, -60.0, 12.0], "weight": 2.0}
TASK = {"schema": "simulearn.task/1", "grid": SADDLE, "goals": [GOAL]}
DOCUMENT = {
    "schema": "simulearn.document/1",
    "name": "mine",
    "grid": SADDLE,
    "goals": [GOAL],
    "printer": "ender-3",
}
STARTS = {
    ".png": b"\x89PNG",
    ".pdf": b"%PDF",
    ".svg": b"<?xml",
    ".gif": b"GIF8",
    ".glb": b"glTF",
    ".npz": b"PK",
    ".pvd": b"PK",
    ".json": b"{",
    ".vtu": b"<",
}


@pytest.fixture(scope="module")
def client():
    return Client(Settings())


def sent(client, data, name="design.json"):
    data = json.dumps(data).encode() if isinstance(data, (dict, list)) else data
    headers = {"Content-Type": "application/octet-stream"}
    return client.request("POST", "/api/open", params={"name": name}, content=data, headers=headers)


def test_a_grid_is_opened_under_the_name_of_its_file(client):
    body = sent(client, SADDLE, "C:\\designs\\Sättel 日本.JSON").json()
    assert (body["kind"], body["name"], body["messages"]) == ("grid", "Sättel 日本", [])
    assert (body["grid"], body["goals"], body["printer"]) == (SADDLE, [], None)


def test_a_task_is_opened_with_its_goals_and_says_what_is_left_out(client):
    body = sent(client, TASK).json()
    assert (body["kind"], body["goals"], body["messages"]) == ("task", [GOAL], [])
    (message,) = sent(client, TASK | {"free": {"joints": [1]}}).json()["messages"]
    assert message["code"] == "opened-task"
    assert "free parts" in message["message"]


def test_a_task_with_a_dangling_beam_is_opened_to_be_mended(client):
    grid = SADDLE | {
        "joints": [*SADDLE["joints"], [130.0, 65.0]],
        "beams": [*SADDLE["beams"], [8, 9]],
        "actuators": [*SADDLE["actuators"], 0.0],
    }
    body = sent(client, TASK | {"grid": grid}).json()
    assert (body["grid"], body["goals"]) == (grid, [GOAL])


def test_a_result_is_opened_as_its_design(client):
    result = synthetic.result(grid_from_dict(SADDLE))
    body = sent(client, outcome_to_dict(result)).json()
    assert (body["kind"], body["grid"]) == ("result", SADDLE)
    assert body["messages"][0]["code"] == "opened-result"


def test_a_document_is_opened_as_it_was_saved(client):
    body = sent(client, DOCUMENT, "other.json").json()
    assert {k: body[k] for k in ("name", "grid", "goals", "printer")} == {
        k: DOCUMENT[k] for k in ("name", "grid", "goals", "printer")
    }


@pytest.mark.parametrize(
    "data",
    [
        b"\xef\xbb\xbf" + json.dumps(SADDLE).encode(),
        json.dumps(SADDLE, indent=2).replace("\n", "\r\n").encode(),
        json.dumps(SADDLE, indent=2).replace("\n", "\r").encode(),
        json.dumps(SADDLE).encode("utf-16"),
        b"\n\n  " + json.dumps(SADDLE).encode() + b"\n",
    ],
)
def test_marks_and_line_ends_do_not_matter(client, data):
    assert sent(client, data).json()["grid"] == SADDLE


from_one = [[i + 1, j + 1] for i, j in SADDLE["beams"]]


@pytest.mark.parametrize(
    ("data", "code", "words"),
    [
        (b"", "empty", "is empty"),
        (b" \n", "empty", "is empty"),
        (b'{"schema": 1,\r\n "joints": [}', "json", "line 2, column 13"),
        (b'{"a": NaN}', "json", "NaN"),
        (b'{"a": 1, "a": 2}', "json", "twice"),
        (b"[" * 100_000, "json", "nested"),
        (b'{"a": ' + b"9" * 5000 + b"}", "json", "digits"),
        (b'{"name": "\xff"}', "file-kind", "byte 10"),
        (b"PK\x03\x04", "format", "ZIP"),
        (b"\x89PNG\r\n", "format", "picture"),
        (b"AC1032\0\0", "format", "save it as DXF"),
        (b"ISO-10303-21;", "format", "STEP"),
        (b"%PDF-1.7", "format", "save it as SVG or DXF"),
        (b"<VTKFile></VTKFile>", "format", "XML"),
        (b"; made by SimuLearn\nG28", "format", "G-code"),
        (b"\xec\xff\x00\x81", "format", "neither"),
        (b"<svg xmlns='http://www.w3.org/2000/svg'></svg>", "no-lines", "no lines"),
        (b"[1, 2]", None, ""),
        (b"3", None, ""),
        ({"schema": "simulearn.toolpath/1"}, "file-kind", "simulearn.toolpath/1"),
        ({"schema": "simulearn.failure/1"}, "file-kind", "no design"),
        (SADDLE | {"schema": "simulearn.grid/2"}, "file-version", "simulearn.grid/1"),
        ({"joints": [], "beams": []}, "grid-file", "schema is missing"),
        (SADDLE | {"joints": [[0, 0, 5]] * 9}, "joints-in-space", "z is not 0"),
        (SADDLE | {"beams": from_one}, "beam-index", "subtract 1"),
        (SADDLE | {"material": "/etc/passwd"}, "material-path", "name"),
        (TASK | {"goals": [GOAL | {"target": [1]}]}, "task", "goals[0].target"),
        (DOCUMENT | {"goals": [GOAL | {"vertex": ["joint", 9, 0]}]}, "document", "no such vertex"),
        (DOCUMENT | {"more": 1}, "document", "more"),
    ],
)
def test_what_cannot_be_opened_says_why_and_where(client, data, code, words):
    body = problem(sent(client, data, "broken.json"), 422, code)
    assert words in body["detail"]
    assert body["detail"].startswith("broken: ")


def test_a_file_that_is_too_large_is_refused():
    client = Client(Settings(file_bytes=1000))
    problem(sent(client, b" " * 1001), 413, "too-large")


@pytest.fixture
def solved(monkeypatch):
    """Let a formula stand in for the engines."""

    def solver(grid, material, progress, cancel):
        return synthetic.result(grid, solid=False)

    for name in ("learned", "fea"):
        monkeypatch.setitem(ENGINES, name, lambda name=name: Engine(name, solver, workers=1))
    simulations._engine.cache_clear()
    yield
    simulations._engine.cache_clear()


def export(client, ending, **more):
    return client.post("/api/export", {"grid": SADDLE, "format": ending, **more})


@pytest.mark.parametrize("ending", [e for e in WRITERS if e not in (".gif", ".mp4", ".webm")])
def test_every_format(client, solved, ending):
    answer = export(client, ending, name="Sättel 日本")
    assert answer.status_code == 200
    assert answer.content.startswith(STARTS.get(ending, b""))
    header = answer.headers["content-disposition"]
    file = "zip" if ending == ".pvd" else ending[1:]
    assert unquote(header.partition("filename*=UTF-8''")[2]) == f"Sättel 日本.{file}"
    assert header.startswith('attachment; filename="Sattel')


def test_several_files_come_as_one_archive_that_holds_together(client, solved):
    archive = zipfile.ZipFile(io.BytesIO(export(client, ".pvd", name="mine").content))
    assert archive.testzip() is None
    index = archive.read("mine.pvd").decode()
    frames = [name for name in archive.namelist() if name != "mine.pvd"]
    assert len(frames) == 12
    assert all(f'"{name}"' in index for name in frames)


def test_a_result_that_was_exported_can_be_read(client, solved):
    with np.load(io.BytesIO(export(client, ".npz").content)) as arrays:
        assert arrays["joints"].shape == (12, 9, 8, 3)
    assert sent(client, export(client, ".json").content).json()["grid"] == SADDLE


@pytest.mark.parametrize(
    ("change", "code", "where"),
    [
        ({"format": ".exe"}, "format-unknown", "format"),
        ({"format": "../x.png"}, "format-unknown", "format"),
        ({"engine": "calculix"}, "engine-unknown", "engine"),
        ({"grid": SADDLE | {"joints": [[0, 0]] * 9}}, "joints-coincide", "joint 1"),
        ({"grid": SADDLE | {"material": "/etc/passwd"}}, "material-path", "material"),
        ({"more": 1}, "request", "more"),
    ],
)
def test_wrong_exports_are_refused(client, solved, change, code, where):
    body = problem(
        client.post("/api/export", {"grid": SADDLE, "format": ".stl"} | change), 422, code
    )
    assert body["where"] == where


def test_large_designs_are_refused(solved):
    problem(export(Client(Settings(joints=8)), ".stl"), 422, "too-large")
    problem(export(Client(Settings(fea_beams=8)), ".stl", engine="fea"), 422, "too-large")


def test_an_animation_that_takes_too_long_ends(solved):
    client = Client(Settings(export_seconds=0.05))
    body = problem(export(client, ".gif"), 422, "time-over")
    assert "0.05 s" in body["detail"]


def test_an_animation_can_be_stopped():
    class After:
        left = 2

        def is_set(self):
            self.left -= 1
            return self.left < 0

    with pytest.raises(CancelledError):
        exports.exported(synthetic.result(), ".gif", "x", After())


@pytest.mark.parametrize(
    ("name", "stem"),
    [
        ("mine", "mine"),
        ("", "grid"),
        (" . ", "grid"),
        ("../../etc/passwd", "-..-etc-passwd"),
        ('a"b\\c\r\nd', "a-b-c d"),
        ("con", "con-"),
        ("Sättel 日本", "Sättel 日本"),
        ("\ud800x", "x"),
        ("x" * 500, "x" * 80),
    ],
)
def test_names_are_harmless_everywhere(name, stem):
    assert safe_stem(name) == stem
    header = attachment(f"{safe_stem(name)}.json")["Content-Disposition"]
    assert header.isascii()
    assert header.isprintable()
    assert header.count('"') == 2

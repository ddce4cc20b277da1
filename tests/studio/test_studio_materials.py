"""Own materials: brought by requests and documents as texts, never read from the server's files."""

import json
import time

import numpy as np
import pytest
from asking import Client, problem

from simulearn import simulate
from simulearn.grid import Grid, grid_to_dict, make
from simulearn.interop import frames
from simulearn.material import load_material, material_text, own_material
from simulearn.studio.settings import Settings

PLA = material_text("pla-hot-water")
SMALL = grid_to_dict(make("saddle", (1, 1), 60.0))


def text_of(name="my-pla", **values):
    """Return the text of PLA with a name and other values of keys."""
    text = PLA.replace('name = "pla-hot-water"', f'name = "{name}"')
    for key, value in values.items():
        lines = text.splitlines()
        k = next(k for k, line in enumerate(lines) if line.startswith(f"{key} ="))
        lines[k] = f"{key} = {value}"
        text = "\n".join(lines)
    return text


MINE = text_of(width=8.0, curl=0.01)
GRID = SMALL | {"material": "my-pla"}
BODY = {"grids": [GRID], "materials": [MINE]}


@pytest.fixture(scope="module")
def client():
    return Client(Settings())


def finished(client, job):
    for _ in range(1200):
        body = client.get(f"/api/jobs/{job}").json()
        if body["state"] not in ("queued", "running"):
            return body
        time.sleep(0.05)
    raise AssertionError(body)


def test_what_is_known_of_materials(client):
    (pla,) = client.get("/api/materials").json()["materials"]
    assert pla["name"] == "pla-hot-water"
    assert pla["strain"] == load_material("pla-hot-water").shrinkage.active
    assert pla["learned"] == {"knows": "inside", "message": ""}
    assert client.get("/api/materials/pla-hot-water").text == PLA
    problem(client.get("/api/materials/other"), 404, "material-unknown")
    texts = [
        MINE,
        text_of("wide", width=11.2),
        text_of("soft", kind='"neo-hookean"').replace("table = [", "# table = [").split("    [0")[0]
        + PLA[PLA.index("\n[shrinkage]") :],
    ]
    mine, wide, soft = client.post("/api/materials", {"materials": texts}).json()["materials"]
    assert (mine["section"]["width"], mine["curl"]) == (8.0, 0.01)
    assert mine["learned"]["knows"] == "inside"
    assert wide["learned"]["knows"] == "outside"
    assert "width over thickness is 2.8" in wide["learned"]["message"]
    assert soft["learned"]["knows"] == "no"
    assert "law is of another form" in soft["learned"]["message"]


def test_a_grid_is_simulated_as_of_its_own_material(client):
    body = client.post("/api/simulate", BODY | {"grids": [SMALL, GRID]}).json()
    pla, mine = body["results"]
    assert pla["grid"]["material"] == "pla-hot-water"
    assert (mine["grid"]["material"], mine["material"]["name"]) == ("my-pla", "my-pla")
    assert mine["material"]["digest"] == own_material(MINE).digest
    same = simulate(Grid(**_arrays(SMALL), material=own_material(MINE)), "learned")
    assert np.allclose(mine["joints"], same.joints, atol=1e-4)
    assert np.abs(np.subtract(mine["joints"], pla["joints"])).max() > 1.0
    binary = client.post("/api/simulate", BODY, headers={"Accept": frames.MEDIA_TYPE})
    assert binary.content[:4] == b"SLF1"
    # What a request brings is gone with it.
    (failure,) = client.post("/api/simulate", {"grids": [GRID]}).json()["results"]
    assert failure["code"] == "material-unknown"


def test_a_material_that_the_model_has_not_learnt(client):
    far = {"grids": [GRID], "materials": [text_of(width=16.0, shell=2.0)]}
    (failure,) = client.post("/api/simulate", far).json()["results"]
    assert failure["code"] == "material-not-learnt"
    assert "finite elements" in failure["hint"]
    near = {"grids": [GRID], "materials": [text_of(width=11.2)]}
    (result,) = client.post("/api/simulate", near).json()["results"]
    assert "material-beyond" in [warning["code"] for warning in result["warnings"]]


def test_finite_elements_and_validation(client):
    job = client.post("/api/fea", BODY).json()["job"]
    (result,) = finished(client, job)["result"]["results"]
    assert result["material"]["digest"] == own_material(MINE).digest
    long = text_of(actuator_length=80.0)
    plain = client.post("/api/validate", GRID | {"materials": [MINE]}).json()
    assert plain["errors"] == []
    short = client.post("/api/validate", GRID | {"materials": [long]}).json()
    assert {error["code"] for error in short["errors"]} == {"actuator-short"}
    (wrong,) = client.post("/api/validate", GRID | {"materials": ["x"]}).json()["errors"]
    assert wrong["code"] == "material-file"


def test_ranking_and_search(client):
    goals = [{"vertex": ["joint", 0, "centre"], "target": [0.0, 0.0, 5.0]}]
    task = {"schema": "simulearn.task/1", "grid": GRID, "goals": goals, "engine": "learned"}
    task |= {"free": {"joints": []}, "limits": {"iterations": 3, "seconds": 5.0}}
    task |= {"materials": [MINE]}
    ranking = client.post("/api/rank", task).json()
    assert {one["grid"]["material"] for one in ranking["best"]} == {"my-pla"}
    end = finished(client, client.post("/api/optimize", task).json()["job"])
    assert end["state"] == "done", end["problem"]
    assert end["result"]["grid"]["material"] == "my-pla"
    problem(client.post("/api/rank", task | {"materials": []}), 422, "material-unknown")
    problem(client.post("/api/optimize", task | {"materials": {}}), 422, "material-file")


def test_how_prints_differ(client):
    scattering = text_of(print=0.05, beam=0.03)
    body = {"grids": [GRID], "materials": [scattering], "prints": 30}
    (result,) = client.post("/api/simulate", body).json()["results"]
    spread = result["scatter"]
    assert (spread["prints"], spread["print"], len(spread["joints"])) == (30, 0.05, 4)
    assert spread["overall_mm"] > 0.1
    binary = client.post("/api/simulate", body, headers={"Accept": frames.MEDIA_TYPE})
    (entry,) = frames.from_bytes(binary.content)
    lines = entry["prints"]
    assert lines.shape == (30, len(GRID["beams"]), 3, 3)
    # Around the shape itself, and not all alike.
    middles = np.array(entry["beams"])[-1].mean(axis=2)
    assert np.abs(lines.mean(axis=0) - middles).max() < 1.0
    assert lines.std(axis=0).max() > 0.1
    alike = body | {"materials": [text_of(print=0.0, beam=0.0)]}
    problem(client.post("/api/simulate", alike), 422, "material-scatter")
    two = body | {"grids": [GRID, GRID]}
    problem(client.post("/api/simulate", two), 422, "too-many-grids")
    problem(client.post("/api/simulate", body | {"prints": 1000}), 422, "request")


def test_prints_and_files(client):
    printing = BODY | {"printer": "ender-3"}
    facts = client.post("/api/gcode", printing).json()
    assert facts["material"] == "my-pla"
    pla = client.post("/api/gcode", {"grids": [SMALL], "printer": "ender-3"}).json()
    assert facts["part_g"] > 1.05 * pla["part_g"]
    assert client.post("/api/toolpath", printing).json()["print"]["material"] == "my-pla"
    export = {"grid": GRID, "format": ".json", "materials": [MINE]}
    result = client.post("/api/export", export).json()
    assert result["material"]["digest"] == own_material(MINE).digest


@pytest.mark.parametrize(
    ("texts", "code", "where"),
    [
        ([MINE, text_of("other", width=0)], "material-file", "materials[1].section.width"),
        ([text_of(active='"much"')], "material-file", "materials[0].shrinkage.active"),
        ([MINE + "\n[colour]\n"], "material-file", "materials[0].colour"),
        (["name = "], "material-file", "materials[0]"),
        ([text_of(thickness="1e300")], "material-file", "materials[0].section.thickness"),
        ([text_of(modulus="1e-300")], "material-file", "materials[0].law.modulus"),
        ([text_of(layer="1e-9")], "material-file", "materials[0].print.layer"),
        (["a" + ".a" * 400 + " = 1"], "material-file", "materials[0]"),
        ([PLA], "material-name", "materials[0].name"),
        ([MINE, MINE], "material-name", "materials[1].name"),
        ([text_of("../../secret")], "material-name", "materials[0].name"),
        (["/etc/passwd"], "material-file", "materials[0]"),
        ([text_of(title='"a\\nG28"')], "material-file", "materials[0].title"),
        ([1], "request", "materials[0]"),
        ([MINE] * 17, "request", "materials"),
        (["#" * 2**17], "request", "materials[0]"),
    ],
)
def test_what_is_wrong_with_a_material_and_where(client, texts, code, where):
    answer = problem(client.post("/api/materials", {"materials": texts}), 422, code)
    assert answer["where"].startswith(where)
    assert problem(client.post("/api/simulate", BODY | {"materials": texts}), 422, code)


def test_a_grid_never_names_a_file(client, tmp_path):
    (tmp_path / "mine.toml").write_text(MINE)
    grid = SMALL | {"material": str(tmp_path / "mine.toml")}
    (failure,) = client.post("/api/simulate", {"grids": [grid]}).json()["results"]
    assert failure["code"] == "material-path"
    based = MINE + f'\nbase = "{tmp_path / "mine.toml"}"\n'
    problem(client.post("/api/materials", {"materials": [based]}), 422, "material-file")


def test_documents_keep_their_materials(client):
    document = {
        "schema": "simulearn.document/1",
        "name": "own",
        "grid": GRID,
        "goals": [],
        "printer": "ender-3",
        "materials": [MINE],
    }
    path = f"/api/documents/{'m' * 22}"
    saved = client.request("PUT", path, json={"revision": 0, "document": document})
    assert saved.json() == {"revision": 1}
    assert client.get(path).json()["document"] == document
    opened = client.post("/api/open?name=own.json", content=json.dumps(document)).json()
    assert (opened["materials"], opened["grid"]["material"]) == ([MINE], "my-pla")
    broken = document | {"materials": [MINE.replace("poisson = 0.406", "poisson = 0.6")]}
    refused = client.request("PUT", path, json={"revision": 1, "document": broken})
    assert problem(refused, 422, "material-file")["where"].startswith("materials[0].law.poisson")


def test_a_material_that_takes_too_long_is_stopped():
    hasty = Client(Settings(simulation_seconds=0.0))
    problem(hasty.post("/api/simulate", BODY | {"engine": "fea"}), 422, "time-over")


def _arrays(grid):
    return {key: grid[key] for key in ("joints", "beams", "actuators", "fixed")}

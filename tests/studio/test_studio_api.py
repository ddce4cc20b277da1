"""The REST API: what it answers to what is right, and what it says about what is wrong."""

import asyncio
import json
import threading

import numpy as np
import pytest
from asking import Client, awaited, problem, raw

from simulearn.errors import CancelledError
from simulearn.grid import Grid, grid_to_dict, lattice, make
from simulearn.interop import frames
from simulearn.inverse import rank, task_from_dict
from simulearn.simulate import engine, outcome_to_dict
from simulearn.studio.routes import designs
from simulearn.studio.settings import Settings


@pytest.fixture(scope="module")
def client():
    return Client()


@pytest.fixture(scope="module")
def saddle():
    return grid_to_dict(make("saddle", (1, 1)))


def task(**changes):
    return {
        "schema": "simulearn.task/1",
        "grid": grid_to_dict(make("saddle", (1, 1))),
        "goals": [{"vertex": ["joint", 3, "centre"], "target": [65, 65, 10]}],
        **changes,
    }


def test_version_names_what_there_is(client):
    answer = client.get("/api/version").json()
    assert answer["engines"] == ["learned", "beams", "fea"]
    assert answer["model"]["name"] == "equilibrium"
    assert ".json" in answer["formats"]
    assert answer["ready"] in (True, False)
    assert answer["limits"]["grids"] == Settings().grids


def test_ready_says_whether_kernels_are_compiled(saddle):
    fresh = Client()
    assert fresh.get("/api/version").json()["ready"] is False
    assert fresh.post("/api/simulate", {"grids": [saddle]}).status_code == 200
    assert fresh.get("/api/version").json()["ready"] is True


def test_library_materials_printers(client):
    library = client.get("/api/library").json()["designs"]
    twist = next(design for design in library if design["name"] == "twist")
    assert twist["grid"] == grid_to_dict(make("twist"))
    (material,) = client.get("/api/materials").json()["materials"]
    assert material["name"] == "pla-hot-water"
    assert material["section"] == {"width": 7.2, "thickness": 4.0, "shell": 0.9}
    assert material["limits"]["actuator_length"] == 10
    printers = {one["name"]: one for one in client.get("/api/printers").json()["printers"]}
    assert printers["bambu-x1"]["nozzle"] == 0.4
    assert printers["ender-3"]["bed"]["width"] == 220
    facts = {"firmware", "sources", "tried", "reach"}
    assert all(facts <= one.keys() for one in printers.values())
    assert all({"shape", "excluded"} <= one["bed"].keys() for one in printers.values())


def test_validate_says_what_the_command_line_says(client, run, tmp_path):
    grid = Grid([[0, 0], [65, 0], [65, 65], [0, 65]], [[0, 1], [1, 2], [2, 3], [3, 0]],
                [0.05, 1, 0, 0], 0)  # fmt: skip
    file = tmp_path / "grid.json"
    file.write_text(json.dumps(grid_to_dict(grid)))
    _, text, _ = run("validate", file, "--json")
    answer = client.post("/api/validate", grid_to_dict(grid)).json()
    assert answer == json.loads(text)
    assert [error["code"] for error in answer["errors"]] == ["actuator-short"]


def test_validate_answers_for_what_is_no_grid(client, saddle):
    answer = client.post("/api/validate", {**saddle, "actuators": [2, 0, 0, 0]}).json()
    assert [(e["code"], e["where"]) for e in answer["errors"]] == [("actuator-ratio", "beam 0")]
    answer = client.post("/api/validate", {"joints": []}).json()
    assert answer["errors"][0]["code"] == "grid-file"
    answer = client.post("/api/validate", {**saddle, "material": "nylon"}).json()
    assert answer["errors"][0]["code"] == "material-unknown"
    problem(client.post("/api/validate", [saddle]), 422, "grid-file")


def test_simulate_answers_as_the_engine_does(client, saddle):
    for name in ("learned", "beams", "fea"):
        answer = client.post("/api/simulate", {"grids": [saddle], "engine": name}).json()
        expected = outcome_to_dict(engine(name).simulate([make("saddle", (1, 1))])[0])
        (result,) = answer["results"]
        result.pop("seconds")
        expected.pop("seconds")
        assert result == expected


def test_a_design_that_fails_takes_no_other_with_it(client, saddle):
    invalid = {**saddle, "actuators": [0.01, 0, 0, 0]}
    large = grid_to_dict(lattice((20, 20), 65))
    unknown = {**saddle, "material": "nylon"}
    path = {**saddle, "material": "/etc/passwd.toml"}
    entries = [saddle, None, invalid, 7, {"joints": 1}, large, unknown, path, saddle]
    results = client.post("/api/simulate", {"grids": entries}).json()["results"]
    codes = [one.get("code") for one in results]
    assert codes == [
        None, "grid-file", "actuator-short", "grid-file", "grid-file", "too-large",
        "material-unknown", "material-path", None,
    ]  # fmt: skip
    assert results[0]["joints"] == results[-1]["joints"]
    assert "at most 300" in results[5]["message"]


def test_frames_come_where_they_are_accepted(client, saddle):
    headers = {"Accept": f"{frames.MEDIA_TYPE}, application/json"}
    answer = client.post("/api/simulate", {"grids": [saddle]}, headers=headers)
    assert answer.headers["content-type"] == frames.MEDIA_TYPE
    assert answer.content[:4] == b"SLF1"
    assert "content-encoding" not in answer.headers


def test_long_text_is_compressed(client, saddle):
    answer = client.post("/api/simulate", {"grids": [saddle]})
    assert answer.headers["content-encoding"] == "gzip"
    assert "content-encoding" not in client.get("/api/version").headers


REFUSED = {
    "unknown engine": ({"engine": "magic"}, "engine-unknown", "engine"),
    "engine for files only": ({"engine": "calculix"}, "engine-unknown", "engine"),
    "unknown model": ({"model": "mine"}, "model-unknown", "model"),
    "path of a model": ({"model": "/tmp/model"}, "model-unknown", "model"),
    "model of another engine": ({"engine": "fea", "model": "paper"}, "engine-model", "model"),
    "no grids": ({"grids": []}, "request", "grids"),
    "grids that are no list": ({"grids": "twist"}, "request", "grids"),
    "unknown key": ({"material": "x"}, "request", "material"),
    "engine that is no name": ({"engine": 3}, "request", "engine"),
    "too many grids": ({"grids": [{}] * 257}, "too-many-grids", "grids"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_wrong_request_is_named_with_its_place(client, saddle, name):
    change, code, where = REFUSED[name]
    body = problem(client.post("/api/simulate", {"grids": [saddle], **change}), 422, code)
    assert body["where"] == where
    assert body["detail"]


def test_finite_elements_answer_one_small_grid(client, saddle):
    two = {"grids": [saddle, saddle], "engine": "fea"}
    assert "/api/fea" in problem(client.post("/api/simulate", two), 422, "too-large")["detail"]
    large = {"grids": [grid_to_dict(lattice((5, 5), 50))], "engine": "fea"}
    problem(client.post("/api/simulate", large), 422, "too-large")


def test_many_large_grids_are_too_many(client):
    small = Client(Settings(beams_in_all=7))
    grids = [grid_to_dict(make("flat", (1, 1)))] * 2
    problem(small.post("/api/simulate", {"grids": grids}), 422, "too-large")
    assert small.post("/api/simulate", {"grids": grids[:1]}).status_code == 200


def test_rank_answers_as_the_library_does(client):
    answer = client.post("/api/rank", task()).json()
    expected = rank(task_from_dict(task()))
    assert answer["error_mm"] == expected.error_mm
    assert len(answer["suggestions"]) == len(expected.suggestions)
    assert [one["words"] for one in answer["best"]] == [s.change.words for s in expected.best]
    assert np.allclose(answer["best"][0]["points"], expected.best[0].points)
    assert answer["best"][0]["grid"] == grid_to_dict(expected.best[0].grid)
    errors = [one["error_mm"] for one in answer["suggestions"]]
    assert errors == sorted(errors)


def test_rank_refuses_what_is_wrong(client):
    body = problem(client.post("/api/rank", task(goals=[])), 422, "task")
    assert body["where"] == "goals"
    problem(client.post("/api/rank", task(surprise=1)), 422, "task")
    problem(client.post("/api/rank", task(engine="fea")), 422, "engine-unknown")
    problem(client.post("/api/rank", [1]), 422, "task")
    bent = task(grid={**task()["grid"], "actuators": [0.01, 0, 0, 0]})
    problem(client.post("/api/rank", bent), 422)
    large = {**task(), "grid": grid_to_dict(lattice((8, 8), 50))}
    problem(client.post("/api/rank", large), 422, "too-large")


MALFORMED = {
    "no JSON": (b"{grids", "line 1, column 2"),
    "nothing": (b"", "body"),
    "NaN": (b'{"grids": [NaN]}', "NaN"),
    "infinity": (b'{"grids": [-Infinity]}', "-Infinity"),
    "a key twice": (b'{"grids": [], "grids": []}', '"grids"'),
    "too deep": (b"[" * 200_000, ""),
    "not UTF-8": (b'{"grids": "\xff"}', "byte 11"),
    "endless number": (b"[" + b"1" * 10_000 + b"]", ""),
    "text after": (b"{} {}", "line 1, column 4"),
}


@pytest.mark.parametrize("name", MALFORMED)
@pytest.mark.parametrize("path", ["/api/simulate", "/api/validate", "/api/rank"])
def test_malformed_json_is_refused_with_its_place(client, path, name):
    text, where = MALFORMED[name]
    body = problem(client.post_text(path, text), 400, "json")
    assert body["where"] == where


def test_numbers_and_texts_that_json_allows_are_no_crash(client, saddle):
    text = json.dumps({"grids": [saddle]})
    huge = text.replace("65.0", "1e999")
    results = client.post_text("/api/simulate", huge).json()["results"]
    assert results[0]["code"] == "grid-file"
    surrogate = text.replace("pla-hot-water", "\\ud800")
    assert client.post_text("/api/simulate", surrogate).json()["results"][0]["code"]
    assert client.post_text("/api/validate", '{"\\ud800": 1}').status_code == 200
    problem(client.post_text("/api/simulate", '{"\\ud800": 1, "grids": [1]}'), 422)


@pytest.mark.parametrize("kind", ["text/plain", "application/x-www-form-urlencoded", ""])
def test_only_json_is_read(client, kind):
    problem(client.post_text("/api/simulate", b"{}", kind), 415, "content-type")


def test_json_may_name_its_characters(client, saddle):
    text = json.dumps({"grids": [saddle]})
    answer = client.post_text("/api/simulate", text, "application/json; charset=utf-8")
    assert answer.status_code == 200


def test_unknown_places_and_methods(client):
    problem(client.get("/api/nothing"), 404, "not-found")
    problem(client.get("/page/nothing.js"), 404, "not-found")
    problem(client.get("/libraries/jquery.js"), 404, "not-found")
    answer = client.get("/api/simulate")
    problem(answer, 405, "method")
    assert answer.headers["allow"] == "POST"


def test_a_mistake_of_ours_is_logged_and_not_shown(client, saddle, monkeypatch, caplog):
    def broken(*_):
        raise ZeroDivisionError("secret")

    monkeypatch.setattr(designs, "engine_of", broken)
    answer = client.post("/api/simulate", {"grids": [saddle]})
    problem(answer, 500, "internal")
    assert "secret" not in answer.text
    assert "ZeroDivisionError: secret" in caplog.text
    assert answer.headers["x-content-type-options"] == "nosniff"


class Gate:
    """An engine that answers when it is let."""

    def __init__(self):
        self.begun, self.opened, self.cancelled = (threading.Event() for _ in range(3))

    def simulate(self, grids, progress=None, cancel=None):
        self.begun.set()
        while not self.opened.wait(0.01):
            if cancel.is_set():
                self.cancelled.set()
                raise CancelledError("cancelled")
        return engine("learned").simulate(grids)


def test_more_than_can_wait_is_refused(saddle, monkeypatch):
    busy = Client(Settings(simulations=1, waiting=1))
    gate = Gate()
    monkeypatch.setattr(designs, "engine_of", lambda *_: gate)

    async def ask():
        body = {"json": {"grids": [saddle]}}
        waiting = [
            asyncio.create_task(busy._request("POST", "/api/simulate", body)) for _ in range(2)
        ]
        while not gate.begun.is_set():
            await asyncio.sleep(0.01)
        third = await busy._request("POST", "/api/simulate", body)
        gate.opened.set()
        return third, await asyncio.gather(*waiting)

    refused, answered = awaited(ask())
    problem(refused, 429, "too-many")
    assert int(refused.headers["retry-after"]) >= 1
    assert [answer.status_code for answer in answered] == [200, 200]
    assert busy.post("/api/simulate", {"grids": [saddle]}).status_code == 200


def test_a_simulation_ends_when_its_client_has_gone(saddle, monkeypatch):
    client, gate = Client(), Gate()
    monkeypatch.setattr(designs, "engine_of", lambda *_: gate)
    body = json.dumps({"grids": [saddle]}).encode()
    sent = {"type": "http.request", "body": body, "more_body": False}

    async def leave():
        while not gate.begun.is_set():
            await asyncio.sleep(0.01)
        return {"type": "http.disconnect"}

    headers = {"content-type": "application/json"}
    awaited(raw(client.app, "POST", "/api/simulate", [sent, leave], headers))
    assert gate.cancelled.wait(10)


def test_a_client_that_leaves_while_it_sends_is_no_mistake(client, caplog):
    received = [
        {"type": "http.request", "body": b"{", "more_body": True},
        {"type": "http.disconnect"},
    ]
    headers = {"content-type": "application/json"}
    assert awaited(raw(client.app, "POST", "/api/simulate", received, headers)) == []
    assert caplog.text == ""


@pytest.mark.parametrize("cells", [(5, 5), (6, 7)])
def test_large_grids_come_in_one_message(client, cells):
    grid = grid_to_dict(make("twist", cells))
    headers = {"Accept": frames.MEDIA_TYPE}
    answer = client.post("/api/simulate", {"grids": [grid]}, headers=headers)
    size = int.from_bytes(answer.content[4:8], "little")
    (entry,) = json.loads(answer.content[8 : 8 + size])["results"]
    assert entry["ok"]
    assert entry["arrays"]["beams"]["shape"] == [12, len(grid["beams"]), 3, 4, 3]

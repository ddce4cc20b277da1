"""Drawings of other programs that the studio opens: what it tells, asks and mends."""

import json

import numpy as np
import pytest
from asking import Client, problem
from drawn import DIAGONAL, SIDE, svg, without_unit

from simulearn.grid import grid_from_dict, grid_to_dict, make
from simulearn.studio.settings import Settings


@pytest.fixture(scope="module")
def client():
    return Client(Settings())


def sent(client, data, name="drawing.svg", **options):
    headers = {"Content-Type": "application/octet-stream"}
    params = {"name": name, **options}
    return client.request("POST", "/api/open", params=params, content=data, headers=headers)


def lengths(body):
    grid = grid_from_dict(body["grid"])
    ends = grid.joints[grid.beams]
    return np.sort(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1))


def test_a_drawing_is_opened_and_all_that_was_done_is_reported(client):
    answer = sent(client, svg(), "C:\\mine\\cell.SVG")
    assert answer.status_code == 200
    body = answer.json()
    assert (body["kind"], body["name"], body["goals"]) == ("drawing", "cell", [])
    np.testing.assert_allclose(lengths(body), [SIDE] * 4 + [DIAGONAL], atol=0.01)
    assert sorted(body["grid"]["actuators"]) == [0, 0, 0, 0, 0.5]
    drawing = body["drawing"]
    assert (drawing["format"], drawing["unit"]["name"]) == ("SVG", "mm")
    layers = {layer["name"]: layer for layer in drawing["layers"]}
    assert layers["frame"] | {"name": ""} == {
        "name": "",
        "colour": "#888888",
        "lines": 6,
        "taken": True,
        "ratio": None,
    }
    assert layers["top 0.5"]["ratio"] == 0.5
    mends = {mend["code"]: mend for mend in drawing["mends"]}
    assert {"gap", "overshoot", "crumb", "leaf"} <= mends.keys()
    # y is upwards in the grid: the beam dangles below the lower left corner.
    corner = np.min(body["grid"]["joints"], axis=0)
    np.testing.assert_allclose(mends["leaf"]["places"], [corner - [0, 20]], atol=0.01)
    messages = " ".join(message["message"] for message in body["messages"])
    assert "text" in messages
    assert "circle" in messages
    assert "hidden" in messages


def test_a_mend_is_left_undone(client):
    mended = sent(client, svg()).json()
    body = sent(client, svg(), without=["leaf", "crumb"]).json()
    assert "leaf" not in {mend["code"] for mend in body["drawing"]["mends"]}
    assert len(body["grid"]["beams"]) == len(mended["grid"]["beams"]) + 1


def test_the_unit_is_requested_and_then_taken(client):
    body = problem(sent(client, without_unit()), 422, "unit-unknown")
    assert body["detail"].startswith("drawing: ")
    assert body["size"] == pytest.approx([60, 100], abs=1)
    assert body["guess"]["name"] == "mm"
    assert body["guess"]["source"]
    inches = sent(client, without_unit(), unit="in").json()
    assert inches["drawing"]["unit"]["mm"] == 25.4
    assert lengths(inches).max() == pytest.approx(DIAGONAL * 25.4)
    wide = sent(client, without_unit(), width=2 * SIDE).json()
    np.testing.assert_allclose(lengths(wide), [2 * SIDE] * 4 + [2 * DIAGONAL], atol=0.01)


def test_layers_curves_and_actuators_are_chosen(client):
    frame = sent(client, svg(), layers=["frame"]).json()
    assert [layer["taken"] for layer in frame["drawing"]["layers"]] == [True, False]
    assert len(frame["grid"]["beams"]) == 4
    plain = sent(client, svg(), actuators="none").json()
    assert set(plain["grid"]["actuators"]) == {0}
    flat = sent(client, svg(), flatten=0.5).json()
    assert "curves" not in {message["code"] for message in flat["messages"]}
    assert len(flat["grid"]["beams"]) > len(plain["grid"]["beams"])


@pytest.mark.parametrize(
    ("options", "code", "where"),
    [
        ({"unit": "parsec"}, "unit-name", "unit"),
        ({"width": -1}, "request", "width"),
        ({"width": "nan"}, "request", "width"),
        ({"tolerance": 0}, "request", "tolerance"),
        ({"flatten": "inf"}, "request", "flatten"),
        ({"actuators": "some"}, "request", "actuators"),
        ({"without": ["everything"]}, "request", "without[0]"),
        ({"layers": ["nobody"]}, "layers-unknown", "nobody"),
    ],
)
def test_options_that_make_no_sense_are_refused(client, options, code, where):
    body = problem(sent(client, svg(), **options), 422, code)
    assert body["where"] == where


def test_lists_of_lines_are_drawings(client):
    square = [[0, 0, 0], [SIDE, 0, 0], [SIDE, SIDE, 0], [0, SIDE, 0]]
    lines = [[square[k], square[(k + 1) % 4]] for k in range(4)]
    body = sent(client, json.dumps(lines).encode(), "lines.json").json()
    assert (body["kind"], len(body["grid"]["beams"])) == ("drawing", 4)
    rows = "\n".join(",".join(map(str, [*p, *q])) for p, q in lines)
    body = sent(client, f"x1,y1,z1,x2,y2,z2\n{rows}\n".encode(), "lines.csv").json()
    assert (body["kind"], body["name"], len(body["grid"]["joints"])) == ("drawing", "lines", 4)


def test_a_file_of_ours_is_no_drawing(client):
    grid = grid_to_dict(make("saddle"))
    body = sent(client, json.dumps(grid).encode(), "saddle.dxf", unit="in").json()
    assert (body["kind"], body["name"], body["drawing"]) == ("grid", "saddle", None)
    assert body["grid"] == grid


def test_broken_drawings_are_reported_as_such(client):
    random = np.random.default_rng(14)
    whole = svg()
    for _ in range(40):
        data = bytearray(whole[: random.integers(1, len(whole))])
        for k in random.integers(0, len(data), 6):
            data[k] = random.integers(0, 256)
        answer = sent(client, bytes(data))
        assert answer.status_code in (200, 422), data
        if answer.status_code == 422:
            assert problem(answer, 422)["detail"].startswith("drawing: ")


def test_a_drawing_that_is_too_large_is_refused():
    problem(sent(Client(Settings(file_bytes=100)), svg()), 413, "too-large")

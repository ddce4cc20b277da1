"""Broken requests to the components of Grasshopper: an answer in its words, soon, and no crash."""

import base64
import json
import random
import socket

import pytest
import rhino3dm
from asking import Client
from grasshopper import (
    HEADERS,
    IO_RESPONSE,
    SCHEMA,
    archived,
    conform,
    line_curve,
    numbers,
    points,
    polyline_curve,
    text,
    value,
)

from simulearn.errors import InputError
from simulearn.studio.hops.archives import decoded

SEED = 7
COUNT = 100
CORNERS = [(65.0 * x, 65.0 * y, 0.0) for y in range(2) for x in range(2)]
PAIRS = [(0, 1), (1, 3), (3, 2), (2, 0)]
ODD = [None, True, -1, 3, 0.5, 1e308, "", "x", "{0}", [], {}, [[]], {"a": None}, "\ud800", "NaN"]
NAMES = ["validate", "simulate", "rank", "gcode", "optimise", "poll", "", "nothing", "solve"]


@pytest.fixture(scope="module")
def client():
    one = Client()
    one.app.state.simulations.warm()
    return one


def request(name):
    """Return a request that is right."""
    given = {
        "Curves": [archived(line_curve(CORNERS[a], CORNERS[b])) for a, b in PAIRS],
        "Actuators": numbers(0.5, -0.5, 1, 0),
    }
    if name in ("rank", "optimise"):
        given |= {"Points": points(CORNERS[3]), "Targets": points((60, 60, 10))}
    if name == "optimise":
        given |= {"Seconds": numbers(1)}
    if name == "poll":
        given = {"Job": text("none")}
    values = [{"ParamName": key, "InnerTree": {"{0}": items}} for key, items in given.items()]
    return {"pointer": f"hops/{name}", "modelunits": "Millimeters", "values": values}


def places(node, path=()):
    """Yield the paths to all parts of JSON."""
    yield path
    parts = (
        node.items()
        if isinstance(node, dict)
        else enumerate(node)
        if isinstance(node, list)
        else ()
    )
    for key, part in parts:
        yield from places(part, (*path, key))


def changed(node, path, rng):
    """Return JSON with one part replaced, removed, renamed or doubled."""
    if not path:
        return rng.choice(ODD)
    copy = json.loads(json.dumps(node))
    parent = copy
    for key in path[:-1]:
        parent = parent[key]
    key, how = path[-1], rng.randrange(5)
    if how == 0 and isinstance(parent, dict):
        parent[rng.choice(["", "x", "InnerTree", "{9;9}", "{a}", "type"])] = parent.pop(key)
    elif how == 1:
        del parent[key]
    elif how == 2 and isinstance(parent, list):
        parent.append(parent[key])
    elif how == 3 and isinstance(parent[key], str):
        letters = list(parent[key])
        for _ in range(rng.randint(1, 4)):
            letters.insert(rng.randrange(len(letters) + 1), rng.choice('"{}[]\\,:0-e\u0000é'))
        parent[key] = "".join(letters)
    else:
        parent[key] = rng.choice(ODD)
    return copy


def broken(rng):
    """Return the text of a broken request."""
    body = request(rng.choice(NAMES))
    for _ in range(rng.randint(1, 3)):
        body = changed(body, rng.choice(list(places(body))), rng)
    content = json.dumps(body)
    if rng.random() < 0.2:
        cut = rng.randrange(len(content))
        content = (
            content[:cut] + rng.choice(["", "}", "\x00", "]]"]) + content[cut + rng.randint(0, 9) :]
        )
    return content.encode("utf-8", "surrogatepass")


@pytest.mark.parametrize("part", range(4))
def test_broken_requests_are_answered_in_words_of_hops(client, part):
    rng = random.Random(SEED + part)
    statuses = []
    for _ in range(COUNT // 4 + 10):
        content = broken(rng)
        answer = client.request("POST", "/solve", content=content, headers=HEADERS)
        assert answer.status_code < 500, (content, answer.text)
        conform(answer.json(), SCHEMA)
        assert answer.status_code < 300 or answer.json()["errors"], content
        statuses.append(answer.status_code)
    assert 422 in statuses or 400 in statuses
    for job in client.app.state.jobs._jobs.values():
        job.stop()


@pytest.mark.parametrize("name", ["validate", "simulate", "rank", "gcode"])
def test_the_request_that_is_broken_is_right(client, name):
    answer = client.post("/solve", request(name))
    assert answer.status_code == 200, answer.json()["errors"]


def archives():
    rng = random.Random(SEED)
    line = line_curve((0, 0, 0), (60, 0, 0))
    joined = rhino3dm.PolyCurve()
    joined.Append(line)
    joined.Append(line_curve((60, 0, 0), (60, 60, 0)))
    named = line_curve((0, 0, 0), (60, 0, 0))
    named.SetUserString("actuator", "top 0.5")
    whole = [
        line,
        named,
        joined,
        polyline_curve(CORNERS),
        polyline_curve(CORNERS).ToNurbsCurve(),
        rhino3dm.Circle(30.0).ToNurbsCurve(),
    ]
    for k in range(COUNT):
        fields = dict(whole[k % len(whole)].Encode())
        data = bytearray(base64.b64decode(fields["data"]))
        spot = rng.randrange(len(data) - 4)
        how = rng.randrange(5)
        if how == 0:
            del data[spot:]
        elif how == 1:
            for _ in range(rng.randint(1, 9)):
                data[rng.randrange(len(data))] = rng.randrange(256)
        elif how == 2:
            data[spot : spot + 4] = rng.choice(
                [b"\xff\xff\xff\x7f", b"\xff" * 4, b"\x00\x00\x00\x40"]
            )
        elif how == 3:
            data[spot:spot] = rng.randbytes(rng.randint(1, 40))
        else:
            data = bytearray(rng.randbytes(len(data)))
        yield {**fields, "data": base64.b64encode(bytes(data)).decode()}


def test_damaged_archives_are_reported():
    """Such archives take the library that reads them up to a minute and all memory."""
    errors = []
    for fields in archives():
        try:
            decoded(fields, "Curves[0]")
        except InputError as error:
            errors.append(str(error))
    assert len(errors) > 0.9 * COUNT
    assert all(words.startswith("Curves[0] is ") for words in errors)


def test_archives_that_are_whole_keep_their_points():
    curve = line_curve((1, 2, 3), (4, 5, 6))
    curve.SetUserString("actuator", "top 0.5")
    found = decoded(curve.Encode(), "")
    assert (found.PointAtEnd.X, found.PointAtEnd.Y, found.PointAtEnd.Z) == (4, 5, 6)
    assert found.GetUserString("actuator") == ""  # what hangs on it is left off


@pytest.mark.parametrize(
    "fields",
    [
        None, 3, "x", [], {}, {"data": 3}, {"data": ""}, {"data": "!"},
        {"version": 1, "archive3dm": 60, "opennurbs": 2**40, "data": "AAAA"},
        {"version": "x", "archive3dm": 60, "opennurbs": 1, "data": "AAAA"},
    ],
)  # fmt: skip
def test_what_is_no_archive(fields):
    with pytest.raises(InputError, match="Curves"):
        decoded(fields, "Curves[0]")


def test_large_requests_are_bounded(client):
    curves = [archived(line_curve((k, 0, 0), (k, 60, 0))) for k in range(3000)]
    body = request("validate")
    body["values"] = [{"ParamName": "Curves", "InnerTree": {"{0}": curves}}]
    answer = client.post("/solve", body)
    assert answer.status_code == 422
    branches = {f"{{{k}}}": [value("x", 1)] for k in range(1000)}
    body["values"] = [{"ParamName": "Curves", "InnerTree": branches}]
    answer = client.post("/solve", body)
    assert "1000 branches; at most" in answer.json()["errors"][0]


def test_over_the_wire_as_net_sends_it(studio):
    """The framework of Rhino 7 waits for "100 Continue" before it sends a body."""
    host, _, port = studio.url.removeprefix("http://").partition(":")
    content = json.dumps(request("validate")).encode()
    head = (
        f"POST /solve HTTP/1.1\r\nContent-Type: application/json; charset=utf-8\r\n"
        f"Host: {host}:{port}\r\nContent-Length: {len(content)}\r\nExpect: 100-continue\r\n"
        "Connection: Keep-Alive\r\n\r\n"
    )
    with socket.create_connection((host, int(port)), 120) as link:
        link.sendall(head.encode())
        assert link.recv(100).startswith(b"HTTP/1.1 100 Continue")
        link.sendall(content)
        received = b""
        while b"\r\n\r\n" not in received or not received.endswith(b"}"):
            received += link.recv(65536)
    status, _, answer = received.partition(b"\r\n\r\n")
    assert b" 200 " in status or b" 503 " in status  # its kernels may not be ready yet
    conform(json.loads(answer), SCHEMA)


def test_probing_over_the_wire(studio):
    import urllib.request

    with urllib.request.urlopen(f"{studio.url}/hops/simulate", timeout=60) as answer:
        assert answer.headers["content-type"] == "application/json"
        conform(json.loads(answer.read()), IO_RESPONSE)

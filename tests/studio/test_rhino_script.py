"""The script for Rhino 8, with a model of rhino3dm in Rhino's place and a studio that runs."""

import ast
import importlib.util
import socket
import sys
from pathlib import Path

import numpy as np
import pytest
import rhino3dm
from asking import Client, problem
from grasshopper import CORNERS, PAIRS, RATIOS, line_curve, polyline_curve
from rhino8 import Rhino, installed

from simulearn.grid import Grid, lattice
from simulearn.simulate import engine, one, skin
from simulearn.studio.hops.meshes import SPACING
from simulearn.studio.rhino import simulearn_rhino as script


def layer(ratio):
    return f"grid::{'top' if ratio > 0 else 'bottom'} {abs(ratio):g}" if ratio else "grid::passive"


def drawn(rhino, scale=1.0, moved=lambda p: p, layers=True):
    """Draw a grid of 2 x 2 cells, its actuators on layers or as user text."""
    found = []
    for (a, b), ratio in zip(PAIRS, RATIOS, strict=True):
        ends = [moved(tuple(scale * v for v in CORNERS[k])) for k in (a, b)]
        where = layer(ratio) if layers else "lines"
        found.append(rhino.draw(line_curve(*ends), where, None if layers else str(ratio)))
    return [str(one) for one in found]


def run(monkeypatch, rhino, studio):
    installed(monkeypatch, rhino)
    script.main(script.Rhino8(), script.Studio(studio.url))
    assert rhino.answers == []
    assert all(ended for _, ended in rhino.records)


@pytest.fixture(scope="module")
def result():
    grid = Grid(np.array(CORNERS)[:, :2], PAIRS, RATIOS, 4)
    return one(engine("learned").simulate([grid])[0])


def vertices(mesh):
    points = (mesh.Vertices.Point3dAt(k) for k in range(len(mesh.Vertices)))
    return np.array([[p.X, p.Y, p.Z] for p in points])


@pytest.mark.parametrize("layers", [True, False])
def test_the_shape_of_a_selection_is_drawn(monkeypatch, studio, result, layers):
    rhino = Rhino(answers=["Simulate", "Exit"])
    rhino.selected = drawn(rhino, layers=layers)
    run(monkeypatch, rhino, studio)
    (mesh,) = rhino.objects("SimuLearn::shape")
    (flat,) = rhino.objects("SimuLearn::flat")
    shape = vertices(mesh)
    corners = result.joints[-1].reshape(-1, 3) + np.array([65, 65, 0])
    apart = np.linalg.norm(shape[:, None] - corners, axis=-1).min(axis=0)
    assert apart.max() < 1e-3
    assert np.ptp(vertices(flat)[:, 2]) == pytest.approx(4.0, abs=1e-4)
    assert rhino.records[0][0] == "SimuLearn Simulate"
    assert any("the unit is mm" in text for text in rhino.written)


def test_the_surface_is_that_of_the_pictures(result):
    from simulearn.show.style import colours
    from simulearn.simulate import result_to_dict

    points, faces, paint = script.surface(result_to_dict(result), -1)
    ours, theirs = np.array(points)[np.array(faces)], skin(result, SPACING)
    rgb = np.rint(255 * colours(theirs.ratio, theirs.joint, result.grid.fixed)).astype(int)
    areas = {}
    for name, quads, tones in (
        ("script", ours, np.array(paint)[np.array(faces)[:, 0]]),
        ("skin", theirs.vertices[-1][theirs.quads], rgb),
    ):
        area = (
            np.linalg.norm(np.cross(quads[:, 2] - quads[:, 0], quads[:, 3] - quads[:, 1]), axis=1)
            / 2
        )
        names = [tuple(tone) for tone in tones.tolist()]
        areas[name] = {
            n: sum(a for a, m in zip(area, names, strict=True) if m == n) for n in set(names)
        }
    near = {}
    for tone, area in areas["script"].items():  # colours are rounded twice
        close = min(
            areas["skin"],
            key=lambda other: max(abs(a - b) for a, b in zip(tone, other, strict=True)),
        )
        assert max(abs(a - b) for a, b in zip(tone, close, strict=True)) <= 1
        near[close] = area
    joints = {(166, 166, 166), (58, 58, 58)}  # whose hidden sides the script draws, too
    for tone, area in areas["skin"].items():
        if tone not in joints:
            assert near[tone] == pytest.approx(area, rel=1e-3)


@pytest.mark.parametrize("units", ["Inches", "Meters"])
def test_a_model_in_other_units(monkeypatch, studio, result, units):
    mm = {"Inches": 25.4, "Meters": 1000.0}[units]
    rhino = Rhino(units, answers=["Simulate", "Exit"])
    rhino.selected = drawn(rhino, 1 / mm, moved=lambda p: (p[0] + 3, 7.0, p[1]))
    run(monkeypatch, rhino, studio)
    (mesh,) = rhino.objects("SimuLearn::shape")
    corners = result.joints[-1].reshape(-1, 3) + np.array([65, 65, 0])
    # The front of the plane xz is its upper side.
    expected = np.stack([corners[:, 0], -corners[:, 2], corners[:, 1]], axis=1) / mm + [3, 7, 0]
    apart = np.linalg.norm(vertices(mesh)[:, None] - expected, axis=-1).min(axis=0)
    assert apart.max() < 1e-3
    assert any(units in text for text in rhino.written)
    assert any("own plane" in text for text in rhino.written)


def test_layers_are_chosen_where_nothing_is_picked(monkeypatch, studio):
    rhino = Rhino(answers=[None, sorted({layer(r) for r in RATIOS}), "Validate", "Exit"])
    drawn(rhino)
    rhino.draw(line_curve((0, 0, 0), (9, 9, 9)), "notes")
    run(monkeypatch, rhino, studio)
    assert rhino.written[-1] == "The grid can be printed and simulated."


def test_what_is_wrong_is_said_and_marked(monkeypatch, studio):
    rhino = Rhino(answers=["Validate", "Validate", "Simulate", "Exit"])
    rhino.selected = drawn(rhino)
    rhino.selected[0] = str(rhino.draw(line_curve(CORNERS[0], CORNERS[1]), "grid::top 0.05"))
    rhino.selected.append(str(rhino.draw(rhino3dm.Circle(20.0).ToNurbsCurve())))
    run(monkeypatch, rhino, studio)
    assert "1 curves are not straight and were left out." in rhino.written
    errors = [text for text in rhino.written if text.startswith("error: ")]
    assert errors
    assert "The grid is not valid." in rhino.written
    text, place = rhino.dots[0]
    assert f"error: {text}" in errors
    assert pytest.approx((32.5, 0)) == (place.X, place.Y)
    assert len(rhino.objects("SimuLearn::messages")) < len(rhino.dots)  # the old ones are deleted
    assert rhino.objects("SimuLearn::shape") == []


def test_mends_are_marked(monkeypatch, studio):
    rhino = Rhino(answers=["Validate", "Exit"])
    rhino.selected = drawn(rhino)
    rhino.selected[0] = str(rhino.draw(line_curve((0, 0, 0), (64.5, 0, 0)), "grid::top 1"))
    run(monkeypatch, rhino, studio)
    assert any("gap" in text for text, _ in rhino.dots)
    assert "The grid can be printed and simulated." in rhino.written


def test_a_suggestion_is_drawn_and_its_axes_can_be_picked_again(monkeypatch, studio):
    answers = ["Rank", CORNERS[8], (125, 125, 20), None, "Suggestion1", "Exit"]
    rhino = Rhino(answers=answers)
    rhino.selected = drawn(rhino)
    run(monkeypatch, rhino, studio)
    assert any(text.startswith("1: ") for text in rhino.written)
    assert len(rhino.objects("SimuLearn::suggestion")) == 1
    axes = rhino.objects("SimuLearn::suggestion axes")
    assert len(axes) == 12
    again = Rhino(answers=["Simulate", "Exit"])
    names = [name for name in rhino.layers_used() if "suggestion axes" in name]
    again.selected = [
        str(
            again.draw(polyline_curve([(p.X, p.Y, p.Z) for p in curve.TryGetPolyline()]), name[11:])
        )
        for name in names
        for curve in rhino.objects(name)
    ]
    assert len(again.selected) == 12
    run(monkeypatch, again, studio)
    (first,), (second,) = rhino.objects("SimuLearn::suggestion"), again.objects("SimuLearn::shape")
    bounds = [np.ptp(vertices(mesh), axis=0) for mesh in (first, second)]
    assert bounds[0] == pytest.approx(bounds[1], abs=0.05)


def test_a_point_on_no_joint_is_refused_and_goals_are_needed(monkeypatch, studio):
    rhino = Rhino(answers=["Rank", (30, 30, 0), (0, 0, 9), "Rank", None, "Exit"])
    rhino.selected = drawn(rhino)
    run(monkeypatch, rhino, studio)
    assert any("mm from the nearest joint" in text for text in rhino.written)
    assert rhino.written[-1] == "No goals were set."


def test_gcode_is_saved(monkeypatch, studio, tmp_path):
    rhino = Rhino(answers=["Gcode", "ender3", tmp_path, "Gcode", "ender3", None, "Exit"])
    rhino.selected = drawn(rhino)
    run(monkeypatch, rhino, studio)
    (file,) = tmp_path.iterdir()
    text = file.read_bytes().decode()
    assert file.name == "grid.gcode"
    assert "G1 X" in text
    assert "\r" not in text
    assert any(str(file) in line and "min" in line for line in rhino.written)


def test_options(monkeypatch, studio):
    answers = ["Options", 0, "beams", CORNERS[0], "Simulate", "Options", 11, "", None, "Exit"]
    rhino = Rhino(answers=answers)
    rhino.selected = drawn(rhino)
    run(monkeypatch, rhino, studio)
    (mesh,) = rhino.objects("SimuLearn::shape")
    assert np.ptp(vertices(mesh)[:, 2]) == pytest.approx(4.0, abs=1e-3)  # frame 0 is flat


def test_curves_that_are_no_grid(monkeypatch, studio):
    rhino = Rhino("Meters", answers=["Simulate", "Exit"])
    rhino.selected = drawn(rhino)  # 65 m long
    run(monkeypatch, rhino, studio)
    assert any("middle beam would be" in text for text in rhino.written)
    empty = Rhino(answers=[None, None])
    run(monkeypatch, empty, studio)
    assert empty.written == ["No curves were picked."]


# Where the studio is


def test_no_studio_is_said_in_plain_words(monkeypatch):
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    monkeypatch.setattr(script, "PORTS", [port])
    monkeypatch.setattr(script, "find", lambda: None)
    rhino = Rhino()
    installed(monkeypatch, rhino)
    script.main(script.Rhino8())
    assert rhino.written[0].startswith("The studio is not running on this machine. Start it")


def test_the_studio_is_found_among_others(monkeypatch, studio):
    monkeypatch.delenv("SIMULEARN_STUDIO", raising=False)
    port = int(studio.url.rpartition(":")[2])
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))  # no one listens there
        found = script.find([other.getsockname()[1], port])
    assert found.address == studio.url
    assert script.find([1]) is None
    monkeypatch.setenv("SIMULEARN_STUDIO", f"{studio.url}/")
    assert script.find([1]).address == studio.url
    monkeypatch.setenv("SIMULEARN_STUDIO", "http://127.0.0.1:1")
    assert script.find([port]) is None


def test_a_studio_that_ends_meanwhile(monkeypatch):
    rhino = Rhino(answers=["Simulate"])
    rhino.selected = drawn(rhino)
    installed(monkeypatch, rhino)
    script.main(script.Rhino8(), script.Studio("http://127.0.0.1:1"))
    assert "is it still running?" in rhino.written[-1]


# The file


def source():
    return Path(script.__file__).read_text(encoding="utf-8")


def test_the_script_is_served():
    client = Client()
    answer = client.get("/rhino/simulearn_rhino.py")
    assert answer.text == source()
    assert answer.headers["content-type"].startswith("text/x-python")
    assert 'filename="simulearn_rhino.py"' in answer.headers["content-disposition"]
    assert answer.text.startswith("#! python3\n")


def test_the_script_is_python_3_9_with_its_standard_library():
    tree = ast.parse(source(), feature_version=(3, 9))
    modules = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            modules |= {name.name.partition(".")[0] for name in node.names}
        elif isinstance(node, ast.ImportFrom):
            modules.add(str(node.module).partition(".")[0])
    rhino = {"Rhino", "rhinoscriptsyntax", "scriptcontext"}
    assert modules - rhino <= sys.stdlib_module_names
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
    assert not any(word.arg == "strict" for call in calls for word in call.keywords)


def test_without_rhino_the_script_can_be_read():
    spec = importlib.util.spec_from_file_location("alone", script.__file__)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    with pytest.raises(ModuleNotFoundError):
        module.Rhino8()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("0.5", "top 0.500000"), ("-1", "bottom 1.000000"), ("0,25", "top 0.250000"),
        ("0", "passive"), ("top 30%", "top 30%"), ("", "own"), (None, "own"),
    ],
)  # fmt: skip
def test_user_text_goes_before_the_layer(text, expected):
    assert script.layer_of({"layer": "own", "text": text}) == expected


def test_the_route_of_lines_says_what_is_wrong():
    client = Client()
    problem(client.post("/rhino/grid", {"lines": []}), 422, "no-lines")
    problem(client.post("/rhino/grid", {"lines": [{"points": [[0, 0, 0]]}]}), 422)
    problem(client.post("/rhino/grid", {"lines": [{"points": [[0, 0], [1, 1]]}]}), 422)
    problem(client.post("/rhino/grid", {"lines": 3}), 422)
    grid = lattice((2, 1))
    lines = [
        {"points": [[*grid.joints[a], 0.0], [*grid.joints[b], 0.0]], "layer": "top 0.5"}
        for a, b in grid.beams.tolist()
    ]
    answer = client.post("/rhino/grid", {"lines": lines, "units": "Millimeters"}).json()
    assert answer["grid"]["actuators"] == [0.5] * len(lines)
    assert any("actuators by layer" in one["text"] for one in answer["remarks"])
    near = [{**lines[0], "layer": "tpo 0.5"}, *lines[1:]]
    answer = client.post("/rhino/grid", {"lines": near}).json()
    remarks = [one["text"] for one in answer["remarks"] if not one["quiet"]]
    assert any("tpo 0.5" in text for text in remarks)
    assert any("millimetres are taken" in text for text in remarks)

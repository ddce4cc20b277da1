"""Hops, the component of Grasshopper, asks the studio: what it reads, sends and shows."""

import json
import sys
from itertools import combinations

import numpy as np
import pytest
import rhino3dm
from asking import HOME, Client
from grasshopper import (
    CORNERS,
    ENTRY,
    HEADERS,
    IO_RESPONSE,
    PAIRS,
    RATIOS,
    SCHEMA,
    Hops,
    archived,
    conform,
    line_curve,
    line_struct,
    numbers,
    points,
    polyline_curve,
    text,
    value,
)

from simulearn.grid import Grid, grid_from_dict, make
from simulearn.material import material_text
from simulearn.simulate import engine, one
from simulearn.studio.settings import Settings

BENT = [(0, 0, 0), (60, 0, 0), (0, 60, 0), (60, 60, 50)]


@pytest.fixture(scope="module")
def client():
    one = Client()
    one.app.state.simulations.warm()
    return one


@pytest.fixture
def place(client):
    """Return a function that puts a component on the canvas."""

    def ask(method, address, content, headers):
        path = address.removeprefix(HOME)
        return client.request(method, path, content=content, headers=headers)

    Hops.cache.clear()
    return lambda name, units="Millimeters": Hops(ask, f"{HOME}/hops/{name}", units)


def drawn(scale=1.0, moved=lambda p: p, curve=line_curve):
    """Return the curves of a grid of 2 x 2 cells."""
    spots = [moved(tuple(scale * v for v in corner)) for corner in CORNERS]
    return [archived(curve(spots[a], spots[b])) for a, b in PAIRS]


def vertices(mesh):
    return np.array(
        [[p.X, p.Y, p.Z] for p in (mesh.Vertices.Point3dAt(k) for k in range(len(mesh.Vertices)))]
    )


def ends(curve):
    a, b = curve.PointAtStart, curve.PointAtEnd
    return np.array([[a.X, a.Y, a.Z], [b.X, b.Y, b.Z]])


def expected(ratios=RATIOS, scale=1.0):
    joints = np.array(CORNERS)[:, :2]
    grid = Grid(joints, PAIRS, ratios, 4)
    return one(engine("learned").simulate([grid])[0])


# What Hops reads


@pytest.mark.parametrize("path", ["/hops", "/hops/"])
def test_components_are_listed(client, path):
    answer = client.get(path)
    assert answer.headers["content-type"] == "application/json"
    entries = answer.json()
    conform(entries, [ENTRY])
    assert [entry["Name"] for entry in entries] == [
        "Validate", "Simulate", "Rank", "Optimise", "Poll", "G-code",
    ]  # fmt: skip
    for entry in entries:  # Hops appends them to the address of the list
        conform(client.get("/hops" + entry["Uri"]).json(), IO_RESPONSE)


@pytest.mark.parametrize("name", ["validate", "simulate/", "Rank", "optimise", "poll", "gcode"])
def test_a_component_says_what_it_takes(place, client, name):
    component = place(name)
    assert component.balloon.errors == []
    assert component.inputs
    assert component.outputs
    described = client.get(f"/io?pointer=hops/{name}").json()
    assert described == client.get(f"/hops/{name}").json()
    assert described == client.post("/io", {"pointer": f"hops/{name}"}).json()


def test_what_hops_makes_of_the_inputs(place):
    component = place("simulate")
    kinds = {name: component.access(name) for name in component.inputs}
    assert kinds == {
        "Curves": "list", "Actuators": "list", "Fixed": "list", "Engine": "item", "Frame": "item",
        "Material": "list",
    }  # fmt: skip
    assert component.inputs["Curves"]["AtLeast"] == 1
    assert component.inputs["Actuators"]["AtLeast"] == 0  # so Hops makes it optional


def test_the_icon_is_a_picture_of_24_pixels(client):
    import base64
    import io

    from PIL import Image

    icon = client.get("/hops/simulate").json()["Icon"]
    assert Image.open(io.BytesIO(base64.b64decode(icon))).size == (24, 24)


@pytest.mark.parametrize("method", ["GET", "HEAD"])
def test_servers_are_probed(client, method):
    assert client.request(method, "/healthcheck").status_code == 200
    assert client.request(method, "/version").headers["content-type"] == "application/json"
    assert client.request(method, "/hops/simulate").status_code == 200
    assert client.get("/healthcheck").text == "healthy"
    assert client.get("/version").json().keys() == {"rhino", "compute", "git_sha"}


def test_an_unknown_component_is_reported_in_the_balloon(place):
    component = place("simulat")
    (error,) = component.balloon.errors
    assert error.startswith("there is no component 'simulat'; there are validate, simulate, rank")


# What it computes


def test_simulate_gives_the_shape_that_the_engine_gives(place):
    component = place("simulate")
    component.solve({"Curves": drawn(), "Actuators": numbers(*RATIOS)})
    assert component.balloon.errors == component.balloon.warnings == []
    result = expected()
    assert component.flat("Joints") == pytest.approx(result.centres[-1] + [65, 65, 0], abs=1e-6)
    (mesh,), (flat,) = component.flat("Mesh"), component.flat("Flat")
    shape = vertices(mesh)
    corners = result.joints[-1].reshape(-1, 3) + np.array([65, 65, 0])
    apart = np.linalg.norm(shape[:, None] - corners, axis=-1).min(axis=0)
    assert apart.max() < 1e-3
    assert np.ptp(vertices(flat)[:, 2]) == pytest.approx(4.0)
    assert len(mesh.VertexColors) == len(mesh.Vertices)
    colours = {tuple(mesh.VertexColors[k][:3]) for k in range(len(mesh.VertexColors))}
    assert (213, 94, 0) in colours  # all of a beam in the top half
    assert (0, 114, 178) in colours
    assert component.flat("Ratios") == RATIOS
    assert component.flat("Bound") == [pytest.approx(result.bound_mm)]
    assert component.flat("Stable") == [True]
    assert len(component.flat("Axes")) == 12
    grid = grid_from_dict(json.loads(component.flat("Grid")[0]))
    assert (grid.joints == np.array(CORNERS)[:, :2]).all()


def test_a_material_is_a_name_or_the_lines_of_a_file(place):
    component = place("simulate")
    words = {"Curves": drawn(), "Actuators": numbers(*RATIOS)}

    def joints(*lines):
        given = {"Material": [value("System.String", line) for line in lines]}
        component.solve(words | given)
        assert component.balloon.errors == []
        return np.array(component.flat("Joints"))

    pla = joints("pla-hot-water")
    text = material_text("pla-hot-water").replace('name = "pla-hot-water"', 'name = "my-pla"')
    assert joints(*text.splitlines()) == pytest.approx(pla, abs=1e-6)
    weak = text.replace("active = 0.09261", "active = 0.0741").replace(
        "shell = 0.09261", "shell = 0.0741"
    )
    heights = joints(weak)[:, 2]
    assert np.ptp(heights) < 0.95 * np.ptp(pla[:, 2])
    assert json.loads(component.flat("Grid")[0])["material"] == "my-pla"
    component.solve(words | {"Material": [value("System.String", "/etc/passwd")]})
    assert "it is one of pla-hot-water" in component.balloon.errors[0]


def test_the_first_frame_is_flat(place):
    component = place("simulate")
    component.solve({"Curves": drawn(), "Frame": [value("System.Int32", 0)]})
    assert np.array(component.flat("Joints")) == pytest.approx(np.array(CORNERS), abs=1e-9)
    for curve, (a, b) in zip(component.flat("Axes"), PAIRS, strict=True):
        assert ends(curve) == pytest.approx(np.array([CORNERS[a], CORNERS[b]]), abs=1e-9)


def test_without_actuators_a_grid_is_passive(place):
    component = place("validate")
    component.solve({"Curves": drawn()})
    assert component.flat("Ratios") == [0.0] * 12
    assert component.flat("Valid") == [True]


@pytest.mark.parametrize(
    ("units", "mm"),
    [
        ("Millimeters", 1.0),
        ("Centimeters", 10.0),
        ("Meters", 1000.0),
        ("Inches", 25.4),
        ("Feet", 304.8),
    ],
)
def test_results_are_in_the_units_of_the_model(place, units, mm):
    result = expected()
    component = place("simulate", units)
    component.solve({"Curves": drawn(1 / mm), "Actuators": numbers(*RATIOS)})
    joints = (result.centres[-1] + [65, 65, 0]) / mm
    assert component.flat("Joints") == pytest.approx(joints, abs=1e-4 / mm)
    assert component.flat("Bound")[0] == pytest.approx(result.bound_mm / mm, rel=1e-3)
    messages = [message for message in component.flat("Messages") if units in message]
    assert messages
    checked = place("validate", units)
    checked.solve({"Curves": drawn(1 / mm)})
    assert any(units in text for text in checked.balloon.warnings) == (mm != 1)


@pytest.mark.parametrize("units", [None, "None", "Unset"])
def test_a_model_without_units_is_in_millimetres_and_that_is_reported(place, units):
    component = place("validate", units)
    component.solve({"Curves": drawn()})
    assert any("millimetres are taken" in text for text in component.balloon.warnings)
    assert component.flat("Valid") == [True]


@pytest.mark.parametrize(("units", "words"), [("Meters", "middle beam"), ("Bananas", "Bananas")])
def test_a_size_or_unit_that_cannot_be_meant_is_an_error(place, units, words):
    component = place("simulate", units)
    component.solve({"Curves": drawn()})
    assert component.values == {}
    assert words in component.balloon.errors[0]


def turned(p):
    """Return a point of the plane xy in the plane xz, away from the origin."""
    return (p[0] + 10, 500.0, p[1] - 20)


def test_a_grid_in_another_plane_stays_in_it(place):
    component = place("simulate")
    component.solve({"Curves": drawn(moved=turned), "Actuators": numbers(*RATIOS)})
    assert any("own plane" in text for text in component.balloon.warnings)
    joints = np.array(component.flat("Joints"))
    result = expected()
    # Its upper side faces the viewer of the front view, who sees z upwards.
    centres = result.centres[-1] + [65, 65, 0]
    back = np.stack([centres[:, 0] + 10, 500 - centres[:, 2], centres[:, 1] - 20], axis=1)
    assert joints == pytest.approx(back, abs=1e-4)


def test_a_slanted_grid_keeps_its_joints(place):
    c, s = np.cos(0.4), np.sin(0.4)
    component = place("simulate")

    def slanted(p):
        return (p[0] - 7, c * p[1] + 3, s * p[1] + 100)

    component.solve({"Curves": drawn(moved=slanted), "Frame": [value("System.Int32", 0)]})
    spots = np.array([slanted(p) for p in CORNERS])
    joints = np.array(component.flat("Joints"))
    assert np.linalg.norm(joints[:, None] - spots, axis=-1).min(axis=1).max() < 1e-6


def test_a_grid_far_from_the_origin_is_answered_there(place):
    component = place("simulate")
    component.solve({"Curves": drawn(moved=lambda p: (p[0] + 2e6, p[1] - 3e6, 40.0))})
    joints = np.array(component.flat("Joints"))
    assert joints[0, :2] == pytest.approx([2e6, -3e6], abs=10)


# Every form in which Rhino writes a curve


def in_one(a, b):
    curve = rhino3dm.PolyCurve()
    middle = [(p + q) / 2 for p, q in zip(a, b, strict=True)]
    curve.Append(line_curve(a, middle))
    curve.Append(line_curve(middle, b))
    return curve


FORMS = {
    "LineCurve": lambda a, b: archived(line_curve(a, b)),
    "PolylineCurve": lambda a, b: archived(polyline_curve([a, b])),
    "NurbsCurve": lambda a, b: archived(line_curve(a, b).ToNurbsCurve()),
    "PolyCurve": lambda a, b: archived(in_one(a, b)),
    "Line": line_struct,
    "Polyline": lambda a, b: value(
        "Rhino.Geometry.Polyline", [dict(zip("XYZ", p, strict=True)) for p in (a, b)]
    ),
    "archive 70": lambda a, b: archived(line_curve(a, b), 70),
    "archive 80": lambda a, b: archived(line_curve(a, b), 80),
    "texts": lambda a, b: value(
        "Rhino.Geometry.LineCurve", {k: str(v) for k, v in line_curve(a, b).Encode().items()}
    ),
    "no text": lambda a, b: {"type": "", "data": line_curve(a, b).Encode()},
}


@pytest.mark.parametrize("form", FORMS)
def test_every_form_of_a_line_is_read(place, form):
    component = place("validate")
    curves = [FORMS[form](CORNERS[a], CORNERS[b]) for a, b in PAIRS]
    component.solve({"Curves": curves, "Actuators": numbers(*RATIOS)})
    assert component.balloon.errors == []
    assert component.flat("Ratios") == RATIOS
    for curve, (a, b) in zip(component.flat("Axes"), PAIRS, strict=True):
        assert ends(curve) == pytest.approx(np.array([CORNERS[a], CORNERS[b]]), abs=1e-9)


def test_a_polyline_is_many_beams_of_one_ratio(place):
    component = place("validate")
    rows = [polyline_curve(CORNERS[3 * k : 3 * k + 3]) for k in range(3)]
    columns = [polyline_curve(CORNERS[k::3]) for k in range(3)]
    curves = [archived(curve) for curve in (*rows, *columns)]
    component.solve({"Curves": curves, "Actuators": numbers(1, -0.5, 0.25, 0, 0, -1)})
    ratios = dict.fromkeys([1.0, -0.5, 0.25, -1.0], 2) | {0.0: 4}
    found = component.flat("Ratios")
    assert {r: found.count(r) for r in set(found)} == ratios


def test_ratios_stay_on_the_beams_that_lie_on_their_curves(place):
    """Lines that miss each other, cross, run past joints, and are drawn twice."""
    rng = np.random.default_rng(3)
    lines, ratios = [], []
    for k in range(3):
        for axis in (0, 1):
            a, b = np.zeros(3), np.zeros(3)
            a[axis], b[axis] = -0.6, 130.5
            a[1 - axis] = b[1 - axis] = 65.0 * k
            lines.append((a + rng.uniform(-0.2, 0.2, 3) * [1, 1, 0], b))
            ratios.append([0.25, 0.5, 0.75, -0.25, -0.5, -0.75][2 * k + axis])
    lines.append((lines[0][0] + [5, 0, 0], lines[0][1] - [5, 0, 0]))
    ratios.append(ratios[0])
    component = place("validate")
    curves = [archived(line_curve(a, b)) for a, b in lines]
    component.solve({"Curves": curves, "Actuators": numbers(*ratios)})
    assert component.balloon.errors == []
    assert component.balloon.warnings  # what was mended
    assert len(component.flat("Ratios")) == 12
    for curve, ratio in zip(component.flat("Axes"), component.flat("Ratios"), strict=True):
        middle = ends(curve).mean(axis=0)
        away = [
            np.linalg.norm(np.cross(middle - a, (b - a) / np.linalg.norm(b - a))) for a, b in lines
        ]
        assert ratio == ratios[int(np.argmin(away))]


def test_what_was_mended_is_reported_with_its_place(place):
    curves = drawn()
    curves[0] = archived(line_curve((0, 0.4, 0), (64.6, 0, 0)))
    component = place("validate")
    component.solve({"Curves": curves})
    texts, places = component.flat("Messages"), component.flat("Places")
    assert len(texts) == len(places)
    gaps = [p for words, p in zip(texts, places, strict=True) if "gap" in words]
    assert len(gaps) == 1
    assert gaps[0] == pytest.approx((65, 0, 0), abs=0.5)
    assert any("gap" in words for words in component.balloon.warnings)


def test_curves_are_left_out_and_counted(place):
    arc = rhino3dm.PolyCurve()
    arc.Append(rhino3dm.Arc(rhino3dm.Circle(20.0), 1.0))
    curves = [*drawn(), archived(arc), archived(rhino3dm.Circle(9.0).ToNurbsCurve())]
    component = place("validate")
    component.solve({"Curves": curves})
    warnings = " ".join(component.balloon.warnings)
    assert "1 x NurbsCurve left out" in warnings
    assert "1 x PolyCurve left out" in warnings or "1 x ArcCurve left out" in warnings


def test_the_fixed_point_chooses_the_joint(place):
    component = place("simulate")
    component.solve({"Curves": drawn(), "Fixed": points((129, 1, 0))})
    assert json.loads(component.flat("Grid")[0])["fixed"] == 2
    assert not any("nearest joint" in text for text in component.balloon.warnings)
    component.solve({"Curves": drawn(), "Fixed": points((110, 1, 0))})
    assert any("20 mm from the nearest joint" in text for text in component.balloon.warnings)


def test_trees_are_a_grid_for_each_branch(place):
    component = place("simulate")
    curves = {"{0;0}": drawn(), "{0;1}": drawn()[:12]}
    ratios = {"{0;0}": numbers(*RATIOS), "{0;1}": numbers(*([0] * 12))}
    component.solve({"Curves": curves, "Actuators": ratios})
    assert component.values["Joints"].keys() == {(0, 0), (0, 1)}
    assert component.values["Ratios"][0, 0] == RATIOS
    assert component.values["Ratios"][0, 1] == [0] * 12
    one_for_all = {"Curves": curves, "Actuators": numbers(*RATIOS)}
    component.solve(one_for_all)
    assert component.values["Ratios"][0, 1] == RATIOS


def test_a_branch_that_fails_does_not_take_others_with_it(place):
    component = place("simulate")
    component.solve({"Curves": {"{0;0}": drawn(), "{2}": [value("x", 1)]}})
    assert component.values["Joints"].keys() == {(0, 0)}
    assert any(text.startswith("{2}: Curves[0]") for text in component.balloon.errors)
    assert component.status != 200  # Hops does not keep it


def test_the_path_of_an_iteration_is_kept(place):
    component = place("validate")
    component.solve({"Curves": drawn()}, path="{0;3}")
    assert component.values["Valid"] == {(0, 3): [True]}


# What is wrong is said in the balloon


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"Curves": []}, "Curves is empty; it is a list of lines or polylines"),
        ({"Actuators": numbers(1, 2)}, "Actuators has 2 ratios for 12 curves; give one for each"),
        ({"Actuators": numbers(*RATIOS[:-1], 1.5)}, "Actuators[11] is 1.5; a ratio lies between"),
        ({"Actuators": [value("System.String", "top")] * 12}, 'Actuators[0] is "top"'),
        ({"Fixed": [value("Rhino.Geometry.Point3d", {"X": 1})]}, "Fixed[0] is no point"),
        ({"Engine": text("magic")}, 'engine "magic" is not known; those that do are learned'),
        ({"Frame": [value("System.Int32", 12)]}, "Frame is 12; frames are 0 (flat) to 11"),
        ({"Curves": points((1, 2, 3))}, "Curves[0] is a Point3d; it is a curve"),
        ({"Curves": [archived(rhino3dm.Mesh())]}, "Curves[0] is neither a curve nor a point"),
        ({"Curves": [value("Rhino.Geometry.LineCurve", {"data": "AA"})]}, "Curves[0] is a damaged"),
        ({"Curves": [line_struct(a, b) for a, b in combinations(BENT, 2)]}, "lie in one plane"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_in_the_balloon(place, given, words):
    component = place("simulate")
    component.solve({"Curves": drawn(), **given})
    assert component.values == {}
    assert component.rebuilt == 0
    assert words in component.balloon.errors[0]
    assert 400 <= component.status < 500
    component.solve({"Curves": drawn(), **given})
    assert component.requests == 2  # Hops keeps no error


def test_an_invalid_design_is_reported_by_validate_with_its_place(place):
    component = place("validate")
    short = {"Curves": drawn(), "Actuators": numbers(0.05, *RATIOS[1:])}
    component.solve(short)
    assert component.flat("Valid") == [False]
    assert component.balloon.errors
    assert component.flat("Messages")[: len(component.balloon.errors)] == [
        words.replace('"', "'") for words in component.balloon.errors
    ]
    assert component.flat("Places")[0] == pytest.approx((32.5, 0, 0))
    assert component.status == 200
    simulate = place("simulate")
    simulate.solve(short)
    assert simulate.balloon.errors
    assert simulate.values == {}


def test_answers_are_kept_by_hops(place):
    component = place("simulate")
    for _ in range(2):
        component.solve({"Curves": drawn()})
    assert component.requests == 1


def test_without_the_package_the_component_says_what_to_install(place, monkeypatch, client):
    monkeypatch.setitem(sys.modules, "rhino3dm", None)
    component = place("simulate")
    component.solve({"Curves": drawn_before})
    assert component.balloon.errors == [
        "Rhino's geometry needs a package: pip install 'simulearn[rhino]'"
    ]
    assert component.status == 501
    assert client.get("/api/version").status_code == 200


drawn_before = drawn()


def test_a_studio_that_still_compiles_says_so_in_time(monkeypatch):
    from simulearn.studio.hops import routes
    from simulearn.studio.simulations import Simulations

    monkeypatch.setattr(routes, "WARMING", 0.2)
    monkeypatch.setattr(Simulations, "start_warming", lambda self: None)
    body = {"pointer": "hops/simulate", "values": []}
    answer = Client().post("/solve", body, headers=HEADERS)
    assert answer.status_code == 503
    conform(answer.json(), SCHEMA)
    assert "prepares itself" in answer.json()["errors"][0]


def test_a_request_has_an_answer_before_hops_gives_up(place, monkeypatch):
    from simulearn.studio.hops.components import shared

    monkeypatch.setattr(shared, "PATIENCE", 0.0)
    component = place("simulate")
    component.solve({"Curves": drawn()})
    assert "takes longer" in component.balloon.errors[0]


# Goals


def goals():
    return {
        "Points": points(CORNERS[8], (32.5, 0, 0)),
        "Targets": points((125, 125, 20), (30, 5, 9)),
    }


def test_rank_gives_five_designs_that_can_be_simulated(place):
    component = place("rank")
    component.solve({"Curves": drawn(), "Actuators": numbers(*RATIOS), **goals()})
    assert component.balloon.errors == []
    errors = component.flat("Errors")
    assert len(component.flat("Changes")) == len(errors) == len(component.flat("Meshes")) == 5
    assert errors == sorted(errors)
    assert errors[0] < component.flat("Error")[0]
    first = {key: component.values[key][0, 0] for key in ("Axes", "Ratios")}
    assert len(first["Axes"]) == len(first["Ratios"]) == 12
    again = place("simulate")
    again.solve({
        "Curves": [archived(curve) for curve in first["Axes"]],
        "Actuators": numbers(*first["Ratios"]),
        "Fixed": points(CORNERS[4]),
    })  # fmt: skip
    (mesh,) = again.flat("Mesh")
    assert vertices(mesh) == pytest.approx(vertices(component.flat("Meshes")[0]), abs=2e-2)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"Targets": points((1, 2, 3))}, "Points has 2 points and Targets 1; give one for each"),
        ({"Points": points((200, 0, 0), (0, 0, 0))}, "Points[0] is 70 mm from the nearest joint"),
        ({"Points": [], "Targets": []}, "Points has 0 points"),
    ],
)
def test_goals_that_are_wrong(place, given, words):
    component = place("rank")
    component.solve({"Curves": drawn(), **goals(), **given})
    assert words in component.balloon.errors[0]


def test_a_search_is_begun_once_and_can_be_polled(place, client):
    given = {"Curves": drawn(), "Actuators": numbers(*RATIOS), **goals(), "Seconds": numbers(4)}
    submit = place("optimise")
    submit.solve(given)
    (job,) = submit.flat("Job")
    submit.solve(given)
    assert submit.flat("Job") == [job]
    assert submit.requests == 2  # the answer is not kept, so that a lost job would be begun anew
    poll = place("poll")
    for _ in range(400):
        poll.solve({"Job": text(job)})
        assert poll.balloon.errors == []
        if poll.flat("State") == ["done"]:
            break
        assert 0 <= poll.flat("Progress")[0] <= 1
        client.app.state.jobs._jobs[job]._stopped.wait(0.1)
    assert poll.flat("State") == ["done"]
    assert poll.status == 200
    assert len(poll.flat("Mesh")) == 1
    assert len(poll.flat("Axes")) == len(poll.flat("Ratios")) == 12
    submit.solve(given)
    assert submit.flat("Job") == [job]
    assert submit.flat("State") == ["done"]
    other = place("optimise")
    other.solve({**given, "Seconds": numbers(3)})
    assert other.flat("Job") != [job]
    client.app.state.jobs.cancel(other.flat("Job")[0])


def test_a_job_that_is_not_known(place):
    poll = place("poll")
    poll.solve({"Job": text("nothing")})
    assert "there is no such search" in poll.balloon.errors[0]
    assert poll.status == 404


# G-code


def test_gcode_is_the_file_line_by_line(place):
    from simulearn.fabricate import load_printer, prepare

    component = place("gcode")
    component.solve({"Curves": drawn(), "Printer": text("prusa-mk4"), "Name": text("my grid")})
    grid = grid_from_dict(json.loads(validated(place)))
    job = prepare([grid], load_printer("prusa-mk4"), ["my grid"])
    assert component.flat("Text") == job.gcode.splitlines()
    assert component.flat("File") == ["my grid.gcode"]
    assert component.flat("Time")[0] == pytest.approx(job.estimate.seconds)
    assert component.flat("Filament")[0] == pytest.approx(job.estimate.filament_mm)
    component.solve({"Curves": drawn(), "Printer": text("typewriter")})
    assert 'printer "typewriter" is not known; known are bambu-x1' in component.balloon.errors[0]


def validated(place):
    component = place("validate")
    component.solve({"Curves": drawn()})
    return component.flat("Grid")[0]


# The protocol


def body(**changes):
    trees = [{"ParamName": "Curves", "InnerTree": {"{0}": drawn_before}}]
    return {"pointer": "hops/validate", "values": trees, **changes}


@pytest.mark.parametrize("path", ["/solve", "/hops/solve", "/hops/validate", "/hops/validate/"])
def test_all_addresses_to_solve_at(client, path):
    answer = client.post(path, body(), headers={"RhinoComputeKey": "secret", **HEADERS})
    assert answer.status_code == 200
    conform(answer.json(), SCHEMA)
    assert answer.json()["pointer"] == "hops/validate"


@pytest.mark.parametrize(
    "pointer", ["validate", "/hops/validate", "hops/validate/", "hops/Validate"]
)
def test_pointers_of_all_ages(client, pointer):
    assert client.post("/solve", body(pointer=pointer)).status_code == 200


def test_a_request_of_an_old_hops(client):
    """Hops of 2021: paths without braces, no units, archives of Rhino 6, no flags."""
    curves = [archived(line_curve(CORNERS[a], CORNERS[b]), 60) for a, b in PAIRS]
    values = [
        {"ParamName": "Curves", "InnerTree": {"0": curves}},
        {"ParamName": "Actuators", "InnerTree": {"0": numbers(*RATIOS)}},
        {"ParamName": "Engine", "InnerTree": {"0": text("learned")}},
        {"ParamName": "Frame", "InnerTree": {"0": [{"type": "System.Int32", "data": "11"}]}},
    ]
    request = {"algo": None, "pointer": "hops/simulate", "cachesolve": False, "values": values}
    answer = client.post("/solve", request)
    assert answer.status_code == 200
    conform(answer.json(), SCHEMA)
    (warning,) = answer.json()["warnings"]
    assert warning == "the request has no units; millimetres are taken"


def test_values_that_no_input_takes_are_reported(client):
    more = [*body()["values"], {"ParamName": "Colour", "InnerTree": {"0": text("red")}}]
    answer = client.post("/solve", body(values=more))
    assert "Validate has no input Colour; its inputs are Curves" in answer.json()["warnings"][0]


@pytest.mark.parametrize(
    ("method", "path", "options", "status"),
    [
        ("GET", "/solve", {}, 405),
        ("POST", "/hops", {"json": {}}, 405),
        ("GET", "/hops/nothing/here", {}, 404),
        ("GET", "/io", {}, 404),
        ("POST", "/solve", {"content": b"", "headers": HEADERS}, 400),
        ("POST", "/solve", {"content": b"{", "headers": HEADERS}, 400),
        ("POST", "/solve", {"content": b"{}", "headers": {"content-type": "text/html"}}, 415),
        ("POST", "/solve", {"json": {}}, 404),
        ("POST", "/solve", {"json": []}, 422),
        ("POST", "/solve", {"json": {"pointer": "hops/validate", "values": 3}}, 422),
        ("POST", "/solve", {"json": {}, "headers": {"host": "example.com"}}, 400),
        ("POST", "/solve", {"json": {}, "headers": {"origin": "http://example.com"}}, 403),
        ("GET", "/hops/validate", {"headers": {"host": "example.com"}}, 400),
    ],
)  # fmt: skip
def test_refusals_are_in_words_of_hops(client, method, path, options, status):
    answer = client.request(method, path, **options)
    assert answer.status_code == status
    assert answer.headers["content-type"] == "application/json"
    describing = method == "GET" or path == "/io"
    conform(answer.json(), IO_RESPONSE if describing else SCHEMA)
    errors = answer.json()["Errors" if describing else "errors"]
    assert len(errors) >= 1
    assert all(errors)


def test_a_body_too_large_is_reported(client):
    small = Client(Settings(file_bytes=100))
    answer = small.post("/solve", body())
    assert answer.status_code == 413
    conform(answer.json(), SCHEMA)
    assert "too large" in answer.json()["errors"][0]


def test_other_answers_stay_problems(client):
    answer = client.post("/api/validate", [])
    assert answer.headers["content-type"] == "application/problem+json"


def test_saddle_of_the_library_from_its_axes(place):
    grid = make("saddle", (2, 2))
    spots = np.pad(grid.joints, ((0, 0), (0, 1)))
    curves = [archived(line_curve(spots[a], spots[b])) for a, b in grid.beams.tolist()]
    component = place("simulate")
    given = {"Curves": curves, "Actuators": numbers(*grid.actuators)}
    component.solve({**given, "Fixed": points(spots[grid.fixed])})
    result = one(engine("learned").simulate([grid])[0])
    heights = sorted(z for _, _, z in component.flat("Joints"))
    assert heights == pytest.approx(sorted(result.centres[-1, :, 2]), abs=1e-6)


@pytest.mark.parametrize("seed", range(6))
def test_points_come_back_to_where_they_were(seed):
    """Any plane, and points in one line only."""
    from simulearn.drawings.drawing import Unit
    from simulearn.studio.hops.placement import placement_of

    rng = np.random.default_rng(seed)
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0][: 2 if seed < 4 else 1]
    places = rng.uniform(-3, 3, (9, len(axes))) @ axes + rng.uniform(-50, 50, 3)
    placement, _ = placement_of(places, Unit(25.4, "in", ""))
    assert placement.axes @ placement.axes.T == pytest.approx(np.eye(3), abs=1e-9)
    assert np.linalg.det(placement.axes) == pytest.approx(1)
    inside = placement.inside(places)
    assert np.abs(inside[:, 2]).max() < 1e-9
    assert placement.outside(inside) == pytest.approx(places, abs=1e-9)

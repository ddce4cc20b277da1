"""Surfaces and goals besides points: opened, kept in documents, compared with shapes."""

import json

import numpy as np
import pytest
import rhino3dm
import trimesh
from asking import Client, problem
from sheets import broken, exported, sheet

import synthetic
from simulearn.grid import grid_from_dict, grid_to_dict, make
from simulearn.inverse import task_from_dict
from simulearn.studio.settings import Settings

SADDLE = grid_to_dict(make("saddle"))
GOAL = {"vertex": ["joint", 0, "centre"], "target": [-60.0, -60.0, 12.0], "weight": 2.0}
HEIGHTS = {"heights": "5 + x/50", "x": [-90, 90], "y": [-90, 90]}
FLAT = {
    "name": "roof",
    "vertices": [[-90, -90, 8], [90, -90, 8], [90, 90, 8], [-90, 90, 8]],
    "faces": [[0, 1, 2], [0, 2, 3]],
}
DOCUMENT = {
    "schema": "simulearn.document/1",
    "grid": SADDLE,
    "goals": [{"vertices": "joints", "surface": "roof"}],
    "surfaces": [FLAT],
    "pose": "free",
}


@pytest.fixture(scope="module")
def client():
    return Client(Settings())


def sent(client, data, name, **options):
    data = json.dumps(data).encode() if isinstance(data, dict) else data
    return client.request(
        "POST",
        "/api/open",
        params={"name": name, **options},
        content=data,
        headers={"Content-Type": "application/octet-stream"},
    )


@pytest.fixture
def rhino(tmp_path):
    """Return a function that gives the contents of a Rhino file."""

    def written(*geometries):
        model = rhino3dm.File3dm()
        model.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Millimeters
        for geometry in geometries:
            model.Objects.Add(geometry)
        model.Write(str(tmp_path / "a.3dm"), 7)
        return (tmp_path / "a.3dm").read_bytes()

    return written


@pytest.mark.parametrize("kind", ["stl", "stl_ascii", "obj", "ply"])
def test_a_mesh_is_known_by_its_contents_whatever_its_name(client, kind):
    body = sent(client, exported(sheet(), kind), "C:\\cad\\Hood.dat").json()
    assert (body["kind"], body["name"]) == ("surface", "Hood.dat")
    surface = body["surface"]
    assert len(surface["faces"]) == surface["triangles"] == 288
    assert surface["size"] == pytest.approx([160, 160, 18.6], abs=0.1)
    assert (surface["unit"], surface["unit_by"], surface["messages"]) == ("mm", "guess", [])


def test_a_glb_has_its_own_unit(client):
    mesh = sheet()
    mesh.apply_scale(0.001)
    surface = sent(client, exported(mesh, "glb"), "hood.glb").json()["surface"]
    assert (surface["unit"], surface["unit_by"]) == ("m", "format")
    assert max(surface["size"]) == pytest.approx(160, abs=0.1)


def test_an_odd_size_is_asked_about_and_a_unit_taken(client):
    mesh = sheet()
    mesh.apply_scale(0.001)
    body = problem(sent(client, exported(mesh, "stl"), "hood.stl"), 422, "unit-unknown")
    assert body["size"] == pytest.approx([0.16, 0.16, 0.0186], abs=1e-3)
    assert body["guess"]["name"] == "m"
    surface = sent(client, exported(mesh, "stl"), "hood.stl", unit="m").json()["surface"]
    assert max(surface["size"]) == pytest.approx(160, abs=0.1)
    assert surface["unit_by"] == "given"


def test_what_was_mended_is_told_with_its_places(client):
    mesh = sheet()
    places = mesh.vertices[mesh.faces[[130, 131]]].mean(axis=(0, 1))
    surface = sent(client, exported(broken(mesh), "ply"), "hood.ply").json()["surface"]
    told = {message["code"]: message for message in surface["messages"]}
    assert set(told) == {"surface-holes", "surface-flipped"}
    np.testing.assert_allclose(told["surface-holes"]["places"], [places], atol=2)
    turned = mesh.vertices[mesh.faces[50]].mean(axis=0)
    np.testing.assert_allclose(told["surface-flipped"]["places"], [turned], atol=0.01)


def test_a_large_mesh_is_simplified_and_says_how_far_off_it_is(client):
    surface = sent(client, exported(sheet(100), "stl"), "hood.stl").json()["surface"]
    assert surface["triangles"] == 20_000
    assert 2000 < len(surface["faces"]) <= 4000
    (message,) = surface["messages"]
    assert message["code"] == "surface-simplified"
    assert "20,000 triangles" in message["message"]
    assert len(json.dumps(surface)) < 250_000


def test_a_file_of_lines_and_faces_is_asked_about(client, rhino):
    flat = sheet()
    flat.vertices *= [1, 1, 0]
    text = exported(flat, "obj") + b"\nl 1 13 169 157 1\nl 1 85 169\nl 13 85 157\n"
    problem(sent(client, text, "both.obj"), 422, "surface-or-drawing")
    assert sent(client, text, "both.obj", meant="surface").json()["kind"] == "surface"
    drawing = sent(client, text, "both.obj", meant="drawing", unit="mm").json()
    assert (drawing["kind"], len(drawing["grid"]["joints"])) == ("drawing", 5)
    ring = rhino3dm.Circle(50).ToNurbsCurve()
    plane = rhino3dm.Sphere(rhino3dm.Point3d(0, 0, 0), 40).ToBrep()
    assert sent(client, rhino(plane), "ball.3dm").json()["kind"] == "surface"
    problem(sent(client, rhino(plane, ring), "both.3dm"), 422, "surface-or-drawing")
    found = sent(client, rhino(plane, ring), "both.3dm", meant="surface").json()["surface"]
    assert any(message["code"] == "surface-left-out" for message in found["messages"])
    assert sent(client, rhino(ring), "ring.3dm", flatten=1).json().get("kind") != "surface"


def test_what_is_no_surface_says_so(client):
    body = problem(sent(client, b"x,y\n0,0\n1,1\n", "a.csv", meant="surface"), 422)
    assert "no surface" in body["detail"]
    problem(sent(client, b"solid a\nfacet normal 0 0 1\nendsolid", "a.stl"), 422)
    ply = exported(trimesh.PointCloud(np.eye(3)), "ply")
    assert "no triangles" in problem(sent(client, ply, "a.ply"), 422)["detail"]
    far = sheet()
    far.apply_translation([2e5, 0, 0])
    problem(sent(client, exported(far, "stl"), "far.stl"), 422, "surface-far")


def test_a_task_is_opened_with_all_its_goals(client):
    goals = [
        GOAL | {"tolerance": 0.5},
        {"vertices": "joints", "surface": HEIGHTS, "slide": False, "weight": 1.0},
        {"vertices": "beams", "surface": HEIGHTS, "weight": 0.5},
        {"vertex": ["joint", 1, 2], "curve": {"points": [[0, 0, 0], [9, 0, 0]]}, "weight": 1.0},
        {"face": ["joint", 8, "top"], "direction": [0.5, 0, 1], "weight": 1.0},
        {"away_from": "itself", "clearance": 1.0, "weight": 1.0},
    ]
    task = {"schema": "simulearn.task/1", "grid": SADDLE, "goals": goals, "pose": "free"}
    body = sent(client, task | {"tolerance": 2.0}, "hood.json").json()
    assert (body["kind"], body["pose"], body["messages"]) == ("task", "free", [])
    (surface,) = body["surfaces"]
    assert np.ptp(surface["vertices"], axis=0)[2] == pytest.approx(3.6)
    opened = [{**goal, "tolerance": goal.get("tolerance", 2.0)} for goal in goals]
    for goal in opened[1:3]:
        goal["surface"] = surface["name"]
    assert body["goals"] == opened


def test_goals_of_files_are_left_out_and_named(client):
    goals = [GOAL, {"vertices": "joints", "surface": {"file": "cad/hood.stl"}}]
    task = {"schema": "simulearn.task/1", "grid": SADDLE, "goals": goals}
    body = sent(client, task, "hood.json").json()
    assert body["goals"] == [GOAL]
    assert "hood.stl" in body["messages"][0]["message"]


def test_a_document_with_a_surface_is_saved_and_opened(client):
    path = f"/api/documents/{'s' * 22}"
    assert (
        client.request("PUT", path, json={"revision": 0, "document": DOCUMENT}).status_code == 200
    )
    assert client.get(path).json()["document"] == DOCUMENT
    body = sent(client, DOCUMENT, "mine.json").json()
    assert (body["surfaces"], body["pose"]) == ([FLAT], "free")


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ({"surfaces": []}, "goals[0].surface"),
        ({"goals": [{"vertices": "joints"}]}, "goals[0]"),
        ({"goals": [{"faces": [["beam", 0]], "surface": "roof"}]}, "goals[0]"),
        ({"goals": [{"vertices": [["joint", 9, 0]], "surface": "roof"}]}, "goals[0].vertices"),
        ({"goals": [{"face": ["joint", 0, 4], "direction": [0, 0, 1]}]}, "goals[0].face"),
        ({"goals": [{"vertices": "joints", "curve": {"file": "a.csv"}}]}, "goals[0].curve"),
        ({"goals": [{"vertices": "joints", "surface": {"file": "a.stl"}}]}, "goals[0].surface"),
        ({"surfaces": [FLAT, FLAT]}, "surfaces[1].name"),
        ({"surfaces": [FLAT | {"faces": [[0, 1, 4]]}]}, "surfaces[0].faces[0]"),
        ({"surfaces": [FLAT | {"faces": [[0, 1, 2]] * 4001}]}, "surfaces[0].faces"),
        ({"pose": "loose"}, "pose"),
    ],
)
def test_a_document_with_a_wrong_goal_or_surface_is_refused(client, change, where):
    body = {"revision": 0, "document": DOCUMENT | change}
    answer = client.request("PUT", f"/api/documents/{'t' * 22}", json=body)
    assert problem(answer, 422, "document")["where"] == where


def shape(height=0.0):
    result = synthetic.result(grid_from_dict(SADDLE), solid=False)
    lift = np.array([0, 0, height])
    return {
        "joints": (result.joints[-1] + lift).tolist(),
        "beams": (result.beams[-1] + lift).tolist(),
    }


def measured(client, goals, shapes, **more):
    task = {"schema": "simulearn.task/1", "grid": SADDLE, "goals": goals, **more}
    answer = client.post("/api/measure", {"task": task, "shapes": shapes})
    assert answer.status_code == 200, answer.text
    return answer.json()


def test_shapes_are_compared_with_their_goals(client):
    mesh = {key: FLAT[key] for key in ("vertices", "faces")}
    goals = [GOAL, {"vertices": "joints", "surface": mesh}]
    body = measured(client, goals, [shape(), shape(3.0)])
    assert [goal["entry"] for goal in body["goals"]] == [0] + [1] * 9
    first, other = body["shapes"]
    centres = np.mean(shape()["joints"], axis=1)
    np.testing.assert_allclose(first["distances_mm"][1:], np.abs(8 - centres[:, 2]), atol=1e-6)
    np.testing.assert_allclose(other["distances_mm"][1:], np.abs(5 - centres[:, 2]), atol=1e-6)
    lines = np.array(first["lines"])
    assert lines.shape == (9, 2, 3)  # points have none: the page draws them itself
    np.testing.assert_allclose(lines[:, 1, 2], 8, atol=1e-6)
    assert first["error_mm"] == pytest.approx(
        np.average(first["distances_mm"], weights=[2] + [1] * 9)
    )
    np.testing.assert_allclose(first["place"]["turn"], np.eye(3))


def test_a_shape_that_may_lie_anywhere_is_placed_where_it_fits(client):
    mesh = {"vertices": [[x, y, z + 400] for x, y, z in FLAT["vertices"]], "faces": FLAT["faces"]}
    goal = {"vertices": "joints", "surface": mesh}
    (first,) = measured(client, [goal], [shape()], pose="free")["shapes"]
    assert first["error_mm"] < 12
    place = first["place"]
    moved = np.mean(shape()["joints"], axis=1) @ np.transpose(place["turn"]) + place["shift"]
    np.testing.assert_allclose(first["distances_mm"], np.abs(moved[:, 2] - 408), atol=1e-4)
    ends = np.array(first["lines"])[:, 0]
    np.testing.assert_allclose(ends, moved, atol=1e-6)


def test_a_shape_of_another_grid_is_refused(client):
    task = {"schema": "simulearn.task/1", "grid": SADDLE, "goals": [GOAL]}
    few = {"joints": shape()["joints"][:3], "beams": []}
    body = problem(client.post("/api/measure", {"task": task, "shapes": [few]}), 422, "shape")
    assert "9 and 12" in body["detail"]


def test_the_goals_of_an_opened_task_are_a_task_again(client):
    """As the page makes it: triangles in place of the surface's name."""
    goals = [{"vertices": "joints", "surface": HEIGHTS, "weight": 1.0}]
    task = {"schema": "simulearn.task/1", "grid": SADDLE, "goals": goals}
    body = sent(client, task, "hood.json").json()
    (surface,) = body["surfaces"]
    mesh = {key: surface[key] for key in ("vertices", "faces")}
    again = task_from_dict(task | {"goals": [goals[0] | {"surface": mesh}]})
    points = np.random.default_rng(1).uniform(-60, 60, (9, 3))
    np.testing.assert_allclose(
        again.aims.distances(points), task_from_dict(task).aims.distances(points), atol=1e-3
    )

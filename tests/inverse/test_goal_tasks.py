"""Tasks with goals of each kind: how files say them, what is said of wrong ones, solved ones."""

import json
from itertools import islice

import numpy as np
import pytest
import rhino3dm
import trimesh

from simulearn.errors import InputError
from simulearn.grid import Grid, grid_to_dict, make
from simulearn.inverse import Space, read_task, task_from_dict, write_task
from simulearn.inverse.keeping import identity
from simulearn.inverse.newton import newton
from simulearn.inverse.problem import Problem
from simulearn.inverse.scoring import places
from simulearn.inverse.task import Free, task_to_dict
from simulearn.simulate import engine

PLAIN = make("flat", (1, 1), 52.0)
AWAY = np.array([[0, 0], [3, -4], [5, 2], [-2, 6]])
HIDDEN = Grid(PLAIN.joints + AWAY, PLAIN.beams, [0.75, -0.5, 1, -0.5], 0)
HEIGHTS = {"heights": "4*sin(x/30)+y*y/500", "x": [-20, 90], "y": [-20, 90]}
J1, J2, J3 = (["joint", k, "centre"] for k in (1, 2, 3))
GOALS = {
    "surface": {"vertices": "joints", "surface": HEIGHTS},
    "stuck": {"vertices": [J1, J3], "surface": HEIGHTS, "slide": False},
    "curve": {"vertices": [J1, J3], "curve": {"points": [[50, 0, 2], [55, 30, 8], [50, 60, 9]]}},
    "plane": {"vertices": "beams", "plane": {"point": [0, 0, 1], "normal": [0.1, 0, 1]}},
    "direction": {"face": ["joint", 3, "top"], "direction": [0.2, 0.1, 1]},
    "distance": {"vertices": [J1, J2], "distance": 70},
    "angle": {"faces": [["joint", 1, "top"], ["joint", 2, "top"]], "angle": 25},
    "away_from": {"away_from": HEIGHTS, "clearance": 2},
    "itself": {"away_from": "itself", "clearance": 1.5},
}


def task_of(*goals, **more):
    return {"schema": "simulearn.task/1", "grid": grid_to_dict(PLAIN), "goals": list(goals)} | more


@pytest.fixture(scope="module")
def beams():
    return engine("beams")


@pytest.fixture(scope="module")
def hidden(beams):
    """The shape of a design that the search does not know."""
    (result,) = beams.simulate([HIDDEN])
    return result.joints[-1], result.beams[-1]


@pytest.mark.parametrize("kind", GOALS)
def test_each_kind_is_read_and_written_as_it_was(kind, tmp_path):
    data = task_of(GOALS[kind] | {"weight": 2.0})
    task = task_from_dict(data)
    assert task_to_dict(task)["goals"] == data["goals"]
    write_task(task, tmp_path / "task.json")
    assert json.loads((tmp_path / "task.json").read_text())["goals"] == data["goals"]
    aims = task.aims
    assert len(task.tolerances) == len(aims) == len(aims.names)
    assert aims.weights.sum() == pytest.approx(1)


def test_one_goal_may_be_of_many_vertices():
    task = task_from_dict(task_of(GOALS["surface"] | {"tolerance": 1}, GOALS["plane"], tolerance=3))
    assert len(task.aims) == 8
    assert task.tolerances == (1,) * 4 + (3,) * 4
    assert task.aims.names[0] == "joint 0, centre"
    assert task.aims.names[-1] == "beam 3, middle, centre"


def wanted_of(kind, joints, sections):
    """Return a goal of a kind that the hidden design meets, or several."""
    centres = joints.mean(axis=1)
    if kind == "free":  # somewhere else, and turned
        turn = [[0, -1, 0], [0, 0, 1], [-1, 0, 0]]
        return [
            {"vertex": ["joint", k, "centre"], "target": (turn @ place + 70).tolist()}
            for k, place in enumerate(centres)
        ]
    if kind == "surface":
        A = np.c_[np.ones(4), centres[:, 0], centres[:, 1], centres[:, 0] * centres[:, 1]]
        a, b, c, d = np.linalg.solve(A, centres[:, 2])
        heights = {"heights": f"{a}+{b}*x+{c}*y+{d}*x*y", "x": [-40, 99], "y": [-40, 99]}
        return {"vertices": "joints", "surface": heights}
    if kind == "curve":
        return {"vertices": [J1, J3], "curve": {"points": centres[[1, 3]].tolist()}}
    if kind == "plane":
        u, v = centres[1] - centres[0], centres[2] - centres[0]
        plane = {"point": [0, 0, 0], "normal": np.cross(u, v).tolist()}
        return {"vertices": [J1, J2], "plane": plane}
    if kind == "distance":
        return {"vertices": [J1, J2], "distance": float(np.linalg.norm(centres[1] - centres[2]))}
    goal = GOALS[kind]
    (part,) = task_from_dict(task_of(goal)).aims.parts
    points = np.stack([vertex.of(joints, sections) for vertex in part.vertices])
    if kind == "direction":
        return goal | {"direction": part.wanted.face.direction(points).tolist()}
    one, other = (face.direction(p) for face, p in zip(part.wanted.faces, (points[:4], points[4:]),
                                                       strict=True))  # fmt: skip
    return goal | {"angle": float(np.degrees(np.arccos(one @ other)))}


@pytest.mark.parametrize(
    "kind", ["surface", "curve", "plane", "direction", "distance", "angle", "away_from", "free"]
)
def test_a_task_of_each_kind_is_solved(kind, beams, hidden):
    joints, sections = hidden
    if kind == "away_from":  # a bar under the far corner, which is to rise
        goal = {"away_from": {"heights": "-3", "x": [30, 90], "y": [30, 90]}, "clearance": 1}
    else:
        goal = wanted_of(kind, joints, sections)
    some = goal if isinstance(goal, list) else [goal]
    task = task_from_dict(task_of(*some, pose="free" if kind == "free" else "fixed"))
    goals, space = task.aims, Space.of(task.start, Free())
    problem = Problem(space, goals, places(beams, goals), model=beams.bundle.model)
    start = problem.scored(*space.start)
    problem.goals = goals.begun(start.points)
    problem.best = None
    start = problem.scored(*space.start)
    for _ in islice(newton(problem, start), 8):
        if problem.best.error < 0.05:
            break
    assert start.error > 0.4
    assert problem.best.error < 0.1 * start.error + 0.05


def test_files_are_seen_from_the_folder_of_the_task(tmp_path, run):
    (tmp_path / "shapes").mkdir()
    ball = trimesh.creation.icosphere(2, 0.03)
    ball.export(tmp_path / "shapes" / "ball.stl")
    (tmp_path / "shapes" / "line.csv").write_text("0,0,0\n50,50,9\n")
    place = {"turn": [[0, -1, 0], [1, 0, 0], [0, 0, 1]], "shift": [30, 30, 40]}
    goals = [
        {"vertex": J3, "surface": {"file": "shapes/ball.stl", "unit": "m", "place": place}},
        {"vertex": J1, "curve": {"file": "shapes/line.csv"}},
        {"away_from": {"file": "shapes/ball.stl"}},
    ]
    path, moved = tmp_path / "task.json", tmp_path / "shapes" / "moved.json"
    path.write_text(json.dumps(task_of(*goals, engine="beams")))
    task = read_task(path, paths=True)
    surface = task.aims.parts[0].wanted.set
    np.testing.assert_allclose(surface.box.mean(axis=0), [30, 30, 40], atol=1e-5)
    assert [message.code for message in task.warnings] == ["surface-unit"]  # of the last one
    write_task(task, moved)
    assert json.loads(moved.read_text())["goals"][0]["surface"]["file"] == "ball.stl"
    again = read_task(moved, paths=True)
    assert again.shapes_digest == task.shapes_digest
    # Another surface is another task, though the file of the task is the same.
    name = identity(task, None)
    trimesh.creation.icosphere(2, 0.031).export(tmp_path / "shapes" / "ball.stl")
    assert identity(read_task(path, paths=True), None) != name
    with pytest.raises(InputError, match=r"goals\[0\].surface.file names a file") as error:
        read_task(path)
    assert error.value.code == "surface-path"
    code, _, err = run("rank", path, "--json")
    assert code == 0
    assert "in metres or inches" in err


@pytest.mark.parametrize(
    ("goal", "words"),
    [
        ({"vertex": J1}, r"goals\[0\] says not what is wanted; a goal has one of target, surface"),
        ({"vertex": J1, "distance": 3}, r"goals\[0\] has vertex; with distance it has vertices"),
        ({"vertex": J1, "target": [1, 2, 3], "plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}},
         r"goals\[0\] wants target and plane"),
        ({"surface": HEIGHTS}, r"goals\[0\] has no vertex and no face; with surface it has"),
        ({"vertices": "beam", "surface": HEIGHTS}, r'goals\[0\].vertices is "beam"; "joints"'),
        ({"vertices": [], "surface": HEIGHTS}, r"goals\[0\].vertices is \[\]"),
        ({"vertices": [["joint", 9, 0]], "surface": HEIGHTS}, r"vertices\[0\]\[1\] is 9; joints"),
        ({"vertex": J1, "surface": {}}, r"surface has no shape; it has one of file, heights"),
        ({"vertex": J1, "surface": {"files": "x"}}, r"surface.files is not a key here; .* file"),
        ({"vertex": J1, "surface": {"heights": "z", "x": [0, 1], "y": [0, 1]}},
         r'goals\[0\].surface: heights hold "z"'),
        ({"vertex": J1, "surface": {"heights": "x"}}, "heights come with x and y"),
        ({"vertex": J1, "surface": HEIGHTS | {"unit": "m"}}, "unit does not go with heights"),
        ({"vertex": J1, "surface": HEIGHTS | {"x": [1]}}, r"surface.x is \[1\]; x is \[from, to\]"),
        ({"vertex": J1, "surface": HEIGHTS | {"heights": 3}}, "surface.heights is 3; heights are"),
        ({"vertex": J1, "surface": HEIGHTS | {"place": {"turn": np.ones((3, 3)).tolist()}}},
         r"surface.place.turn is no rotation"),
        ({"vertex": J1, "surface": {"vertices": [[0, 0, 0]] * 3, "faces": [[0, 1, 2]]}},
         "has no triangle that can be used"),
        ({"vertex": J1, "surface": {"vertices": [[0, 0, "0"]], "faces": [[0, 1, 2]]}},
         r"vertices\[0\]\[2\] is \"0\"; vertices of triangles are"),
        ({"vertex": J1, "surface": {"vertices": [[0, 0, 0]] * 3, "faces": [[0, 1, 10**30]]}},
         r"faces\[0\]\[2\] is 1000000000000000000000000000000; faces of triangles are"),
        ({"vertex": J1, "surface": {"vertices": [[0, 0, 0]] * 3, "faces": [[0, 1, 3]]}},
         "1 of 1 triangles name vertices that are not there"),
        ({"vertex": J1, "curve": {"points": [[0, 0, 0], [1e200, 0, 0]]}},
         r"points\[1\]\[0\] is 1e\+200; points are .*none is more than 1,000,000"),
        ({"vertex": J1, "plane": {"point": [0, 0, 0], "normal": [0, -1e200, 0]}},
         r"normal\[1\] is -1e\+200"),
        ({"vertex": J1, "target": [0, 0, 0], "weight": 1e300}, r"weight is 1e\+300"),
        ({"vertex": J1, "curve": {"points": [[0, 0, 0]]}}, "points are a list of at least two"),
        ({"vertex": J1, "curve": {"points": [[0, 0, 0]] * 2}}, "a curve has at least two points"),
        ({"vertex": J1, "plane": {"point": [0, 0, 0]}}, "plane.normal is missing; a normal is"),
        ({"vertex": J1, "plane": {"point": [0, 0, 0], "normal": [0, 0, 0]}}, "it has a length"),
        ({"face": ["beam", 0, 5], "direction": [0, 0, 1]}, r"face\[2\] is 5; sections are"),
        ({"face": ["beam"], "direction": [0, 0, 1]}, "a face is"),
        ({"vertex": J1, "direction": [0, 0, 1]}, "with direction it has face or faces"),
        ({"faces": [["beam", 0]], "angle": 3}, "faces are two, between which the angle is"),
        ({"faces": [["beam", 0], ["beam", 1]], "angle": 200}, "angle is 200; an angle is in"),
        ({"vertices": [J1, J1], "distance": 3}, "vertices are two, between which"),
        ({"away_from": "me"}, r'away_from is "me"; what is kept away from is "itself"'),
        ({"away_from": "itself", "clearance": -1}, "clearance is -1; a clearance"),
        ({"vertex": J1, "target": [0, 0, 0], "clearance": 1}, "clearance is of what is"),
        ({"vertex": J1, "target": [0, 0, 0], "slide": False}, "slide is false; only on a surface"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named(goal, words):
    with pytest.raises(InputError, match=words) as error:
        task_from_dict(task_of(goal))
    assert error.value.where
    assert "\n" not in str(error.value)


def test_a_wrong_file_is_named_with_its_place(tmp_path):
    path = tmp_path / "task.json"
    task = task_of({"vertex": J1, "surface": {"file": "a.stl", "unit": "parrots"}})
    path.write_text(json.dumps(task))
    with pytest.raises(InputError, match=r'surface.unit is wrong: "parrots" is no unit'):
        read_task(path, paths=True)
    for file, words in (("none.stl", "there is no such file"), ("task.json", "the ending is not")):
        path.write_text(json.dumps(task_of({"vertex": J1, "surface": {"file": file}})))
        with pytest.raises(InputError, match=rf"goals\[0\].surface: .*{file}: {words}"):
            read_task(path, paths=True)


@pytest.mark.parametrize("name", ["best.json", "shape.3dm", "answer-3.json"])
def test_a_search_writes_over_nothing_that_it_reads(name, tmp_path, run):
    task = {"vertex": J3, "surface": {"file": "shape.3dm"}}
    model = rhino3dm.File3dm()
    model.Objects.AddSphere(rhino3dm.Sphere(rhino3dm.Point3d(0, 0, 0), 20.0))
    model.Write(str(tmp_path / "shape.3dm"), 7)
    path = tmp_path / (name if name.endswith("json") else "task.json")
    path.write_text(json.dumps(task_of(task, engine="beams")))
    before = path.read_bytes(), (tmp_path / "shape.3dm").read_bytes()
    code, _, err = run("optimize", path, "-o", tmp_path)
    assert code == 1
    assert f"{name}: is what is read, and would be replaced" in err
    code, _, err = run("rank", path, "-o", path)
    assert code == 1
    assert "is what is read" in err
    assert (path.read_bytes(), (tmp_path / "shape.3dm").read_bytes()) == before


def test_surfaces_out_of_reach_and_of_another_unit_are_reported(tmp_path):
    from simulearn.inverse.reach import out_of_reach

    far = task_from_dict(
        task_of({"vertex": J3, "surface": HEIGHTS | {"place": {"shift": [0, 0, 900]}}})
    )
    assert [m.code for m in out_of_reach(far.start, far.aims)] == ["target-far"]
    tiny = {"heights": "0.001*x", "x": [0, 0.05], "y": [0, 0.05]}
    small = task_from_dict(task_of({"vertex": J3, "surface": tiny}))
    (message,) = out_of_reach(small.start, small.aims)
    assert message.code == "targets-tiny"
    assert "if its file is in metres" in message.message
    inches = {"heights": "0.1*x", "x": [0, 3], "y": [0, 3]}
    small = task_from_dict(task_of({"vertices": "joints", "surface": inches}))
    (message,) = out_of_reach(small.start, small.aims)
    assert "if its file is in inches" in message.message


def test_a_search_tells_each_goal(beams, tmp_path, run, monkeypatch):
    # Finite elements would take most of the time, and say nothing about goals.
    monkeypatch.setattr("simulearn.inverse.checking.engine", lambda name, mesh: beams)
    monkeypatch.setattr("simulearn.inverse.search.warm", lambda engine: None)
    goals = [GOALS["surface"], GOALS["direction"], GOALS["itself"]]
    path, folder = tmp_path / "task.json", tmp_path / "found"
    limits = {"iterations": 2, "seconds": 20, "corrections": 0}
    path.write_text(json.dumps(task_of(*goals, engine="beams", pose="free", limits=limits)))
    code, out, _ = run("optimize", path, "-o", folder)
    assert code == 0
    assert "surface (4 goals): " in out
    assert " degrees" in out
    figures = json.loads((folder / "summary.json").read_text())
    assert [goal["kind"] for goal in figures["goals"]] == [
        *["surface"] * 4,
        "direction",
        "away from itself",
    ]
    assert figures["goals"][4]["angle_deg"] >= 0
    turn = np.array(figures["place"]["turn"])
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-9)
    mean = np.mean([goal["distance_mm"] for goal in figures["goals"]])
    assert mean == pytest.approx(figures["error_fea_mm"], abs=1e-3)
    for name in ("shape.png", "changing.gif", "shape.3dm"):
        assert (folder / name).stat().st_size > 5000

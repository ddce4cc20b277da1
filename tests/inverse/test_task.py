"""The task file: what it may hold, and what is said of what it may not."""

import json

import numpy as np
import pytest

from simulearn.errors import InputError
from simulearn.grid import grid_to_dict, make
from simulearn.inverse import read_task, task_from_dict, task_to_dict, write_task


def with_(data, path, value):
    """Return data with the value at a path of keys replaced."""
    data = json.loads(json.dumps(data))
    place = data
    for key in path[:-1]:
        place = place.setdefault(key, {}) if isinstance(place, dict) else place[key]
    place[path[-1]] = value
    return data


def test_all_but_schema_grid_and_goals_may_be_left_out(small):
    task = task_from_dict({key: small[key] for key in ("schema", "grid", "goals")})
    assert (task.method, task.engine) == ("default", "learned")
    assert (task.free.move, task.free.ratio, task.free.joints) == (5.0, 0.25, None)
    assert task.limits.seconds == 30.0


def test_the_form_of_the_design_document_is_read(small):
    data = {
        **small,
        "free": {"joints": [1, 2], "actuators": [0], "move": 5.0, "ratio": 0.25},
        "method": "default",
        "engine": "learned",
        "limits": {"iterations": 30, "seconds": 30},
    }
    assert task_from_dict(data).free.joints == [1, 2]


def test_center_and_numbers_with_a_point_are_read(small):
    vertices = [["joint", 1.0, "center"], ["beam", 0, "end", "center"]]
    goals = [{"vertex": vertex, "target": [1, 2, 3]} for vertex in vertices]
    task = task_from_dict({**small, "goals": goals, "free": {"joints": [1.0]}})
    assert [goal.vertex for goal in task.goals] == [
        ["joint", 1, "centre"],
        ["beam", 0, "end", "centre"],
    ]
    assert task.free.joints == [1]


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_a_byte_order_mark_is_read_over(small, tmp_path, encoding):
    (tmp_path / "task.json").write_bytes(json.dumps(small).encode(encoding))
    assert task_to_dict(read_task(tmp_path / "task.json")) == task_to_dict(task_from_dict(small))


def test_a_task_is_kept(small, tmp_path):
    task = task_from_dict(small)
    write_task(task, tmp_path / "task.json")
    assert task_to_dict(read_task(tmp_path / "task.json")) == task_to_dict(task)


def test_goals_are_arrays(small):
    goals = task_from_dict(small).aims
    np.testing.assert_allclose(goals.weights, [2 / 3, 1 / 3])
    assert [str(v) for v in goals.vertices] == ["joint 3, centre", "beam 1, middle, centre"]


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        (["schema"], "simulearn.task/2", 'schema is "simulearn.task/2"; this program reads'),
        (["colour"], 1, "colour is not a key here; the keys are schema, grid, goals, free"),
        (["limits", "hours"], 1, "limits.hours is not a key here; the keys are iterations"),
        (["goals"], [], r"goals is \[\]; goals are a list of at least one"),
        (["goals", 0, "target"], [1, 2], r"goals\[0\].target is \[1, 2\]; a target is"),
        (["goals", 1, "target", 2], None, r"goals\[1\].target\[2\] is null"),
        (["goals", 1, "target", 2], float("nan"), r"goals\[1\].target\[2\] is NaN"),
        (["goals", 0, "weight"], -1, r"goals\[0\].weight is -1; a weight is"),
        (["goals", 0, "colour"], 1, r"goals\[0\].colour is not a key here; the keys are vertex"),
        (["goals", 0, "vertex"], ["joint", 3], r'goals\[0\].vertex is \["joint", 3\]; a vertex is'),
        (["goals", 0, "vertex"], ["joint", 9, 0], r"vertex\[1\] is 9; joints are numbered 0 to 3"),
        (["goals", 0, "vertex"], ["joint", 0, 8], r"vertex\[2\] is 8; corners are numbered 0 to 7"),
        (["goals", 0, "vertex"], ["beam", 0, 3, 0], r"vertex\[2\] is 3; sections are numbered"),
        (["goals", 0, "vertex"], ["beam", 0, True, 0], r"vertex\[2\] is true"),
        (["grid", "fixed"], 7, "grid: fixed is 7"),
        (["grid", "schema"], "x", 'grid: schema is "x"'),
        (["free", "joints"], [4], r"free.joints\[0\] is 4; joints are numbered 0 to 3"),
        (["free", "joints"], [1, 0], r"free.joints\[1\] is 0, the fixed joint"),
        (["free", "move"], 0, "free.move is 0; a move is a length"),
        (["free", "ratio"], "a", 'free.ratio is "a"'),
        (["free", "pairs", "flip"], "z", 'free.pairs.flip is "z"; flip is "x"'),
        (["free", "pairs", "joints"], [[1, 2], [2, 3]], "free.pairs.joints has 2 in two pairs"),
        (["free", "pairs", "joints"], [[0, 1]], "free.pairs.joints has 0, which is not free"),
        (["limits", "iterations"], 0, "limits.iterations is 0; iterations are an integer"),
    ],
)
def test_what_is_wrong_is_named_with_its_place(small, path, value, message):
    with pytest.raises(InputError, match=message) as error:
        task_from_dict(with_(small, path, value))
    assert error.value.code != "input"
    assert error.value.where


@pytest.mark.parametrize("data", [[], None, 3, {}, {"schema": "simulearn.task/1"}])
def test_what_is_no_task_is_refused(data):
    with pytest.raises(InputError):
        task_from_dict(data)


def test_goals_without_weight_are_refused(small):
    for goal in small["goals"]:
        goal["weight"] = 0
    with pytest.raises(InputError, match="all have the weight 0"):
        task_from_dict(small)


def test_a_dangling_beam_is_refused(small):
    grid = make("flat", (1, 1), 50.0)
    data = grid_to_dict(grid)
    data["joints"].append([120.0, 0.0])
    data["beams"].append([1, 4])
    data["actuators"].append(0.0)
    with pytest.raises(InputError, match="grid: beam 4 dangles"):
        task_from_dict({**small, "grid": data})


@pytest.mark.parametrize("text", ["", "{", "[" * 100_000, '{"schema": 1}'])
def test_a_damaged_file_is_one_line(tmp_path, text):
    path = tmp_path / "task.json"
    path.write_text(text)
    with pytest.raises(InputError, match=r"task\.json: "):
        read_task(path)
    with pytest.raises(InputError, match="there is no such file"):
        read_task(tmp_path / "none.json")

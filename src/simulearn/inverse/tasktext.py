"""What is said of a task file that is wrong: which key, where, and what would be right."""

from collections.abc import Sequence
from typing import Any

from pydantic import BaseModel

from simulearn.grid.arrays import shown
from simulearn.inverse.goalfile import (
    MOST,
    OBJECT,
    WORDS,
    CurveFile,
    Goal,
    Motion,
    PlaneFile,
    SurfaceFile,
)
from simulearn.inverse.naming import FACE, VERTEX

MOST_ANSWERS = 20
KEYS = {
    "schema": 'this program reads "simulearn.task/1"',
    "grid": "a grid is written as in a grid file",
    "goals": "goals are a list of at least one object with vertex, target, weight and others",
    "vertex": VERTEX,
    "vertices": f'"joints", "beams", or a list of vertices: {VERTEX}',
    "surface.vertices": "vertices of triangles are a list of [x, y, z], finite numbers in mm",
    "face": FACE,
    "faces": f"a list of faces: {FACE}",
    "surface.faces": "faces of triangles are a list of three indices of vertices, counted from 0",
    "surface": "a surface is an object with file and unit, heights, x and y, or vertices and faces",
    "curve": "a curve is an object with file and unit, or points",
    "plane": "a plane is an object with point and normal, both [x, y, z]",
    "direction": "a direction is [x, y, z], finite numbers",
    "distance": "a distance is a length in mm, more than 0",
    "angle": "an angle is in degrees, from 0 to 180",
    "away_from": 'what is kept away from is "itself", or a surface as an object',
    "slide": "slide is true or false",
    "clearance": "a clearance is a length in mm, at least 0",
    "file": "a file is a path, seen from the folder of the task",
    "unit": 'a unit is a name such as "mm", "m" or "in"',
    "heights": 'heights are an expression such as "20*sin(x/30)", or a table: a list of rows',
    "x": "x is [from, to], finite numbers in mm",
    "y": "y is [from, to], finite numbers in mm",
    "step": "a step is a length in mm, more than 0",
    "place": "a place is an object with turn and shift",
    "turn": "a turn is three rows of a rotation, each three numbers",
    "shift": "a shift is [x, y, z], finite numbers in mm",
    "points": "points are a list of at least two [x, y, z], finite numbers in mm",
    "point": "a point is [x, y, z], finite numbers in mm",
    "normal": "a normal is [x, y, z], finite numbers",
    "pose": 'a pose is "fixed" or "free"',
    "target": "a target is [x, y, z], finite numbers in mm",
    "weight": "a weight is a number of at least 0",
    "tolerance": "a tolerance is a length in mm, more than 0",
    "robust": "robust is true or false",
    "free": "free is an object with joints, actuators, move, ratio and pairs",
    "joints": "joints are a list of indices counted from 0 (or of two of them, in pairs)",
    "actuators": "actuators are a list of beams counted from 0 (or of two of them, in pairs)",
    "move": "a move is a length in mm, more than 0 and at most 1000",
    "ratio": "a step of ratios is more than 0 and at most 1",
    "pairs": "pairs are an object with flip, joints and actuators",
    "flip": 'flip is "x", "y", "xy" or "none"',
    "method": "a method is a name",
    "engine": "an engine is a name",
    "limits": "limits are an object with iterations, seconds, corrections and answers",
    "iterations": "iterations are an integer of at least 1",
    "seconds": "seconds are a number more than 0",
    "corrections": "corrections are an integer of at least 0",
    "answers": f"answers are an integer from 1 to {MOST_ANSWERS}",
}
PARTS: dict[str, type[BaseModel]] = {
    "goals": Goal,
    "surface": SurfaceFile,
    "away_from": SurfaceFile,
    "curve": CurveFile,
    "plane": PlaneFile,
    "place": Motion,
}


def line_of(error: Any, task: type[BaseModel]) -> str:
    """Return one of pydantic's errors about a task in our words."""
    place, value = [k for k in error["loc"] if not _inner(k)], error["input"]
    where = place_of(place)
    if not place:
        return f"is {shown(value)}; a task is an object with the keys {_keys(task)}"
    names = [k for k in place if isinstance(k, str)]
    of_triangles = names[-2:-1] in (["surface"], ["away_from"])
    hint = (of_triangles and KEYS.get(f"surface.{names[-1]}")) or KEYS.get(names[-1], "")
    if MOST in {abs(error.get("ctx", {}).get(limit, 0)) for limit in ("le", "ge")}:
        hint += f"; none is more than {MOST:,.0f}"
    if error["type"] == "missing":
        return f"{where} is missing; {hint}"
    if error["type"] == "extra_forbidden":
        return f"{where} is not a key here; the keys are {_keys(_part(task, names[:-1]))}"
    return f"{where} is {shown(value)}; {hint}"


def _part(task: type[BaseModel], names: Sequence[str]) -> type[BaseModel]:
    """Return the model of a part by the keys that lead to it."""
    model = task
    for name in names:
        if name in PARTS:
            model = PARTS[name]
        else:
            kind = model.model_fields[name].annotation
            model = kind if isinstance(kind, type) and issubclass(kind, BaseModel) else model
    return model


def _keys(model: type[BaseModel]) -> str:
    return ", ".join(field.alias or name for name, field in model.model_fields.items())


def place_of(keys: Sequence[str | int]) -> str:
    """Return a path of keys and indices in words, as `goals[1].target[2]`."""
    words = [f"[{k}]" if isinstance(k, int) else f".{k}" for k in keys if not _inner(k)]
    return "".join(words).lstrip(".")


def _inner(key: str | int) -> bool:
    """Return whether a key is none of the file but names a kind that a value may be of."""
    return key in (WORDS, OBJECT)

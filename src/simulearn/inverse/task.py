"""The task file: a grid, goals, what may change, and how to search; JSON, `simulearn.task/1`."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    PrivateAttr,
    SerializerFunctionWrapHandler,
    ValidationError,
    model_serializer,
)

from simulearn.errors import InputError
from simulearn.files import read_text, replacing
from simulearn.grid import Grid, grid_from_dict, grid_to_dict
from simulearn.grid.arrays import shown, whole
from simulearn.grid.cleaning import removals
from simulearn.inverse.goals import Goals, Vertex
from simulearn.material import Material

SCHEMA = "simulearn.task/1"
MOST_ANSWERS = 20
MORE = 2.0  # limits of seconds, that other answers may take after the first

Index = Annotated[int, BeforeValidator(whole), Field(ge=0, lt=2**31)]
Pair = Annotated[list[Index], Field(min_length=2, max_length=2)]
Positive = Annotated[float, Field(gt=0)]


def _plain_vertex(words: Any) -> Any:
    """Return a vertex as it is kept: "center" as "centre", 2.0 as 2."""
    if not isinstance(words, list):
        return words
    return ["centre" if word == "center" else whole(word) for word in words]


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, strict=True, extra="forbid", allow_inf_nan=False)

    @model_serializer(mode="wrap")
    def _written(self, write: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """Leave out what is not wanted of prints or answers; files without it stay as they were."""
        return {
            key: value
            for key, value in write(self).items()
            if (key, value) not in (("tolerance", None), ("robust", False), ("answers", 1))
        }


class Goal(_Part):
    """A vertex, the point where it is wanted, and how much it counts.

    Attributes:
        vertex: ["joint", k, "centre"], ["joint", k, corner] or ["beam", b, section, corner].
        target: [x, y, z] mm, seen from the fixed joint.
        weight: not negative.
        tolerance: distance from the target that a print may have, mm; None: that of the task.
    """

    vertex: Annotated[list[Any], BeforeValidator(_plain_vertex)]
    target: Annotated[list[float], Field(min_length=3, max_length=3)]
    weight: Annotated[float, Field(ge=0)] = 1.0
    tolerance: Positive | None = None


class Pairs(_Part):
    """What changes alike, so that a symmetric design stays one.

    Attributes:
        flip: the coordinates in which partners move oppositely; a joint that is its own partner
            moves only along the others.
        joints: pairs of joints; [k, k] is a joint on the line of symmetry.
        actuators: pairs of beams that have the same ratio.
    """

    flip: Literal["x", "y", "xy", "none"] = "x"
    joints: list[Pair] = []
    actuators: list[Pair] = []


class Free(_Part):
    """What may change, and by how much in one step.

    Attributes:
        joints: their indices; None: all but the fixed one.
        actuators: the beams whose ratios may change; None: all.
        move: step of a joint, mm.
        ratio: step of a ratio.
        pairs: what changes alike.
    """

    joints: list[Index] | None = None
    actuators: list[Index] | None = None
    move: Annotated[float, Field(gt=0, le=1000)] = 5.0
    ratio: Annotated[float, Field(gt=0, le=1)] = 0.25
    pairs: Pairs = Pairs()


class Limits(_Part):
    """When to stop.

    Attributes:
        iterations: of the method.
        seconds: of getting ready, searching and checking; only the first check may take up to a
            quarter more, and compiling once on a machine longer than half of it.
        corrections: how often to go on from targets corrected by FEA.
        answers: how many designs that differ are wanted; several take up to thrice the seconds.
    """

    iterations: Annotated[int, Field(ge=1)] = 1000
    seconds: Positive = 30.0
    corrections: Annotated[int, Field(ge=0)] = 2
    answers: Annotated[int, Field(ge=1, le=MOST_ANSWERS)] = 1

    @property
    def seconds_in_all(self) -> float:
        """That a search may take for all answers."""
        return self.seconds if self.answers == 1 else (1 + MORE) * self.seconds


class Task(_Part):
    """What is wanted of a grid, and how to search for it.

    Attributes:
        schema_: version of the form.
        grid: the design to begin with, as in a grid file.
        goals: at least one.
        free: what may change.
        method: one of `simulearn.inverse.METHODS`.
        engine: one of `simulearn.simulate.ENGINES`.
        limits: when to stop.
        tolerance: of the goals that have none of their own, mm; None: they have none.
        robust: whether a design is searched for whose prints come close, all in all.
    """

    schema_: Literal["simulearn.task/1"] = Field(alias="schema", default="simulearn.task/1")
    grid: dict[str, Any]
    goals: Annotated[list[Goal], Field(min_length=1)]
    free: Free = Free()
    method: str = "default"
    engine: str = "learned"
    limits: Limits = Limits()
    tolerance: Positive | None = None
    robust: bool = False
    _material: Material | None = PrivateAttr(None)  # that the grid holds itself

    @property
    def start(self) -> Grid:
        """The design to begin with, its fixed joint at the origin."""
        return self._design.centred

    @property
    def _design(self) -> Grid:
        own = self._material
        materials = {} if own is None else {own.name: own}
        return grid_from_dict(self.grid, paths=True, materials=materials)

    @property
    def aims(self) -> Goals:
        """The goals as arrays."""
        grid = self._design
        return Goals.of(
            [_vertex(goal.vertex, f"goals[{k}].vertex", grid) for k, goal in enumerate(self.goals)],
            np.array([goal.target for goal in self.goals]),
            np.array([goal.weight for goal in self.goals]),
        )

    @property
    def tolerances(self) -> tuple[float | None, ...]:
        """The tolerance of each goal, mm."""
        own = [goal.tolerance for goal in self.goals]
        return tuple(self.tolerance if one is None else one for one in own)

    @property
    def of_prints(self) -> bool:
        """Whether the task asks anything of prints, and not only of the design."""
        return self.robust or any(one is not None for one in self.tolerances)

    def with_grid(self, grid: Grid) -> "Task":
        """Return the same task, beginning with another design."""
        task = self.model_copy(update={"grid": grid_to_dict(grid)})
        task._material = _own(grid)
        return task


KEYS = {
    "schema": f'this program reads "{SCHEMA}"',
    "grid": "a grid is written as in a grid file",
    "goals": "goals are a list of at least one object with vertex, target, weight and tolerance",
    "vertex": '["joint", k, "centre"], ["joint", k, corner] or ["beam", b, section, corner]',
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
PLACES: dict[str, type[BaseModel]] = {
    "goals": Goal,
    "free": Free,
    "pairs": Pairs,
    "limits": Limits,
}
SECTIONS = ("start", "middle", "end")


def read_task(path: Path | str, *, paths: bool = False) -> Task:
    """Return the task in a file.

    Args:
        path: of the file.
        paths: whether the grid's material may be the path of a file; if not, it must be a name.

    Raises:
        InputError: the file cannot be read or does not describe a task; one line says where.
    """
    try:
        return task_from_dict(json.loads(read_text(path)), paths=paths)
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        raise InputError(
            f"{path}: is not valid JSON at {place}: {error.msg}", "task", str(path)
        ) from error
    except RecursionError as error:
        raise InputError(f"{path}: lists are nested too deeply", "task", str(path)) from error
    except InputError as error:
        if isinstance(error.__cause__, OSError | UnicodeDecodeError):
            raise
        raise InputError(f"{path}: {error}", error.code, error.where) from error


def write_task(task: Task, path: Path | str) -> None:
    """Write a task to a file, or leave the old one.

    Raises:
        InputError: the file cannot be written.
    """
    with replacing(path) as temporary:
        temporary.write_text(json.dumps(task_to_dict(task), indent=1) + "\n", encoding="utf-8")


def task_to_dict(task: Task) -> dict[str, Any]:
    """Return a task as plain lists and numbers under the file's keys."""
    return task.model_dump(by_alias=True)


def task_from_dict(
    data: Any, *, paths: bool = False, materials: Mapping[str, Material] | None = None
) -> Task:
    """Return the task that a dict with the file's keys describes.

    Args:
        data: such as JSON gives.
        paths: whether the grid's material may be the path of a file; if not, it must be a name.
        materials: those that the grid's material may name besides the ones that come along.

    Raises:
        InputError: a key, type, index or number is wrong; one line says which.
    """
    if isinstance(data, dict) and "schema" not in data:
        raise InputError(f"schema is missing; {KEYS['schema']}", "task", "schema")
    try:
        task = Task.model_validate(data)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        raise InputError(_line(first), "task", _place(first["loc"])) from error
    try:
        grid = grid_from_dict(task.grid, paths=paths, materials=materials)
    except InputError as error:
        raise InputError(f"grid: {error}", error.code, error.where or "grid") from error
    for removed in removals(grid):
        raise InputError(
            f"grid: {removed.message}; take it out of a grid that is searched from",
            removed.code,
            removed.where,
        )
    _check(task, grid)
    task._material = _own(grid)
    return task


def _own(grid: Grid) -> Material | None:
    """Return the material that a grid holds itself, None where it names one."""
    return grid.material if isinstance(grid.material, Material) else None


def _check(task: Task, grid: Grid) -> None:
    """Raise InputError where the parts of a task do not fit each other."""
    for k, goal in enumerate(task.goals):
        _vertex(goal.vertex, f"goals[{k}].vertex", grid)
    if not sum(goal.weight for goal in task.goals) > 0:
        raise InputError("goals all have the weight 0; at least one counts", "task", "goals")
    joints, beams, free = len(grid.joints), len(grid.beams), task.free
    _indices(free.joints or [], joints, "free.joints", "joints")
    _indices(free.actuators or [], beams, "free.actuators", "beams")
    if free.joints is not None and grid.fixed in free.joints:
        place = free.joints.index(grid.fixed)
        raise InputError(
            f"free.joints[{place}] is {grid.fixed}, the fixed joint, the origin of all targets",
            "task",
            f"free.joints[{place}]",
        )
    for name, pairs, count, allowed in (
        ("joints", free.pairs.joints, joints, free.joints),
        ("actuators", free.pairs.actuators, beams, free.actuators),
    ):
        where = f"free.pairs.{name}"
        flat = [k for pair in pairs for k in dict.fromkeys(pair)]
        _indices(flat, count, where, "joints" if name == "joints" else "beams")
        for k in flat:
            if flat.count(k) > 1:
                raise InputError(f"{where} has {k} in two pairs; it has one partner", "task", where)
            if (allowed is not None and k not in allowed) or (name == "joints" and k == grid.fixed):
                raise InputError(f"{where} has {k}, which is not free to change", "task", where)


def _indices(indices: Sequence[int], count: int, where: str, what: str) -> None:
    for place, k in enumerate(indices):
        if k >= count:
            raise InputError(
                f"{where}[{place}] is {k}; {what} are numbered 0 to {count - 1}",
                "task",
                f"{where}[{place}]",
            )


def _vertex(words: list[Any], where: str, grid: Grid) -> Vertex:
    """Return the vertex that a task names.

    Raises:
        InputError: there is no such vertex.
    """

    def number(place: int, count: int, what: str) -> int:
        k = words[place]
        if isinstance(k, bool) or not isinstance(k, int) or not 0 <= k < count:
            raise InputError(
                f"{where}[{place}] is {shown(k)}; {what} are numbered 0 to {count - 1}",
                "task",
                f"{where}[{place}]",
            )
        return k

    def corner(place: int, count: int) -> int | None:
        return None if words[place] == "centre" else number(place, count, "corners")

    match words:
        case ["joint", _, _]:
            return Vertex("joint", number(1, len(grid.joints), "joints"), corner(2, 8))
        case ["beam", _, named, _]:
            beam = number(1, len(grid.beams), "beams")
            section = SECTIONS.index(named) if named in SECTIONS else number(2, 3, "sections")
            return Vertex("beam", beam, corner(3, 4), section)
    text = f"{where} is {shown(words)}; a vertex is {KEYS['vertex']}"
    raise InputError(text, "task", where)


def _line(error: Any) -> str:
    """Return one of pydantic's errors in our words."""
    place, value = error["loc"], error["input"]
    where = _place(place)
    if not place:
        keys = ", ".join(_keys(Task))
        return f"is {shown(value)}; a task is an object with the keys {keys}"
    names = [k for k in place if isinstance(k, str)]
    hint = KEYS.get(names[-1], "")
    if error["type"] == "missing":
        return f"{where} is missing; {hint}"
    if error["type"] == "extra_forbidden":
        keys = ", ".join(_keys(PLACES[names[-2]] if len(names) > 1 else Task))
        return f"{where} is not a key here; the keys are {keys}"
    return f"{where} is {shown(value)}; {hint}"


def _keys(model: type[BaseModel]) -> list[str]:
    return [field.alias or name for name, field in model.model_fields.items()]


def _place(keys: Sequence[str | int]) -> str:
    """Return a path of keys and indices in words, as `goals[1].target[2]`."""
    return "".join(f"[{k}]" if isinstance(k, int) else f".{k}" for k in keys).lstrip(".")

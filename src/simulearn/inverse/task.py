"""The task file: a grid, goals, what may change, and how to search; JSON, `simulearn.task/1`."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, PrivateAttr, ValidationError

from simulearn.errors import InputError, Message
from simulearn.files import parse_json, path_from, read_text, replacing
from simulearn.grid import Grid, grid_from_dict, grid_to_dict
from simulearn.grid.arrays import whole
from simulearn.grid.cleaning import removals
from simulearn.grid.gridfile import with_material
from simulearn.inverse.goalfile import CurveFile, FilePart, Goal, Positive, SurfaceFile
from simulearn.inverse.goals import Goals
from simulearn.inverse.tasktext import KEYS, MOST_ANSWERS, line_of, place_of
from simulearn.inverse.wanting import Shapes, goals_of, rows_of
from simulearn.material import Material

SCHEMA = "simulearn.task/1"
MORE = 2.0  # limits of seconds, that other answers may take after the first

Index = Annotated[int, BeforeValidator(whole), Field(ge=0, lt=2**31)]
Pair = Annotated[list[Index], Field(min_length=2, max_length=2)]


class Pairs(FilePart):
    """What changes alike, so that a symmetric design stays one.

    Attributes:
        flip: the coordinates in which partners move oppositely; a joint that is its own partner
            moves only along the others.
        joints: pairs of joints; [k, k] is a joint on the line of symmetry.
        actuators: pairs of beams that have the same ratio.
    """

    flip: Literal["x", "y", "xy", "none"] = "x"
    joints: list[Pair] = []  # noqa: RUF012  (pydantic copies it)
    actuators: list[Pair] = []  # noqa: RUF012


class Free(FilePart):
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


class Limits(FilePart):
    """When to stop.

    Attributes:
        iterations: of the method.
        seconds: of getting ready, searching and checking; only the first check may take up to a
            quarter more, and compiling once on a machine longer than half of it.
        corrections: how often to go on from targets corrected by FEA.
        answers: how many designs that differ are wanted; several take up to thrice the seconds.
    """

    iterations: Annotated[int, Field(ge=1, lt=2**31)] = 1000
    seconds: Positive = 30.0
    corrections: Annotated[int, Field(ge=0, lt=2**31)] = 2
    answers: Annotated[int, Field(ge=1, le=MOST_ANSWERS)] = 1

    @property
    def seconds_in_all(self) -> float:
        """That a search may take for all answers."""
        return self.seconds if self.answers == 1 else (1 + MORE) * self.seconds


class Task(FilePart):
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
        pose: whether goals are seen from the fixed joint, or the shape may be placed anywhere.
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
    pose: Literal["fixed", "free"] = "fixed"
    _material: Material | None = PrivateAttr(None)  # that the grid holds itself
    _shapes: Shapes = PrivateAttr(default_factory=Shapes)

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
        """The goals as arrays, one for each vertex or face that an entry names."""
        return goals_of(self.goals, self._design, self._shapes, self.pose == "free")

    @property
    def warnings(self) -> tuple[Message, ...]:
        """What was mended or guessed in surfaces and curves."""
        return tuple(self._shapes.warnings)

    @property
    def files(self) -> tuple[Path, ...]:
        """The files of surfaces and curves."""
        here = self._shapes.folder or Path()
        said = [one for goal in self.goals for one in (goal.surface, goal.curve, goal.away_from)]
        names = [one.file for one in said if isinstance(one, SurfaceFile | CurveFile)]
        return tuple(here / name for name in names if name is not None)

    @property
    def shapes_digest(self) -> str:
        """SHA-256 of the surfaces and curves; "" where there are none."""
        return self._shapes.digest

    @property
    def tolerances(self) -> tuple[float | None, ...]:
        """The tolerance of each of the goals in `aims`, mm."""
        grid = self._design
        own = [goal.tolerance for goal in self.goals for _ in range(rows_of(goal, grid))]
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


def read_task(path: Path | str, *, paths: bool = False) -> Task:
    """Return the task in a file.

    Args:
        path: of the file.
        paths: whether the grid's material may be the path of a file, and whether surfaces and
            curves may be files, seen from the folder of this one; if not, neither may.

    Raises:
        InputError: the file cannot be read or does not describe a task; one line says where.
    """
    try:
        folder = Path(path).parent if paths else None
        data = parse_json(read_text(path))
        if folder is not None and isinstance(data, dict) and "grid" in data:
            data |= {"grid": with_material(data["grid"], folder)}
        return task_from_dict(data, paths=paths, folder=folder)
    except InputError as error:
        if isinstance(error.__cause__, OSError | UnicodeDecodeError):
            raise
        raise InputError(f"{path}: {error}", error.code, error.where) from error


def write_task(task: Task, path: Path | str) -> None:
    """Write a task to a file, or leave the old one.

    Raises:
        InputError: the file cannot be written.
    """
    data = task_to_dict(task)
    _moved_paths(data, task, Path(path).parent)
    with replacing(path) as temporary:
        temporary.write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")


def _moved_paths(data: dict[str, Any], task: Task, folder: Path) -> None:
    """Let the files that goals name be seen from another folder."""
    here = task._shapes.folder
    if here is None or here.resolve() == folder.resolve():
        return
    for goal in data["goals"]:
        for key in ("surface", "curve", "away_from"):
            said = goal.get(key)
            if isinstance(said, dict) and "file" in said:
                said["file"] = path_from(folder, here / said["file"])


def task_to_dict(task: Task) -> dict[str, Any]:
    """Return a task as plain lists and numbers under the file's keys."""
    return task.model_dump(by_alias=True)


def task_from_dict(
    data: Any,
    *,
    paths: bool = False,
    materials: Mapping[str, Material] | None = None,
    folder: Path | str | None = None,
) -> Task:
    """Return the task that a dict with the file's keys describes.

    Args:
        data: such as JSON gives.
        paths: whether the grid's material may be the path of a file; if not, it must be a name.
        materials: those that the grid's material may name besides the ones that come along.
        folder: that the files of surfaces and curves are seen from; None: no file may be named.

    Raises:
        InputError: a key, type, index or number is wrong; one line says which.
    """
    if isinstance(data, dict) and "schema" not in data:
        raise InputError(f"schema is missing; {KEYS['schema']}", "task", "schema")
    try:
        task = Task.model_validate(data)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        raise InputError(line_of(first, Task), "task", place_of(first["loc"])) from error
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
    task._material = _own(grid)
    task._shapes = Shapes(None if folder is None else Path(folder))
    _check(task, grid)
    return task


def _own(grid: Grid) -> Material | None:
    """Return the material that a grid holds itself, None where it names one."""
    return grid.material if isinstance(grid.material, Material) else None


def _check(task: Task, grid: Grid) -> None:
    """Raise InputError where the parts of a task do not fit each other."""
    goals_of(task.goals, grid, task._shapes)
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

"""What a search leaves on disk, so that it can go on: its steps and checks, written as one file."""

import hashlib
import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from simulearn.errors import InputError, Message
from simulearn.files import read_text, replacing
from simulearn.grid import Grid, grid_from_dict, grid_to_dict
from simulearn.inverse.checking import Check
from simulearn.inverse.task import Task, task_to_dict

SCHEMA = "simulearn.search/1"
COLUMNS = ("iteration", "phase", "seconds", "designs", "error_mm", "words")
ROBUST = -1  # the phase of a robust search in which prints are looked at
ANSWERS = -2  # the phase in which other answers are looked for
FIGURES = ("error_mm", "error_fea_mm", "why", "apart_mm", "bound_mm", "phase")  # of a check


@dataclass(frozen=True)
class Step:
    """An iteration.

    Attributes:
        iteration: from 1; 0 is the design to begin with.
        phase: 0 searching, 1 and more after so many corrections by finite elements; ROBUST;
            ANSWERS, whose steps are each another design and its own error.
        seconds: of searching and checking, all runs together.
        designs: scored so far.
        error_mm: of the best so far, by the engine, against the targets of the phase; expected of
            prints where the phase is ROBUST.
        words: what was done.
        joints, actuators: of the best so far.
    """

    iteration: int
    phase: int
    seconds: float
    designs: int
    error_mm: float
    words: str
    joints: list[list[float]]
    actuators: list[float]

    def grid(self, like: Grid) -> Grid:
        """Return the best grid so far, all else being as in another."""
        return Grid(self.joints, like.beams, self.actuators, like.fixed, like.material)

    def row(self) -> dict[str, Any]:
        """Return what history files hold."""
        return {name: getattr(self, name) for name in COLUMNS}


@dataclass(frozen=True, eq=False)
class Past:
    """What earlier runs of a search did.

    Attributes:
        steps: in their order.
        checks: by finite elements, in their order.
    """

    steps: tuple[Step, ...] = ()
    checks: tuple[Check, ...] = ()


def identity(task: Task, model: str | None) -> str:
    """Return what names a search: all of the task but its limits, its surfaces, the model."""
    data = task_to_dict(task)
    del data["limits"]
    digest = task.shapes_digest
    text = json.dumps([data, model, *([digest] if digest else [])], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def read_past(folder: Path, name: str) -> Past:
    """Return what earlier runs in a folder did, nothing if there was none.

    Args:
        folder: of the search.
        name: `identity` of the search.

    Raises:
        InputError: the folder holds another search, or its file is damaged.
    """
    path = folder / "search.json"
    if not path.exists():
        return Past()
    try:
        data = json.loads(read_text(path))
        if data["schema"] != SCHEMA or not isinstance(data["steps"], list):
            raise ValueError("another schema")
        steps = tuple(Step(**step) for step in data["steps"])
        checks = tuple(_check(row) for row in data.get("checks", []))
    except (ValueError, KeyError, TypeError) as error:
        raise InputError(f"{path}: is damaged ({error}); name another folder") from error
    if data["identity"] != name:
        raise InputError(f"{path}: is the search of another task; name another folder")
    return Past(steps, checks)


def write_past(
    folder: Path, name: str, steps: Sequence[Step], checks: Sequence[Check] = ()
) -> None:
    """Write what a search did, for going on (search.json) and for people (history.csv)."""
    data = {
        "schema": SCHEMA,
        "identity": name,
        "steps": [asdict(step) for step in steps],
        "checks": [_row(check) for check in checks],
    }
    with replacing(folder / "search.json") as temporary:
        temporary.write_text(json.dumps(data) + "\n", encoding="utf-8")
    lines = [",".join(COLUMNS)]
    for s in steps:
        words = s.words.replace('"', "'")
        lines.append(
            f'{s.iteration},{s.phase},{s.seconds:.2f},{s.designs},{s.error_mm:.4f},"{words}"'
        )
    with replacing(folder / "history.csv") as temporary:
        temporary.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _row(check: Check) -> dict[str, Any]:
    return {
        "grid": grid_to_dict(check.grid),
        **{name: getattr(check, name) for name in FIGURES},
        "shift": None if check.shift is None else check.shift.tolist(),
        "collisions": [asdict(message) for message in check.collisions],
    }


def _check(row: dict[str, Any]) -> Check:
    shift = row["shift"]
    return Check(
        grid=grid_from_dict(row["grid"], paths=True),
        **{name: row[name] for name in FIGURES},
        shift=None if shift is None else np.array(shift, dtype=float),
        passes=tuple(Message(**one) for one in row.get("collisions", ())),
    )

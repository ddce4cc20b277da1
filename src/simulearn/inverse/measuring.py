"""How far shapes are from the goals of a task, for those who look at them one by one."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.inverse.goals import Goals
from simulearn.inverse.kinds import AtPoints
from simulearn.inverse.task import Task
from simulearn.inverse.wanting import rows_of
from simulearn.rigid import Place

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Measured:
    """A shape against the G goals of a task.

    Attributes:
        error_mm: weighted mean distance.
        distances: (G,) mm.
        degrees: by which directions are off; None of goals that are none.
        lines: (K, 2, 3) mm from where the shape is placed to where it should be, of all goals
            that are no points.
        place: the motion that brings the shape to where it is compared.
    """

    error_mm: float
    distances: Array
    degrees: tuple[float | None, ...]
    lines: Array
    place: Place


def measure(task: Task, shapes: Sequence[tuple[Array, Array]]) -> list[Measured]:
    """Return how far shapes of a task's grid, or of designs made from it, are from its goals.

    Args:
        task: what is wanted.
        shapes: corners of the joints (J, 8, 3) and of the beams' sections (B, 3, 4, 3), mm, in the
            last frame; the first is the one that a search begins with, from which goals that may
            not slide and a free pose begin.

    Raises:
        InputError: a shape is not one of such a grid.
    """
    joints, beams = len(task.start.joints), len(task.start.beams)
    aims = task.aims
    goals: Goals | None = None
    found = []
    for k, (corners, sections) in enumerate(shapes):
        if corners.shape != (joints, 8, 3) or sections.shape != (beams, 3, 4, 3):
            text = (
                f"shapes[{k}] has {len(corners)} joints and {len(sections)} beams; the grid has "
                f"{joints} and {beams}, with 8 corners and 3 sections of 4 corners each"
            )
            raise InputError(text, "shape", f"shapes[{k}]")
        points = aims.points(corners, sections)
        goals = goals or aims.begun(points)
        found.append(_measured(goals, aims, points))
    return found


def entries(task: Task) -> list[int]:
    """Return for each of the G goals which entry of the task it comes from."""
    return [k for k, goal in enumerate(task.goals) for _ in range(rows_of(goal, task.start))]


def _measured(goals: Goals, aims: Goals, points: Array) -> Measured:
    placed, distances = goals.placed(points), goals.distances(points)
    if not np.isfinite(distances).all():
        raise InputError("goals lie too far from the shape to be compared with it", "task", "goals")
    lines = [
        part.wanted.lines(placed[at])
        for (part, at), (aim, _) in zip(goals.slices(), aims.slices(), strict=True)
        if not isinstance(aim.wanted, AtPoints)
    ]
    return Measured(
        float(goals.error(points)),
        distances,
        tuple(goals.degrees(points)),
        np.concatenate([np.zeros((0, 2, 3)), *lines]),
        goals.place(points),
    )

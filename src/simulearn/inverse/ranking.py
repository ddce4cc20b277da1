"""Ranking, for a designer who chooses: every single modification scored in one call.

The five best that are shown differ really: no two change the same joint or beam, and no two move
the goals' vertices in nearly the same way.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import ComputationError
from simulearn.grid import Grid
from simulearn.inverse.changes import Change, changes
from simulearn.inverse.goals import Goals
from simulearn.inverse.problem import Problem
from simulearn.inverse.scoring import places
from simulearn.inverse.space import Space
from simulearn.inverse.task import Free, Task
from simulearn.simulate import Simulator

Array = NDArray[np.float64]

SHOWN = 5
ALIKE = 0.97  # cosine between motions of the vertices, above which they are the same idea


@dataclass(frozen=True, eq=False)
class Suggestion:
    """A modification and what it leads to.

    Attributes:
        change: the modification.
        grid: the design after it.
        error_mm: predicted.
        points: (G, 3) mm, where the goals' vertices come to.
        moved_mm: mean distance by which it moves them.
    """

    change: Change
    grid: Grid
    error_mm: float
    points: Array
    moved_mm: float


@dataclass(frozen=True, eq=False)
class Ranking:
    """All valid modifications of a design, the best first.

    Attributes:
        grid: the design as it is.
        error_mm: of it.
        points: (G, 3) mm, where its vertices come to.
        suggestions: all of them.
        best: five that differ.
    """

    grid: Grid
    error_mm: float
    points: Array
    suggestions: tuple[Suggestion, ...]
    best: tuple[Suggestion, ...]


def rank(task: Task, engine: Simulator) -> Ranking:
    """Return the modifications of a task's grid, ranked by the error that they lead to.

    Raises:
        InputError: the grid is not valid, or nothing may change.
        ComputationError: the engine has no answer for the grid itself.
    """
    return ranked(task.start, task.aims, task.free, engine)


def explore(grid: Grid, engine: Simulator, free: Free = Free()) -> Ranking:  # noqa: B008
    """Return the modifications of a grid without goals: the ones that change its shape most first.

    The goals are the joints where they are, so that an error is how far they are moved.

    Raises:
        InputError: the grid is not valid, or nothing may change.
    """
    (result,) = engine.simulate([grid])
    told = ranked(grid, Goals.centres(result.centres[-1]), free, engine)
    most = told.suggestions[::-1]
    return Ranking(told.grid, told.error_mm, told.points, most, different(most, told.points))


def ranked(grid: Grid, goals: Goals, free: Free, engine: Simulator) -> Ranking:
    """Return the modifications of a grid, ranked by the error of its goals."""
    space = Space.of(grid, free, getattr(engine, "training", None))
    problem = Problem(space, goals, places(engine, goals))
    x, a = space.start
    tried = changes(space, a)
    told = problem.points(
        x + np.array([np.zeros_like(x), *(change.dx for change in tried)]),
        a + np.array([np.zeros_like(a), *(change.da for change in tried)]),
    )
    errors = problem.error(told)
    if not np.isfinite(errors[0]):
        raise ComputationError("the engine has no answer for the grid; ask --engine fea")
    moved = np.linalg.norm(told - told[0], axis=-1).mean(axis=-1)
    order = [int(k) for k in np.argsort(errors[1:], kind="stable") + 1 if np.isfinite(errors[k])]
    suggestions = tuple(
        Suggestion(
            change=tried[k - 1],
            grid=space.grid_at(x + tried[k - 1].dx, a + tried[k - 1].da),
            error_mm=float(errors[k]),
            points=told[k],
            moved_mm=float(moved[k]),
        )
        for k in order
    )
    return Ranking(
        space.grid, float(errors[0]), told[0], suggestions, different(suggestions, told[0])
    )


def different(
    suggestions: Sequence[Suggestion], points: Array, count: int = SHOWN
) -> tuple[Suggestion, ...]:
    """Return the first few suggestions that differ really, filled up with the next best.

    Args:
        suggestions: the best first.
        points: (G, 3) mm, the vertices of the design as it is.
        count: how many.
    """
    chosen: list[Suggestion] = []
    for one in suggestions:
        if len(chosen) == count:
            break
        if not any(_same_part(one, other) or _alike(one, other, points) for other in chosen):
            chosen.append(one)
    left = [one for one in suggestions if one not in chosen]
    chosen += left[: count - len(chosen)]
    return tuple(sorted(chosen, key=suggestions.index))


def _same_part(one: Suggestion, other: Suggestion) -> bool:
    return (one.change.part, one.change.indices) == (other.change.part, other.change.indices)


def _alike(one: Suggestion, other: Suggestion, points: Array) -> bool:
    a, b = (one.points - points).ravel(), (other.points - points).ravel()
    return bool(a @ b > ALIKE * np.linalg.norm(a) * np.linalg.norm(b))

"""Ranking, for a designer who chooses: every single modification scored in one call.

The five best that are shown differ really: no two change the same joint or beam, and no two move
the goals' vertices nearly alike.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from simulearn.display import Displayed
from simulearn.errors import Cancel, ComputationError, Message
from simulearn.grid import Grid
from simulearn.inverse.changes import Change, changes
from simulearn.inverse.goals import Goals
from simulearn.inverse.prints import without_scatter
from simulearn.inverse.probability import Probability, probability
from simulearn.inverse.problem import Problem
from simulearn.inverse.scoring import places
from simulearn.inverse.space import Space
from simulearn.inverse.task import Free, Task
from simulearn.simulate import Progress, Simulator
from simulearn.simulate import engine as engine_of

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
        points: (V, 3) mm, where the goals' vertices come to.
        moved_mm: mean distance by which it moves them.
        probability: how often prints of it meet the goals; of the best five of a task that has
            tolerances.
    """

    change: Change
    grid: Grid
    error_mm: float
    points: Array
    moved_mm: float
    probability: Probability | None = None


@dataclass(frozen=True, eq=False)
class Ranking(Displayed):
    """All valid modifications of a design, the best first.

    Attributes:
        grid: the design as it is.
        error_mm: of it.
        points: (V, 3) mm, where its vertices come to.
        suggestions: all of them.
        best: five that differ.
        goals: what is wanted; None where a grid alone was ranked.
        probability: how often prints of the design as it is meet the goals.
        warnings: about the goals.
    """

    grid: Grid
    error_mm: float
    points: Array
    suggestions: tuple[Suggestion, ...]
    best: tuple[Suggestion, ...]
    goals: Goals | None = None
    probability: Probability | None = None
    warnings: tuple[Message, ...] = ()


def rank(
    design: Task | Grid,
    engine: Simulator | str | None = None,
    model: str | None = None,
    free: Free | None = None,
    cancel: Cancel | None = None,
    progress: Progress | None = None,
) -> Ranking:
    """Return the modifications of a design, the best first.

    Of a task's grid the best come closest to the goals. Of a grid without goals they are the ones
    that change its shape most: its goals are the joints where they are, so that an error is how
    far they are moved.

    Args:
        design: a task, or a grid.
        engine: the simulator, or the name of one; the task's if not given, or `learned`.
        model: for the engine `learned`; its default if not given.
        free: what of a grid may change; a task says so itself.
        cancel: stops the ranking between designs.
        progress: called with the prints done and the prints in all, where there are tolerances.

    Raises:
        InputError: the grid is not valid, or nothing may change.
        ComputationError: the engine has no answer for the grid itself.
        CancelledError: the token was set.
    """
    simulator = engine or (design.engine if isinstance(design, Task) else "learned")
    if isinstance(simulator, str):
        simulator = engine_of(simulator, model)
    if isinstance(design, Task):
        ranking = _ranked(design.start, design.aims, design.free, simulator, cancel)
        ranking = replace(ranking, warnings=design.warnings)
        return _with_probabilities(ranking, design, simulator, cancel, progress)
    return _ranked(design, None, free or Free(), simulator, cancel)


def _ranked(
    grid: Grid, goals: Goals | None, free: Free, engine: Simulator, cancel: Cancel | None
) -> Ranking:
    space = Space.of(grid, free, getattr(engine, "training", None))
    moving = Goals.centres(np.zeros((len(grid.joints), 3)))
    placed = places(engine, goals or moving, cancel)
    problem = Problem(space, goals or moving, placed, cancel=cancel)
    x, a = space.start
    tried = changes(space, a)
    xs = x + np.array([np.zeros_like(x), *(change.dx for change in tried)])
    ratios = a + np.array([np.zeros_like(a), *(change.da for change in tried)])
    points = problem.points(xs, ratios)
    if goals is not None and np.isfinite(points[0]).all():
        problem.goals = goals = goals.begun(points[0])
    if not np.isfinite(points[0]).all():
        raise ComputationError(
            f"the engine {engine.name} has no answer for the grid",
            "no-answer",
            "grid",
            "finite elements may have one",
        )
    moved = np.linalg.norm(points - points[0], axis=-1).mean(axis=-1)
    errors = problem.error(points) if goals else np.nan_to_num(moved, nan=np.inf)
    order = np.argsort(errors[1:] if goals else -moved[1:], kind="stable") + 1
    designs = space.designs(xs, ratios)
    suggestions = tuple(
        Suggestion(
            change=tried[k - 1],
            grid=Grid(
                designs.flat[k],
                designs.beams,
                designs.actuators[k],
                designs.fixed,
                space.grid.material,
            ),
            error_mm=float(errors[k]),
            points=points[k],
            moved_mm=float(moved[k]),
        )
        for k in order.tolist()
        if np.isfinite(errors[k])
    )
    best = different(suggestions, points[0])
    return Ranking(space.grid, float(errors[0]), points[0], suggestions, best, goals)


def _with_probabilities(
    ranking: Ranking,
    task: Task,
    engine: Simulator,
    cancel: Cancel | None,
    progress: Progress | None,
) -> Ranking:
    """Return a ranking of a task with tolerances that says how often prints are within them."""
    goals, wanted = ranking.goals or task.aims, task.tolerances
    if all(one is None for one in wanted):
        return ranking
    if warnings := without_scatter(task, ranking.grid):
        return replace(ranking, warnings=(*ranking.warnings, *warnings))
    designs = [(ranking.grid, ranking.points), *((one.grid, one.points) for one in ranking.best)]
    found: list[Probability | None] = []
    for grid, points in designs:
        done = len(found)

        def part(now: int, of: int, done: int = done) -> None:
            if progress is not None:
                progress(done * of + now, len(designs) * of)

        try:
            found.append(
                probability(
                    grid, goals, wanted, points, engine=engine, progress=part, cancel=cancel
                )
            )
        except ComputationError:  # the table shows that there is none
            found.append(None)
    own, *others = found
    best = [replace(one, probability=p) for one, p in zip(ranking.best, others, strict=True)]
    return replace(ranking, best=tuple(best), probability=own)


def different(
    suggestions: Sequence[Suggestion], points: Array, count: int = SHOWN
) -> tuple[Suggestion, ...]:
    """Return the first few suggestions that differ really, filled up with the next best.

    Args:
        suggestions: the best first.
        points: (V, 3) mm, the vertices of the design as it is.
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

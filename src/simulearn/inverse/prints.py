"""What follows a search whose task asks anything of prints: a probability, a robust design.

The probability that a print meets the goals stands with the best design. A robust search then goes
on from there with a few prints of each design, and what it comes to is taken where more prints of
it meet the goals, or as many and closer, by prints that the search has not seen.
"""

from __future__ import annotations

from operator import attrgetter
from time import monotonic
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import CancelledError, ComputationError, InputError, Message, stop_if
from simulearn.grid import Grid
from simulearn.inverse.checking import Check
from simulearn.inverse.goals import Goals
from simulearn.inverse.keeping import ROBUST
from simulearn.inverse.newton import newton
from simulearn.inverse.probability import Probability, probability
from simulearn.inverse.problem import OutOfTime, Until
from simulearn.inverse.robust import PRINTS, robust_problem
from simulearn.inverse.space import Space
from simulearn.inverse.task import Task
from simulearn.material import load_material
from simulearn.simulate.scatter import require_scatter

if TYPE_CHECKING:
    from simulearn.inverse.search import Search

Regarded = tuple[Check, Probability | None, Probability | None, list[Message]]


def without_scatter(task: Task, grid: Grid) -> list[Message]:
    """Return a warning where a task asks for prints of which nothing is known.

    Raises:
        InputError: it asks for a robust design.
    """
    if not task.of_prints:
        return []
    try:
        require_scatter(load_material(grid.material))
    except InputError as error:
        if task.robust:
            raise
        return [Message("material-scatter", error.where, str(error))]
    return []


def regard_prints(search: Search, space: Space, goals: Goals, best: Check) -> Regarded:
    """Return the design to answer with, and how often prints of it meet the goals.

    Args:
        search: that came to the best design.
        space: of the designs.
        goals: what is wanted.
        best: the best design without regard to prints.

    Returns:
        The best design or a robust one; how often prints of it meet the goals; of a robust search,
        how often prints of the best do; warnings.

    Raises:
        CancelledError: the search was stopped.
    """
    warnings: list[Message] = []
    nominal = probability_of(search, best, goals, warnings)
    if not search.task.robust:
        return best, nominal, None, warnings
    robust = _robust(search, space, goals, best, warnings)
    passes = robust is not None and bool(robust.collisions) and not best.collisions
    if robust is not None and robust is not best and not passes:
        other = probability_of(search, robust, goals, warnings)
        if other is not None and (nominal is None or other.better_than(nominal)):
            return robust, other, nominal, warnings
    return best, nominal, nominal, warnings


def probability_of(
    search: Search, design: Check, goals: Goals, warnings: list[Message]
) -> Probability | None:
    """Return how often prints of a design meet the goals; None where there is no answer."""
    known, wanted, grid = _points(design, goals), search.task.tolerances, design.grid.centred
    try:
        return probability(grid, goals, wanted, known, engine=search.engine, cancel=search.cancel)
    except ComputationError as error:
        text = f"how often a print meets the goals is not known: {error}"
        warnings.append(Message("no-probability", "goals", text))
        return None


def _robust(
    search: Search, space: Space, goals: Goals, best: Check, warnings: list[Message]
) -> Check | None:
    """Return the check of the design whose prints come closest; None if none was looked for."""
    limits = search.task.limits
    until = monotonic() + limits.seconds - search.seconds - search.checking
    out_of_time = Until(search.cancel, until)
    known, grid = _points(best, goals), best.grid.centred
    problem = robust_problem(
        space, goals, grid, known, search.engine, until, search.cancel, out_of_time
    )
    # An earlier run may have come further.
    earlier = [step.grid(space.grid) for step in search.steps if step.phase == ROBUST]
    try:
        scored = [problem.scored(*space.point(one)) for one in (grid, *earlier[-1:])]
    except (OutOfTime, CancelledError):
        stop_if(search.cancel)
        scored = []
    start = min(scored, key=attrgetter("error"), default=None)
    if start is None and earlier:  # there is no time to go on from there
        return search.known_check(earlier[-1])
    if start is None or not np.isfinite(start.error):
        why = "a print of the best design has no answer" if scored else "the time was over"
        text = f"no robust design was looked for: {why}; more seconds or another start may help"
        warnings.append(Message("robust-not-begun", "limits.seconds", text))
        return None
    words = f"expected of {PRINTS} prints of each design"
    last = search.steps[-1]
    search.note(space, start, last.iteration, last.designs, ROBUST, words)
    if last.iteration < limits.iterations:
        start = search.descended(problem, newton, start, limits.iterations, ROBUST)
    now = search.problem(space, goals, np.inf).scored(start.x, start.a)
    return search.checked(space.grid_at(now.x, now.a), now, goals, ROBUST)


def _points(check: Check, goals: Goals) -> NDArray[np.float64] | None:
    """Return where the vertices of a checked design are (V, 3) mm; None in a later run."""
    shape = check.shape
    return None if shape is None else goals.points(shape.joints[-1], shape.beams[-1])

"""One call for every method: search within limits, check by finite elements, correct, go on.

The clock begins once the engine's kernels are compiled. A search uses part of its time; then its
best design is checked by finite elements. Where they differ, the targets are moved by the
difference and the search goes on from there, as often as the limits allow.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from importlib import import_module
from time import monotonic

import numpy as np

from simulearn.errors import ComputationError, InputError
from simulearn.grid import Grid
from simulearn.inverse.checking import Check, check
from simulearn.inverse.goals import Goals
from simulearn.inverse.keeping import Step
from simulearn.inverse.problem import Did, Found, OutOfTime, Problem, drawing
from simulearn.inverse.scoring import places
from simulearn.inverse.space import Space
from simulearn.inverse.task import Task
from simulearn.simulate import Simulator, engine
from simulearn.simulate.learned import Learned

METHODS = {  # name -> module, function
    "default": ("simulearn.inverse.newton", "newton"),
    "brute-force": ("simulearn.inverse.brute_force", "brute_force"),
    "gradient": ("simulearn.inverse.gradient", "gradient"),
    "cma": ("simulearn.inverse.cma_es", "cma_es"),
}
Method = Callable[[Problem, Found], Iterator[Did]]
Tell = Callable[[Step], None]

GOOD = 0.1  # mm, about the engine's own error; a search that came so far has done its work
SEARCHING = 0.75  # of the time left goes into a search that corrections may follow
WORTH = 0.1  # of the error, that a correction must promise


@dataclass(frozen=True, eq=False)
class Outcome:
    """What a search found.

    Attributes:
        check: the best design, by the engine and by finite elements; None if it was interrupted.
        grid: the best design.
        error_mm: of it, by the engine that was used.
        steps: the iterations, 0 being the beginning.
        seconds: of searching and checking.
        interrupted: whether it was stopped by the user.
    """

    check: Check | None
    grid: Grid
    error_mm: float
    steps: tuple[Step, ...]
    seconds: float
    interrupted: bool

    @property
    def designs(self) -> int:
        """How many designs were scored."""
        return self.steps[-1].designs

    @property
    def iterations(self) -> int:
        """Of the method."""
        return self.steps[-1].iteration


def method(name: str) -> Method:
    """Return the method of a name.

    Raises:
        InputError: there is none.
    """
    if name not in METHODS:
        raise InputError(f'method "{name}" is not known; known are {", ".join(METHODS)}')
    module, function = METHODS[name]
    found: Method = getattr(import_module(module), function)
    return found


def optimize(
    task: Task,
    model: str | None = None,
    tell: Tell = lambda step: None,
    before: tuple[Step, ...] = (),
) -> Outcome:
    """Search for a design whose vertices come to their targets.

    An interrupt (Ctrl-C) ends the search and keeps the best so far.

    Args:
        task: what is wanted.
        model: for the engine `learned`; its default if not given.
        tell: called after each iteration.
        before: the steps of an earlier run, from which to go on.

    Raises:
        InputError: the grid is not valid, nothing may change, method or engine is not known.
        ComputationError: the engine has no answer for the design to begin with.
    """
    search = Search(task, engine(task.engine, model), method(task.method), tell, list(before))
    return search.run()


@dataclass(eq=False)
class Search:
    """A search under way.

    Attributes:
        task: what is wanted.
        engine: who answers.
        method: how to search.
        tell: called after each iteration.
        steps: so far.
    """

    task: Task
    engine: Simulator
    method: Method
    tell: Tell
    steps: list[Step]
    best: Check | None = field(default=None)
    _begun: float = field(default=0.0)
    _checking: float = field(default=3.0)  # s that a check takes, until one tells

    def run(self) -> Outcome:
        """Search, check and correct within the limits."""
        goals = self.task.aims
        space = Space.of(self.task.start, self.task.free, getattr(self.engine, "training", None))
        now = self._started(space, goals)
        phase, shift, interrupted = 0, np.zeros_like(goals.targets), False
        try:
            while True:
                now = self._searched(space, goals.shifted(shift), now, phase)
                begun = monotonic()
                found = check(space.grid_at(now.x, now.a), goals, self.engine)
                self._checking = monotonic() - begun
                if found.better_than(self.best):
                    self.best = found
                if not self._worth_going_on(found, phase):
                    break
                assert found.shift is not None
                phase, shift = phase + 1, found.shift
        except KeyboardInterrupt:
            interrupted = True
        if self.best is not None:
            grid, error = self.best.grid, self.best.error_mm
        else:
            grid, error = self.steps[-1].grid(space.grid), self.steps[-1].error_mm
        return Outcome(self.best, grid, error, tuple(self.steps), self.seconds, interrupted)

    @property
    def seconds(self) -> float:
        """Of searching and checking, earlier runs included."""
        return monotonic() - self._begun

    def _started(self, space: Space, goals: Goals) -> Found:
        """Return the design to begin with, and start the clock."""
        problem = self._problem(space, goals, np.inf)
        before = self.steps[-1] if self.steps else None
        x, a = space.start if before is None else space.point(before.grid(space.grid))
        found = problem.found(x, a)
        if not np.isfinite(found.error):
            raise ComputationError(
                f"the engine {self.engine.name} has no answer for the design to begin with"
            )
        if isinstance(self.engine, Learned):  # its kernels are compiled before the clock runs
            next(self.method(self._problem(space, goals, np.inf), found), None)
        self._begun = monotonic() - (before.seconds if before else 0.0)
        if before is None:
            self._note(space, found, 0, 1, 0, "the design to begin with")
        return found

    def _problem(self, space: Space, goals: Goals, until: float) -> Problem:
        model = self.engine.bundle.model if isinstance(self.engine, Learned) else None
        problem = Problem(
            space,
            goals,
            lambda designs: told(designs),
            model=model,
            source=drawing(len(self.steps)),  # other numbers in each phase and after each stop
            until=until,
        )
        told = places(self.engine, goals, problem.going)
        return problem

    def _searched(self, space: Space, goals: Goals, start: Found, phase: int) -> Found:
        """Return the best design of a phase, by the engine."""
        limits = self.task.limits
        left = limits.seconds - self.seconds
        share = SEARCHING if phase < limits.corrections else 1.0
        problem = self._problem(space, goals, monotonic() + share * (left - self._checking))
        done = self.steps[-1].iteration
        most = done + max(1, round(share * (limits.iterations - done)))
        before = self.steps[-1].designs
        # Targets may have moved since it was scored.
        error = float(problem.error(start.points[None])[0])
        start = problem.best = Found(start.x, start.a, start.points, error)
        try:
            if start.error > GOOD and done < limits.iterations:
                for did in self.method(problem, start):
                    now = problem.best
                    count = self.steps[-1].iteration + did.whole
                    self._note(space, now, count, before + problem.designs, phase, did.words)
                    if count >= most or now.error < GOOD:
                        break
                    problem.going()
        except OutOfTime:
            pass
        return problem.best

    def _note(
        self, space: Space, now: Found, iteration: int, designs: int, phase: int, words: str
    ) -> None:
        grid = space.grid_at(now.x, now.a)
        step = Step(
            iteration=iteration,
            phase=phase,
            seconds=round(self.seconds, 3),
            designs=designs,
            error_mm=now.error,
            words=words,
            joints=grid.joints.tolist(),
            actuators=grid.actuators.tolist(),
        )
        self.steps.append(step)
        self.tell(step)

    def _worth_going_on(self, found: Check, phase: int) -> bool:
        """Whether to go on from targets that finite elements have corrected."""
        limits = self.task.limits
        if found.error_fea_mm is None or found.apart_mm is None:
            return False
        return (
            phase < limits.corrections
            and self.steps[-1].iteration < limits.iterations
            and limits.seconds - self.seconds > 2 * self._checking
            and found.error_fea_mm > GOOD
            and found.apart_mm > WORTH * found.error_fea_mm
        )

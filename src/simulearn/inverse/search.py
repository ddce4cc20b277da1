"""One call for every method: search within limits, check by finite elements, correct, go on.

One time limit covers getting ready, searching and checking. A search uses part
of its time; then its best design is checked by finite elements. Where they differ, the targets are
moved by the difference and the search goes on from there, as often as the limits allow. A search
that found a design returns it, whatever a check, an interrupt or a token does afterwards.

Of a robust search this is the first half: the second goes on from its best design with a few prints
of each design, and the better of both by the probability that a print meets the goals is returned.
Where several answers are wanted, they come after that; see `answers`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from time import monotonic
from typing import TYPE_CHECKING

import numpy as np

from simulearn.errors import Cancel, CancelledError, ComputationError, stop_if
from simulearn.grid import Grid
from simulearn.inverse.answers import add_answers
from simulearn.inverse.archive import Archive, Distance
from simulearn.inverse.checking import Check, check
from simulearn.inverse.found import SearchResult
from simulearn.inverse.front import Answer
from simulearn.inverse.goals import Goals
from simulearn.inverse.keeping import ANSWERS, Past, Step
from simulearn.inverse.methods import Method, method
from simulearn.inverse.prints import regard_prints, without_scatter
from simulearn.inverse.problem import OutOfTime, Problem, Scored, Until, drawing
from simulearn.inverse.reach import not_near, out_of_reach
from simulearn.inverse.scoring import places_and_collisions
from simulearn.inverse.space import Space
from simulearn.inverse.task import Limits, Task
from simulearn.simulate import Result, Simulator
from simulearn.simulate import engine as engine_of
from simulearn.simulate.calls import warm
from simulearn.simulate.learned import Learned

if TYPE_CHECKING:
    from simulearn.fabricate import Printer

Progress = Callable[[Step], None]  # called with each step, as soon as it is done

NOMINAL = 0.5  # of the limits of a robust search, before prints are looked at
GOOD = 0.08  # mm; a search that came so far has done its work
SURE = 0.6  # of the engine's bound, below which a check says more than further searching
NEAR = 1.0  # mm, below which the engine is asked for its bound
SEARCHING = 0.75  # of the time left goes into a search that corrections may follow
WORTH = 0.1  # of the error, that a correction must promise
GRACE = 10.0  # s beyond the deadline that the first check of a search may take, at most
GRACE_SHARE = 0.25  # of the time, likewise
CHECKING = 0.25  # s for each beam that a check takes, until one has been measured


def optimize(
    task: Task,
    engine: Simulator | str | None = None,
    model: str | None = None,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
    before: Past | None = None,
    printer: Printer | str | None = None,
) -> SearchResult:
    """Search for a design whose vertices come to their targets.

    An interrupt (Ctrl-C) or the token ends the search and keeps the best so far.

    Args:
        task: what is wanted.
        engine: the simulator, or the name of one; the task's if not given.
        model: for the engine `learned`; its default if not given.
        progress: called after each iteration with the step that was done, the best design in it.
        cancel: stops the search within an iteration.
        before: an earlier run, from which to go on.
        printer: whose print times stand with several answers, or the name of one; a common one
            if not given.

    Raises:
        InputError: the grid is not valid, nothing may change, method or engine is not known.
        ComputationError: the engine has no answer for the design to begin with.
    """
    simulator = engine or task.engine
    if isinstance(simulator, str):
        simulator = engine_of(simulator, model)
    return Search(task, simulator, progress, cancel, before or Past(), printer).run()


class Search:
    """A search that is running.

    Args:
        task: what is wanted.
        engine: the simulator.
        progress: called after each iteration.
        cancel: stops the search.
        before: an earlier run.
        printer: whose print times count, or the name of one.
    """

    def __init__(
        self,
        task: Task,
        engine: Simulator,
        progress: Progress | None,
        cancel: Cancel | None,
        before: Past,
        printer: Printer | str | None = None,
    ) -> None:
        self.task, self.engine, self.cancel = task, engine, cancel
        self.limits = _nominal(task)
        self.method = method(task.method)
        self.steps, self.checks = list(before.steps), list(before.checks)
        self.archive: Archive | None = None
        self.answers: tuple[Answer, ...] = ()
        self.printer = printer
        self._bounds: dict[bytes, float] = {}
        self._progress = progress
        self._created, self._begun = monotonic(), np.inf
        self.checking = CHECKING * len(task.grid["beams"])

    def run(self) -> SearchResult:
        """Search, check and correct within the limits; then regard prints, if the task asks."""
        goals, start = self.task.aims, self.task.start
        unknown = without_scatter(self.task, start)
        warnings = [*self.task.warnings, *out_of_reach(start, goals), *unknown]
        space = Space.of(start, self.task.free, getattr(self.engine, "training", None))
        if self.task.limits.answers > 1:
            self.archive = Archive(Distance.of(space, turned=goals.pose is not None))
        goals, now = self._started(space, goals)
        interrupted = False
        best = of_prints = nominal = None
        try:
            phase, shift = self._resumed(goals)
            while True:
                now = self._searched(space, goals.shifted(shift), now, phase)
                latest = self.checked(space.grid_at(now.x, now.a), now, goals, phase)
                if latest.shift is None or not self._worth_going_on(latest, phase):
                    break
                phase, shift = phase + 1, latest.shift
            best = self._best()
            if best is not None and self.task.of_prints and not unknown:
                best, of_prints, nominal, said = regard_prints(self, space, goals, best)
                warnings += said
            if best is not None and self.archive is not None:
                best, of_prints, said = add_answers(self, space, goals, best, of_prints)
                warnings += said
        except (KeyboardInterrupt, CancelledError):
            interrupted = True
        best = best or self._best()
        if best is not None and (not interrupted or best.error_fea_mm is not None):
            grid, error = best.grid, best.error_mm
        else:
            last = next(step for step in reversed(self.steps) if step.phase != ANSWERS)
            best, grid, error = None, last.grid(space.grid), last.error_mm
        return SearchResult(
            best,
            grid,
            error,
            tuple(self.steps),
            tuple(self.checks),
            self.seconds,
            goals,
            interrupted,
            (
                *warnings,
                *([] if interrupted else not_near(start, error, warnings)),
                *([] if best is None else best.collisions),
            ),
            of_prints,
            nominal,
            self.answers,
        )

    @property
    def seconds(self) -> float:
        """Of searching and checking, earlier runs included."""
        return float(monotonic() - self._begun)

    def _started(self, space: Space, goals: Goals) -> tuple[Goals, Scored]:
        """Return the goals as they are begun, the design to begin with, and start the clock."""
        before = self._nominal_step() if self.steps else None
        start = self.problem(space, goals, np.inf).scored(*space.start)
        if np.isfinite(start.error):
            goals = goals.begun(start.points)
            x, a = space.start if before is None else space.point(before.grid(space.grid))
            problem = self.problem(space, goals, np.inf)
            error = float(problem.error(start.points[None])[0])
            start = replace(start, error=error) if before is None else problem.scored(x, a)
        if not np.isfinite(start.error):
            raise ComputationError(
                f"the engine {self.engine.name} has no answer for the design to begin with",
                "no-answer",
                "grid",
            )
        # All kernels are compiled before the clock runs, those of the checks, too.
        warm("fea")
        if isinstance(self.engine, Learned):
            next(self.method(self.problem(space, goals, np.inf), start), None)
        # Reading the model and getting ready count, but the first time on a machine, which takes
        # longer than many searches, no more than half of the time.
        ready = min(monotonic() - self._created, self.task.limits.seconds / 2)
        self._begun = monotonic() - ready - (self.steps[-1].seconds if before else 0.0)
        if before is None:
            self.note(space, start, 0, 1, 0, "the design to begin with")
        return goals, start

    def _resumed(self, goals: Goals) -> tuple[int, np.ndarray]:
        """Return the phase to go on with, and by how much its targets are moved (V, 3) mm."""
        phase = self._nominal_step().phase
        for one in reversed(self.checks):
            if one.phase == phase - 1 and one.shift is not None:
                return phase, one.shift
        return 0, np.zeros_like(goals.offset)

    def problem(self, space: Space, goals: Goals, until: float) -> Problem:
        """Return the problem to come to goals by the engine, until a time."""
        model = self.engine.bundle.model if isinstance(self.engine, Learned) else None
        places, collides = places_and_collisions(self.engine, goals, Until(self.cancel, until))
        return Problem(
            space,
            goals,
            places,
            model=model,
            source=drawing(len(self.steps)),  # other numbers in each phase and after each stop
            until=until,
            cancel=self.cancel,
            archive=self.archive,
            collides=collides,
        )

    def _searched(self, space: Space, goals: Goals, start: Scored, phase: int) -> Scored:
        """Return the best design of a phase, by the engine."""
        limits = self.limits
        left = limits.seconds - self.seconds
        share = SEARCHING if phase < limits.corrections else 1.0
        room = min(self.checking, left / 2)
        problem = self.problem(space, goals, monotonic() + share * (left - room))
        done = self.steps[-1].iteration
        most = done + max(1, round(share * (limits.iterations - done)))
        # Targets may have moved since it was scored.
        error = float(problem.error(start.points[None])[0])
        start = problem.best = replace(start, error=error)
        if start.error > GOOD and done < limits.iterations:
            return self.descended(problem, self.method, start, most, phase)
        return start

    def descended(
        self, problem: Problem, method: Method, start: Scored, most: int, phase: int
    ) -> Scored:
        """Return the best design that a method comes to from a start within the limits."""
        before, space = self.steps[-1].designs, problem.space
        problem.best = start
        try:
            for advance in method(problem, start):
                now = problem.best
                count = self.steps[-1].iteration + advance.complete
                self.note(space, now, count, before + problem.designs, phase, advance.words)
                if count >= most or now.error < self._enough(space, now, phase):
                    break
                problem.going()
        except OutOfTime:
            pass
        except CancelledError:  # within a simulation; by the deadline, or by the user
            stop_if(self.cancel)
        return problem.best

    def _enough(self, space: Space, now: Scored, phase: int) -> float:
        """Return the error (mm) of a design with which a phase ends.

        Before the first check the engine's own error is in it, and is not worth fitting to.
        """
        known = isinstance(self.engine, Learned) and self.limits.corrections > 0
        if phase != 0 or not known or now.error > NEAR:
            return GOOD
        key = now.x.tobytes() + now.a.tobytes()
        if key not in self._bounds:
            (outcome,) = self.engine.simulate([space.grid_at(now.x, now.a)], cancel=self.cancel)
            bound = outcome.bound_mm if isinstance(outcome, Result) else None
            self._bounds[key] = bound or 0.0
        return max(GOOD, SURE * self._bounds[key])

    def known_check(self, grid: Grid) -> Check | None:
        """Return the check of a design, perhaps of an earlier run; None if there is none."""
        for one in self.checks:
            if one.error_fea_mm is not None and _same(one.grid, grid):
                return one
        return None

    def checked(self, grid: Grid, now: Scored, goals: Goals, phase: int) -> Check:
        """Return the check of a design, perhaps one of an earlier run."""
        if (known := self.known_check(grid)) is not None:
            return known
        begun = monotonic()
        grace = 0.0 if self.checks else min(GRACE, GRACE_SHARE * self.task.limits.seconds)
        until = Until(self.cancel, self._begun + self.task.limits.seconds + grace)
        latest = check(grid, now.points, goals, self.engine, self.cancel, until, phase)
        self.checking = monotonic() - begun
        self.checks.append(latest)
        return latest

    def note(
        self, space: Space, now: Scored, iteration: int, designs: int, phase: int, words: str
    ) -> None:
        """Add a step, and show it."""
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
        if self._progress is not None:
            self._progress(step)

    def _nominal_step(self) -> Step:
        """Return the last step before prints were looked at."""
        return next(step for step in reversed(self.steps) if step.phase >= 0)

    def _best(self) -> Check | None:
        """Return the best check of a design that was found without regard to prints."""
        best: Check | None = None
        for one in self.checks:
            if one.phase >= 0:
                best = one if one.better_than(best) else best
        return best

    def _worth_going_on(self, latest: Check, phase: int) -> bool:
        """Whether to go on from targets that finite elements have corrected."""
        limits = self.limits
        if latest.error_fea_mm is None or latest.apart_mm is None:
            return False
        return (
            phase < limits.corrections
            and self.steps[-1].iteration < limits.iterations
            and limits.seconds - self.seconds > 2 * self.checking
            and latest.error_fea_mm > GOOD
            and latest.apart_mm > WORTH * latest.error_fea_mm
        )


def _nominal(task: Task) -> Limits:
    """Return the limits of a search before prints are looked at."""
    limits = task.limits
    if not task.robust:
        return limits
    half = {"seconds": NOMINAL * limits.seconds, "iterations": -(-limits.iterations // 2)}
    return limits.model_copy(update=half)


def _same(one: Grid, other: Grid) -> bool:
    return bool(
        np.allclose(one.joints, other.joints, rtol=0, atol=1e-9)
        and np.array_equal(one.actuators, other.actuators)
    )

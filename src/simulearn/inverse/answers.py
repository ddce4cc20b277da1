"""Several answers: after the best design, others that come to the goals too and truly differ.

The archive has kept the best of each kind among all designs that the search scored. The search
begins again a few times, in turn with ratios drawn anew and with one actuator less than the good
design that has the fewest, so that there are some that are cheaper. Then designs are chosen: the
closest, the one with the least actuators, the one with the shortest beams, and those farthest from
these; and all are checked by finite elements, as many at once as there are cores.

What comes after the first answer takes at most as long again as the limit; the new beginnings take
half of the time that the first answer took, unless there are too few good designs.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import replace
from operator import attrgetter
from time import monotonic
from typing import TYPE_CHECKING

import numpy as np

from simulearn.errors import CancelledError, ComputationError, Either, InputError, Message, stop_if
from simulearn.files import cores
from simulearn.grid import Grid, check_designs
from simulearn.inverse.archive import Archive
from simulearn.inverse.beginnings import drawn_anew, elsewhere, narrowed, with_less
from simulearn.inverse.checking import Check, check
from simulearn.inverse.front import Answer, actuators_of, choice, on_front
from simulearn.inverse.goals import Goals
from simulearn.inverse.keeping import ANSWERS
from simulearn.inverse.prints import probability_of
from simulearn.inverse.probability import Probability
from simulearn.inverse.problem import OutOfTime, Scored, Until
from simulearn.inverse.space import Space
from simulearn.material import load_material

if TYPE_CHECKING:
    from simulearn.fabricate import Printer
    from simulearn.inverse.search import Search

Added = tuple[Check, Probability | None, list[Message]]

PRINTER = "prusa-mk4"  # whose print times are given where no printer is named
SLACK = 0.015  # of the dimension, by which another answer may be worse than the best
FAR = 3.0  # times that, where there are not enough; it is said of them
OFF = 2.0  # least distances, by which ratios drawn anew stay away from what is there
BEGINNINGS = 4
LATE = "the time was over before it was checked"
SHARE = 0.5  # of the time that the first answer took, for all new beginnings together


def add_answers(
    search: Search, space: Space, goals: Goals, best: Check, of_prints: Probability | None
) -> Added:
    """Look for other answers than the best, and give the search all of them.

    Args:
        search: that came to the best design and has an archive.
        space: of the designs.
        goals: what is wanted.
        best: the best design so far.
        of_prints: how often prints of it meet the goals, if that is known.

    Returns:
        The best of all answers, how often prints of it meet the goals, and warnings.

    Raises:
        CancelledError: the search was stopped; it has the answers so far.
    """
    assert search.archive is not None
    several = _Several(search, space, goals, best, search.archive)
    chosen = [best]
    try:
        several.begin_again()
        chosen = several.chosen()
        several.check(chosen)
        return several.finished(chosen, of_prints)
    except (KeyboardInterrupt, CancelledError):
        search.answers = several.compared([several.known(one) for one in chosen])
        raise


class _Several:
    """The search for other answers; see `add_answers`."""

    def __init__(
        self, search: Search, space: Space, goals: Goals, best: Check, archive: Archive
    ) -> None:
        self.search, self.space, self.goals, self.best = search, space, goals, best
        self.archive, self.limits = archive, search.task.limits
        self.slack = SLACK * space.grid.dimension
        self.first = search.seconds
        self.deadline = monotonic() + self.limits.seconds_in_all - self.first
        # What an earlier run came to; and the best, which nothing of its kind may replace.
        earlier = [step for step in search.steps if step.phase == ANSWERS]
        self.begun_again = len(earlier)
        known = [(step.grid(space.grid), step.error_mm) for step in earlier]
        for grid, error in [*known, (best.grid, 0.0)]:
            one = grid.centred
            archive.add(one.joints[None], one.actuators[None], np.array([error]))

    @property
    def good(self) -> float:
        """Up to this error by the engine (mm) a design is a good answer."""
        errors = self.archive.errors
        others = errors[errors > 0]  # the best is there without its own
        return float(min([self.best.error_mm, *others])) + self.slack

    def begin_again(self) -> None:
        """Search from other beginnings; the archive keeps what is found."""
        each = SHARE * self.first / BEGINNINGS
        while monotonic() + each + self._checking < self.deadline:
            enough = (self.archive.errors <= self.good).sum() >= self.limits.answers
            if self.begun_again >= BEGINNINGS and enough:
                return
            self._from_another(monotonic() + each)
            self.begun_again += 1

    @property
    def _checking(self) -> float:
        """Seconds that the checks of all answers will take."""
        # Two at once are not done in half of the time.
        return 0.75 * self.search.checking * (self.limits.answers - 1)

    def _from_another(self, until: float) -> None:
        """Search from another beginning, and note what it came to."""
        search, space, words = self.search, self.space, "ratios drawn anew"
        less = self.begun_again % 2 == 1
        if less:
            problem = search.problem(space, self.goals, np.inf)
            good = self.archive.errors <= self.good
            start = with_less(problem, self.archive, good, self.begun_again // 2)
            space = narrowed(space, start, search.task.free)
            words = f"with {np.count_nonzero(start.actuators)} actuators"
        problem = search.problem(space, self.goals, until)
        steps = [step.grid(self.space.grid) for step in search.steps if step.phase == ANSWERS]
        away = 1.0 if less else OFF
        try:
            begin = problem.scored(*space.start) if less else drawn_anew(problem)
            problem.best = None  # what the beginning is near to may be better
            problem.allowed = elsewhere(self.archive, [self.best.grid.centred, *steps], away)
            for _ in search.method(problem, begin):
                problem.going()
        except OutOfTime:
            pass
        except CancelledError:  # within a simulation; by the deadline, or by the user
            stop_if(search.cancel)
        if problem.best is not None:
            self._note(space, problem.best, problem.designs, words)

    def _note(self, space: Space, now: Scored, designs: int, words: str) -> None:
        last = self.search.steps[-1]
        self.search.note(space, now, last.iteration, last.designs + designs, ANSWERS, words)

    def chosen(self) -> list[Check]:
        """Return the designs to answer with, the best first, as far as they are known.

        Where an earlier run has checked enough of them, they are those.
        """
        archive, grid, count = self.archive, self.space.grid, self.limits.answers
        candidates = [
            self.known(Check(one, float(error), why=LATE, phase=ANSWERS))
            for one, error in zip(archive.grids(grid), archive.errors, strict=True)
        ]
        before = [k for k, one in enumerate(candidates) if one.error_fea_mm is not None]
        which = np.array(before if len(before) >= count else range(len(archive)))
        joints, ratios, errors = (
            part[which] for part in (archive.joints, archive.ratios, archive.errors)
        )
        material = load_material(grid.material)
        net = check_designs(grid.beams, grid.fixed, joints, ratios, material).net_lengths
        costs = np.column_stack([(np.abs(ratios) * net).sum(axis=1), net.sum(axis=1)])
        distances = archive.distance(joints, ratios, joints, ratios)
        good, most = self.good, self.good + FAR * self.slack
        picked = choice(errors, costs, distances, good, count)
        far = np.flatnonzero((errors > good) & (errors <= most))
        picked += far[np.argsort(errors[far], kind="stable")].tolist()
        return [self.best, *(candidates[which[k]] for k in picked[1:count])]

    def known(self, one: Check) -> Check:
        """Return the check of a design by finite elements, or what is given if there is none."""
        return self.search.known_check(one.grid) or one

    def check(self, chosen: list[Check]) -> None:
        """Put checks by finite elements in the places of those that have none, while time lasts."""
        waiting = [k for k, one in enumerate(chosen) if one.error_fea_mm is None]
        if not waiting:
            return
        search, space = self.search, self.space
        problem = search.problem(space, self.goals, np.inf)
        x, a = map(np.array, zip(*(space.point(chosen[k].grid) for k in waiting), strict=True))
        points = problem.points(x, a)
        for t, k in enumerate(waiting):
            error = float(problem.error(points[t]))
            self._note(space, Scored(x[t], a[t], points[t], error), 1, f"answer {k + 1} is checked")
        stop = Either(search.cancel)
        rest = (self.goals, search.engine, stop, Until(stop, self.deadline), ANSWERS)
        with ThreadPoolExecutor(min(cores(), len(waiting))) as pool:
            futures = {
                pool.submit(check, chosen[k].grid, points[t], *rest): k
                for t, k in enumerate(waiting)
            }
            try:
                for future in as_completed(futures):
                    one = chosen[futures[future]] = future.result()
                    if one.error_fea_mm is not None:
                        search.checks.append(one)
            finally:  # whatever ends this early ends the others, too
                stop.set()
                pool.shutdown(cancel_futures=True)

    def finished(self, chosen: list[Check], of_prints: Probability | None) -> Added:
        """Give the search its answers with all that is to be known of them."""
        search = self.search
        warnings: list[Message] = []
        answers = self.compared(chosen)
        prints = [of_prints] * len(answers)
        if of_prints is not None:
            rest = answers[1:]
            prints[1:] = [probability_of(search, a.check, self.goals, warnings) for a in rest]
        name, times = print_times([one.grid for one in answers], search.printer, warnings)
        answers = on_front(
            replace(one, probability=share, printer=name, print_seconds=time)
            for one, share, time in zip(answers, prints, times, strict=True)
        )
        best = answers[0]
        if not search.task.robust:
            best = min(answers, key=attrgetter("collides", "error"))
        for one in answers if search.task.robust else ():
            best = one if one.more_robust_than(best) else best
        others = [one for one in answers if one is not best]
        if best is not answers[0]:  # beside which the first may be none any more
            most = self.good + FAR * self.slack
            others = [one for one in others if one.check.error_mm <= most]
        search.answers = on_front((best, *others))
        return best.check, best.probability, [*warnings, *self._wanting()]

    def _wanting(self) -> list[Message]:
        """Return warnings where there are fewer answers than wanted, or some are no good."""
        answers, count = self.search.answers, self.limits.answers
        more = "more seconds, or more that is free to change, may help"
        messages = []
        if len(answers) < count:
            text = f"{len(answers)} of {count} answers were found that differ; {more}"
            messages.append(Message("answers-fewer", "limits.answers", text))
        far = [str(k) for k, one in enumerate(answers, 1) if one.check.error_mm > self.good]
        if far:
            text = f"answers {', '.join(far)} stay more than {self.good:.2f} mm away; {more}"
            messages.append(Message("answers-far", "limits.answers", text))
        passing = [str(k) for k, one in enumerate(self.search.answers, 1) if one.collides]
        if passing:
            text = f"parts of answers {', '.join(passing)} run through each other: `collisions`"
            messages.append(Message("answers-collide", "limits.answers", text))
        return messages

    def compared(self, checks: list[Check]) -> tuple[Answer, ...]:
        """Return designs as answers; print times and probabilities are not known yet."""
        away = self.archive.distance.between
        answers = []
        for one in checks:
            others = [away(one.grid, other.grid) for other in checks if other is not one]
            nearest = min(others, default=None)
            answers.append(Answer(one, *actuators_of(one.grid), nearest))
        return on_front(answers)


def print_times(
    grids: Sequence[Grid], printer: Printer | str | None, warnings: list[Message]
) -> tuple[str, list[float | None]]:
    """Return the name of a printer, and how long (s) it prints each grid, heating not counted.

    None stands for what it cannot print.

    Args:
        grids: each printed alone.
        printer: on what, or its name; a common one if None.
        warnings: where a reason is added.
    """
    from simulearn.fabricate import load_printer, prepare

    machine = printer or PRINTER
    if isinstance(machine, str):
        machine = load_printer(machine)
    times: list[float | None] = []
    for grid in grids:
        try:
            times.append(prepare([grid], machine).estimate.seconds)
        except (InputError, ComputationError) as error:
            times.append(None)
            text = f"how long an answer takes to print is not known: {error}"
            why = Message("answers-print", "printer", text)
            warnings += [] if why in warnings else [why]
    return machine.name, times

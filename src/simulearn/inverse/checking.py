"""The check of a design: simulated again by finite elements, and what follows from the difference.

An engine's error hardly changes from a design to its neighbours. So targets moved by the error at
the best design make the engine search for what finite elements will confirm.
"""

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import Cancel, CancelledError, Message, stop_if
from simulearn.grid import Grid
from simulearn.inverse.goals import Goals
from simulearn.simulate import Failure, Outcome, Result, Simulator, engine
from simulearn.simulate.colliding import collision_warnings

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Check:
    """A design by the engine of the search and by finite elements.

    Attributes:
        grid: the design.
        error_mm: of the engine's shape.
        error_fea_mm: of the shape by finite elements; None where they give no answer.
        why: why they give none.
        apart_mm: weighted mean distance between the two, over the goals' vertices.
        bound_mm: what the engine expects its error to stay below, where it estimates that.
        shift: (V, 3) mm, from finite elements to the engine.
        phase: of the search that ended with this design.
        result: by the engine; None where it has no full rollout, or in an earlier run.
        fea: by finite elements; None where they give no answer, or in an earlier run.
        passes: what an earlier run said of parts that run through each other.
    """

    grid: Grid
    error_mm: float
    error_fea_mm: float | None = None
    why: str = ""
    apart_mm: float | None = None
    bound_mm: float | None = None
    shift: Array | None = None
    phase: int = 0
    result: Result | None = field(default=None, repr=False)
    fea: Result | None = field(default=None, repr=False)
    passes: tuple[Message, ...] = ()

    @property
    def agrees(self) -> bool | None:
        """Whether the two are within the bound of each other; None where that is not known."""
        if self.apart_mm is None or self.bound_mm is None:
            return None
        return self.apart_mm <= self.bound_mm

    @property
    def shape(self) -> Result | None:
        """By finite elements where they answered in this run, else by the engine."""
        return self.fea or self.result

    @property
    def collisions(self) -> tuple[Message, ...]:
        """The warning that parts of the shape run through each other, if they do."""
        return self.passes if self.shape is None else collision_warnings(self.shape.collisions)

    def better_than(self, other: "Check | None") -> bool:
        """Whether finite elements prefer this one, or it is the one without collisions."""
        return other is None or self._badness < other._badness

    @property
    def _badness(self) -> tuple[bool, bool, float]:
        error = self.error_fea_mm
        return error is None, bool(self.collisions), np.inf if error is None else error


def check(
    grid: Grid,
    points: Array,
    goals: Goals,
    simulator: Simulator,
    cancel: Cancel | None = None,
    until: Cancel | None = None,
    phase: int = 0,
) -> Check:
    """Return what an engine and finite elements say of a design.

    Args:
        grid: the design.
        points: (V, 3) mm, where the goals' vertices come to by the engine.
        goals: what is wanted.
        simulator: the engine of the search.
        cancel: stops the check.
        until: ends the check without an answer of finite elements.
        phase: of the search that ended with the design.

    Raises:
        CancelledError: the check was stopped.
    """
    own = _outcome(simulator, grid, cancel, until)
    # By the fine mesh, whose answers the learned model gives.
    fine = engine("fea", mesh="fine")
    reference = own if simulator.name == "fea" else _outcome(fine, grid, cancel, until)
    result = own if isinstance(own, Result) else None
    known = Check(
        grid=grid,
        error_mm=float(goals.error(points)),
        bound_mm=None if result is None else result.bound_mm,
        phase=phase,
        result=result,
    )
    if not isinstance(reference, Result):
        late = "the time was over before they had one"
        why = late if reference is None else reference.message
        return replace(known, why=why)
    there = goals.points(reference.joints[-1], reference.beams[-1])
    return replace(
        known,
        fea=reference,
        error_fea_mm=float(goals.error(there)),
        apart_mm=goals.apart(points, there),
        shift=points - there,
    )


def _outcome(
    simulator: Simulator, grid: Grid, cancel: Cancel | None, until: Cancel | None
) -> Outcome | None:
    """Return an engine's outcome; None if the time was over before it had one."""
    try:
        (outcome,) = simulator.simulate([grid], cancel=until or cancel)
    except CancelledError:
        stop_if(cancel)
        return None
    if isinstance(outcome, Failure) and outcome.invalid:
        raise outcome.error  # such as an engine that is not installed
    return outcome

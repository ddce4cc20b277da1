"""The check of an answer: the design simulated again by finite elements, and what to learn from it.

An engine's mistake hardly changes from a design to its neighbours. So targets moved by the mistake
at the best design make the engine look for what finite elements will confirm.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import ComputationError
from simulearn.grid import Grid
from simulearn.inverse.goals import Goals
from simulearn.simulate import Result, Simulator, engine

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Check:
    """A design by the engine that found it and by finite elements.

    Attributes:
        grid: the design.
        result: by the engine.
        fea: by finite elements; None where they give no answer.
        why: why they give none.
        error_mm: of the engine's shape.
        error_fea_mm: of the shape by finite elements.
        apart_mm: weighted mean distance between the two, over the goals.
        bound_mm: what the engine expects its error to stay below, where it tells.
        shift: (G, 3) mm, from finite elements to the engine.
    """

    grid: Grid
    result: Result
    fea: Result | None
    why: str | None
    error_mm: float
    error_fea_mm: float | None
    apart_mm: float | None
    bound_mm: float | None
    shift: Array | None

    @property
    def agrees(self) -> bool | None:
        """Whether the two are within the bound of each other; None where that is not known."""
        if self.apart_mm is None or self.bound_mm is None:
            return None
        return self.apart_mm <= self.bound_mm

    def better_than(self, other: "Check | None") -> bool:
        """Whether finite elements prefer this one."""
        if other is None:
            return True
        inf = np.inf
        mine = inf if self.error_fea_mm is None else self.error_fea_mm
        return mine < (inf if other.error_fea_mm is None else other.error_fea_mm)


def check(grid: Grid, goals: Goals, asked: Simulator) -> Check:
    """Return what an engine and finite elements say of a design."""
    (result,) = asked.simulate([grid])
    here = goals.points(result.joints[-1], result.beams[-1])
    fea, why = None, None
    try:
        fea = result if asked.name == "fea" else engine("fea").simulate([grid])[0]
    except ComputationError as error:
        why = str(error)
    bound = result.record.get("bound_mm")
    there = None if fea is None else goals.points(fea.joints[-1], fea.beams[-1])
    return Check(
        grid=grid,
        result=result,
        fea=fea,
        why=why,
        error_mm=float(goals.error(here)),
        error_fea_mm=None if there is None else float(goals.error(there)),
        apart_mm=None
        if there is None
        else float(np.linalg.norm(here - there, axis=-1) @ goals.weights),
        bound_mm=None if bound is None else float(bound),
        shift=None if there is None else here - there,
    )

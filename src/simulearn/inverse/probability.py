"""The probability that a print meets its goals: prints of a design are drawn and measured.

Finite elements, where they checked the design, say where its vertices are; the prints say by how
much each of them is elsewhere, against the design without scatter by the same simulator.
"""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import binomtest

from simulearn.errors import Cancel, ComputationError
from simulearn.grid import Grid
from simulearn.inverse.goals import Goals
from simulearn.material import load_material
from simulearn.simulate import Progress, Simulator
from simulearn.simulate.scatter import (
    Draw,
    beyond_learnt,
    draw_prints,
    prints_source,
    simulate_prints,
)
from simulearn.simulate.source import Source

Array = NDArray[np.float64]

SEED = 1  # not that of the prints by which a robust design is found
SURE = 0.95  # of the interval


@dataclass(frozen=True)
class Probability:
    """How often prints of a design meet its goals.

    Attributes:
        drawn, prints: how many were drawn, and how many have an answer; one without meets nothing.
        engine: that simulated the prints.
        tolerances: of each goal, mm; None where it has none.
        goals: of each goal, how often a print is within its tolerance.
        together: how often a print is within the tolerances of all goals that have one.
        between: what `together` would be of very many prints, with 95 % confidence.
        error_mm: mean error of the prints.
        error_90_mm: that nine of ten prints stay below.
        print, beam: relative standard deviations of the strains that were assumed, from print to
            print and from beam to beam of one.
        beyond: how many were drawn with a beam beyond what the model has learnt; their answers are
            guesses.
    """

    drawn: int
    prints: int
    engine: str
    tolerances: tuple[float | None, ...]
    goals: tuple[float | None, ...]
    together: float | None
    between: tuple[float, float] | None
    error_mm: float
    error_90_mm: float
    print: float = 0.0
    beam: float = 0.0
    beyond: int = 0

    def better_than(self, other: "Probability") -> bool:
        """Whether more prints meet all goals; if as many do, whether they come closer."""
        return (-(self.together or 0.0), self.error_mm) < (-(other.together or 0.0), other.error_mm)

    def to_dict(self) -> dict[str, Any]:
        """Return it as plain data."""
        return asdict(self)

    @property
    def words(self) -> str:
        """All of it in one line."""
        of = f"{self.drawn} prints by {self.engine}"
        if self.drawn > self.prints:
            of += f" ({self.drawn - self.prints} without an answer)"
        error = f"{self.error_mm:.2f} mm on average, nine of ten below {self.error_90_mm:.2f} mm"
        if self.together is None or self.between is None:
            return f"{of}: {error}"
        low, high = (f"{100 * end:.0f}" for end in self.between)
        return (
            f"{100 * self.together:.0f} % of {of} are within all tolerances "
            f"(of very many, {low} to {high} %): {error}"
        )

    @property
    def assumes(self) -> str:
        """What all of it assumes, in one line."""
        line = (
            f"assumed: strains differ by {self.print:.1%} from print to print and {self.beam:.1%} "
            "from beam to beam, and nothing else does"
        )
        if self.beyond:
            line += f"; {self.beyond} prints have a beam beyond what the model has learnt"
        return line


def probability(
    grid: Grid,
    goals: Goals,
    tolerances: Sequence[float | None],
    known: Array | None = None,
    count: int | None = None,
    engine: Simulator | None = None,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
) -> Probability:
    """Return how often prints of a design meet its goals.

    Args:
        grid: the design, its fixed joint at the origin.
        goals: what is wanted.
        tolerances: of each goal, mm, or None.
        known: (V, 3) mm, where the vertices of the design are by finite elements or the engine.
        count: of the prints; as many as is quick if not given.
        engine: that simulates the design; see `simulate.scatter.prints_source`.
        progress: called with the prints done and the prints in all.
        cancel: stops between prints.

    Raises:
        InputError: the material has no scatter.
        ComputationError: the design or all prints have no answer.
        CancelledError: the token was set.
    """
    material = load_material(grid.material)
    source = prints_source(material, engine)
    count = count or source.count
    draw = draw_prints(material, len(grid.beams), count, SEED).with_nominal(material)
    points = points_of_prints(grid, goals, draw, source, progress, cancel)
    nominal, points = points[0], points[1:]
    if known is not None:
        points = points + (known - nominal)
    there = np.asarray(np.isfinite(points).all(axis=(1, 2)))
    if not there.any():
        raise ComputationError("no print of the design has an answer", "no-answer", "grid")
    limits = np.array([np.inf if one is None else one for one in tolerances])
    within = there[:, None] & (goals.distances(points) <= limits)
    met = int(within.all(axis=1).sum())
    some = any(one is not None for one in tolerances)
    interval = binomtest(met, count).proportion_ci(SURE, "wilson")
    errors = goals.error(points[there])
    return Probability(
        drawn=count,
        prints=int(there.sum()),
        engine=source.engine,
        tolerances=tuple(tolerances),
        goals=tuple(
            None if one is None else float(share)
            for one, share in zip(tolerances, within.mean(axis=0), strict=True)
        ),
        together=met / count if some else None,
        between=(float(interval.low), float(interval.high)) if some else None,
        error_mm=float(errors.mean()),
        error_90_mm=float(np.percentile(errors, 90)),
        print=material.scatter.print,
        beam=material.scatter.beam,
        beyond=beyond_learnt(draw, source),
    )


def points_of_prints(
    grid: Grid,
    goals: Goals,
    draw: Draw,
    source: Source,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
) -> Array:
    """Return where the goals' vertices come to in each print: (T, V, 3) mm; NaN without answer."""
    prints = simulate_prints(grid, draw, source, progress, cancel)
    points = goals.points(prints.joints, prints.sections)
    return np.where(prints.converged[:, None, None], points, np.nan)

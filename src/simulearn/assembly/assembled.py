"""An assembly simulated: each grid once, whatever becomes of the others."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from simulearn.assembly.assembly import Assembly, Part
from simulearn.assembly.obstacles import Surface, surfaces
from simulearn.assembly.timeline import Timeline, timeline
from simulearn.errors import Cancel, ComputationError, InputError, Message
from simulearn.simulate import Failure, Outcome, Progress, Result, Simulator

MANY = 20  # grids; of so many only the corners are kept


@dataclass(frozen=True, eq=False)
class PartCollision:
    """Where two parts, a part and itself, or a part and an obstacle are in each other.

    Attributes:
        names: of the two; twice the same within a part.
        beams: of either; -1 of an obstacle.
        time: s, when it is worst.
        step: in which that is.
        depth_mm: how deep.
        place: (3,) mm.
    """

    names: tuple[str, str]
    beams: tuple[int, int]
    time: float
    step: int
    depth_mm: float
    place: NDArray[np.float64]

    @property
    def words(self) -> str:
        """What collides, and how deep."""
        a, b = self.names
        what = f"{a} with itself" if a == b else f"{a} with {b}"
        return f"{what} by {self.depth_mm:.1f} mm in step {self.step + 1}"


@dataclass(frozen=True, eq=False)
class Assembled:
    """The outcomes of an assembly's parts.

    Attributes:
        assembly: what was put together.
        engine: name of the engine.
        outcomes: of each part; parts with equal grids share theirs.
        obstacles: their surfaces in their places, by name.
        collisions: where parts run into each other, into themselves or into obstacles.
        warnings: about the obstacles and the checks.
    """

    assembly: Assembly
    engine: str
    outcomes: tuple[Outcome, ...]
    obstacles: Mapping[str, Surface] = field(default_factory=dict)
    collisions: tuple[PartCollision, ...] = ()
    warnings: tuple[Message, ...] = ()

    @cached_property
    def timeline(self) -> Timeline:
        """When each part is where."""
        return timeline(self.assembly)

    @property
    def present(self) -> list[tuple[int, Part, Result]]:
        """The parts that have a result: which one, the part, the result."""
        rows = enumerate(zip(self.assembly.parts, self.outcomes, strict=True))
        return [(k, part, one) for k, (part, one) in rows if isinstance(one, Result)]

    @property
    def failures(self) -> dict[str, Failure]:
        """Why parts have no result, by the names of those with grids of their own."""
        distinct = self.assembly.distinct
        return {
            part.name: outcome
            for k, (part, outcome) in enumerate(
                zip(self.assembly.parts, self.outcomes, strict=True)
            )
            if isinstance(outcome, Failure) and distinct[k] == k
        }

    def require(self) -> None:
        """Raise the first failure where no part has a result.

        Raises:
            InputError: its grid is not valid.
            ComputationError: its grid has no answer.
        """
        if self.present:
            return
        name, failure = next(iter(self.failures.items()))
        error = failure.error
        text = f"part {name}: {error}"
        if isinstance(error, InputError):
            raise InputError(text, error.code, error.where, error.messages)
        raise ComputationError(text, error.code, error.where, error.hint)


def simulate_assembly(
    assembly: Assembly,
    engine: Simulator,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
) -> Assembled:
    """Return the outcomes of an assembly's parts; equal grids are simulated once.

    Args:
        assembly: the parts.
        engine: that simulates them.
        progress: called with the frames done and the frames in all.
        cancel: stops the simulation.

    Raises:
        CancelledError: the token was set.
    """
    distinct = assembly.distinct
    first = list(dict.fromkeys(distinct))
    grids = [assembly.parts[k].grid for k in first]
    outcomes = engine.simulate(grids, progress, cancel)
    # Stresses and solids of all parts at once may not fit into memory.
    kept = [
        replace(one, stress=None, solid=None, displacements=None)
        if isinstance(one, Result) and len(first) > MANY
        else one
        for one in outcomes
    ]
    by_grid = dict(zip(first, kept, strict=True))
    outcomes = [by_grid[k] for k in distinct]
    return Assembled(assembly, engine.name, tuple(outcomes), surfaces(assembly))

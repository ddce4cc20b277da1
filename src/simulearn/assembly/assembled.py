"""An assembly simulated: each grid once, whatever becomes of the others."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

from simulearn.assembly.assembly import Assembly, Part
from simulearn.assembly.checking import PartCollision, collisions_of
from simulearn.assembly.obstacles import surfaces
from simulearn.assembly.timeline import Timeline, timeline
from simulearn.errors import Cancel, ComputationError, InputError, Message
from simulearn.simulate import Failure, Outcome, Progress, Result, Simulator
from simulearn.surfaces import Surface

MANY = 20  # grids; of so many only the corners are kept


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
    """Return the outcomes of an assembly's parts, and what runs into what.

    Args:
        assembly: the parts.
        engine: that simulates them.
        progress: called with the frames done and the frames in all.
        cancel: stops the simulation and the checks.

    Raises:
        InputError: an obstacle cannot be read.
        CancelledError: the token was set.
    """
    return checked(simulated(assembly, engine, progress, cancel), cancel=cancel)


def simulated(
    assembly: Assembly,
    engine: Simulator,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
) -> Assembled:
    """Return the outcomes of an assembly's parts, unchecked; equal grids are simulated once.

    The arguments are those of `simulate_assembly`.
    """
    around = surfaces(assembly)
    distinct = assembly.distinct
    first = list(dict.fromkeys(distinct))
    outcomes = engine.simulate([assembly.parts[k].grid for k in first], progress, cancel)
    # Stresses and solids of all parts at once may not fit into memory.
    kept = [
        replace(one, stress=None, solid=None, displacements=None)
        if isinstance(one, Result) and len(first) > MANY
        else one
        for one in outcomes
    ]
    by_grid = dict(zip(first, kept, strict=True))
    mended = [message for surface in around.values() for message in surface.warnings]
    for name, surface in around.items():
        if not surface.closed:
            text = f"obstacle {name} is no closed body; only what meets its faces is seen"
            mended.append(Message("surface-open", name, text))
    parts = tuple(by_grid[k] for k in distinct)
    return Assembled(assembly, engine.name, parts, around, warnings=tuple(mended))


def checked(
    assembled: Assembled, progress: Progress | None = None, cancel: Cancel | None = None
) -> Assembled:
    """Return an assembly with its collisions; parts without a result are left out.

    Args:
        assembled: the outcomes of its parts.
        progress: called with the steps checked and the steps in all.
        cancel: stops it within a step.

    Raises:
        CancelledError: the token was set.
    """
    found = collisions_of(
        assembled.assembly,
        assembled.present,
        assembled.obstacles,
        assembled.timeline,
        progress,
        cancel,
    )
    return replace(assembled, collisions=found)

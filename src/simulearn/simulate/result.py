"""The outcome of simulating a grid, the same for every engine: a Result, or a Failure and why.

An answer carries what qualifies it: whether it is stable, how far off it may be, where the grid
snapped, and what else is to be known. A design without an answer does not take others with it.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from simulearn.collisions.collision import Collision
from simulearn.display import Displayed
from simulearn.errors import ComputationError, InputError, Message
from simulearn.grid import Grid
from simulearn.material import Identity
from simulearn.schedule import FRAMES, Snap

if TYPE_CHECKING:  # so that reading a result does not load a solver
    from simulearn.fea import Solid
    from simulearn.simulate.spread import Spread

__all__ = ["FRAMES", "Failure", "Outcome", "Outcomes", "Result", "one", "results"]


@dataclass(frozen=True, eq=False)
class Result(Displayed):
    """The twelve frames of a morphing grid; mm, MPa, +z up.

    Attributes:
        grid: the design, as simulated.
        engine: name of the engine that answered.
        joints: (12, J, 8, 3) corners of the joints: bottom counter-clockwise seen from +z, then
            top in the same order, the first being the one with the smallest angle in [0, 2 pi).
        beams: (12, B, 3, 4, 3) sections start, middle, end; corners right-bottom, left-bottom,
            right-top, left-top, where left is z x (start -> end).
        stress: (12, B, 4, 4, 6) sections start, before and after the middle, end; the four
            corners; components 11 22 33 12 13 23 in global axes. None where an engine has none.
        seconds: time the simulation took.
        material: name and digest of the material system.
        model: name and digest of the learned model; None for an engine without one.
        stable: whether every frame is a stable equilibrium.
        bound_mm: mean vertex error of the last frame that nine of ten such answers stay below;
            None for an engine that does not estimate its error.
        snaps: sudden motions to another equilibrium, in the order in which they happen.
        warnings: about the design and the answer.
        collisions: parts that run through each other, the deepest first.
        record: of the solver's work, for example iterations per frame.
        solid: the solid mesh, where the engine has one.
        displacements: (12, N, 3) of the solid's nodes from the flat grid.
        scatter: how prints of the design differ, where that was computed.
    """

    grid: Grid
    engine: str
    joints: NDArray[np.float64]
    beams: NDArray[np.float64]
    stress: NDArray[np.float64] | None
    seconds: float
    material: Identity
    model: Identity | None = None
    stable: bool = True
    bound_mm: float | None = None
    snaps: tuple[Snap, ...] = ()
    warnings: tuple[Message, ...] = ()
    collisions: tuple[Collision, ...] = ()
    record: dict[str, Any] = field(default_factory=dict)
    solid: Solid | None = None
    displacements: NDArray[np.float64] | None = None
    scatter: Spread | None = None

    @property
    def centres(self) -> NDArray[np.float64]:
        """(12, J, 3) centres of the joints: the mean of their eight corners."""
        return self.joints.mean(axis=2)


@dataclass(frozen=True, eq=False)
class Failure(Displayed):
    """Why a design has no result.

    Attributes:
        grid: the design, as it was given.
        code: short name of the reason, for programs.
        where: the place: a joint, beam, frame or key.
        message: the reason, for people.
        hint: what may help; empty where nothing is known to.
        invalid: all that is wrong with the input; empty where the input is right and the
            computation failed.
    """

    grid: Grid
    code: str
    where: str
    message: str
    hint: str = ""
    invalid: tuple[Message, ...] = ()

    @classmethod
    def of(cls, grid: Grid, error: InputError | ComputationError, hint: str = "") -> Failure:
        """Return the failure of a design whose simulation raised an error."""
        text = str(error)
        if isinstance(error, InputError):
            invalid = error.messages or (Message(error.code, error.where, text),)
            return cls(grid, error.code, error.where, text, hint, invalid)
        return cls(grid, error.code, error.where, text, error.hint or hint)

    @property
    def error(self) -> InputError | ComputationError:
        """The same as an exception."""
        if self.invalid:
            return InputError(self.message, self.code, self.where, self.invalid)
        return ComputationError(self.message, self.code, self.where, self.hint)


Outcome = Result | Failure


class Outcomes(list[Outcome], Displayed):
    """The outcomes of several designs, in their order, shown as a table."""

    def __repr__(self) -> str:
        text: str = self._repr_mimebundle_(include=["text/plain"])["text/plain"]
        return text


def one(outcome: Outcome) -> Result:
    """Return the result of an outcome.

    Raises:
        InputError: the design is not valid, or is nothing for the engine.
        ComputationError: the design is valid, but has no answer.
    """
    if isinstance(outcome, Failure):
        raise outcome.error
    return outcome


def results(outcomes: Iterable[Outcome]) -> list[Result]:
    """Return the results of outcomes that must all have one; raises as `one` does."""
    return [one(outcome) for outcome in outcomes]

"""The one interface to every engine: grids in, an outcome for each of them out.

Inverse design, pictures and the command line know this and not which engine answers.
"""

from collections.abc import Callable, Sequence
from typing import Protocol

from simulearn.errors import Cancel
from simulearn.grid import Grid
from simulearn.simulate.result import Outcome

Progress = Callable[[int, int], None]  # (frames done, frames in all)


class Simulator(Protocol):
    """An engine that predicts how grids morph; it may be called from several threads."""

    @property
    def name(self) -> str:
        """Name of the engine."""
        ...

    def simulate(
        self,
        grids: Sequence[Grid],
        progress: Progress | None = None,
        cancel: Cancel | None = None,
    ) -> list[Outcome]:
        """Return the outcomes of the grids, in their order.

        A grid that is not valid, or has no answer, is a Failure in its place.

        Args:
            grids: the designs.
            progress: called with the frames done and the frames in all, over all grids: after
                each frame by an engine that computes frame by frame, after each batch by others.
                Calls come one at a time, but perhaps from other threads.
            cancel: stops the simulation within a frame or batch.

        Raises:
            CancelledError: the token was set before all outcomes were there.
        """
        ...

"""The one interface to every engine: grids in, results out.

Inverse design, pictures and the command line know this and not which engine answers.
"""

from collections.abc import Callable, Sequence
from typing import Protocol

from simulearn.grid import Grid
from simulearn.simulate.result import Result

Progress = Callable[[int, int], None]  # (frames done, frames in all)


class Simulator(Protocol):
    """An engine that tells how grids morph."""

    @property
    def name(self) -> str:
        """Name of the engine, as `--engine` takes it."""
        ...

    def simulate(self, grids: Sequence[Grid], progress: Progress | None = None) -> list[Result]:
        """Return the results of the grids, in their order.

        Args:
            grids: the designs.
            progress: called after every frame with the frames done and the frames in all.

        Raises:
            InputError: a grid does not validate; the message says where.
            ComputationError: a grid validates, but its simulation failed; never a wrong result.
        """
        ...

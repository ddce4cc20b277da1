"""The frames of a simulation, as data: which there are, what is released and what loads act.

Flat, then the release of the residual stress in equal steps under gravity, then creep. Every
engine, model and file takes the number of frames and their meaning from here.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Schedule:
    """Frames by their number.

    Attributes:
        steps: equal steps in which the residual stress is released.
    """

    steps: int = 10

    @property
    def frames(self) -> int:
        """Number of frames: flat, one after each step of release, one after creep."""
        return self.steps + 2

    @property
    def released(self) -> tuple[float, ...]:
        """(frames,) released fraction of the residual stress."""
        return (*(k / self.steps for k in range(self.steps + 1)), 1.0)

    def gravity(self, creep: float) -> tuple[float, ...]:
        """Return the (frames,) multiples of gravity.

        Creep softens all load-driven strain by 1 + phi, as that multiple of gravity would.

        Args:
            creep: creep strain over elastic strain, phi.
        """
        return (0.0, *[1.0] * self.steps, 1.0 + creep)

    @property
    def names(self) -> tuple[str, ...]:
        """(frames,) what each shows."""
        return ("flat", *(f"{s:.0%} released" for s in self.released[1:-1]), "after creep")


@dataclass(frozen=True)
class Snap:
    """A sudden motion to another equilibrium under the same load.

    Attributes:
        released: fraction of the residual stress at which it begins.
        frame: the first frame that shows it.
    """

    released: float
    frame: int


SCHEDULE = Schedule()
FRAMES = SCHEDULE.frames

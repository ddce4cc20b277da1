"""The states of a solid frame by frame, as the schedule wants them."""

from collections.abc import Iterator

from simulearn.fea.path import Path
from simulearn.fea.problem import SolidState
from simulearn.schedule import FRAMES, SCHEDULE

UNDER_GRAVITY = 1  # which of the states is no frame


def march(path: Path, creep: float) -> Iterator[SolidState]:
    """Yield the states of a solid: flat, under gravity alone, then those of the frames 1, 2, ...

    Args:
        path: of the flat solid.
        creep: creep strain over elastic strain.

    Raises:
        ComputationError: an increment has no equilibrium, nor comes to rest elsewhere.
        CancelledError: the problem's token said so.
    """
    gravity = SCHEDULE.gravity(creep)
    yield path.last[-1]
    # Gravity first: bringing both up at once takes more iterations, and fails more often.
    yield path.advance(0.0, gravity[1], 1)
    path.restart()
    for frame in range(1, FRAMES - 1):
        yield path.advance(SCHEDULE.released[frame], gravity[frame], frame)
    path.restart()
    yield path.advance(SCHEDULE.released[-1], gravity[-1], FRAMES - 1)

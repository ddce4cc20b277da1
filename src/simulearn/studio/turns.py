"""Work of up to seconds beside the server's loop: a few at a time, a bounded number in line."""

from collections.abc import Callable
from typing import TypeVar

from anyio import CapacityLimiter, to_thread

from simulearn.studio.problems import too_many

T = TypeVar("T")


class Turns:
    """Threads that work in turn.

    Args:
        workers: at the same time.
        waiting: most that wait for one of them.
    """

    def __init__(self, workers: int, waiting: int) -> None:
        self._limiter = CapacityLimiter(workers)
        self._waiting = waiting

    async def run(self, work: Callable[[], T]) -> T:
        """Return what work returns; it runs in a thread when its turn comes.

        Raises:
            Problem: too many are waiting.
        """
        if self._limiter.statistics().tasks_waiting >= self._waiting:
            raise too_many("the server has enough to do; try again in a moment")
        return await to_thread.run_sync(work, limiter=self._limiter)

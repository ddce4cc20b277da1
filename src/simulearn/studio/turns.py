"""Work that a request waits for: a few at a time in threads, a bounded number in line.

Work takes a token, which is set when the client that waits has gone, when the time is over, and
when the server ends.
"""

import asyncio
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from math import inf
from time import monotonic
from typing import Any, TypeVar

from fastapi import Request

from simulearn.errors import Cancel, CancelledError, stop_if
from simulearn.studio.problems import Problem, too_many

T = TypeVar("T")


class Turns:
    """Threads that work in turn.

    Args:
        name: of the threads.
        workers: at the same time.
        waiting: most that wait for one of them.
        seconds: that work may take once its turn has come.
    """

    def __init__(self, name: str, workers: int, waiting: int, seconds: float = inf) -> None:
        self._name, self._workers, self._seconds = name, workers, seconds
        self._pool = self._new_pool()
        self._most = workers + waiting
        self._tokens: set[_Token] = set()  # of all that run or wait
        self._answers: set[asyncio.Future[Any]] = set()  # that requests wait for

    async def run(self, request: Request, work: Callable[[Cancel], T]) -> T:
        """Return what work returns; it runs in a thread when its turn comes.

        Args:
            request: that waits for it.
            work: takes a token that is set when it shall end.

        Raises:
            Problem: too many are waiting, or the work took too long.
            CancelledError: the client has gone, or the server ends.
        """
        if len(self._tokens) >= self._most:
            raise too_many("the server has enough to do; try again in a moment")
        cancel = _Token(self._seconds)
        self._tokens.add(cancel)
        running = self._pool.submit(_work, work, cancel)
        # A thread that cannot stop at once counts until it has stopped.
        running.add_done_callback(lambda _: self._tokens.discard(cancel))
        answer = asyncio.wrap_future(running)
        gone = asyncio.create_task(_disconnected(request))
        self._answers.add(answer)
        try:
            await asyncio.wait((answer, gone), return_when=asyncio.FIRST_COMPLETED)
            if not answer.done() or answer.cancelled():
                raise CancelledError("the client has gone, or the server ends")
            return answer.result()
        finally:
            self._answers.discard(answer)
            gone.cancel()
            if not answer.done():
                cancel.set()
                answer.cancel()

    def close(self) -> list[threading.Thread]:
        """Stop what runs and waits, and let no request wait for it any more.

        The same application may be started again. To be called in the server's loop.

        Returns:
            Threads that may take a while to end.
        """
        pool, self._pool = self._pool, self._new_pool()
        for token in list(self._tokens):
            token.set()
        for answer in list(self._answers):
            answer.cancel()
        pool.shutdown(wait=False, cancel_futures=True)
        return [t for t in threading.enumerate() if t.name.startswith(f"{self._name}_")]

    def _new_pool(self) -> ThreadPoolExecutor:
        return ThreadPoolExecutor(self._workers, self._name)


class _Token:
    """Says that work shall end: when somebody has decided so, or when its time is over.

    Args:
        seconds: that it may take, from its beginning.
    """

    def __init__(self, seconds: float) -> None:
        self.seconds = seconds
        self.deadline = inf
        self._set = threading.Event()

    def begin(self) -> None:
        """Let the time run."""
        self.deadline = monotonic() + self.seconds

    def set(self) -> None:
        self._set.set()

    @property
    def overdue(self) -> bool:
        return monotonic() > self.deadline

    def is_set(self) -> bool:
        return self._set.is_set() or self.overdue


def _work(work: Callable[[Cancel], T], cancel: _Token) -> T:
    cancel.begin()
    try:
        stop_if(cancel)
        return work(cancel)
    except CancelledError as error:
        if not cancel.overdue:
            raise
        text = f"that takes longer than the {cancel.seconds:g} s that it may take here"
        raise Problem(422, "time-over", text) from error


async def _disconnected(request: Request) -> None:
    """Return when the client has closed the connection."""
    while (await request.receive())["type"] != "http.disconnect":
        pass

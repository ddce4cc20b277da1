"""Simulations that a request waits for: a few at a time in threads, a bounded number in line.

The kernels run without the interpreter's lock, so that threads use all cores and the server goes on
to answer. A simulation ends early when the client that wants it has gone.
"""

import asyncio
import logging
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from typing import TypeVar

from fastapi import Request

from simulearn.errors import Cancel, CancelledError, InputError
from simulearn.learn.common.bundle import shipped
from simulearn.simulate import engine
from simulearn.simulate.engines import ENGINES, StreamingSimulator
from simulearn.studio.problems import too_many
from simulearn.studio.settings import Settings

T = TypeVar("T")

AT_ONCE = ("learned", "beams", "fea")  # engines that answer a request directly

logger = logging.getLogger("simulearn.studio")


class Simulations:
    """The engines, and the threads that run them.

    Args:
        settings: of the server.
    """

    def __init__(self, settings: Settings) -> None:
        self._threads = settings.simulations
        self._pool = self._new_pool()
        self._most = settings.simulations + settings.waiting
        self._tokens: set[threading.Event] = set()  # of all that run or wait
        self._warming, self._warm = threading.Lock(), threading.Event()

    @property
    def ready(self) -> bool:
        """Whether the kernels are compiled, so that an answer takes milliseconds."""
        return self._warm.is_set()

    def start_warming(self) -> None:
        """Begin to compile the kernels in the background."""
        threading.Thread(target=self.warm, name="warm", daemon=True).start()

    def warm(self) -> None:
        """Compile the kernels, once; whoever comes meanwhile waits."""
        with self._warming:
            if self._warm.is_set():
                return
            try:
                engine_of("learned").warm()
            except Exception:
                # Each simulation will fail with its own message; the page is served all the same.
                logger.exception("the engine could not be made ready")
            self._warm.set()

    async def run(self, request: Request, work: Callable[[Cancel], T]) -> T:
        """Return what work returns; it runs in a thread when its turn comes.

        Args:
            request: that waits for it.
            work: takes a token that is set when nobody waits any more.

        Raises:
            Problem: too many are waiting.
            CancelledError: the client has gone.
        """
        if len(self._tokens) >= self._most:
            raise too_many("too many simulations are waiting; try again in a moment")
        cancel = threading.Event()
        self._tokens.add(cancel)
        running = self._pool.submit(self._work, work, cancel)
        # A thread that cannot stop at once counts until it has stopped.
        running.add_done_callback(lambda _: self._tokens.discard(cancel))
        answer = asyncio.wrap_future(running)
        gone = asyncio.create_task(_disconnected(request))
        try:
            await asyncio.wait((answer, gone), return_when=asyncio.FIRST_COMPLETED)
            if not answer.done():
                raise CancelledError("the client has gone")
            return answer.result()
        finally:
            gone.cancel()
            if not answer.done():
                cancel.set()
                answer.cancel()

    def close(self) -> None:
        """Stop what runs and waits; the same application may be started again."""
        pool, self._pool = self._pool, self._new_pool()
        for token in list(self._tokens):
            token.set()
        pool.shutdown(wait=False, cancel_futures=True)

    def _new_pool(self) -> ThreadPoolExecutor:
        return ThreadPoolExecutor(self._threads, "simulation")

    def _work(self, work: Callable[[Cancel], T], cancel: threading.Event) -> T:
        self.warm()
        if cancel.is_set():
            raise CancelledError("cancelled")
        return work(cancel)


async def _disconnected(request: Request) -> None:
    """Return when the client has closed the connection."""
    while (await request.receive())["type"] != "http.disconnect":
        pass


def engine_of(name: str, model: str | None = None) -> StreamingSimulator:
    """Return an engine that answers requests.

    Args:
        name: of the engine.
        model: the name of a model that comes with SimuLearn; never a path.

    Raises:
        InputError: there is no such engine or model, or it is not for requests.
    """
    known = ", ".join(AT_ONCE)
    if name not in AT_ONCE:
        what = "does not answer here" if name in ENGINES else "is not known"
        text = f'engine "{name}" {what}; those that do are {known}'
        raise InputError(text, "engine-unknown", "engine")
    if model is not None and model not in (models := ["default", *shipped()]):
        text = f'model "{model}" is not known; known are {", ".join(models)}'
        raise InputError(text, "model-unknown", "model")
    return _engine(name, model)


@lru_cache(maxsize=16)
def _engine(name: str, model: str | None) -> StreamingSimulator:
    return engine(name, model)

"""The engines of a server, made ready once, and the simulations that requests wait for.

The kernels run without the interpreter's lock, so that threads use all cores and the server goes on
to answer.
"""

import logging
import threading
from collections.abc import Callable
from functools import lru_cache, partial
from typing import TypeVar

from fastapi import Request

from simulearn.errors import Cancel, InputError, stop_if
from simulearn.learn.common.bundle import shipped
from simulearn.simulate import engine
from simulearn.simulate.engines import ENGINES, StreamingSimulator
from simulearn.studio.settings import Settings
from simulearn.studio.turns import Turns

T = TypeVar("T")

AT_ONCE = ("learned", "beams", "fea")  # engines that answer a request directly

logger = logging.getLogger("simulearn.studio")


class Simulations:
    """The engines, and the threads that run them.

    Args:
        settings: of the server.
    """

    def __init__(self, settings: Settings) -> None:
        seconds = settings.simulation_seconds
        self._turns = Turns("simulation", settings.simulations, settings.waiting, seconds)
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
        """Return what work returns; see `Turns.run`. Kernels are compiled before."""
        return await self._turns.run(request, partial(self._work, work))

    def close(self) -> list[threading.Thread]:
        """Stop what runs and waits; see `Turns.close`."""
        return self._turns.close()

    def _work(self, work: Callable[[Cancel], T], cancel: Cancel) -> T:
        self.warm()
        stop_if(cancel)
        return work(cancel)


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

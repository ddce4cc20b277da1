"""How JAX is used: double precision around each call, and room for its kernels in memory.

Importing this changes nothing. Library code runs JAX in double precision through
`double_precision`. A program that owns its process, such as the command line, may name a folder for
compiled kernels by JAX's own variable JAX_COMPILATION_CACHE_DIR.
"""

from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import ParamSpec, TypeVar

import jax
import jax.monitoring

P = ParamSpec("P")
T = TypeVar("T")

MAPS = 30_000  # memory maps; Linux grants a process 65,530
AFTER = 20  # kernels made since the last count, before maps are counted again
MANY = 300  # kernels made, after which they are forgotten where maps cannot be counted


def double_precision(function: Callable[P, T]) -> Callable[P, T]:
    """Return a function that runs with JAX in double precision, and leaves JAX as it was."""

    @wraps(function)
    def wrapped(*args: P.args, **kwargs: P.kwargs) -> T:
        with jax.enable_x64(True):
            return function(*args, **kwargs)

    return wrapped


class _Made:
    """Counts the kernels made since maps were last counted."""

    kernels = 0  # since maps were last counted
    uncounted = 0  # where maps cannot be counted, since kernels were last forgotten

    def __call__(self, event: str, duration_secs: float, **_: str | int) -> None:
        self.kernels += event == "/jax/core/compile/backend_compile_duration"


def make_room() -> None:
    """Forget the kernels in memory if they are so many that the system might refuse more.

    A kernel takes up to a thousand memory maps; where a process is refused one, the compiler ends
    it. Call this where no kernel runs. What is needed again comes back from the folder.
    """
    if _made.kernels < AFTER:
        return
    _made.uncounted += _made.kernels
    _made.kernels = 0
    try:
        with Path("/proc/self/maps").open("rb") as file:
            full = sum(1 for _ in file) > MAPS
    except OSError:  # not Linux: there is no such limit, but memory is not endless either
        full = _made.uncounted > MANY
    if full:
        _made.uncounted = 0
        jax.clear_caches()


_made = _Made()
jax.monitoring.register_event_duration_secs_listener(_made)

"""How JAX is set up: double precision, and compiled kernels kept between runs.

Import this before using JAX. Kernels are kept in the user's cache folder, so that only the first
simulation on a machine waits for the compiler; JAX_COMPILATION_CACHE_DIR names another folder.
"""

import os
from pathlib import Path

import jax
import jax.monitoring

from simulearn.files import cache_folder

MAPS = 30_000  # memory maps; Linux grants a process 65,530
AFTER = 20  # kernels made since the last count, before maps are counted again


def _keep_kernels() -> None:
    base = cache_folder()
    if base is None:
        return
    folder = base / "compiled"
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return
    if os.access(folder, os.W_OK):  # else every run compiles for itself
        jax.config.update("jax_compilation_cache_dir", str(folder))
        jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.2)


class _Made:
    """Counts the kernels made since maps were last counted."""

    kernels = 0

    def __call__(self, event: str, duration_secs: float, **_: str | int) -> None:
        self.kernels += event == "/jax/core/compile/backend_compile_duration"


def make_room() -> None:
    """Forget the kernels in memory if they are so many that the system might refuse more.

    A kernel takes up to a thousand memory maps; where a process is refused one, the compiler ends
    it. Call this where no kernel runs. What is needed again comes back from the folder.
    """
    if _made.kernels < AFTER:
        return
    _made.kernels = 0
    try:
        with Path("/proc/self/maps").open("rb") as file:
            maps = sum(1 for _ in file)
    except OSError:
        return  # not Linux, where maps have such a limit
    if maps > MAPS:
        jax.clear_caches()


_made = _Made()
jax.monitoring.register_event_duration_secs_listener(_made)
jax.config.update("jax_enable_x64", True)
if "JAX_COMPILATION_CACHE_DIR" not in os.environ:
    _keep_kernels()

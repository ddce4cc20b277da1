"""How JAX is set up: double precision, and compiled kernels kept between runs.

Import this before using JAX. Kernels are kept in the user's cache folder, so that only the first
simulation on a machine waits for the compiler; JAX_COMPILATION_CACHE_DIR names another folder.
"""

import os
import sys
from pathlib import Path

import jax


def cache_folder() -> Path:
    """Return the folder for what can be computed again, by the custom of the platform."""
    if sys.platform == "win32":
        base = os.environ.get("LOCALAPPDATA", Path.home() / "AppData" / "Local")
    elif sys.platform == "darwin":
        base = Path.home() / "Library" / "Caches"
    else:
        base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(base) / "simulearn"


def _keep_kernels() -> None:
    folder = cache_folder() / "compiled"
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return
    if os.access(folder, os.W_OK):  # else every run compiles for itself
        jax.config.update("jax_compilation_cache_dir", str(folder))
        jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.2)


jax.config.update("jax_enable_x64", True)
if "JAX_COMPILATION_CACHE_DIR" not in os.environ:
    _keep_kernels()

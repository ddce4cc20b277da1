"""Native kernels: loops that Numba compiles once on a machine, for every topology alike.

A kernel is compiled at its first call and kept in the user's cache folder. Kernels of one source
folder call only each other, so what they do follows from that folder: its digest, with the versions
of the compiler, names the folder in which they are kept. Nothing of the host process is changed.
"""

import hashlib
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import Any

import llvmlite
import numba
import numpy as np
from numba.core import event
from numba.core.caching import CompileResultCacheImpl, FunctionCache

from simulearn.files import cache_folder


def native(
    entry: bool = True, allocates: bool = True, **options: Any
) -> Callable[[Callable[..., Any]], Any]:
    """Return a decorator that compiles a function; it runs without the interpreter's lock.

    Args:
        entry: whether Python calls it. Entries are kept on disk; what only other kernels call is
            compiled into them.
        allocates: whether it makes arrays. What does not need not count who holds those that it is
            given, which in short functions costs more than their work.
        options: further options of `numba.njit`.
    """

    def decorate(function: Callable[..., Any]) -> Any:
        # Wrappers for callers that a kernel does not have would only take time to compile.
        wrappers = {"no_cfunc_wrapper": True, "no_cpython_wrapper": not entry}
        settings: Any = {"nogil": True, "error_model": "numpy", **wrappers, **options}
        if not allocates:
            settings["_nrt"] = False
        compile_: Any = numba.njit(**settings)(function)
        if entry:
            with suppress(RuntimeError, OSError):  # no folder: every process compiles for itself
                compile_._cache = _Kernels(function)
        return compile_

    return decorate


def inlined(function: Callable[..., Any]) -> Any:
    """Compile a short function that makes no arrays into each place where a kernel calls it."""
    return native(entry=False, allocates=False, forceinline=True)(function)


class _Place:
    """Where a function's kernels are kept; Numba knows a folder by its path, we by its contents."""

    def __init__(self, function: Callable[..., Any], folder: Path) -> None:
        self._py_file, self._line = function.__code__.co_filename, function.__code__.co_firstlineno
        self._folder = folder

    @classmethod
    def from_function(cls, function: Callable[..., Any], file: str) -> "_Place | None":
        """Return the place of a function, None where there is no folder."""
        folder = _folder(Path(file).parent)
        return None if folder is None else cls(function, folder)

    def ensure_cache_path(self) -> None:
        """Make the folder again, should somebody have emptied the cache meanwhile."""
        self._folder.mkdir(parents=True, exist_ok=True)

    def get_cache_path(self) -> str:
        """Return the folder of the kernels."""
        return str(self._folder)

    def get_source_stamp(self) -> str:
        """Return what tells an edited source from the old one: the name of the folder does."""
        return self._folder.name

    def get_disambiguator(self) -> str:
        """Return what tells functions of one name in one file apart."""
        return str(self._line)


class _Placed(CompileResultCacheImpl):
    _locator_classes = [_Place]  # noqa: RUF012  (of the base class, too)


class _Kernels(FunctionCache):
    """The kernels of a function on disk; what cannot be read or written is done without."""

    _impl_class = _Placed

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return a kernel, None where there is none or its file is torn."""
        try:
            return super().load_overload(sig, target_context)
        except Exception:  # whatever the bytes of a torn file make of the unpickling
            with suppress(OSError):
                self.flush()  # so that the next run finds what this one compiles
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep a kernel, where there is room."""
        try:
            super().save_overload(sig, data)
        except OSError:
            self.disable()


def is_kept(kernel: Any) -> bool:
    """Return whether an entry has been compiled on this machine and is kept on disk."""
    file = getattr(getattr(kernel, "_cache", None), "_cache_file", None)
    return file is None or Path(file._index_path).exists()


@contextmanager
def on_compile(notify: Callable[[], None]) -> Iterator[None]:
    """Call `notify` once, when a kernel has to be compiled while the context lasts."""
    listener = _Listener(notify)
    with event.install_listener("numba:compile", listener):
        yield


class _Listener(event.Listener):
    """Notifies of the first compilation only."""

    def __init__(self, notify: Callable[[], None]) -> None:
        self._notify: Callable[[], None] | None = notify

    def on_start(self, event: Any) -> None:
        notify, self._notify = self._notify, None
        if notify is not None:
            notify()

    def on_end(self, event: Any) -> None:
        pass


@cache
def _folder(source: Path) -> Path | None:
    """Return the folder that keeps the kernels of a source folder, None where none can be written.

    Equal sources share it, wherever they lie: those of a checkout and of an installed package.
    """
    base = cache_folder()
    if base is None:
        return None
    versions = f"{numba.__version__} {llvmlite.__version__} {np.__version__}"
    digest = hashlib.sha256(versions.encode())
    for file in sorted(source.glob("*.py")):
        digest.update(file.name.encode() + b"\0" + file.read_bytes() + b"\0")
    folder = base / "native" / digest.hexdigest()[:16]
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return None
    return folder if os.access(folder, os.W_OK) else None

"""Who computes trials: processes of this machine, or a Dask cluster. One thread for each trial.

A worker that dies or hangs is replaced and only its own trial is lost. Workers answer with bytes
and never write files, so a cluster needs no common disk.
"""

import os
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import get_context, parent_process

from simulearn.dataset.trial import TrialJob, TrialOutcome, run
from simulearn.errors import InputError

LONGEST = 900.0  # s; a trial takes seconds, and a minute where kernels are compiled


@dataclass(frozen=True)
class Workers:
    """Workers that are ready.

    Attributes:
        submit: give a job to them; the future brings its answer.
        count: how many there are now.
    """

    submit: Callable[[TrialJob], "Future[TrialOutcome]"]
    count: Callable[[], int]


@contextmanager
def local_workers(processes: int, longest: float = LONGEST) -> Iterator[Workers]:
    """Yield processes of this machine; a trial that takes too long (s) is given up."""
    from pebble import ProcessPool

    pool = ProcessPool(processes, initializer=_begin, context=get_context("spawn"))
    with _no_interrupts():
        assert pool.active  # its threads start now, and hand on to workers what is blocked here
    try:
        yield Workers(
            lambda job: pool.schedule(run, args=(job,), timeout=longest), lambda: processes
        )
    finally:
        pool.stop()
        pool.join()


@contextmanager
def cluster_workers(address: str) -> Iterator[Workers]:
    """Yield the workers of a Dask cluster.

    Args:
        address: of its scheduler, as tcp://host:8786.

    Raises:
        InputError: nobody answers there, or Dask is not installed.
    """
    try:
        from distributed import Client
    except ImportError as error:
        raise InputError("a cluster needs Dask: pip install 'simulearn[cluster]'") from error
    try:
        client = Client(address, timeout=10, set_as_default=False)
    except (OSError, ValueError) as error:
        raise InputError(f"{address}: no Dask scheduler answers there") from error
    try:
        executor = client.get_executor(pure=False)
        yield Workers(
            lambda job: executor.submit(run, job),
            lambda: sum(client.nthreads().values()),
        )
    finally:
        client.close()


@contextmanager
def _no_interrupts() -> Iterator[None]:
    """Block Ctrl-C in threads and processes that start meanwhile; this thread gets it as before.

    A worker would otherwise meet it in its first second, before `_begin` leaves it to the parent.
    """
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _begin() -> None:
    """Leave Ctrl-C to the parent, and end when it is no more, even if it was killed."""
    from threadpoolctl import threadpool_limits

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # Matrices of a trial are small; threads of several workers would only wait for each other.
    threadpool_limits(1)
    parent = parent_process()
    assert parent is not None

    def watch() -> None:
        parent.join()
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()

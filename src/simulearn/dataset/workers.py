"""Who computes trials: processes of this machine, or a Dask cluster. One thread for each trial.

A worker that dies or hangs is replaced and only its own trial is lost. Workers answer with bytes
and never write files, so a cluster needs no common disk.
"""

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import get_context

from simulearn.dataset.trial import Answer, Job, run
from simulearn.errors import InputError

# Matrices of a trial are small; threads of several workers would only wait for each other.
ONE_THREAD = {
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "XLA_FLAGS": "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1",
}
LONGEST = 900.0  # s; a trial takes seconds, and a minute where kernels are compiled


@dataclass(frozen=True)
class Workers:
    """Workers that are ready.

    Attributes:
        submit: give a job to them; the future brings its answer.
        count: how many there are now.
    """

    submit: Callable[[Job], "Future[Answer]"]
    count: Callable[[], int]


@contextmanager
def local_workers(processes: int, longest: float = LONGEST) -> Iterator[Workers]:
    """Yield processes of this machine; a trial that takes too long (s) is given up."""
    from pebble import ProcessPool

    with _one_thread():
        pool = ProcessPool(
            processes, initializer=_begin, initargs=(os.getpid(),), context=get_context("spawn")
        )
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
        raise InputError("--scheduler needs Dask: pip install 'simulearn[cluster]'") from error
    try:
        client = Client(address, timeout=10, set_as_default=False)
    except (OSError, ValueError) as error:
        raise InputError(f"--scheduler {address}: no Dask scheduler answers there") from error
    try:
        executor = client.get_executor(pure=False)
        yield Workers(
            lambda job: executor.submit(run, job),
            lambda: sum(client.nthreads().values()),
        )
    finally:
        client.close()


@contextmanager
def _one_thread() -> Iterator[None]:
    """Set the environment in which workers begin."""
    before = {name: os.environ.get(name) for name in ONE_THREAD}
    os.environ.update(ONE_THREAD)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def _begin(parent: int) -> None:
    """Leave Ctrl-C to the parent, and end when it is no more, even if it was killed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(1.0)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()

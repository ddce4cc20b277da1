"""Who computes trials and the like: processes of this machine, or a Dask cluster; one thread each.

A worker that dies or hangs is replaced and only its own trial is lost. Workers answer with bytes
and never write files, so a cluster needs no common disk.
"""

import os
import signal
import socket
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from multiprocessing import parent_process
from multiprocessing.context import SpawnContext, SpawnProcess
from time import monotonic, sleep
from typing import Any

from simulearn import __version__
from simulearn.dataset.trial import SOLVER_VERSION, run
from simulearn.errors import ComputationError, InputError
from simulearn.extras import require

LONGEST = 900.0  # s; a trial takes seconds, and a minute where kernels are compiled
ANSWERING = 10.0  # s that a scheduler may take to answer at first
WAITING = 30.0  # s that a cluster may be without workers

Work = Callable[[Any], Any]  # job -> answer, both of plain data that travels

_starting = threading.Lock()


@dataclass(frozen=True)
class Workers:
    """Workers that are ready.

    Attributes:
        submit: give a job to them, a trial or another that they were made for; the future brings
            its answer.
        count: how many there are now.
        check: called while no answer comes; raises ComputationError where none will come.
    """

    submit: Callable[[Any], "Future[Any]"]
    count: Callable[[], int]
    check: Callable[[], None] = lambda: None


@contextmanager
def local_workers(processes: int, longest: float = LONGEST, work: Work = run) -> Iterator[Workers]:
    """Yield processes of this machine.

    They do not run the caller's script again, as new processes do in Python: it needs no guard.

    Args:
        processes: how many.
        longest: s; a job that takes longer is given up.
        work: what they do with a job: trials, or a function of another module.

    Raises:
        ComputationError: no process can be started.
    """
    from pebble import ProcessPool

    try:
        pool = ProcessPool(processes, initializer=_begin, context=_Context())
        with _no_interrupts():
            # Its threads start now, and hand on to workers what is blocked here.
            assert pool.active
    except OSError as error:
        raise _not_started(error.strerror or str(error)) from error

    def submit(job: Any) -> "Future[Any]":
        try:
            return pool.schedule(work, args=(job,), timeout=longest)
        except RuntimeError as error:  # the pool has given up
            raise _not_started("they end as soon as they begin") from error

    try:
        yield Workers(submit, lambda: processes)
    finally:
        pool.stop()
        pool.join()


def _not_started(why: str) -> ComputationError:
    return ComputationError(
        f"worker processes cannot be started ({why})",
        "workers",
        hint="they need memory, and some room in the folder for shared memory (/dev/shm)",
    )


class _Process(SpawnProcess):
    """A process that does not import the caller's script."""

    @staticmethod
    def _Popen(process_obj: Any) -> Any:  # noqa: N802  (a name of Python's own)
        # Python hands on where the script is, if there is one; our workers need nothing of it, and
        # a script without a guard would begin its own work again, one from stdin cannot be found.
        with _starting, _without_script():
            return SpawnProcess._Popen(process_obj)


class _Context(SpawnContext):
    Process = _Process


@contextmanager
def _without_script() -> Iterator[None]:
    """Let the caller's script look as if it were typed into an interpreter."""
    names: dict[str, Any] = vars(sys.modules["__main__"])
    kept: dict[str, Any] = {name: names[name] for name in ("__spec__", "__file__") if name in names}
    names["__spec__"] = None
    names.pop("__file__", None)
    try:
        yield
    finally:
        names.update(kept)


@contextmanager
def cluster_workers(address: str, waiting: float = WAITING, work: Work = run) -> Iterator[Workers]:
    """Yield the workers of a Dask cluster.

    Args:
        address: of its scheduler, as tcp://host:8786.
        waiting: s that it may be without workers.
        work: what they do with a job; see `local_workers`.

    Raises:
        InputError: nobody answers there, or Dask is not installed.
        ComputationError: it has no workers, or they have not this version of SimuLearn.
    """
    require("a Dask cluster needs", "distributed")
    from distributed import Client

    try:
        _knock(address)
        client = Client(address, timeout=ANSWERING, set_as_default=False)
    except Exception as error:  # Dask raises many kinds for what is no scheduler
        raise InputError(
            f"{address}: no Dask scheduler answers there; an address is as tcp://host:8786"
        ) from error
    team = _Cluster(client, address, waiting, work)
    try:
        team.begin()
        yield Workers(team.submit, team.count, team.check)
    finally:
        with suppress(Exception):  # the scheduler may be gone
            client.close(timeout=5)


def _knock(address: str) -> None:
    """Raise OSError or ValueError where nobody listens; Dask would leave threads behind."""
    scheme, _, place = address.rpartition("://")
    host, _, port = place.rpartition(":")
    if not place:
        raise ValueError("no place")
    if scheme in ("", "tcp", "tls", "ws", "wss"):
        socket.create_connection((host.strip("[]"), int(port)), timeout=ANSWERING).close()


class _Cluster:
    """The workers of a Dask cluster.

    Args:
        client: of its scheduler.
        address: for messages.
        waiting: s that it may be without workers.
        work: what they do with a job.
    """

    def __init__(self, client: Any, address: str, waiting: float, work: Work) -> None:
        self._client, self._address, self._waiting = client, address, waiting
        self._work = work
        self._executor = client.get_executor(pure=False)
        self._last = monotonic()  # when there was a worker

    def begin(self) -> None:
        """Wait for workers, and make sure that they can do the work."""
        while not self.count():
            self.check()
            sleep(0.2)
        ours = f"{__version__}, solver {SOLVER_VERSION}"
        theirs = self._request(lambda: self._client.run(_version(), on_error="return"))
        for worker, answer in theirs.items():
            if answer != ours:
                has = "no SimuLearn that works" if isinstance(answer, BaseException) else answer
                raise ComputationError(
                    f"the worker {worker} has {has}; this machine has {ours}",
                    "workers",
                    hint="install the same version on all of them",
                )

    def submit(self, job: Any) -> "Future[Any]":
        """Give a job to a worker."""
        future: Future[Any] = self._request(lambda: self._executor.submit(self._work, job))
        return future

    def count(self) -> int:
        """Return how many threads of workers there are."""
        threads = self._request(lambda: sum(self._client.nthreads().values()))
        if threads:
            self._last = monotonic()
        return int(threads)

    def check(self) -> None:
        """Raise ComputationError where the scheduler or all workers are gone."""
        if not self.count() and monotonic() - self._last > self._waiting:
            raise ComputationError(
                f"{self._address}: the scheduler has had no workers for {self._waiting:.0f} s",
                "workers",
                hint=f"start some: dask worker {self._address}",
            )

    def _request(self, question: Callable[[], Any]) -> Any:
        """Return what the scheduler answers."""
        try:
            if self._client.status in ("closed", "closing"):
                raise OSError("the connection is closed")
            return question()
        except Exception as error:
            raise ComputationError(
                f"{self._address}: the Dask scheduler answers no more ({type(error).__name__})",
                "scheduler",
                hint="what is finished is kept, and the same command goes on",
            ) from error


def _version() -> Callable[[], str]:
    """Return a function that says which version a worker has; it travels with its code."""

    def version() -> str:
        from simulearn import __version__
        from simulearn.dataset.trial import SOLVER_VERSION

        return f"{__version__}, solver {SOLVER_VERSION}"

    return version


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

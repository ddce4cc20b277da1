"""Jobs: computations of seconds to minutes, which run in threads while a browser asks about them.

A few run at a time and a bounded number waits. A job ends early when it is cancelled, when its time
is over, or when nobody has asked about it for minutes, as after a tab was closed: all three are one
token, which the computation looks at as often as it can. What is finished is kept for an hour.
"""

import json
import logging
import secrets
import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from time import monotonic
from typing import Any

from simulearn.errors import CancelledError, ComputationError, InputError
from simulearn.studio.problems import Problem
from simulearn.studio.settings import Settings

QUEUED, RUNNING, DONE, FAILED, CANCELLED = "queued", "running", "done", "failed", "cancelled"

ABANDONED = 300.0  # s without a question; a browser asks from a hidden tab once a minute
KEPT_SECONDS = 3600.0
KEPT_JOBS = 200
KEPT_BYTES = 2**28  # of all results
RETRY_AFTER = 5  # s

logger = logging.getLogger("simulearn.studio")


@dataclass(frozen=True)
class Answer:
    """What a computation came to.

    Attributes:
        result: as JSON.
        frames: shapes as a binary message; see `frames`.
        partial: whether the computation was stopped and this is the best so far.
    """

    result: bytes
    frames: bytes | None = None
    partial: bool = False


@dataclass(eq=False)
class Job:
    """A computation, how far it is, and the token that stops it.

    Attributes:
        kind: "optimize" or "fea".
        work: computes the answer; it is given this job, to report to and to be stopped by.
        seconds: that it may take.
        now: the clock.
        id: its name, which cannot be guessed.
        state: queued, running, done, failed or cancelled.
        progress: done and in all; None where that is not known.
        steps: so far, each as JSON.
        answer: once it is finished; also of one that was stopped, where it had come to something.
        problem: why it failed.
    """

    kind: str
    work: "Work"
    seconds: float
    now: Callable[[], float] = monotonic
    id: str = field(default_factory=lambda: secrets.token_urlsafe(16))
    state: str = QUEUED
    progress: tuple[int, int] | None = None
    steps: list[bytes] = field(default_factory=list)
    answer: Answer | None = None
    problem: Problem | None = None

    def __post_init__(self) -> None:
        self.last_question = self.now()
        self.begun = self.ended = float("inf")
        self.bytes = 0  # of memory that it holds, about; counted when it is finished
        self._stopped = threading.Event()

    def is_set(self) -> bool:
        """Return whether the computation shall stop."""
        return self._stopped.is_set() or self.overdue or self.abandoned

    def stop(self) -> None:
        """Let the computation end as soon as it can."""
        self._stopped.set()

    @property
    def overdue(self) -> bool:
        """Whether its time is over."""
        return self.now() - self.begun > self.seconds

    @property
    def abandoned(self) -> bool:
        """Whether nobody has asked about it for long."""
        return self.now() - self.last_question > ABANDONED

    @property
    def finished(self) -> bool:
        """Whether nothing more will happen."""
        return self.state not in (QUEUED, RUNNING)

    @property
    def took(self) -> float:
        """Seconds since it began, or that it took."""
        if self.begun > self.ended:  # it never began
            return 0.0
        return max(0.0, min(self.now(), self.ended) - self.begun)

    def report(self, done: int, total: int) -> None:
        """Take note of how far the computation is."""
        self.progress = done, total

    def add_step(self, step: dict[str, Any]) -> None:
        """Take note of a step that was done."""
        self.steps.append(json.dumps(step, allow_nan=False).encode())

    def run(self) -> None:
        """Compute the answer; every failure is kept as a problem."""
        try:
            self.answer = self.work(self)
            state = CANCELLED if self.answer.partial and not self.overdue else DONE
        except CancelledError:
            state = CANCELLED
            if self.overdue and not self._stopped.is_set():
                text = f"the job took longer than the {self.seconds:g} s that it may take here"
                state, self.problem = FAILED, Problem(422, "time-over", text)
        except (InputError, ComputationError) as error:
            state, self.problem = FAILED, Problem.of(error)
        except Exception:
            logger.exception("the job %s failed", self.kind)
            text = "the server made a mistake; its log says more"
            state, self.problem = FAILED, Problem(500, "internal", text)
        self.end(state)

    def end(self, state: str) -> None:
        """Set the final state; it is set last, so that whoever sees it sees all else."""
        self.bytes = sum(map(len, self.steps))
        if self.answer is not None:
            self.bytes += len(self.answer.result) + len(self.answer.frames or b"")
        self.ended = self.now()
        self.state = state


Work = Callable[[Job], Answer]


class Jobs:
    """All jobs of a server.

    Args:
        settings: how many run, how many wait, and how long each may take.
        now: the clock.
    """

    def __init__(self, settings: Settings, now: Callable[[], float] = monotonic) -> None:
        self._settings, self._now = settings, now
        self._jobs: dict[str, Job] = {}  # the oldest first
        self._line: deque[Job] = deque()
        self._threads: set[threading.Thread] = set()
        self._lock = threading.Lock()

    def start(self, kind: str, work: Work) -> Job:
        """Begin a job, or put it in line.

        Raises:
            Problem: too many are waiting.
        """
        job = Job(kind, work, self._settings.job_seconds, self._now)
        with self._lock:
            self._tidy()
            busy = sum(not job.finished for job in self._jobs.values())
            if busy >= self._settings.job_workers + self._settings.jobs_waiting:
                raise Problem(
                    429,
                    "too-many-jobs",
                    "too many jobs are waiting; try again in a moment",
                    headers={"Retry-After": str(RETRY_AFTER)},
                )
            self._jobs[job.id] = job
            self._line.append(job)
            if len(self._threads) < self._settings.job_workers:
                # A thread that computes must not keep the program from ending.
                thread = threading.Thread(target=self._compute, name="job", daemon=True)
                self._threads.add(thread)
                thread.start()
        return job

    def get(self, name: str) -> Job:
        """Return a job; that somebody asks keeps it from being abandoned.

        Raises:
            Problem: there is none of that name, or none any more.
        """
        with self._lock:
            self._tidy()
            job = self._jobs.get(name)
            if job is None:
                text = "there is no such job; it was finished long ago, or the server began anew"
                raise Problem(404, "job-unknown", text, "id")
            job.last_question = self._now()
            return job

    def cancel(self, name: str) -> Job:
        """Stop a job; it ends at once if it has not begun, else as soon as it can.

        Raises:
            Problem: there is none of that name.
        """
        job = self.get(name)
        job.stop()
        with self._lock:
            self._tidy()
        return job

    def close(self) -> list[threading.Thread]:
        """Stop all jobs; the same application may be started again.

        Returns:
            Threads that may take a while to end.
        """
        with self._lock:
            for job in self._jobs.values():
                job.stop()
            self._tidy()
            return list(self._threads)

    def _compute(self) -> None:
        """Run jobs until none is waiting."""
        while (job := self._next()) is not None:
            job.run()
            with self._lock:
                self._tidy()

    def _next(self) -> Job | None:
        with self._lock:
            self._tidy()
            if not self._line:
                self._threads.discard(threading.current_thread())
                return None
            job = self._line.popleft()
            job.begun, job.state = self._now(), RUNNING
            return job

    def _tidy(self) -> None:
        """End waiting jobs that are not wanted any more, and drop finished ones."""
        for job in [job for job in self._line if job.is_set()]:
            self._line.remove(job)
            job.end(CANCELLED)
        finished = [job for job in self._jobs.values() if job.finished]
        count, size = len(finished), sum(job.bytes for job in finished)
        for job in finished:
            old = self._now() - job.ended > KEPT_SECONDS
            if old or count > KEPT_JOBS or (size > KEPT_BYTES and count > 1):
                del self._jobs[job.id]
                count, size = count - 1, size - job.bytes

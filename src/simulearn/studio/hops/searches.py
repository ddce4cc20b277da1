"""Searches that Grasshopper began, by what they search for: asked twice, a search runs once."""

import hashlib
import json
import threading
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from simulearn.studio.hops.design import Design
from simulearn.studio.jobs import CANCELLED, FAILED, Job, Jobs
from simulearn.studio.problems import Problem

MOST = 200  # as many as finished jobs are kept


@dataclass(frozen=True, eq=False)
class Search:
    """A job, and the design from which it began."""

    job: str
    design: Design


class Searches:
    """The searches of a studio that came from Grasshopper.

    Args:
        jobs: of the studio.
    """

    def __init__(self, jobs: Jobs) -> None:
        self._jobs = jobs
        self._found: OrderedDict[str, Search] = OrderedDict()
        self._lock = threading.Lock()

    def start(self, task: dict[str, Any], design: Design, begin: Callable[[], Job]) -> Job:
        """Return the job of a task: the one that was begun for it, or a new one.

        One that failed or was stopped is begun anew.

        Raises:
            Problem: too many jobs are waiting.
        """
        key = hashlib.sha256(json.dumps(task, sort_keys=True).encode()).hexdigest()
        with self._lock:
            known = self._found.get(key)
            job = self._job(known.job) if known else None
            if job is None or job.state in (FAILED, CANCELLED):
                job = begin()
                self._found.pop(key, None)
            self._found[key] = Search(job.id, design)
            while len(self._found) > MOST:
                self._found.popitem(last=False)
            return job

    def design(self, job: str) -> Design:
        """Return the design from which a job began.

        Raises:
            Problem: no search of that name came from Grasshopper.
        """
        with self._lock:
            for search in reversed(self._found.values()):
                if search.job == job:
                    return search.design
        text = "there is no such search; solve Optimise once more"
        raise Problem(404, "job-unknown", text, "Job")

    def _job(self, name: str) -> Job | None:
        try:
            return self._jobs.get(name)
        except Problem:
            return None

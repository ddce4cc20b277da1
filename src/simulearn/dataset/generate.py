"""Generating a data set: every trial in its own file, so that a run goes on where it stopped.

FOLDER/config.json         what is being generated
FOLDER/trials/KEY.npz      a trial, written in one step
FOLDER/failures/KEY.json   a design that has no result, and why
"""

import json
import time
from collections.abc import Callable, Collection, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, wait
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from simulearn.dataset.config import Config, config_of
from simulearn.dataset.trial import TrialJob, TrialOutcome, is_whole
from simulearn.dataset.workers import Workers, local_workers
from simulearn.errors import ComputationError, InputError
from simulearn.files import cores, read_text, replacing

PATIENCE = 10.0  # s without an answer, after which it is checked that somebody computes
AHEAD = 2  # jobs given to each worker, so that none waits for its next
TRIES = 3  # of a trial whose worker dies
DIED = TrialOutcome("broken", reason=f"its worker died, {TRIES} times")


@dataclass
class Tally:
    """How far a run is.

    Attributes:
        trials: designs in the set.
        present: trials and failures that were there before this run.
        done: trials of this run.
        torn: of them or still to come, those whose file was there but empty, torn or odd.
        failed: failures in the folder, of this run or before.
        seconds: the solver's time in the trials of this run.
        reasons: why trials of this run failed.
    """

    trials: int
    present: int = 0
    done: int = 0
    failed: int = 0
    torn: int = 0
    seconds: float = 0.0
    reasons: list[str] = field(default_factory=list)
    begun: float = field(default_factory=time.monotonic)

    @property
    def per_minute(self) -> float:
        """Trials and failures of this run a minute."""
        passed = time.monotonic() - self.begun
        return 60 * (self.done + len(self.reasons)) / max(passed, 1e-9)

    @property
    def left(self) -> int:
        """Designs that this run has not come to yet, or is computing."""
        return self.trials - self.present - self.done - len(self.reasons)


class Folder:
    """The folder of a data set that is being generated.

    Args:
        path: where; made if it is not there.
        config: of the set; None takes the one that is there.

    Raises:
        InputError: another set is there, or none, or the folder cannot be made.
    """

    def __init__(self, path: Path | str, config: Config | None = None) -> None:
        self.path = Path(path)
        described = self.path / "config.json"
        if config is None:
            if not described.exists():
                raise InputError(f"{path}: is not the folder of a data set (no config.json)")
            config = self._described(described)
        else:
            if described.exists() and (wrong := config.differences(self._described(described))):
                raise InputError(
                    f"{path}: holds another data set ({'; '.join(wrong)}); choose another folder"
                )
            try:
                for folder in (self.path, self.path / "trials", self.path / "failures"):
                    folder.mkdir(parents=True, exist_ok=True)
            except OSError as error:
                raise InputError(f"{path}: cannot be made ({error.strerror})") from error
            with replacing(described) as temporary:
                temporary.write_text(config.model_dump_json(indent=1) + "\n", "utf-8")
        self.config = config

    def trial(self, key: str) -> Path:
        """Return where a trial is kept."""
        return self.path / "trials" / f"{key}.npz"

    def failure(self, key: str) -> Path:
        """Return where it is kept why a design has no trial."""
        return self.path / "failures" / f"{key}.json"

    def state(self, key: str) -> Literal["done", "failed", "torn", "missing"]:
        """Return what is there of a design; a torn file is as good as none, but is reported."""
        if is_whole(self.trial(key)):
            return "done"
        if self.why(key) is not None:
            return "failed"
        there = self.trial(key).exists() or self.failure(key).exists()
        return "torn" if there else "missing"

    def why(self, key: str) -> str | None:
        """Return why a design has no trial, None where no sound file says so."""
        record = _record(self.failure(key))
        return None if record is None else str(record["reason"])

    def keep(self, k: int, job: TrialJob, answer: TrialOutcome) -> None:
        """Keep an answer."""
        if answer.outcome == "done":
            with replacing(self.trial(job.key)) as temporary:
                temporary.write_bytes(answer.content)
            return
        record = {
            "trial": k,
            "outcome": answer.outcome,
            "reason": answer.reason,
            "grid": job.grid,
        }
        with replacing(self.failure(job.key)) as temporary:
            temporary.write_text(json.dumps(record, indent=1) + "\n", "utf-8")

    def forget_failures(self, outcomes: Collection[str] = ("failed", "broken")) -> None:
        """Forget failures of some outcomes, so that they are tried again."""
        for path in (self.path / "failures").glob("*.json"):
            record = _record(path)
            if record is not None and record["outcome"] in outcomes:
                path.unlink()

    def sweep(self) -> None:
        """Take away what a killed run left half written."""
        for path in [*self.path.glob("*/.*.npz"), *self.path.glob("*/.*.json")]:
            path.unlink(missing_ok=True)

    @staticmethod
    def _described(path: Path) -> Config:
        try:
            data = json.loads(read_text(path))
        except json.JSONDecodeError as error:
            raise InputError(
                f"{path}: is damaged ({error}); delete it, and generate the set again: its trials "
                "are kept"
            ) from error
        return config_of(data, str(path))


def _record(path: Path) -> dict[str, Any] | None:
    """Return the record of a failure; None where there is none, or a file that is no such thing."""
    try:
        record = json.loads(read_text(path))
    except (InputError, ValueError, RecursionError):
        return None
    if not isinstance(record, dict) or not {"outcome", "reason"} <= record.keys():
        return None
    return record


def generate(
    config: Config,
    path: Path | str,
    workers: AbstractContextManager[Workers] | None = None,
    progress: Callable[[Tally], None] = lambda tally: None,
) -> Tally:
    """Generate the trials of a data set that are not there yet.

    Args:
        config: of the set.
        path: of its folder.
        workers: who computes; by default a process for each core.
        progress: called when the work begins and after each trial.

    Raises:
        InputError: the folder holds another set, or cannot be written.
        ComputationError: the disk is full, no worker can be started, or none is left.
    """
    folder = Folder(path, config)
    folder.sweep()
    folder.forget_failures(("broken",))
    tally = Tally(config.trials)
    todo = _missing(folder, tally)
    first = next(todo, None)
    if first is None:
        progress(tally)
        return tally
    with workers or local_workers(cores()) as team:
        progress(tally)
        running: dict[Future[TrialOutcome], tuple[int, TrialJob, int]] = {}
        upcoming: tuple[int, TrialJob] | None = first
        while upcoming or running:
            while upcoming and len(running) < AHEAD * max(team.count(), 1):
                running[team.submit(upcoming[1])] = (*upcoming, 1)
                upcoming = next(todo, None)
            finished, _ = wait(running, timeout=PATIENCE, return_when=FIRST_COMPLETED)
            if not finished:
                team.check()
            for future in finished:
                k, job, tries = running.pop(future)
                answer = _answer(future)
                if answer is None and tries < TRIES:
                    running[team.submit(job)] = (k, job, tries + 1)
                    continue
                _take(folder, tally, k, job, answer or DIED)
                progress(tally)
    return tally


def _missing(folder: Folder, tally: Tally) -> Iterator[tuple[int, TrialJob]]:
    """Yield the designs that have no trial yet, and count those that have."""
    for k in range(folder.config.trials):
        job = TrialJob.of(folder.config.design(k), folder.config)
        state = folder.state(job.key)
        if state in ("done", "failed"):
            tally.present += 1
            tally.failed += state == "failed"
        else:
            tally.torn += state == "torn"
            yield k, job


def _answer(future: "Future[TrialOutcome]") -> TrialOutcome | None:
    """Return the answer; None if the worker died."""
    try:
        return future.result()
    except TimeoutError:
        return TrialOutcome("broken", reason="took too long and was given up")
    except Exception:
        return None


def _take(folder: Folder, tally: Tally, k: int, job: TrialJob, answer: TrialOutcome) -> None:
    try:
        folder.keep(k, job, answer)
    except InputError as error:
        raise ComputationError(
            f"{error}; {tally.present + tally.done} trials are there, and the same command goes on"
        ) from error
    if answer.outcome == "done":
        tally.done += 1
        tally.seconds += answer.seconds
    else:
        tally.failed += 1
        tally.reasons.append(f"trial {k}: {answer.reason}")

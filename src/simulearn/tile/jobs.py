"""Answers to the searches of a tiling: files of earlier runs, then processes or a cluster.

FOLDER/work/KEY.json   the answer to a job, by its name
"""

import json
from collections.abc import Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from time import monotonic, time

from simulearn.dataset.workers import Workers
from simulearn.errors import Cancel, InputError, stop_if
from simulearn.files import read_text, replacing
from simulearn.tile.searching import ModuleAnswer, ModuleJob
from simulearn.tile.tiled import Progress, Stage

STALE = 3600.0  # s, after which half a file is what a killed run has left
TRIES = 3  # of a search whose worker dies
PATIENCE = 0.5  # s between two looks at the token and the clock
AHEAD = 2  # jobs given to each worker


class Jobs:
    """Answers jobs from the folder, or by workers, whose answers are then kept there.

    Args:
        workers: who searches.
        folder: where answers are kept; None: nowhere.
        report: called after each answer.
        cancel: stops it.
        until: when no more searches are begun, by `time.monotonic`.

    Raises:
        InputError: the folder cannot be made.
    """

    def __init__(
        self,
        workers: Workers,
        folder: Path | None,
        report: Progress,
        cancel: Cancel | None,
        until: float,
    ) -> None:
        self.workers, self.report, self.cancel, self.until = workers, report, cancel, until
        self.folder = None if folder is None else folder / "work"
        if self.folder is not None:
            try:
                self.folder.mkdir(parents=True, exist_ok=True)
            except OSError as error:
                raise InputError(f"{folder}: cannot be made ({error.strerror})") from error
            for half in self.folder.glob(".*.json"):
                with suppress(OSError):  # another run may write it now
                    if time() - half.stat().st_mtime > STALE:
                        half.unlink()

    def answers(
        self, number: int, jobs: Sequence[ModuleJob], final: bool = False
    ) -> list[ModuleAnswer | None]:
        """Return the answers to jobs, in their order; None where the time was over before.

        Args:
            number: of the round.
            jobs: what is wanted.
            final: whether nothing can be left out, so that the time does not count.

        Raises:
            CancelledError: the token was set.
            ComputationError: no worker is left.
        """
        found = [self._kept(job) for job in jobs]
        waiting = [k for k, answer in enumerate(found) if answer is None]
        running: dict[Future[ModuleAnswer], tuple[int, int]] = {}
        self._said(number, found)
        try:
            while waiting or running:
                stop_if(self.cancel)
                if not final and monotonic() > self.until:
                    break
                while waiting and len(running) < AHEAD * max(self.workers.count(), 1):
                    k = waiting.pop(0)
                    running[self.workers.submit(jobs[k])] = k, 1
                finished, _ = wait(running, timeout=PATIENCE, return_when=FIRST_COMPLETED)
                if not finished:
                    self.workers.check()
                for future in finished:
                    k, tries = running.pop(future)
                    answer = _answer(future)
                    if answer is None and tries < TRIES:
                        running[self.workers.submit(jobs[k])] = k, tries + 1
                        continue
                    found[k] = answer or ModuleAnswer(None, why=f"its worker died, {TRIES} times")
                    self._keep(jobs[k], found[k])
                    self._said(number, found)
        finally:
            for future in running:
                future.cancel()
        return found

    def _said(self, number: int, found: Sequence[ModuleAnswer | None]) -> None:
        done = sum(answer is not None for answer in found)
        self.report(Stage(number, done, len(found)))

    def _kept(self, job: ModuleJob) -> ModuleAnswer | None:
        """Return the answer that an earlier run kept; None if there is none, or a torn file."""
        if self.folder is None:
            return None
        try:
            return ModuleAnswer(**json.loads(read_text(self.folder / f"{job.key}.json")))
        except (InputError, ValueError, TypeError, RecursionError):
            return None

    def _keep(self, job: ModuleJob, answer: ModuleAnswer | None) -> None:
        """Keep an answer; what failed is tried again another time."""
        if self.folder is None or answer is None or answer.grid is None:
            return
        with replacing(self.folder / f"{job.key}.json") as temporary:
            temporary.write_text(json.dumps(asdict(answer)) + "\n", "utf-8")


def _answer(future: "Future[ModuleAnswer]") -> ModuleAnswer | None:
    """Return the answer; None if the worker died."""
    try:
        return future.result()
    except TimeoutError:
        return ModuleAnswer(None, why="took too long and was given up")
    except Exception:
        return None

"""Running `ccx`, a program of its own: in a temporary folder, as a child that never outlives us.

Set SIMULEARN_KEEP to keep the folder with deck, log and results.
"""

import os
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from simulearn.errors import Cancel, ComputationError, InputError, stop_if
from simulearn.fea.calculix.output import last_error, read_sta

# Words of messages by which CalculiX says that an increment, however short, did not converge.
GIVEN_UP = ("diverge", "too many", "increment size", "max. # of increments")


class NotConvergedError(ComputationError):
    """CalculiX found no equilibrium; smaller steps may help."""


@dataclass(frozen=True)
class Ccx:
    """CalculiX in a folder, where the deck is `trial.inp`.

    Attributes:
        program: the executable.
        folder: where it runs.
        threads: processors that it may use.
        timeout: seconds allowed in all.
        deadline: when they are over, by the monotonic clock.
        cancel: token that stops it.
    """

    program: str
    folder: Path
    threads: int
    timeout: float | None
    deadline: float | None
    cancel: Cancel | None = None

    def path(self, ending: str) -> Path:
        """Return the path of the deck ("inp") or of an output."""
        return self.folder / f"trial.{ending}"

    def run(self, watch: Callable[[], None] | None = None) -> None:
        """Run the deck to its end.

        Args:
            watch: called a few times a second while CalculiX runs.

        Raises:
            NotConvergedError: an increment did not converge.
            ComputationError: CalculiX failed otherwise, or took too long.
            CancelledError: the token said so.
        """
        for ending in ("sta", "dat"):
            self.path(ending).unlink(missing_ok=True)
        environment = os.environ | {"OMP_NUM_THREADS": str(self.threads)}
        with (
            self.path("log").open("w", encoding="utf-8") as log,
            subprocess.Popen(
                [self.program, "-i", "trial"],
                cwd=self.folder,
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=subprocess.STDOUT,
                env=environment,
            ) as process,
        ):
            try:
                self._wait(process, watch)
            finally:
                process.kill()  # no effect on one that has ended; Ctrl-C must not leave it running
        text = self.path("log").read_text(encoding="utf-8", errors="replace")
        if process.returncode == 0 and "Job finished" in text:
            return
        done = read_sta(self.path("sta"))
        step, increment = (done[-1][0], done[-1][1] + 1) if done else (1, 1)
        message = last_error(text) or f"exit status {process.returncode}"
        kind = NotConvergedError if any(word in message for word in GIVEN_UP) else ComputationError
        raise kind(f"CalculiX stopped in step {step}, increment {increment}: {message}")

    def _wait(self, process: subprocess.Popen[bytes], watch: Callable[[], None] | None) -> None:
        while True:
            try:
                process.wait(0.1)
                return
            except subprocess.TimeoutExpired:
                if self.deadline is not None and time.monotonic() > self.deadline:
                    raise ComputationError(
                        f"CalculiX took longer than the {self.timeout:g} s allowed"
                    ) from None
            stop_if(self.cancel)
            if watch is not None:
                watch()


@contextmanager
def ccx(
    threads: int = 1, timeout: float | None = None, cancel: Cancel | None = None
) -> Iterator[Ccx]:
    """Yield CalculiX in a temporary folder.

    Raises:
        InputError: it is not installed.
    """
    program = shutil.which("ccx")
    if program is None:
        raise InputError("CalculiX (ccx) was not found; on Debian: apt install calculix-ccx")
    folder = Path(tempfile.mkdtemp(prefix="simulearn-ccx-"))
    deadline = None if timeout is None else time.monotonic() + timeout
    try:
        yield Ccx(program, folder, threads, timeout, deadline, cancel)
    finally:
        if not os.environ.get("SIMULEARN_KEEP"):
            shutil.rmtree(folder, ignore_errors=True)

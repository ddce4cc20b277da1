"""Running CalculiX on a solid and reading its frames back.

CalculiX is a program of its own: it runs in a temporary folder, as a child that never outlives the
call. Set SIMULEARN_KEEP to keep the folder with deck, log and results.
"""

import os
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import ComputationError, InputError
from simulearn.fea.calculix.brick import matching
from simulearn.fea.calculix.deck import write_deck
from simulearn.fea.calculix.output import last_error, read_dat, read_sta
from simulearn.fea.calculix.schedule import Step, schedule
from simulearn.fea.solid import Solid
from simulearn.material import Material

Progress = Callable[[int, int], None]  # (frames done, frames in all)

FRAMES = 12
LAW = "st-venant-kirchhoff"
PARTS = (1, 2, 4)  # steps per tenth of release, the next tried where one does not converge


@dataclass(frozen=True, eq=False)
class CalculixFrames:
    """What CalculiX computed.

    Attributes:
        displacements: (12, N, 3) mm; frame 0 is zero.
        stress: (12, E, Q, 6) Cauchy stress at the solid's integration points, MPa, global axes,
            order 11 22 33 12 13 23; frame 0 is zero.
        record: `iterations` and `increments` of each frame, `parts`, `seconds`, `program`.
    """

    displacements: NDArray[np.float64]
    stress: NDArray[np.float64]
    record: dict[str, Any]


def calculix(
    solid: Solid,
    material: Material,
    *,
    law: str | None = None,
    progress: Progress | None = None,
    timeout: float | None = None,
    threads: int = 1,
) -> CalculixFrames:
    """Return the twelve frames of a solid, computed by CalculiX.

    Args:
        solid: the solid, one growth in each brick.
        material: its law's modulus and Poisson ratio, gravity and creep are used.
        law: the law if not the material's own; CalculiX has "st-venant-kirchhoff" with growth.
        progress: called with the frames done and the frames in all.
        timeout: most seconds to wait.
        threads: processors that CalculiX may use.

    Raises:
        InputError: CalculiX is not installed, or cannot compute this law or mesh.
        ComputationError: it did not converge, crashed or took too long.
    """
    if (law or material.law.kind) != LAW:
        raise InputError(
            f"CalculiX has no {law or material.law.kind} law with growth; it has {LAW}"
        )
    points = matching(solid.points)
    program = shutil.which("ccx")
    if program is None:
        raise InputError("CalculiX (ccx) was not found; on Debian: apt install calculix-ccx")
    begin = time.monotonic()
    folder = Path(tempfile.mkdtemp(prefix="simulearn-ccx-"))
    try:
        for parts in PARTS:
            steps = schedule(material, parts)
            write_deck(folder / "trial.inp", solid, material.law, steps)
            left = None if timeout is None else timeout - (time.monotonic() - begin)
            failure = _run([program, "-i", "trial"], folder, steps, progress, left, threads)
            if failure is None:
                break
        if failure is not None:
            raise failure
        displacements, stress = _frames(folder / "trial.dat", solid, steps)
        counts = _counts(folder / "trial.sta", steps)
    finally:
        if not os.environ.get("SIMULEARN_KEEP"):
            shutil.rmtree(folder, ignore_errors=True)
    record = counts | {"parts": parts, "seconds": time.monotonic() - begin, "program": program}
    return CalculixFrames(displacements, stress[:, :, points], record)


def _run(
    command: list[str],
    folder: Path,
    steps: Sequence[Step],
    progress: Progress | None,
    timeout: float | None,
    threads: int,
) -> ComputationError | None:
    """Run CalculiX to its end; return the error if it does not converge, raise any other."""
    (folder / "trial.sta").unlink(missing_ok=True)
    environment = os.environ | {"OMP_NUM_THREADS": str(threads)}
    deadline = None if timeout is None else time.monotonic() + timeout
    log = folder / "trial.log"
    with (
        log.open("w", encoding="utf-8") as stream,
        subprocess.Popen(
            command, cwd=folder, stdout=stream, stderr=subprocess.STDOUT, env=environment
        ) as process,
    ):
        try:
            _wait(process, folder, steps, progress, deadline)
        finally:
            process.kill()  # no effect on one that has ended; Ctrl-C must not leave it running
    done = read_sta(folder / "trial.sta")
    if process.returncode == 0 and "Job finished" in log.read_text(errors="replace"):
        return None
    step, increment = (done[-1][0], done[-1][1] + 1) if done else (1, 1)
    where = f"CalculiX stopped in step {step} of {len(steps)}, increment {increment}"
    message = last_error(log) or f"exit status {process.returncode}"
    error = ComputationError(f"{where}: {message}")
    if "increment" in message or "cutbacks" in message or "diverge" in message:
        return error
    raise error


def _wait(
    process: subprocess.Popen[bytes],
    folder: Path,
    steps: Sequence[Step],
    progress: Progress | None,
    deadline: float | None,
) -> None:
    told = 0
    while True:
        try:
            process.wait(0.2)
            return
        except subprocess.TimeoutExpired:
            if deadline is not None and time.monotonic() > deadline:
                raise ComputationError("CalculiX took longer than allowed") from None
        done = read_sta(folder / "trial.sta")
        # The step under way is not done; what stands before it is.
        frame = max([s.frame or 0 for s in steps[: done[-1][0] - 1]] or [0]) if done else 0
        if progress is not None and frame > told:
            told = frame
            progress(frame + 1, FRAMES)


def _frames(
    path: Path, solid: Solid, steps: Sequence[Step]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    moves, stresses = read_dat(path, len(solid.nodes), len(solid.bricks))
    if not len(moves) == len(stresses) == len(steps):
        raise ComputationError(f"CalculiX wrote {len(moves)} of {len(steps)} steps")
    kept = [k for k, step in enumerate(steps) if step.frame is not None]
    return tuple(  # type: ignore[return-value]
        np.stack([np.zeros_like(values[0]), *(values[k] for k in kept)])
        for values in (moves, stresses)
    )


def _counts(path: Path, steps: Sequence[Step]) -> dict[str, list[int]]:
    """Return iterations and increments that led to each frame."""
    iterations, increments = [0] * FRAMES, [0] * FRAMES
    frame = FRAMES
    of: list[int] = []
    for step in reversed(steps):  # a step without a frame belongs to the next one that has
        frame = frame if step.frame is None else step.frame
        of.insert(0, frame)
    for step_number, _, count in read_sta(path):
        iterations[of[step_number - 1]] += count
        increments[of[step_number - 1]] += 1
    return {"iterations": iterations, "increments": increments}

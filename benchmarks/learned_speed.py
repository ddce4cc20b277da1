"""How fast the learned models are that come with SimuLearn, and how exactly answers turn along.

All in one run: warm rollouts and cold commands beside those of the finite elements. Time is that
of one thread.

    python benchmarks/learned_speed.py
    with the environment of the Makefile's ONE_THREAD
"""

import os
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

from report import Report
from simulearn.grid import Rules, draw_valid
from simulearn.learn.common.bundle import bundle_of, shipped
from simulearn.learn.common.model import Designs, Model, last_frame
from simulearn.simulate import engine


def designs(count: int) -> Designs:
    """Return random 2x2 designs."""
    grids = [draw_valid(Rules(), 77, k)[0].centred for k in range(count)]
    return Designs(
        grids[0].beams,
        grids[0].fixed,
        np.stack([g.joints for g in grids]),
        np.stack([g.actuators for g in grids]),
    )


def warm(answer: Callable[[Designs], object], count: int) -> float:
    """Return the median seconds of answering so many designs, everything compiled."""
    batch = designs(count)
    answer(batch)
    spent = []
    for _ in range(max(9, 200 // count)):  # what is short is easily disturbed
        begun = time.perf_counter()
        answer(batch)
        spent.append(time.perf_counter() - begun)
    return float(np.median(spent))


def by_fea(count: int = 5) -> float:
    """Return the median seconds of one design by finite elements, everything compiled."""
    solver, spent = engine("fea"), []
    for k in range(count + 1):
        begun = time.perf_counter()
        solver.simulate([draw_valid(Rules(), 77, k)[0]])
        spent.append(time.perf_counter() - begun)
    return float(np.median(spent[1:]))


def cold(*words: str) -> float:
    """Return the seconds of the whole command, kernels compiled and kept before."""
    command = [sys.executable, "-m", "simulearn.cli", "simulate", "saddle", *words, "--json"]
    spent = []
    for _ in range(3):
        begun = time.perf_counter()
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, env=os.environ)
        spent.append(time.perf_counter() - begun)
    return min(spent)


def turned(model: Model) -> tuple[float, float]:
    """Return how far answers to turned and to mirrored designs are off, % of dimension."""
    sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "learn"))
    from conformance import mirrored_error, turned_error

    batch = designs(40)
    size = float(batch.dimensions.mean())
    return 100 * turned_error(model, batch) / size, 100 * mirrored_error(model, batch) / size


def main() -> None:
    """Measure all models."""
    report = Report("learned_speed", "Speed of the learned models")
    report.say(
        "2x2 designs; the median of nine (of two hundred single ones), everything compiled; the "
        "command is `simulearn simulate saddle`, the best of three, kernels kept from before. "
        "Beside that, how far the answer to a turned or mirrored design is from the turned or "
        "mirrored answer, and the bundle's size."
    )
    times = []
    for name in shipped():
        model = bundle_of(name).model
        off = turned(model)
        size = sum(f.stat().st_size for f in bundle_of(name).path.iterdir())
        times.append(
            (
                name,
                f"{1000 * warm(model.rollout, 1):.1f}",
                f"{1000 * warm(model.rollout, 100):.0f}",
                f"{1000 * warm(partial(last_frame, model), 100):.0f}",
                f"{cold('--engine', 'learned', '--model', name):.1f}",
                f"{off[0]:.1e}",
                f"{off[1]:.1e}",
                f"{size / 1e6:.1f}",
            )
        )
    fea = (f"{1000 * by_fea():.0f}", "", "", f"{cold('--engine', 'fea'):.1f}", "", "", "")
    times.append(("finite elements", *fea))
    report.table(
        [
            *("model", "one rollout, ms", "100 designs, ms", "their last frames, ms", "command, s"),
            *("turned, % of dimension", "mirrored, %", "MB"),
        ],
        times,
    )
    report.save()


if __name__ == "__main__":
    main()

"""How good and how fast the learned models are that come with SimuLearn.

Accuracy is measured on the test trials of the data set that a model has learnt from, and on sets
of other topologies where they are there; the truth is always the finite elements'. Time is
that of one thread.

    python benchmarks/learned.py [--data data/default.h5 data/3x3.h5 ...]
"""

import argparse
import os
import subprocess
import sys
import time
from pathlib import Path

import jax
import numpy as np

from report import Report
from simulearn.dataset import read_dataset
from simulearn.grid import Rules, draw_valid
from simulearn.learn.bundle import bundle_of, shipped
from simulearn.learn.evaluate import evaluate, for_testing
from simulearn.learn.model import Designs, Model, last_frame
from simulearn.simulate import engine

SETS = ("default", "beams-removed", "2x3", "3x3")
PAPER = ("the paper's (its own FEA)", "default", 400, "3.03", "", "4.13", "", "2.89", *[""] * 4)


def designs(count: int) -> Designs:
    """Return random 2x2 designs."""
    grids = [draw_valid(Rules(), 77, k)[0].centred for k in range(count)]
    return Designs(
        grids[0].beams,
        grids[0].fixed,
        np.stack([g.joints for g in grids]),
        np.stack([g.actuators for g in grids]),
    )


def warm(model: Model, count: int, times: int = 9) -> float:
    """Return the median seconds of answering so many designs, everything compiled."""
    asked = designs(count)
    model.rollout(asked)
    spent = []
    for _ in range(times):
        begun = time.perf_counter()
        model.rollout(asked)
        spent.append(time.perf_counter() - begun)
    return float(np.median(spent))


def warm_last(model: Model, count: int, times: int = 9) -> float:
    """Return the median seconds of telling the last frame of so many designs."""
    asked = designs(count)
    last_frame(model, asked)
    spent = []
    for _ in range(times):
        begun = time.perf_counter()
        last_frame(model, asked)
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

    asked = designs(40)
    size = float(asked.dimensions.mean())
    return 100 * turned_error(model, asked) / size, 100 * mirrored_error(model, asked) / size


def main() -> None:
    """Measure all models on all sets that are there."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    files = [Path("data") / f"{name}.h5" for name in SETS]
    parser.add_argument("--data", nargs="*", type=Path, default=[f for f in files if f.exists()])
    sets = parser.parse_args().data

    report = Report("learned", "Learned models")
    rows: list[tuple[object, ...]] = [PAPER]
    still: list[str] = []
    frames: dict[str, list[dict[str, float]]] = {}
    for path in sets:
        data = read_dataset(path, stress=False)
        batches = for_testing(data)
        for name in shipped():
            jax.clear_caches()  # each topology has its kernels, and memory maps are not endless
            e = evaluate(bundle_of(name).model, batches).errors
            s = e.summary()
            rows.append(
                (
                    name,
                    data.config.name,
                    s["trials"],
                    *(f"{s[k]:.2f}" for k in ("mean_percent", "median_percent", "p97_percent")),
                    f"{s['worst_percent']:.2f}",
                    f"{s['mean_mm']:.2f}",
                    f"{s['rotation_deg']:.2f}",
                    f"{s['gap_mm']:.3f}",
                    "" if e.bound is None else f"{100 * (e.vertex[:, -1] <= e.bound).mean():.0f}",
                    int((~e.converged).sum()),
                )
            )
            if path == sets[0]:
                frames[name] = s["frames"]
        still.append(f"{data.config.name} {100 * float((e.motion / e.dimension).mean()):.1f}")
    report.say(
        "Mean distance of all corners of joints and sections in the last frame, % of each trial's "
        "grid dimension; joints' rotation error and the gap between joints and beams likewise "
        "in the last frame. A model that moves nothing would be off by, in %: "
        + ", ".join(still)
        + "."
    )
    report.table(
        ["model", "set", "trials", "mean", "median", "97 %", "worst", "mm", "deg", "gap mm",
         "below their 90 % bound, %", "no answer"],
        rows,
    )  # fmt: skip
    report.say("Frame by frame, mean (97th percentile), % of dimension, on the first set:")
    report.table(
        ["model", *map(str, range(12))],
        [
            (name, *(f"{f['mean_percent']:.2f} ({f['p97_percent']:.2f})" for f in told))
            for name, told in frames.items()
        ],
    )
    report.say("Time of one thread, and how far an answer is from turning with its design:")
    times = []
    for name in shipped():
        model = bundle_of(name).model
        off = turned(model)
        size = sum(f.stat().st_size for f in bundle_of(name).path.iterdir())
        times.append(
            (
                name,
                f"{1000 * warm(model, 1):.1f}",
                f"{1000 * warm(model, 100):.0f}",
                f"{1000 * warm_last(model, 100):.0f}",
                f"{cold('--engine', 'learned', '--model', name):.1f}",
                f"{off[0]:.2f}",
                f"{off[1]:.2f}",
                f"{size / 1e6:.1f}",
            )
        )
    fea = (f"{1000 * by_fea():.0f}", "", "", f"{cold('--engine', 'fea'):.1f}", "0", "0", "")
    times.append(("finite elements", *fea))
    report.table(
        [
            *("model", "one rollout, ms", "100 designs, ms", "their last frames, ms", "command, s"),
            *("turned, %", "mirrored, %", "MB"),
        ],
        times,
    )  # fmt: skip
    report.save()


if __name__ == "__main__":
    main()

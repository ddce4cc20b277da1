"""How good the learned models are that come with SimuLearn.

Accuracy is measured on the test trials of the data set that a model has learnt from, and on sets
of other topologies where they are there; the reference is always the finite elements'. Speed is
measured by `learned_speed.py`.

    python benchmarks/learned.py [--data data/default.h5 data/3x3.h5 ...]
"""

import argparse
from pathlib import Path

import jax

from report import Report
from simulearn.dataset import read_dataset
from simulearn.learn.common.bundle import bundle_of, shipped
from simulearn.learn.common.evaluate import evaluate, for_testing

SETS = ("default", "beams-removed", "2x3", "3x3")
PAPER = ("the paper's (its own FEA)", "default", 400, "3.03", "", "4.13", "", "2.89", *[""] * 4)


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
            (name, *(f"{f['mean_percent']:.2f} ({f['p97_percent']:.2f})" for f in per_frame))
            for name, per_frame in frames.items()
        ],
    )
    report.save()


if __name__ == "__main__":
    main()

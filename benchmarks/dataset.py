"""Measure the generation and the reading of data sets.

python benchmarks/dataset.py [--trials 80] [--workers 2] [--packed data/default.h5]
"""

import argparse
import json
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from report import Report
from simulearn.dataset import generate, local_workers, pack, read_config, read_dataset

OTHERS = ("beams-removed", "2x3", "3x3")


def main() -> None:
    """Generate, pack, read, and report."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--trials", type=int, default=80)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--packed", type=Path, default=Path("data/default.h5"))
    options = parser.parse_args()
    config = read_config("default").model_copy(update={"trials": options.trials})
    report = Report("dataset", "Data sets")
    with TemporaryDirectory() as folder:
        team = local_workers(options.workers)
        begun, warm = time.perf_counter(), []

        def progress(tally) -> None:
            # Workers start and load their kernels with their first trials.
            if tally.done == 2 * options.workers and not warm:
                warm.append((time.perf_counter(), tally.seconds, tally.done))

        tally = generate(config, folder, team, progress)
        ended = time.perf_counter()
        since, seconds, before = warm[0]
        rate = 60 * (tally.done - before) / (ended - since)
        share = (tally.seconds - seconds) / (options.workers * (ended - since))
        report.say(
            f"{options.trials} trials of the default set by {options.workers} workers, "
            "`simulearn dataset generate default`:"
        )
        report.table(
            ["what", "measured", "wanted"],
            [
                ["trials a minute, after the workers have started", f"{rate:.0f}", "40"],
                [
                    "trials a minute, with their start",
                    f"{60 * tally.done / (ended - begun):.0f}",
                    "",
                ],
                ["overhead over the bare solver", f"{100 * (1 - share):.1f} %", "< 5 %"],
                ["failed", tally.failed, ""],
            ],
        )
        packed = Path(folder) / "x.h5"
        pack(folder, packed)
        report.say(f"Packed: {packed.stat().st_size / tally.done / 1000:.1f} kB a trial.")
    if options.packed.exists():
        begun = time.perf_counter()
        data = read_dataset(options.packed, "train")
        whole = time.perf_counter() - begun
        begun = time.perf_counter()
        read_dataset(options.packed, "train", stress=False)
        less = time.perf_counter() - begun
        report.say(
            f"`{options.packed}` ({options.packed.stat().st_size / 1e6:.1f} MB; wanted: < 80): "
            f"{len(data):,} training trials are read in {whole:.2f} s, {less:.2f} s without stress "
            "(wanted: < 3 s)."
        )
    rows = []
    for name in ("default", *OTHERS):
        path = options.packed.with_name(f"{name}.h5")
        if path.exists():
            rows.append(_row(name, path))
    if rows:
        report.say("The sets:")
        report.table(
            [
                "set", "trials", "failed", "redrawn", "halved", "unstable", "iterations, median",
                "dimension, mean (3 %, 97 %), mm", "net beam, mean (3 %, 97 %), mm",
                "motion, % of dimension", "MB",
            ],
            rows,
        )  # fmt: skip
        report.say(
            "The paper's: dimension 94.44 (65.64; 124.39 at 96 %), beams 51.29 (23.11, 80.19)."
        )
    report.save()


def _row(name: str, path: Path) -> list[object]:
    from simulearn.dataset.statistics import summary

    figures = json.loads(json.dumps(summary(read_dataset(path, stress=False))))
    size, beam, motion = (
        figures["quantities"][key] for key in ("dimension", "net_length", "motion_percent")
    )

    def spread(quantity: dict[str, float]) -> str:
        return "{mean:.2f} ({p3:.2f}, {p97:.2f})".format(**quantity)

    return [
        name, figures["trials"], figures["failed"], figures["redrawn"], figures["halved"],
        figures["unstable"], f"{figures['iterations']['median']:.0f}", spread(size), spread(beam),
        f"{motion['mean']:.1f}", f"{path.stat().st_size / 1e6:.1f}",
    ]  # fmt: skip


if __name__ == "__main__":
    main()

"""How many answers one search gives that are good and truly differ, and how long that takes.

The tasks are those of benchmarks/inverse.py: the nine joint centres of a random design's shape by
finite elements, beginning with a flat grid. Each is searched once for one answer and once for
several, with the same limits. What is done is kept in a file, so the benchmark can be stopped and
goes on. All times and limits are of the processor, whatever else the machine does: checks that run
at once count one after the other.

    python benchmarks/answers.py [--tasks 10] [--answers 5] [--seconds 15] [--out out/answers]
    with the environment of the Makefile's ONE_THREAD
"""

import argparse
import json
import time
from pathlib import Path
from typing import Any

time.monotonic = time.process_time  # before a search takes its clock from there

# ruff: noqa: E402
import numpy as np
from matplotlib.figure import Figure

from inverse import LENGTH, PICTURES, SEED, WANTED, task_of
from report import Report
from simulearn.grid import Rules, draw_valid
from simulearn.inverse import Space, optimize
from simulearn.inverse.archive import LEAST, Distance
from simulearn.inverse.keeping import ANSWERS
from simulearn.show import style
from simulearn.simulate import engine

GREEN, GREY = "#009e73", "#a6a6a6"


def run(targets: np.ndarray, seconds: float, answers: int) -> dict[str, Any]:
    """Return what a search with so many answers makes of a task."""
    task = task_of(targets, "default", seconds)
    limits = task.limits.model_copy(update={"answers": answers})
    task = task.model_copy(update={"limits": limits})
    found = optimize(task)
    check = found.check
    assert check is not None
    distance = Distance.of(Space.of(task.start, task.free))
    grids = [one.grid for one in found.answers]
    return {
        "error_mm": check.error_mm,
        "error_fea_mm": check.error_fea_mm,
        "seconds": found.seconds,
        "first_seconds": [s.seconds for s in found.steps if s.phase != ANSWERS][-1],
        "designs": found.designs,
        "answers": [{k: v for k, v in a.to_dict().items() if k != "grid"} for a in found.answers],
        "distances": [[distance.between(a, b) for b in grids] for a in grids],
    }


def measure(tasks: int, seconds: float, answers: int, folder: Path) -> list[dict[str, Any]]:
    """Return both runs of each task, which are kept in files."""
    folder.mkdir(parents=True, exist_ok=True)
    rows = []
    for k in range(tasks):
        path = folder / f"targets-{k}.json"
        if not path.exists():
            (result,) = engine("fea").simulate([draw_valid(Rules(), SEED, k)[0]])
            path.write_text(json.dumps(result.centres[-1].tolist()), "utf-8")
        targets = np.array(json.loads(path.read_text("utf-8")))
        row: dict[str, Any] = {}
        for name, count in (("one", 1), ("several", answers)):
            path = folder / f"{name}-{count}-{seconds:g}s-{k}.json"
            if not path.exists():
                path.write_text(json.dumps(run(targets, seconds, count)), "utf-8")
            row[name] = json.loads(path.read_text("utf-8"))
            print(k, name, row[name]["error_fea_mm"], row[name]["seconds"], flush=True)
        rows.append(row)
    return rows


def error(answer: dict[str, Any]) -> float:
    """Return the error of an answer by finite elements, by the engine where they had no time."""
    fea = answer["error_fea_mm"]
    return float(answer["error_mm"] if fea is None else fea)


def table_row(k: int, row: dict[str, Any]) -> list[str]:
    """Return the figures of a task."""
    one, several = row["one"], row["several"]
    answers = several["answers"]
    away = np.array(several["distances"])
    apart = away[np.triu_indices(len(away), 1)]
    errors = [error(answer) for answer in answers]
    lengths = [answer["actuator_mm"] for answer in answers]
    good = [m for e, m in zip(errors, lengths, strict=True) if e <= WANTED]
    return [
        str(k),
        f"{error(one):.2f}",
        f"{errors[0]:.2f}",
        f"{sum(e <= WANTED for e in errors)} of {len(errors)}",
        f"{max(errors):.2f}",
        f"{apart.min():.2f} / {apart.mean():.2f}" if len(apart) else "",
        f"{lengths[0]:.0f} / {min(good, default=np.nan):.0f}",
        f"{one['seconds']:.0f}",
        f"{several['seconds']:.0f}",
    ]


def picture(rows: list[dict[str, Any]]) -> Figure:
    """Return the errors of all answers against the length of their actuators, task by task."""
    figure = Figure(figsize=(7.2, 3.2), dpi=style.DPI, layout="constrained")
    across = -(-len(rows) // 2)
    axes = figure.subplots(2, across, sharey=True, squeeze=False)
    for ax in axes.flat[len(rows) :]:
        ax.axis("off")
    for k, (ax, row) in enumerate(zip(axes.flat, rows, strict=False)):
        answers = row["several"]["answers"]
        errors, lengths = [error(a) for a in answers], [a["actuator_mm"] for a in answers]
        faces = [GREEN if a["on_front"] else "white" for a in answers]
        ax.axhline(error(row["one"]), color=GREY, lw=0.8, ls="--")
        ax.scatter(lengths, errors, s=16, c=faces, edgecolors=GREEN, linewidths=0.9, zorder=2)
        ax.set_title(f"task {k}", fontsize=7, loc="left")
        ax.tick_params(labelsize=6)
        ax.spines[["top", "right"]].set_visible(False)
    most = max(error(answer) for row in rows for answer in row["several"]["answers"])
    axes[0, 0].set_ylim(0, 1.08 * most)
    figure.supylabel("error by finite elements, mm", fontsize=8)
    figure.supxlabel("length of the actuators, mm", fontsize=8)
    return style.ink(figure)


def main() -> None:
    """Measure and report."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--tasks", type=int, default=10)
    parser.add_argument("--answers", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=15.0)
    parser.add_argument("--out", type=Path, default=Path("out/answers"))
    given = parser.parse_args()
    rows = measure(given.tasks, given.seconds, given.answers, given.out)

    report = Report("answers", "Several answers")
    report.say(
        f"{given.tasks} reachable tasks: targets are the nine joint centres of random designs "
        f"(seed {SEED}) by finite elements, the start is a flat grid of {LENGTH:g} mm beams, the "
        f"engine is the default model. Each is searched once for one answer and once for "
        f"{given.answers}, with the limit of {given.seconds:g} s, after which other answers may "
        "take twice as long again; times are of one core of the processor. Errors are means over "
        "the nine goals, by finite elements."
    )
    head = ["task", "one answer, mm", "best of several, mm", f"within {WANTED:g} mm", "worst, mm"]
    head += ["distance, least / mean", "actuators of the best / least, mm"]
    head += ["one answer, s", "several, s"]
    report.table(head, [table_row(k, row) for k, row in enumerate(rows)])
    every = [error(answer) for row in rows for answer in row["several"]["answers"]]
    unchecked = sum(a["error_fea_mm"] is None for r in rows for a in r["several"]["answers"])
    ratio = [row["several"]["seconds"] / row["one"]["seconds"] for row in rows]
    gains = [error(row["one"]) - error(row["several"]) for row in rows]
    no_worse, better = sum(g >= -0.05 for g in gains), sum(g > 0.05 for g in gains)
    report.say(
        f"{sum(e <= WANTED for e in every)} of {len(every)} answers come within {WANTED:g} mm "
        f"({unchecked} had no time for their check by finite elements and count by the model). "
        f"Several answers take {np.median(ratio):.1f} times as long as one in the median, "
        f"{max(ratio):.1f} times at most. The best of several is no worse than the one answer in "
        f"{no_worse} of {len(rows)} tasks (to .05 mm), and better in {better}. Two answers of a "
        f"task are at least {LEAST:g} apart: ratios on average, plus joints in lengths of a beam."
    )
    report.say("![answers](../pictures/answers-front.png)")
    report.say("Dashed: the one answer. Filled: on the front of all four costs.")
    report.save()
    picture(rows).savefig(PICTURES / "answers-front.png")


if __name__ == "__main__":
    main()

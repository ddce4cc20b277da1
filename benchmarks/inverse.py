"""How close methods of inverse design come to shapes that can be reached, and how fast.

Each task asks for the nine joint centres of a random design's shape by finite elements and begins
with a flat grid of equal beams. Every answer is checked by finite elements. What is done is kept in
a file, so the benchmark can be stopped and goes on.

    python benchmarks/inverse.py [--tasks 30] [--few 10] [--seconds 30] [--out out/inverse]
    with the environment of the Makefile's ONE_THREAD
"""

import argparse
import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from report import Report
from simulearn.grid import Rules, draw_valid, grid_to_dict, make
from simulearn.inverse import optimize, rank, task_from_dict
from simulearn.inverse.goals import Goals
from simulearn.inverse.gradient import fitting_slopes
from simulearn.inverse.space import Space
from simulearn.inverse.task import Free, Task
from simulearn.learn.equilibrium.slopes import Slopes
from simulearn.show import style
from simulearn.simulate import engine

SEED = 700  # no data set is drawn from it
LENGTH = 60.0  # mm, of the beams to begin with
WANTED = 1.5  # mm
TIGHT = 1e-9  # mm, tolerance of simulations whose differences are taken
METHODS = ("default", "brute-force", "gradient", "cma")
COLOURS = {"default": "#009e73", "brute-force": "#262626", "gradient": "#d55e00", "cma": "#0072b2"}
PICTURES = Path(__file__).parent.parent / "docs" / "pictures"


def task_of(targets: np.ndarray, method: str, seconds: float) -> Task:
    """Return the task of targets (9, 3) mm for the joint centres."""
    goals = [
        {"vertex": ["joint", k, "centre"], "target": place}
        for k, place in enumerate(targets.tolist())
    ]
    return task_from_dict(
        {
            "schema": "simulearn.task/1",
            "grid": grid_to_dict(make("flat", length=LENGTH)),
            "goals": goals,
            "method": method,
            "limits": {"seconds": seconds},
        }
    )


def run(targets: np.ndarray, method: str, seconds: float) -> dict[str, Any]:
    """Return what a method makes of a task."""
    found = optimize(task_of(targets, method, seconds))
    assert found.check is not None
    return {
        "error_mm": found.error_mm,
        "error_fea_mm": found.check.error_fea_mm,
        "apart_mm": found.check.apart_mm,
        "designs": found.designs,
        "iterations": found.iterations,
        "seconds": found.seconds,
        "phases": found.steps[-1].phase,
        "curve": [[step.seconds, step.designs, step.error_mm] for step in found.steps],
    }


def measure(tasks: int, few: int, seconds: float, folder: Path) -> dict[str, dict[str, Any]]:
    """Run all methods, one file for each run."""
    folder.mkdir(parents=True, exist_ok=True)
    runs: dict[str, dict[str, Any]] = {method: {} for method in METHODS}
    for k in range(tasks):
        path = folder / f"targets-{k}.json"
        if not path.exists():
            fine = engine("fea", mesh="fine")  # by which answers are checked
            (result,) = fine.simulate([draw_valid(Rules(), SEED, k)[0]])
            path.write_text(json.dumps(result.centres[-1].tolist()), "utf-8")
        targets = np.array(json.loads(path.read_text("utf-8")))
        for method in METHODS[: 4 if k < few else 2]:
            path = folder / f"{method}-{seconds:g}s-{k}.json"
            if not path.exists():
                path.write_text(json.dumps(run(targets, method, seconds)), "utf-8")
            runs[method][str(k)] = row = json.loads(path.read_text("utf-8"))
            print(
                k, method, {x: row[x] for x in ("error_mm", "error_fea_mm", "seconds")}, flush=True
            )
    return runs


def ranking() -> tuple[int, float, float]:
    """Return how many modifications a ranking scores, and its median and best time, ms."""
    targets = engine("learned").simulate([make("saddle", length=LENGTH)])[0].centres[-1]
    task, learned = task_of(targets, "default", 1.0), engine("learned")
    spent = []
    for _ in range(12):
        begun = time.perf_counter()
        found = rank(task, learned)
        spent.append(1000 * (time.perf_counter() - begun))
    return len(found.suggestions), float(np.median(spent[2:])), min(spent)


def slope_error() -> float:
    """Return the largest relative distance of the error's gradient from central differences."""
    model = engine("learned").bundle.model
    worst = 0.0
    for k in range(3):
        grid = draw_valid(Rules(), SEED, k)[0].centred
        goals = Goals.centres(np.c_[grid.joints, np.full(len(grid.joints), 8.0)])
        space = Space.of(grid, Free())
        x, a = space.start

        def ask(x: np.ndarray, a: np.ndarray, space: Space = space, goals: Goals = goals) -> Slopes:
            return fitting_slopes(model, space.designs(x[None], a[None]), goals, tolerance=TIGHT)

        def along(
            u: np.ndarray, v: np.ndarray, h: float, x: np.ndarray = x, a: np.ndarray = a
        ) -> float:
            return _slope(lambda t: float(ask(x + t * u, a + t * v).cost[0]), h)

        slope = ask(x, a)
        free = np.flatnonzero((a != 0) & (np.abs(a) < 1))  # where a step to either side is smooth
        own = np.r_[np.einsum("pjc,jc->p", space.motions, slope.flat[0]), slope.actuators[0][free]]
        differences = [along(u, 0 * a, 0.1) for u in np.eye(len(x))]
        differences += [along(0 * x, v, 0.003) for v in np.eye(len(a))[free]]
        worst = max(worst, float(np.linalg.norm(own - differences) / np.linalg.norm(own)))
    return worst


def _slope(f: Callable[[float], float], h: float) -> float:
    """Return the derivative of f at 0 by central differences of fourth order.

    Steps are wide, since the networks' single precision makes costs rough.
    """
    return (8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h)


def curves(runs: dict[str, dict[str, Any]], seconds: float) -> Figure:
    """Return the median error against time and against designs, methods side by side."""
    figure = Figure(figsize=(7.2, 2.8), dpi=style.DPI, layout="constrained")
    axes = figure.subplots(1, 2, sharey=True)
    most = max(r["designs"] for results in runs.values() for r in results.values())
    for ax, column, label, stop in (
        (axes[0], 0, "seconds", seconds),
        (axes[1], 1, "designs simulated", most),
    ):
        at = np.linspace(0.0, stop, 400) if column == 0 else np.geomspace(1, stop, 400)
        for method, results in runs.items():
            if results:
                lines = [_stepped(np.array(r["curve"]), column, at) for r in results.values()]
                ax.plot(at, np.median(lines, axis=0), color=COLOURS[method], lw=1.4, label=method)
                low, high = np.percentile(lines, [25, 75], axis=0)
                ax.fill_between(at, low, high, color=COLOURS[method], alpha=0.12, lw=0)
        ax.axhline(WANTED, color=style.INK, lw=0.6, ls=":")
        ax.set_yscale("log")
        ax.yaxis.set_major_formatter("{x:g}")
        ax.set_xlabel(label, fontsize=8)
        ax.spines[["top", "right"]].set_visible(False)
        ax.tick_params(which="both", labelsize=7)
    axes[1].set_xscale("log")
    axes[0].set_ylabel("median fitting error, mm", fontsize=8)
    axes[0].legend(frameon=False, fontsize=7)
    return style.ink(figure)


def _stepped(curve: np.ndarray, column: int, at: np.ndarray) -> np.ndarray:
    place = np.searchsorted(curve[:, column], at, side="right") - 1
    return np.maximum(np.minimum.accumulate(curve[:, 2]), 0.01)[np.maximum(place, 0)]


def main() -> None:
    """Measure and report."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--tasks", type=int, default=30)
    parser.add_argument("--few", type=int, default=10, help="tasks for gradient and cma")
    parser.add_argument("--seconds", type=float, default=30.0)
    parser.add_argument("--out", type=Path, default=Path("out/inverse"))
    options = parser.parse_args()
    runs = measure(options.tasks, options.few, options.seconds, options.out)

    report = Report("inverse", "Inverse design")
    report.say(
        f"{options.tasks} reachable tasks (gradient and cma: the first {options.few}): targets are "
        f"the nine joint centres of random designs (seed {SEED}) by the fine mesh, the start is a "
        f"flat grid of {LENGTH:g} mm beams, the engine is the default model, the limit is "
        f"{options.seconds:g} s with all checks. A search that comes to .08 mm stops. Errors are "
        f"means over the nine goals, after the check by the same mesh; wanted are {WANTED:g} mm."
    )
    rows = []
    for method, results in runs.items():
        if not results:
            continue
        errors = np.array([r["error_fea_mm"] for r in results.values()], float)
        own = np.array([r["error_mm"] for r in results.values()])
        rows.append(
            [
                method,
                f"{np.median(errors):.2f}",
                f"{errors.mean():.2f}",
                f"{errors.max():.2f}",
                f"{np.median(own):.2f}",
                f"{(errors <= WANTED).sum()} of {len(errors)}",
                f"{(errors <= 0.5).sum()} of {len(errors)}",
                f"{np.median([r['seconds'] for r in results.values()]):.1f}",
                f"{np.median([r['designs'] for r in results.values()]):.0f}",
            ]
        )
    head = ["method", "median, mm", "mean", "worst", "median by the engine"]
    report.table([*head, f"to {WANTED:g} mm", "to 0.5 mm", "seconds", "designs"], rows)
    report.say("![curves](../pictures/inverse-curves.png)")
    count, median, best = ranking()
    report.say(
        f"Ranking {count} modifications of a 2x2 grid, warm: {median:.0f} ms in the median, "
        f"{best:.0f} ms at best (paper: 2 s)."
    )
    report.say(
        f"The error's gradient by joints and ratios differs from central differences by "
        f"{slope_error():.1e} of its size at most (3 designs)."
    )
    report.save()
    curves(runs, options.seconds).savefig(PICTURES / "inverse-curves.png")


if __name__ == "__main__":
    main()

"""Simulate random designs by the rules of the paper, and count what fails.

python benchmarks/designs.py [--designs 300] [--processes 2]
"""

import argparse
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np

from report import Report
from simulearn.errors import ComputationError
from simulearn.fea import simulate_grid
from simulearn.grid import Rules, draw, validate
from simulearn.material import load_material

SEED = 300
Figures = tuple[int, str, bool, int, int, float, float, int, float]


def one(k: int) -> Figures:
    """Simulate design k.

    Returns:
        its number, what happened, stability, iterations, halvings, span, motion, snaps and
        processor seconds.
    """
    material = load_material("pla-hot-water")
    grid = draw(Rules(), SEED, k)
    errors = validate(grid, material).errors
    if errors:
        return k, f"rejected: {errors[0].code}", True, 0, 0, 0.0, 0.0, 0, 0.0
    begun = time.process_time()
    try:
        trial = simulate_grid(grid, material)
    except ComputationError as error:
        return k, f"failed: {error}", True, 0, 0, grid.dimension, 0.0, 0, 0.0
    moved = float(np.linalg.norm(trial.joints[11] - trial.joints[0], axis=-1).mean())
    return (
        k,
        "converged",
        trial.stable,
        sum(trial.record["iterations"]),
        trial.record["halved"],
        grid.dimension,
        moved,
        len(trial.snaps),
        time.process_time() - begun,
    )


def main() -> None:
    """Run the designs and report."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--designs", type=int, default=300)
    parser.add_argument("--processes", type=int, default=2)
    options = parser.parse_args()
    with ProcessPoolExecutor(options.processes, get_context("spawn")) as pool:
        list(pool.map(one, range(options.processes)))  # compiled
        begun = time.perf_counter()
        results = []
        for result in pool.map(one, range(options.designs)):
            results.append(result)
            if not result[1].startswith("converged"):
                print(*result, flush=True)
        wall = time.perf_counter() - begun
    done = [r for r in results if r[1] == "converged"]
    report = Report("designs", "Random designs")
    counts = {
        what: sum(r[1].split(":")[0] == what for r in results)
        for what in ("converged", "rejected", "failed")
    }
    report.say(
        f"{options.designs} random 2x2 designs (seed {SEED}), {options.processes} processes:"
    )
    report.table(["converged", "rejected by validation", "failed"], [list(counts.values())])
    report.say(
        f"{60 * len(done) / wall:.0f} trials of 12 frames a minute; a trial takes "
        f"{np.mean([r[8] for r in done]):.2f} s of a processor, which is "
        f"{60 * options.processes / np.mean([r[8] for r in done]):.0f} a minute on as many cores "
        "without other work; "
        f"iterations a trial: median {np.median([r[3] for r in done]):.0f}, "
        f"most {max(r[3] for r in done)}; trials with a halved increment: "
        f"{sum(r[4] > 0 for r in done)}; with an unstable frame: "
        f"{sum(not r[2] for r in done)}; that snap: {sum(r[7] > 0 for r in done)}; "
        "mean grid dimension "
        f"{np.mean([r[5] for r in done]):.1f} mm, "
        f"mean motion of the joints {np.mean([100 * r[6] / r[5] for r in done]):.1f} % of it."
    )
    for r in results:
        if not r[1].startswith("converged"):
            report.say(f"- design {r[0]}: {r[1]}")
    report.save()


if __name__ == "__main__":
    main()

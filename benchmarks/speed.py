"""How long a trial takes, beside CalculiX on one thread each, and from a cold start.

Both solve the same designs with the same law (St Venant-Kirchhoff, which CalculiX has with exact
growth); the error of each mesh is the distance to a mesh of 3,648 bricks.

    make bench, or python benchmarks/speed.py [--designs 1] with the environment of its ONE_THREAD
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time

import numpy as np

from against_calculix import material
from mesh_study import REFERENCE
from report import Report
from simulearn.fea import COARSE, Layout, simulate_grid
from simulearn.fea.calculix import simulate_grid as by_calculix
from simulearn.grid import Rules, draw_valid

THREE, FOUR_SLABS = Layout(core=1), Layout(core=1, slabs=4)
RUNS = {
    "ours, one brick across (default)": (simulate_grid, COARSE),
    "ours, three across, 4 slabs": (simulate_grid, FOUR_SLABS),
    "ours, three across, 8 slabs": (simulate_grid, THREE),
    "CalculiX, three across, 4 slabs": (by_calculix, FOUR_SLABS),
    "CalculiX, three across, 8 slabs": (by_calculix, THREE),
}


def cold(folder: str) -> float:
    """Return the seconds of `simulearn simulate saddle` with compiled kernels kept in a folder."""
    environment = {k: v for k, v in os.environ.items() if k not in ("XLA_FLAGS", "OMP_NUM_THREADS")}
    environment["JAX_COMPILATION_CACHE_DIR"] = folder
    environment["JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS"] = "0.2"
    begun = time.perf_counter()
    command = [sys.executable, "-m", "simulearn.cli", "simulate", "saddle", "--json"]
    subprocess.run(command, env=environment, check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - begun


def main() -> None:
    """Time everything in one run."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--designs", type=int, default=1)
    designs = parser.parse_args().designs

    with tempfile.TemporaryDirectory() as folder:
        starts = [cold(folder) for _ in range(3)]
    law = material("st-venant-kirchhoff")
    own = material("marlow")
    seconds: dict[str, list[float]] = {name: [] for name in RUNS}
    errors: dict[str, list[float]] = {name: [] for name in RUNS}
    marlow = []
    for k in range(designs):
        grid, _ = draw_valid(Rules(), 42, k)
        for layout in (COARSE, FOUR_SLABS, THREE):
            simulate_grid(grid, law, layout)  # compiled
        simulate_grid(grid, own)
        marlow.append(simulate_grid(grid, own).seconds)
        truth = simulate_grid(grid, law, REFERENCE).joints[-1]
        for name, (solver, layout) in RUNS.items():
            trial = solver(grid, law, layout)
            seconds[name].append(trial.seconds)
            away = np.linalg.norm(trial.joints[-1] - truth, axis=-1).mean()
            errors[name].append(float(100 * away / grid.dimension))
            print(name, seconds[name][-1], errors[name][-1], flush=True)

    base = np.mean(seconds["ours, one brick across (default)"])
    report = Report("speed", "Speed")
    report.say(
        f"{designs} random designs, twelve frames, one thread each, side by side in one run; error "
        "is the mean distance of the last frame's joint corners to a mesh of 3,648 bricks, "
        "% of the grid's dimension."
    )
    report.table(
        ["solver and mesh", "error", "seconds", "ratio"],
        [
            (
                name,
                f"{np.mean(errors[name]):.3f}",
                f"{np.mean(seconds[name]):.2f}",
                f"{np.mean(seconds[name]) / base:.1f}",
            )
            for name in RUNS
        ],
    )
    report.say(
        f"With the Marlow law of PLA a trial takes {np.mean(marlow):.2f} s on one thread. "
        f"`simulearn simulate saddle` from a cold start, nothing compiled: {starts[0]:.1f} s; with "
        f"compiled kernels kept: {min(starts[1:]):.1f} s."
    )
    report.save()


if __name__ == "__main__":
    main()

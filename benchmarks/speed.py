"""How long a trial takes: beside CalculiX, beside another checkout, and from a cold start.

Both solvers take the same designs with the same law (St Venant-Kirchhoff, which CalculiX has with
exact growth), one thread each; the error of each mesh is the distance to a mesh of 3,648 bricks.
With --before FOLDER the same trials run with that checkout of SimuLearn, in turns.

    make bench, or python benchmarks/speed.py [--designs 1] [--before FOLDER] with the environment
    of its ONE_THREAD
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

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


TRIALS = 12  # random designs timed with each checkout

# Runs with any checkout: processor seconds of trials, and of topologies not met before.
PROGRAM = """
import json, time
from simulearn.fea import simulate_grid
from simulearn.grid import Rules, draw_valid, drop_beams, make
from simulearn.material import load_material

material = load_material("pla-hot-water")

def seconds(grid):
    begun = time.process_time()
    simulate_grid(grid, material)
    return time.process_time() - begun

first = seconds(make("saddle"))
known = [seconds(draw_valid(Rules(), 4242, k)[0]) for k in range(%d)]
new = []
for grid in (drop_beams(make("saddle"), [0, 5]), drop_beams(make("saddle"), [0, 10])):
    new.append([seconds(grid), seconds(grid)])
print(json.dumps({"first": first, "known": known, "new": new}))
"""


def cold(folder: str) -> float:
    """Return the seconds of `simulearn simulate saddle` with compiled kernels kept in a folder."""
    environment = {**os.environ, "XDG_CACHE_HOME": folder}
    begun = time.perf_counter()
    command = [sys.executable, "-m", "simulearn.cli", "simulate", "saddle", "--json"]
    subprocess.run(command, env=environment, check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - begun


def trials(checkout: Path, folder: str) -> dict[str, Any]:
    """Return the processor seconds of trials with a checkout, see PROGRAM."""
    environment = {
        **os.environ,
        "PYTHONPATH": str(checkout / "src"),
        "XDG_CACHE_HOME": folder,
        "JAX_COMPILATION_CACHE_DIR": folder,
        "JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS": "0.2",
    }
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM % TRIALS],
        env=environment,
        check=True,
        capture_output=True,
        text=True,
    )
    return json.loads(done.stdout.splitlines()[-1])


def compare(report: Report, before: Path | None) -> None:
    """Report trials a minute and the price of a new topology, with one or two checkouts."""
    checkouts = {"this one": Path(__file__).parents[1]}
    if before is not None:
        checkouts["before"] = before
    rows = []
    for name, path in checkouts.items():
        with tempfile.TemporaryDirectory() as folder:  # on a machine that knows no kernel
            got = trials(path, folder)
        print(name, got, flush=True)
        known = float(np.mean(got["known"]))
        extra = max(once - again for once, again in got["new"])
        rows.append(
            (name, f"{got['first']:.1f}", f"{known:.2f}", f"{120 / known:.0f}", f"{extra:.2f}")
        )
    report.say(
        f"{TRIALS} random designs with the Marlow law of PLA, processor seconds of one core in a "
        "warm process that began on a machine without kernels; trials a minute are those of two "
        "cores; the last column is what the first trial of a topology not met before costs more "
        "than its second:"
    )
    report.table(
        ["checkout", "first trial", "a trial", "trials a minute", "a new topology, more"], rows
    )


def main() -> None:
    """Time everything in one run."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--designs", type=int, default=1)
    parser.add_argument("--before", type=Path)
    options = parser.parse_args()
    designs = options.designs

    with tempfile.TemporaryDirectory() as folder:
        starts = [cold(folder) for _ in range(3)]
    law = material("st-venant-kirchhoff")
    own = material("marlow")
    seconds: dict[str, list[float]] = {name: [] for name in RUNS}
    errors: dict[str, list[float]] = {name: [] for name in RUNS}
    marlow = []
    for k in range(designs):
        grid, _ = draw_valid(Rules(), 42, k)
        marlow.append(simulate_grid(grid, own).seconds)
        reference = simulate_grid(grid, law, REFERENCE).joints[-1]
        for name, (solver, layout) in RUNS.items():
            trial = solver(grid, law, layout)
            seconds[name].append(trial.seconds)
            away = np.linalg.norm(trial.joints[-1] - reference, axis=-1).mean()
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
    compare(report, options.before)
    report.save()


if __name__ == "__main__":
    main()

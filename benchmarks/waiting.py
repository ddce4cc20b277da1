"""How long one waits for the learned engine: the first time, warm, any topology, many designs.

Everything is measured through the public call, in processes of their own. With --before FOLDER the
same is measured with that checkout of SimuLearn, in turns; its caches are its own.

    python benchmarks/waiting.py [--before FOLDER]
    with the environment of the Makefile's ONE_THREAD
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

from report import Report

HERE = Path(__file__).parent.parent
ROUNDS = 3  # runs of each checkout, in turns

# What runs with any checkout. Times are of the wall, s.
PROGRAM = """
import json, resource, sys, time
import numpy as np
from simulearn.grid import Grid, Rules, draw_valid, drop_beams, make
from simulearn.inverse import Task, rank
from simulearn.inverse.goals import Goals
from simulearn.simulate import engine

LONG = len(sys.argv) > 1
learned = engine("learned")
out = {}

def seconds(call, count=1):
    spent = []
    for _ in range(count):
        begun = time.perf_counter()
        call()
        spent.append(time.perf_counter() - begun)
    return float(np.median(spent))

designs = [draw_valid(Rules(), 77, k)[0] for k in range(100)]
learned.simulate(designs[:1])
learned.simulate(designs)
out["one"] = seconds(lambda: learned.simulate(designs[:1]), 100)
out["hundred"] = seconds(lambda: learned.simulate(designs), 7)

from simulearn.inverse.task import task_from_dict
from simulearn.grid import grid_to_dict
grid = make("cone")
task = task_from_dict({
    "schema": "simulearn.task/1", "grid": grid_to_dict(grid),
    "goals": [{"vertex": ["joint", 0, "centre"], "target": [-50, -50, -20]}],
})
ranking = rank(task, learned)
out["changes"] = len(ranking.suggestions)
out["rank"] = seconds(lambda: rank(task, learned), 7)

new = []
for beams in ([0, 5], [0, 10], [3, 8]):
    grid = drop_beams(make("saddle"), beams)
    first = seconds(lambda: learned.simulate([grid]))
    new.append(first - seconds(lambda: learned.simulate([grid]), 9))
out["new topology"] = max(new)

if LONG:
    sizes = {}
    for cells in (2, 3, 4, 6, 8, 10, 12):
        grid = draw_valid(Rules(cells=(cells, cells), jitter=4.0, length=(22.0, 24.0)), 5, 0)[0]
        (result,) = learned.simulate([grid])
        sizes[len(grid.joints)] = seconds(lambda: learned.simulate([grid]), 3)
    out["sizes"] = sizes
    random = np.random.default_rng(1)
    seen = set()
    plain = make("saddle", (3, 3))
    while len(seen) < 100:
        gone = tuple(sorted(random.choice(24, size=4, replace=False).tolist()))
        (result,) = learned.simulate([drop_beams(plain, list(gone))])
        if hasattr(result, "joints"):
            seen.add(gone)
    out["topologies"] = len(seen)
out["memory"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
print(json.dumps(out))
"""


def run(program: list[str], checkout: Path, cache: Path) -> tuple[str, float]:
    """Return what a program prints with a checkout, and the seconds that it takes."""
    env = {**os.environ, "PYTHONPATH": str(checkout / "src"), "XDG_CACHE_HOME": str(cache)}
    begun = time.perf_counter()
    done = subprocess.run(
        [sys.executable, *program], check=True, env=env, stdout=subprocess.PIPE, text=True
    )
    return done.stdout, time.perf_counter() - begun


def command(checkout: Path, cache: Path) -> float:
    """Return the seconds of a whole command."""
    start = "from simulearn.cli import main; main()"
    words = ["simulate", str(HERE / "examples" / "twist.json"), "--engine", "learned", "--json"]
    return run(["-c", start, *words], checkout, cache)[1]


def measured(checkouts: dict[str, Path]) -> dict[str, dict[str, Any]]:
    """Return the figures of each checkout, run in turns."""
    figures: dict[str, dict[str, Any]] = {name: {} for name in checkouts}
    with tempfile.TemporaryDirectory() as folder:
        caches = {name: Path(folder) / name for name in checkouts}
        for name, checkout in checkouts.items():
            caches[name].mkdir()
            figures[name]["first"] = command(checkout, caches[name])
        rounds: dict[str, list[dict[str, Any]]] = {name: [] for name in checkouts}
        for k in range(ROUNDS):
            for name, checkout in checkouts.items():
                long = ["long"] if k == 0 and name == "now" else []
                text, _ = run(["-c", PROGRAM, *long], checkout, caches[name])
                rounds[name].append(json.loads(text))
                rounds[name][-1]["command"] = command(checkout, caches[name])
    for name, results in rounds.items():
        for key in results[0]:
            values = [result[key] for result in results if key in result]
            scalar = isinstance(values[0], int | float)
            figures[name][key] = float(np.median(values)) if scalar else values[0]
        figures[name]["memory"] = max(result["memory"] for result in results)
    return figures


def main() -> None:
    """Measure and report."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--before", type=Path)
    given = parser.parse_args()
    checkouts = {"before": given.before} if given.before else {}
    figures = measured({**checkouts, "now": HERE})
    report = Report("waiting", "Waiting for the learned engine")
    report.say(
        "Through the public call: validation, prediction and results; 2x2 designs; both cores of "
        f"the machine; the median of {ROUNDS} processes, of each the median. `before` is another "
        "checkout of SimuLearn, run in turns with this one."
    )
    names = {
        "first": ("first command on a machine, nothing compiled, s", 1.0),
        "command": ("the same command later, s", 1.0),
        "one": ("one design, twelve frames, ms", 1e3),
        "hundred": ("a hundred designs, twelve frames, ms", 1e3),
        "rank": ("ranking all changes of a 2x2 grid, ms", 1e3),
        "new topology": ("a topology not met before, more than a known one, ms", 1e3),
    }
    rows = []
    for key, (words, factor) in names.items():
        values = [factor * figures[name][key] for name in figures]
        ratio = f"{values[-1] / values[0]:.2f}" if len(values) == 2 else ""
        rows.append((words, *(f"{value:.3g}" for value in values), ratio))
    report.table(["what", *figures, "ratio"], rows)
    now = figures["now"]
    report.say(f"Ranked: {now['changes']:.0f} changes.")
    sizes = {int(k): v for k, v in now["sizes"].items()}
    joints = np.array(sorted(sizes))
    spent = np.array([sizes[k] for k in joints])
    power = np.polyfit(np.log(joints), np.log(spent), 1)[0]
    report.table(
        ["joints", "ms"], [(str(k), f"{1000 * s:.1f}") for k, s in zip(joints, spent, strict=True)]
    )
    report.say(
        f"Time grows as joints to the power {power:.2f} (square grids of 2x2 to 12x12 cells, beams "
        f"of 22 to 24 mm). A process that met {now['topologies']:.0f} different topologies of 3x3 "
        f"grids took {now['memory']:.0f} MB at most."
    )
    report.save()


if __name__ == "__main__":
    main()

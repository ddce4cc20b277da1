"""Compare where designs snap: the finite elements and the learned simulator.

The designs are those of `snapping.json`: random ones in which an earlier default model snapped.

    python benchmarks/snaps.py [--designs 20]
"""

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np

from report import Report
from simulearn.grid import Rules, draw_valid
from simulearn.simulate import Result, engine

DESIGNS = Path(__file__).parent / "snapping.json"
RELEASED = 0.03  # of the stress, by which the first snap may differ
APART = 0.02  # of the dimension, by which the last shape may differ in the mean


def first(result: Any) -> float | None:
    """Return the released fraction at the first snap."""
    return result.snaps[0].released if result.snaps else None


def percent(x: float | None) -> str:
    """Return a fraction as text."""
    return "-" if x is None else f"{100 * x:.1f} %"


def main() -> None:
    """Compare and report."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--designs", type=int, default=1000)
    given = parser.parse_args()
    solid, learned = engine("fea", mesh="fine"), engine("learned")
    rows, alike, plain = [], 0, 0
    for design in json.loads(DESIGNS.read_text())[: given.designs]:
        grid, _ = draw_valid(Rules(**design["rules"]), design["seed"], design["k"])
        (theirs,), (ours,) = solid.simulate([grid]), learned.simulate([grid])
        name = f"{design['kind']}, {design['seed']}/{design['k']}"
        if not (isinstance(theirs, Result) and isinstance(ours, Result)):
            rows.append((name, "no answer", "no answer", "-", "no"))
            continue
        away = np.linalg.norm(theirs.joints[-1] - ours.joints[-1], axis=-1).mean() / grid.dimension
        a, b = first(theirs), first(ours)
        neither = a is None and b is None
        both = a is not None and b is not None and abs(a - b) <= RELEASED
        same = (both or neither) and away <= APART
        alike += same
        plain += same and neither
        rows.append((name, percent(a), percent(b), percent(float(away)), "yes" if same else "no"))
        print(*rows[-1], flush=True)
    report = Report("snaps", "Designs that snap")
    report.say(
        f"{len(rows)} random designs on the edge of a snap: an earlier default model snapped in "
        f"all of them. In {alike} the learned simulator and the finite elements (fine mesh) agree: "
        f"in {alike - plain} both snap within {RELEASED:.0%} of the release, in {plain} neither "
        f"does, and last shapes are within {APART:.0%} of the dimension."
    )
    head = ["design", "finite elements snap at", "learned at", "last shapes apart", "alike"]
    report.table(head, rows)
    report.save()


if __name__ == "__main__":
    main()

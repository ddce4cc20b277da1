"""Count random designs of many kinds that the learned simulator has no answer for.

It also counts the snaps that it follows and the unstable balances that it leaves.

    python benchmarks/any_grid.py [--designs 1000] [--seed 9000]
"""

import argparse
import time
from collections.abc import Iterator
from math import cos, pi, sin

import numpy as np

from report import Report
from simulearn.grid import Grid, Rules, draw_valid, library, make, validate
from simulearn.learn.common.bundle import bundle_of
from simulearn.learn.common.model import Designs
from simulearn.material import load_material

KINDS = {
    "2 x 2": Rules(),
    "2 x 2, one to three beams removed": Rules(removed=(1, 3)),
    "2 x 3": Rules(cells=(2, 3)),
    "3 x 3": Rules(cells=(3, 3)),
}
PLA = load_material("pla-hot-water")


def drawn(rules: Rules, seed: int, count: int) -> Iterator[Grid]:
    """Yield random designs."""
    for k in range(count):
        yield draw_valid(rules, seed, k)[0]


def polygons(seed: int, count: int) -> Iterator[Grid]:
    """Yield rings of three to eight beams with random joints and actuators."""
    random = np.random.default_rng(seed)
    while count:
        sides = int(random.integers(3, 9))
        radius = random.uniform(40, 75, sides)
        angle = 2 * pi * (np.arange(sides) + random.uniform(-0.2, 0.2, sides)) / sides
        joints = np.array([(r * cos(a), r * sin(a)) for r, a in zip(radius, angle, strict=True)])
        beams = np.array([(k, (k + 1) % sides) for k in range(sides)])
        grid = Grid(joints, beams, _ratios(random, sides), 0).centred
        if validate(grid, PLA).valid:
            count -= 1
            yield grid


def strips(seed: int, count: int) -> Iterator[Grid]:
    """Yield chains of two to six beams, bent a little in the plane."""
    random = np.random.default_rng(seed)
    while count:
        many = int(random.integers(2, 7))
        turn = np.cumsum(random.uniform(-0.5, 0.5, many))
        steps = random.uniform(40, 75, many)[:, None] * np.stack([np.cos(turn), np.sin(turn)], 1)
        joints = np.vstack([np.zeros((1, 2)), np.cumsum(steps, axis=0)])
        beams = np.array([(k, k + 1) for k in range(many)])
        grid = Grid(joints, beams, _ratios(random, many), 0)
        if validate(grid, PLA).valid:
            count -= 1
            yield grid


def designed() -> Iterator[Grid]:
    """Yield the library in some sizes."""
    for name in library():
        for cells in ((1, 1), (2, 2), (3, 3), (4, 4)):
            yield make(name, cells, 50.0)


def _ratios(random: np.random.Generator, count: int) -> np.ndarray:
    size = random.choice([0.0, 0.25, 0.5, 0.75, 1.0], count)
    return size * random.choice([-1.0, 1.0], count)


def main() -> None:
    """Count and report."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--designs", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=9000)
    given = parser.parse_args()
    kinds = {name: drawn(rules, given.seed, given.designs) for name, rules in KINDS.items()}
    kinds |= {
        "rings of 3 to 8 beams": polygons(given.seed, given.designs),
        "strips of 2 to 6 beams": strips(given.seed, given.designs),
        "library, 1 x 1 to 4 x 4": designed(),
    }
    model = bundle_of("default").model
    rows = []
    for name, grids in kinds.items():
        total = failed = snapped = left = 0
        seconds = 0.0
        for grid in grids:
            one = grid.centred
            designs = Designs(one.beams, one.fixed, one.joints[None], one.actuators[None])
            begun = time.process_time()
            frames = model.rollout(designs)
            seconds += time.process_time() - begun
            total += 1
            failed += not frames.converged[0]
            snapped += bool(frames.snaps[0])
            left += bool(frames.left_balance[0])
        rows.append((name, total, failed, snapped, left, f"{1000 * seconds / total:.1f}"))
        print(*rows[-1], flush=True)
    report = Report("any_grid", "Any grid has an answer")
    report.say("Random designs through the learned simulator (model `equilibrium`), all frames.")
    head = ["designs", "number", "no answer", "snap", "leave a balance", "ms each (processor)"]
    report.table(head, rows)
    report.save()


if __name__ == "__main__":
    main()

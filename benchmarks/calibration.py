"""Test the calibration blindly: intervals that cover hidden materials, designs predicted.

Members of the family are drawn, with the section of the base. What ruler and straight edge would
read of their strips is simulated and given noise; the fit sees the form only. Then random 2 x 2
designs are simulated in the fitted and in the hidden material. Strips and designs in the hidden
material are simulated by the model, or by finite elements on the fine mesh, which the fit does not
know.

    python benchmarks/calibration.py [--members 40] [--by-fea 20] [--designs 10] [--noise 0.3]
        [--repeats 3]
"""

import argparse
import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from typing import Any

import numpy as np
from numpy.typing import NDArray

from report import Report
from simulearn.calibrate import Estimate, Form, fit
from simulearn.calibrate.measuring import simulated
from simulearn.calibrate.parameters import WORDS, values_of
from simulearn.calibrate.plate import records
from simulearn.fea import simulate_grid
from simulearn.fea.layout import FINE
from simulearn.files import cores
from simulearn.grid import Grid, Rules, draw_valid
from simulearn.material import Family, Material, draw_member, load_material
from simulearn.simulate.members import Prints, last_frames

Simulate = Callable[[Grid, list[Material]], Prints]

SEED = 2026
WANTED = "85 to 95"
FLOOR, AIM = 0.8, 0.5  # % of dimension


@dataclass(frozen=True)
class Blind:
    """What was found of a hidden material.

    Attributes:
        estimates: of its numbers.
        hidden: the numbers themselves.
        fitted, unfitted: error of each design in the fitted and in the base material, %.
    """

    estimates: tuple[Estimate, ...]
    hidden: NDArray[np.float64]
    fitted: list[float]
    unfitted: list[float]


def by_fea(grid: Grid, materials: list[Material]) -> Prints:
    """Return the last frames of a grid in materials by the fine mesh."""
    trials = [simulate_grid(grid, material, FINE) for material in materials]
    joints, sections = (np.stack([x[-1] for x in every]) for every in zip(
        *((trial.joints, trial.beams) for trial in trials), strict=True
    ))  # fmt: skip
    return Prints(joints, sections, np.ones(len(trials), np.bool_))


def read_form(
    base: Material, hidden: Material, noise: float, repeats: int, seed: int, simulate: Simulate
) -> Form:
    """Return a form with the readings of a hidden material's strips, to 0.1 mm."""
    random = np.random.default_rng([SEED, seed])
    strips = {}
    for name, record in records(base, repeats).items():
        sides = [
            simulated(record, [hidden], rises, simulate=simulate)[0] for rises in (True, False)
        ]
        chord, rise = sides[0] if sides[0][1] > 0 else sides[1]
        exact = np.array([record.length(base.section.width), chord, rise])[:, None]
        rows = (exact + noise * random.normal(size=(3, repeats))).round(1).tolist()
        before, chords, rises = map(tuple, rows)
        strips[name] = record.model_copy(update={"before": before, "chord": chords, "rise": rises})
    return Form(strips=strips)


def away(grid: Grid, one: Prints, other: Prints) -> float:
    """Return the mean distance of joint corners in two shapes, % of the dimension."""
    return float(100 * np.linalg.norm(one.joints - other.joints, axis=-1).mean() / grid.dimension)


def blind(job: tuple[int, argparse.Namespace, bool]) -> Blind:
    """Return what is found of a member."""
    k, args, fea = job
    base = load_material("pla-hot-water")
    simulate = cached(by_fea) if fea else last_frames
    hidden = draw_member(family_of(base), base, np.random.default_rng([SEED, k, 1]).uniform)
    found = fit(read_form(base, hidden, args.noise, args.repeats, k, simulate), base)
    designs = [draw_valid(Rules(), SEED, d)[0] for d in range(args.designs)]
    fitted, unfitted = [], []
    for grid in designs:
        shape = simulate(grid, [hidden])
        fitted.append(away(grid, last_frames(grid, [found.material]), shape))
        unfitted.append(away(grid, last_frames(grid, [base]), shape))
    print(f"{k}: {np.nanmean(fitted):.2f} %", file=sys.stderr, flush=True)
    return Blind(found.estimates, values_of(hidden, base), fitted, unfitted)


def cached(simulate: Simulate) -> Simulate:
    """Return the same function, which remembers its last answer."""
    last: list[tuple[Any, Prints]] = []

    def again(grid: Grid, materials: list[Material]) -> Prints:
        name = (grid.joints.tobytes(), grid.actuators.tobytes())
        if not last or last[0][0] != name:
            last[:] = [(name, simulate(grid, materials))]
        return last[0][1]

    return again


def family_of(base: Material) -> Family:
    """Return the family with the section of a material."""
    section = base.section
    slender, rim = section.width / section.thickness, section.shell / section.width
    return Family(slender=(slender, slender), rim=(rim, rim))


def errors_of(values: list[float]) -> str:
    """Return mean, median and ninth decile of errors as text."""
    low, high = np.nanquantile(values, [0.5, 0.9])
    return f"{np.nanmean(values):.2f} | {low:.2f} | {high:.2f}"


def tell(report: Report, args: argparse.Namespace, members: list[Blind]) -> None:
    """Write the tables of some members."""
    inside = np.array(
        [
            [one.low <= v <= one.high for one, v in zip(m.estimates, m.hidden, strict=True)]
            for m in members
        ]
    )
    rows = []
    for p, name in enumerate(WORDS):
        error = np.array([m.estimates[p].value - m.hidden[p] for m in members])
        before = np.array([m.estimates[p].base - m.hidden[p] for m in members])
        width = np.mean([m.estimates[p].high - m.estimates[p].low for m in members])
        rows.append(
            (
                name,
                f"{np.sqrt((before**2).mean()):.3f}",
                f"{np.sqrt((error**2).mean()):.3f}",
                f"{width:.3f}",
                f"{100 * inside[:, p].mean():.0f} %",
            )
        )
    head = ("number", "base's error (rms)", "fitted one's", "width of interval", "covered")
    report.table(head, rows)
    report.say(
        f"All intervals of 90 % together cover {100 * inside.mean():.1f} % (wanted {WANTED} %)."
    )
    report.say(
        f"{args.designs} random 2 x 2 designs in each: mean distance of joint corners from those "
        f"in the hidden material, % of dimension (floor {FLOOR:g}, aim {AIM:g})."
    )
    shapes = (("base", "unfitted"), ("fitted", "fitted"))
    report.table(
        ("material", "mean", "median", "nine of ten below"),
        [
            (name, *errors_of([x for m in members for x in getattr(m, key)]).split(" | "))
            for name, key in shapes
        ],
    )


def main() -> None:
    """Draw, fit, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--members", type=int, default=40)
    parser.add_argument("--by-fea", type=int, default=20, help="members simulated so, too")
    parser.add_argument("--designs", type=int, default=10)
    parser.add_argument("--noise", type=float, default=0.3)
    parser.add_argument("--repeats", type=int, default=3)
    args = parser.parse_args()
    with ProcessPoolExecutor(cores(), mp_context=get_context("spawn")) as pool:
        own = list(pool.map(blind, [(k, args, False) for k in range(args.members)]))
        fea = list(pool.map(blind, [(k, args, True) for k in range(args.by_fea)]))
    report = Report("calibration", "Calibration in blind tests")
    report.say(
        f"{args.members} materials were drawn from the family (`material.Family`), with the "
        f"section of the base. Their strips were simulated, {args.repeats} repeats each, and read "
        f"with a noise of {args.noise:g} mm on every value. Materials, readings and predictions "
        "are all of one simulator: this is how well a fit does where the physics is right."
    )
    tell(report, args, own)
    if fea:
        report.say(
            f"**By finite elements.** The first {args.by_fea} of them again, strips and designs in "
            "the hidden material by finite elements on the fine mesh: fit and predictions are by "
            "the model, whose error counts, too."
        )
        tell(report, args, fea)
    report.save()


if __name__ == "__main__":
    main()

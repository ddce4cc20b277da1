"""Test the calibration blindly: intervals that cover hidden materials, designs predicted.

Members of the family are drawn, with the section of the base. What ruler and straight edge would
read of their strips is simulated and given noise; the fit sees the form only. Then random 2 x 2
designs are simulated in the fitted and in the hidden material.

    python benchmarks/calibration.py [--members 40] [--designs 10] [--noise 0.3] [--repeats 3]
"""

import argparse

import numpy as np
from numpy.typing import NDArray

from report import Report
from simulearn.calibrate import Estimate, Form, fit
from simulearn.calibrate.measuring import simulated
from simulearn.calibrate.parameters import WORDS, values_of
from simulearn.calibrate.plate import records
from simulearn.grid import Grid, Rules, draw_valid
from simulearn.material import Family, Material, draw_member, load_material
from simulearn.simulate.members import last_frames

SEED = 2026
WANTED = "85 to 95"
FLOOR, AIM = 0.8, 0.5  # % of dimension


def read_form(base: Material, hidden: Material, noise: float, repeats: int, seed: int) -> Form:
    """Return a form with the readings of a hidden material's strips, to 0.1 mm."""
    random = np.random.default_rng([SEED, seed])
    strips = {}
    for name, record in records(base, repeats).items():
        sides = [simulated(record, [hidden], rises)[0] for rises in (True, False)]
        chord, rise = sides[0] if sides[0][1] > 0 else sides[1]
        exact = np.array([record.length(base.section.width), chord, rise])[:, None]
        rows = (exact + noise * random.normal(size=(3, repeats))).round(1).tolist()
        before, chords, rises = map(tuple, rows)
        strips[name] = record.model_copy(update={"before": before, "chord": chords, "rise": rises})
    return Form(strips=strips)


def away(grid: Grid, one: Material, other: Material) -> float:
    """Return the mean distance of joint corners in two materials, % of the dimension."""
    at = last_frames(grid, [one, other]).joints
    return float(100 * np.linalg.norm(at[0] - at[1], axis=-1).mean() / grid.dimension)


def errors_of(values: list[float]) -> str:
    """Return mean, median and ninth decile of errors as text."""
    low, high = np.nanquantile(values, [0.5, 0.9])
    return f"{np.nanmean(values):.2f} | {low:.2f} | {high:.2f}"


def main() -> None:
    """Draw, fit, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--members", type=int, default=40)
    parser.add_argument("--designs", type=int, default=10)
    parser.add_argument("--noise", type=float, default=0.3)
    parser.add_argument("--repeats", type=int, default=3)
    args = parser.parse_args()
    base = load_material("pla-hot-water")
    section = base.section
    slender, rim = section.width / section.thickness, section.shell / section.width
    family = Family(slender=(slender, slender), rim=(rim, rim))
    designs = [draw_valid(Rules(), SEED, k)[0] for k in range(args.designs)]

    fits: list[tuple[tuple[Estimate, ...], NDArray[np.float64]]] = []
    fitted: list[float] = []
    unfitted: list[float] = []
    for k in range(args.members):
        hidden = draw_member(family, base, np.random.default_rng([SEED, k, 1]).uniform)
        found = fit(read_form(base, hidden, args.noise, args.repeats, k), base)
        fits.append((found.estimates, values_of(hidden, base)))
        fitted += [away(grid, found.material, hidden) for grid in designs]
        unfitted += [away(grid, base, hidden) for grid in designs]
        print(f"{k + 1} of {args.members}: {np.nanmean(fitted):.2f} %", flush=True)

    report = Report("calibration", "Calibration in blind tests")
    report.say(
        f"{args.members} materials were drawn from the family (`material.Family`), with the "
        f"section of the base. Their strips were simulated, {args.repeats} repeats each, and read "
        f"with a noise of {args.noise:g} mm on every value. Materials, readings and predictions "
        "are all of one simulator: this is how well a fit does where the physics is right."
    )
    rows = []
    inside = np.array(
        [[one.low <= v <= one.high for one, v in zip(*pair, strict=True)] for pair in fits]
    )
    for p, name in enumerate(WORDS):
        error = np.array([pair[0][p].value - pair[1][p] for pair in fits])
        before = np.array([pair[0][p].base - pair[1][p] for pair in fits])
        width = np.mean([pair[0][p].high - pair[0][p].low for pair in fits])
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
    report.table(
        ("material", "mean", "median", "nine of ten below"),
        [
            (name, *errors_of(values).split(" | "))
            for name, values in (("base", unfitted), ("fitted", fitted))
        ],
    )
    report.save()


if __name__ == "__main__":
    main()

"""How far the default model is from the fine mesh, for kinds of grids and materials it never saw.

Three sets of trials by the fine mesh: unseen designs and members of the kinds learnt (those kept
for testing), kinds that were kept out of training, and beside them the same designs by the default
mesh, whose own error is reported. Then PLA's 2x2 grids against the default mesh, which is what the
model was judged by before it learnt the family.

    python benchmarks/family.py [--model default] [--record]
"""

import argparse
from collections.abc import Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import beta

from report import Report
from simulearn.dataset import Batch, read_config, read_dataset
from simulearn.errors import ComputationError
from simulearn.fea import simulate_grid
from simulearn.files import cores
from simulearn.learn.common.bundle import bundle_of
from simulearn.learn.common.evaluate import evaluate, for_testing
from simulearn.learn.common.metrics import Errors
from simulearn.learn.common.saving import add_metrics
from simulearn.learn.equilibrium.bound_fit import FOLDS, JudgedTrials, judged_trials, quantile_of
from simulearn.learn.equilibrium.model import Equilibrium

DATA = Path("data")
SETS = {"kinds learnt": "family-test", "kinds kept out": "family-kept-out"}
NOMINAL = 150  # PLA's 2x2 grids of the test trials of the set `default`


def coarse_error(job: tuple[Any, Any, Any, Any]) -> float:
    """Return the vertex error of the default mesh in the last frame, % of dimension."""
    grid, material, joints, sections = job
    try:
        trial = simulate_grid(grid, material)
    except ComputationError:
        return np.nan
    away = [
        np.linalg.norm(a - b, axis=-1).ravel()
        for a, b in ((trial.joints[-1], joints), (trial.beams[-1], sections))
    ]
    return float(100 * np.concatenate(away).mean() / grid.dimension)


def jobs_of(batches: Iterable[Batch]) -> list[tuple[Any, Any, Any, Any]]:
    """Return designs, materials and last frames of trials."""
    return [
        (batch.grid(t), (batch.materials or (batch.material,) * len(batch))[t],
         batch.joints[t, -1], batch.sections[t, -1])
        for batch in batches for t in range(len(batch))
    ]  # fmt: skip


def nominal_job(k: int) -> tuple[Any, Any] | None:
    """Return PLA's test design k of the set `default` and its last frame by the default mesh."""
    design = read_config("default").design(k)
    try:
        trial = simulate_grid(design.grid, design.material)
    except ComputationError:
        return None
    return design.grid, (trial.joints, trial.beams)


def nominal_errors(model: Any) -> np.ndarray:
    """Return the errors of a model to PLA's 2x2 grids against the default mesh, %."""
    from simulearn.learn.common.model import Designs

    with ProcessPoolExecutor(cores()) as pool:
        found = [x for x in pool.map(nominal_job, range(4, 5 * NOMINAL, 5)) if x is not None]
    grids = [grid for grid, _ in found]
    designs = Designs(
        grids[0].beams, grids[0].fixed, np.stack([g.joints for g in grids]),
        np.stack([g.actuators for g in grids]), mesh=0.0,
    )  # fmt: skip
    frames = model.rollout(designs)
    out = []
    for t, (grid, (joints, beams)) in enumerate(found):
        away = [
            np.linalg.norm(a - b, axis=-1).ravel()
            for a, b in ((frames.joints[t, -1], joints[-1]), (frames.sections[t, -1], beams[-1]))
        ]
        out.append(100 * np.concatenate(away).mean() / grid.dimension)
    return np.array(out)


def interval(below: int, count: int) -> str:
    """Return the 90 % interval of a part of which some were counted, % (Clopper and Pearson)."""
    low = 0.0 if below == 0 else beta.ppf(0.05, below, count - below + 1)
    high = 1.0 if below == count else beta.ppf(0.95, below + 1, count - below)
    return f"{100 * low:.0f} to {100 * high:.0f}"


def judged_by_others(
    model: Equilibrium, batches: Sequence[Batch], unfamiliar: Sequence[Batch]
) -> list[list[object]]:
    """Return by kind how many trials are below bounds that were fitted to nine tenths of the rest.

    They are twice as many as the test ones; the model's own bound is fitted to half of them.
    """
    assert model.bound is not None
    trials = judged_trials(model, batches, model.bound.seen)
    others = judged_trials(model, unfamiliar, model.bound.seen)
    folds = np.random.default_rng(0).permutation(len(trials.error)) % FOLDS
    bound = np.empty(len(folds))
    for fold in range(FOLDS):
        old, new = folds != fold, folds == fold
        fitted = quantile_of(JudgedTrials(*(x[old] for x in trials)), others)
        bound[new] = fitted.of(trials.signs[new], trials.classes[new])
    rows = []
    for kind in ("all", *np.unique(trials.kinds)):
        mine = (trials.kinds == kind) | (kind == "all")
        below, ratio = bound[mine] >= trials.error[mine], bound[mine] / trials.error[mine]
        count = int(mine.sum())
        rows.append([
            kind, count,
            f"{100 * below.mean():.0f} ({interval(int(below.sum()), count)})",
            f"{np.median(ratio):.1f}",
        ])  # fmt: skip
    return rows


def row(title: str, figures: dict[str, Any], mesh: float) -> list[object]:
    """Return a row of the table."""
    count = figures["trials"]
    below = round(figures["below_bound_percent"] * count / 100)
    return [
        title, figures["trials"],
        *(f"{figures[k]:.2f}" for k in ("mean_percent", "median_percent", "worst_percent")),
        f"{figures['below_bound_percent']:.0f} ({interval(below, count)})",
        f"{figures['bound_over_error']:.1f}",
        f"{mesh:.2f}",
    ]  # fmt: skip


def main() -> None:
    """Measure and report."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--model", default="default")
    parser.add_argument("--record", action="store_true", help="keep the figures in the card")
    given = parser.parse_args()
    bundle = bundle_of(given.model)
    report = Report("family", "The family: every kind of grid, every member")
    head = ["", "trials", "mean", "median", "worst", "below bound, % (90 % interval)",
            "bound / error", "default mesh"]  # fmt: skip
    unfamiliar = read_dataset(DATA / "family-bound.h5", stress=False)
    for title, name in SETS.items():
        data = read_dataset(DATA / f"{name}.h5", stress=False)
        batches = for_testing(data)
        snapped = sum(sum(b.snapped) for b in batches)
        batches = [replace(b.take(~np.array(b.snapped))) for b in batches]
        batches = [b for b in batches if len(b)]
        errors: Errors = evaluate(bundle.model, batches).errors
        with ProcessPoolExecutor(cores()) as pool:
            mesh = np.array(list(pool.map(coarse_error, jobs_of(batches))))
        figures = errors.summary()
        if given.record:
            bundle = add_metrics(bundle, data.config.name, figures)
        kinds = np.array(errors.kinds)
        rows = [row("all", figures, np.nanmean(mesh))]
        rows += [row(k, f, np.nanmean(mesh[kinds == k])) for k, f in figures["kinds"].items()]
        report.say(
            f"**{title}** (`{name}`): mean vertex error of the last frame against the fine mesh, % "
            f"of the dimension; {snapped} trials that snap are left out. The last column is how "
            "far the default mesh is off, on the same designs."
        )
        report.table(head, rows)
        of_kinds = [f["mean_percent"] for f in figures["kinds"].values()]
        report.say(f"Mean of the kinds, each as much as any other: {np.mean(of_kinds):.2f} %.")
        if title == "kinds learnt":
            report.say(
                "All trials of the set, each judged by a bound that was fitted to nine tenths of "
                "the others. With the intervals this says more of single kinds."
            )
            report.table(
                ["", "trials", "below bound, % (90 % interval)", "bound / error"],
                judged_by_others(bundle.model, data.batches, unfamiliar.batches),
            )
            report.say("By what the material is: lowest and highest third of each number.")
            members = np.asarray(errors.members)
            thirds = []
            for k, (number, parts) in enumerate(figures["members"].items()):
                for part, words in (("low", "to"), ("high", "from")):
                    limit = parts[part]["most" if part == "low" else "least"]
                    values = abs(members[:, k]) if number == "curl" else members[:, k]
                    inside = values <= limit if part == "low" else values >= limit
                    thirds.append(
                        row(f"{number} {words} {limit:.3g}", parts[part], np.nanmean(mesh[inside]))
                    )
            report.table(head, thirds)
    errors_ = nominal_errors(bundle.model)
    report.say(
        f"**PLA, 2x2, against the default mesh** ({len(errors_)} test designs of `default`): mean "
        f"{errors_.mean():.3f} %, median {np.median(errors_):.3f}, 97th percentile "
        f"{np.percentile(errors_, 97):.3f}, worst {errors_.max():.3f}."
    )
    report.save()


if __name__ == "__main__":
    main()

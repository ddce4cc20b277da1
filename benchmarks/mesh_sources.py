"""Where the distance of the default mesh from a fine one comes from: parts of grids, one by one.

A bar has no joint in which beams meet, a corner one of two beams, a cross one of four. Each is
simulated with one thing finer at a time: bricks across, slabs along, layers. The reference is twice
as fine in every direction.

    python benchmarks/mesh_sources.py
"""

import numpy as np

from mesh_study import LAYOUTS as STUDIED
from mesh_study import REFERENCE
from report import Report
from simulearn.fea import Trial, simulate_grid
from simulearn.fea.bar import bar, curvature
from simulearn.grid import Grid
from simulearn.material import Material, load_material

PLA = load_material("pla-hot-water")
LIGHT = PLA.model_copy(update={"gravity": PLA.gravity.model_copy(update={"density": 1e-15})})
LAYOUTS = {name: layout for name, layout in STUDIED.items() if layout != REFERENCE}
ARMS = np.array([[0, 0], [60, 0], [0, 60], [-60, 0], [0, -60]])


def wide() -> Material:
    """Light PLA with a wide section, whose passive half shrinks half as much."""
    section = LIGHT.section.model_copy(update={"width": 10.4, "shell": 1.2})
    shrinkage = LIGHT.shrinkage.model_copy(
        update={"stress_passive": 0.5 * LIGHT.shrinkage.stress_active}
    )
    return LIGHT.model_copy(update={"section": section, "shrinkage": shrinkage})


def still() -> Material:
    """PLA that does not shrink: weight alone bends and twists it."""
    zero = PLA.shrinkage.model_copy(update={"active": 0.0, "shell": 0.0})
    return PLA.model_copy(update={"shrinkage": zero})


def arms(many: int, ratio: float) -> Grid:
    """Beams that meet in a joint, the end of the first one held."""
    return Grid(ARMS[: many + 1], [[0, k + 1] for k in range(many)], [ratio] * many, 1)


CASES: dict[str, tuple[Grid, Material]] = {
    "bar, active": (bar(50.0, 1.0, LIGHT), LIGHT),
    "bar, half active": (bar(50.0, 0.5, LIGHT), LIGHT),
    "bar, passive": (bar(50.0, 0.0, LIGHT), LIGHT),
    "bar, active, wide section": (bar(50.0, 1.0, wide()), wide()),
    "bar, weight alone": (bar(90.0, 0.0, still()), still()),
    "corner, weight alone (bends and twists)": (arms(2, 0.0), still()),
    "corner, active": (arms(2, 1.0), LIGHT),
    "cross, active": (arms(4, 1.0), LIGHT),
    "cross, passive": (arms(4, 0.0), LIGHT),
}


def distance(trial: Trial, reference: Trial) -> float:
    """Mean distance of joint corners in the last frame, mm."""
    return float(np.linalg.norm(trial.joints[-1] - reference.joints[-1], axis=-1).mean())


def main() -> None:
    """Compare the layouts on parts of grids."""
    rows, bends = [], []
    for title, (grid, material) in CASES.items():
        reference = simulate_grid(grid, material, REFERENCE)
        moved = np.linalg.norm(reference.joints[-1] - reference.joints[0], axis=-1).mean()
        trials = {name: simulate_grid(grid, material, layout) for name, layout in LAYOUTS.items()}
        shares = [100 * distance(t, reference) / grid.dimension for t in trials.values()]
        rows.append([title, f"{moved:.2f}", *(f"{x:.3f}" for x in shares)])
        if title.startswith("bar, ") and "weight" not in title:
            bent = [curvature(t.solid, t.displacements[-1]) for t in [reference, *trials.values()]]
            bends.append([title, *(f"{x:.4f}" for x in bent)])
        print(rows[-1], bends[-1:], flush=True)

    report = Report("mesh_sources", "Where the error of the default mesh comes from")
    report.say(
        "Mean distance of joint corners in the last frame to the reference (four bricks across, 16 "
        "slabs, two layers a half), % of the dimension of the part; beams have 4 mm of thickness."
    )
    report.table(["part", "motion, mm", *LAYOUTS], rows)
    report.say("Curvature of bars in their middle half, deg/mm.")
    report.table(["bar", "reference", *LAYOUTS], bends)
    report.save()


if __name__ == "__main__":
    main()

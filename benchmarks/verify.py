"""Climb the verification ladder and write down every figure.

python benchmarks/verify.py
"""

import numpy as np

import ladder
from report import Report
from simulearn.fea import Layout, simulate_grid
from simulearn.fea.bar import bar, curvature
from simulearn.fea.laws import law_of, neo_hookean
from simulearn.fea.problem import Control
from simulearn.grid import make


def main() -> None:
    """Measure every rung."""
    pla = ladder.PLA
    report = Report("verify", "The verification ladder")
    rows: list[tuple[str, str, str]] = []
    marlow = law_of(pla.law)
    laws = {"Marlow": marlow, "neo-Hookean": neo_hookean(0.78, 3.9), "St Venant": ladder.svk()}
    for title, rung, wanted in (
        ("Patch test: inner forces of distorted bricks, relative", ladder.patch, "1e-12"),
        ("Rigid turn of growing bricks: change of forces, relative", ladder.rigid, "1e-12"),
        ("Tangent against central differences, relative", ladder.tangent, "1e-8"),
    ):
        figures = ", ".join(f"{name} {rung(law):.1e}" for name, law in laws.items())
        rows.append((title, figures, wanted))

    for upper in (1, 2, 3):
        error = 100 * (ladder.bilayer(upper) - 1)
        rows.append((f"Timoshenko bilayer, {upper} of 4 layers shrink", f"{error:+.3f} %", "1 %"))
    shear = 100 * abs(ladder.end_shear()).max(axis=0)
    rows.append(
        (
            "Cantilever, end shear (Sze 2004), 20 loads: -U, W, worst",
            f"{shear[0]:.2f} %, {shear[1]:.2f} %",
            "1 %",
        )
    )
    moment = 100 * abs(ladder.end_moment()).max(axis=0)
    rows.append(
        (
            "Cantilever, end moment to half a turn: U, W over L, worst",
            f"{moment[0]:.3f} %, {moment[1]:.3f} %",
            "1 %",
        )
    )
    bend = ladder.bend_45()
    published = np.array([-13.4, -23.5, 53.4])
    away = 100 * np.linalg.norm(bend - published) / np.linalg.norm(published)
    rows.append(
        (
            "45 degree bend (Bathe, Bolourchi 1979): tip at " + ", ".join(f"{x:.2f}" for x in bend),
            f"{away:.2f} % of its way",
            "1 %",
        )
    )
    worst = max(abs(ladder.brick(marlow, 1 + e) / stress - 1) for e, stress in pla.law.table)
    rows.append(
        (
            "One brick in tension against the material table, worst of 23 points",
            f"{100 * worst:.3f} %",
            "1 %",
        )
    )
    rows.append(
        (
            "Heavy cantilever at small load against beam theory",
            f"{100 * (ladder.sag() - 1):+.3f} %",
            "1 %",
        )
    )

    free = pla.model_copy(update={"gravity": pla.gravity.model_copy(update={"acceleration": 0.0})})
    trial = simulate_grid(bar(pla.calibration.length, 1.0, pla), free)
    bent = curvature(trial.solid, trial.displacements[10])
    rows.append(
        ("Calibration: free beam of 50 mm, middle half", f"{bent:.4f} deg/mm", "1.95 +- .02")
    )

    quasi, steps = ladder.creep_of_beam()
    rows.append(
        (
            f"Creep sag of a 90 mm beam: quasi-elastic {quasi:.4f} mm, step by step {steps:.4f} mm",
            f"{100 * (quasi / steps - 1):+.3f} %",
            "1 %",
        )
    )
    for title, error in ladder.symmetry().items():
        rows.append((f"Symmetry: {title}, all frames", f"{error:.1e} mm", "1e-6 mm"))
    report.table(["rung", "measured", "wanted"], rows)

    saddle = make("saddle")
    runs = {
        "mixed Newton, extrapolated": Control(),
        "plain Newton, extrapolated": Control(mixed=False, iterations=40),
    }
    trials = {name: simulate_grid(saddle, pla, Layout(), control) for name, control in runs.items()}
    reference = simulate_grid(saddle, pla, Layout(), Control(tolerance=1e-9)).joints
    report.say("Iterations of the saddle's eleven frames, and the distance to tight convergence:")
    report.table(
        ["iteration", "a frame", "in all", "halved", "largest error, mm"],
        [
            (
                name,
                " ".join(map(str, t.record["iterations"][1:])),
                sum(t.record["iterations"]),
                t.record["halved"],
                f"{abs(t.joints - reference).max():.1e}",
            )
            for name, t in trials.items()
        ],
    )
    report.save()


if __name__ == "__main__":
    main()

"""Measure how far apart our shapes are from those of CalculiX on the same mesh and law.

Random designs with gravity, all twelve frames. CalculiX has the St Venant-Kirchhoff law with exact
growth (docs/calculix.md); a few designs go through the Marlow law too, which CalculiX reaches by
successive linear laws. The mesh is three bricks across with four slabs a beam: 450 bricks.

    python benchmarks/against_calculix.py [--designs 20] [--marlow 1] [--processes 1]
"""

import argparse
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np

from report import Report
from simulearn.fea import Layout, simulate_grid
from simulearn.fea.calculix import simulate_grid as by_calculix
from simulearn.grid import Rules, draw_valid
from simulearn.material import ElasticData, Material, load_material

SEED = 20
LAYOUT = Layout(core=1, slabs=4)
Row = tuple[int, str, float, float, float, float, float]


def material(law: str) -> Material:
    """Return PLA with its own law, or with the St Venant-Kirchhoff law of its constants."""
    pla = load_material("pla-hot-water")
    if law == pla.law.kind:
        return pla
    data = ElasticData(kind=law, modulus=pla.law.modulus, poisson=pla.law.poisson)
    return pla.model_copy(update={"law": data})


def one(task: tuple[int, str]) -> Row:
    """Return design, law, distances of frame 10 and last, motion (% of dimension), seconds."""
    k, law = task
    grid, _ = draw_valid(Rules(), SEED, k)
    theirs = by_calculix(grid, material(law), LAYOUT)
    ours = simulate_grid(grid, material(law), LAYOUT)
    away = np.linalg.norm(ours.joints - theirs.joints, axis=-1).mean(axis=(1, 2))
    moved = np.linalg.norm(ours.joints[-1] - ours.joints[0], axis=-1).mean()
    percent = 100 / grid.dimension
    row = (
        k,
        law,
        float(away[10] * percent),
        float(away[11] * percent),
        float(moved * percent),
        theirs.seconds,
        ours.seconds,
    )
    print(*row, flush=True)
    return row


def main() -> None:
    """Compare and report."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--designs", type=int, default=20)
    parser.add_argument("--marlow", type=int, default=1)
    parser.add_argument("--processes", type=int, default=1)
    options = parser.parse_args()
    tasks = [(k, "st-venant-kirchhoff") for k in range(options.designs)]
    tasks += [(k, "marlow") for k in range(options.marlow)]
    with ProcessPoolExecutor(options.processes, get_context("spawn")) as pool:
        rows = list(pool.map(one, tasks))
    report = Report("against_calculix", "Against CalculiX")
    report.say(
        "Mean distance of joint corners between our solver and CalculiX 2.20 on the same mesh and "
        "law, % of the grid's dimension. Asked: below 0.5 % each."
    )
    summary = []
    for law in ("st-venant-kirchhoff", "marlow"):
        of_law = np.array([row[2:] for row in rows if row[1] == law])
        if len(of_law):
            mean, worst = of_law.mean(axis=0), of_law.max(axis=0)
            summary.append(
                [
                    law,
                    len(of_law),
                    *(f"{x:.5f}" for x in (mean[0], worst[0], mean[1], worst[1])),
                    f"{mean[2]:.1f}",
                ]
            )
    report.table(
        ["law", "designs", "frame 10, mean", "worst", "last, mean", "worst", "motion"], summary
    )
    report.table(
        ["design", "law", "frame 10", "last frame", "motion"],
        [[row[0], row[1], f"{row[2]:.5f}", f"{row[3]:.5f}", f"{row[4]:.1f}"] for row in rows],
    )
    report.save()


if __name__ == "__main__":
    main()

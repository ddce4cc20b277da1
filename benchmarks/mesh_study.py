"""How far the default mesh is from a mesh twice as fine, in % of the grid's dimension.

The reference has twice as many bricks in every direction: 3,648 for a 2x2 grid.

    python benchmarks/mesh_study.py [--designs N]
"""

import argparse

import numpy as np

from report import Report
from simulearn.fea import COARSE, THREE_ACROSS, Layout, simulate_grid
from simulearn.grid import Rules, draw_valid
from simulearn.material import load_material

REFERENCE = Layout(core=2, slabs=16, layers=2)
LAYOUTS = {
    "one across (default)": COARSE,
    "one across, 16 slabs": Layout(slabs=16),
    "one across, 2 layers a half": Layout(layers=2),
    "three across": THREE_ACROSS,
    "three across, 16 slabs": Layout(core=1, slabs=16),
    "four across, 16 slabs, 2 layers a half (reference)": REFERENCE,
}


def main() -> None:
    """Compare the layouts on random designs."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--designs", type=int, default=3)
    designs = parser.parse_args().designs
    material = load_material("pla-hot-water")
    distances: dict[str, list[list[float]]] = {name: [] for name in LAYOUTS}
    seconds: dict[str, list[float]] = {name: [] for name in LAYOUTS}
    size: dict[str, str] = {}
    for k in range(designs):
        grid, _ = draw_valid(Rules(), 11, k)
        trials = {name: simulate_grid(grid, material, layout) for name, layout in LAYOUTS.items()}
        reference = trials["four across, 16 slabs, 2 layers a half (reference)"].joints
        for name, trial in trials.items():
            away = np.linalg.norm(trial.joints - reference, axis=-1).mean(axis=(1, 2))
            distances[name].append(list(100 * away[[1, 5, 10, 11]] / grid.dimension))
            seconds[name].append(trial.seconds)
            size[name] = f"{trial.record['bricks']:,} | {trial.record['unknowns']:,}"
            print(k, name, np.round(distances[name][-1], 3), round(trial.seconds, 1), flush=True)

    report = Report("mesh_study", "Mesh study")
    report.say(
        f"{designs} random designs, mean distance of joint corners to the reference, % of the "
        "grid's dimension. Asked: the default below 1 %."
    )
    report.table(
        ["layout", "bricks", "unknowns", "frame 1", "frame 5", "frame 10", "last", "worst last"],
        [
            [
                name,
                *size[name].split(" | "),
                *(f"{x:.3f}" for x in np.mean(d, axis=0)),
                f"{np.max(d, axis=0)[-1]:.3f}",
            ]
            for name, d in distances.items()
        ],
    )
    report.save()


if __name__ == "__main__":
    main()

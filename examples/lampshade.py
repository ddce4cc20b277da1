"""A lampshade of three modules, by inverse design (Yang et al., SimuLearn, UIST 2020, Figure 16).

The shade is a surface of revolution, wider below. Five columns go around it, three modules to a
column: top, middle, bottom. Each module is a 2x2 grid, symmetric about its column, whose nine
joints are wanted on the surface, as seen from its centre joint with z pointing outwards. The
fitted modules are then put back on the surface: a preview of the assembly.

    python examples/lampshade.py [-o out/lampshade] [--seconds 30] [--engine learned]
"""

import argparse
from pathlib import Path

import numpy as np

from simulearn.grid import grid_to_dict, make, write_grid
from simulearn.inverse import SearchResult, Task, optimize, task_from_dict, write_task
from simulearn.rigid import Place
from simulearn.show.assembly import assembly

MODULES = ("top", "middle", "bottom")
AROUND = 5  # columns
HEIGHT = 100.0  # mm, of a module
PAIRS = {
    "flip": "x",
    "joints": [[0, 2], [3, 5], [6, 8], [1, 1], [7, 7]],
    "actuators": [[0, 2], [1, 4], [5, 7], [6, 9], [10, 11]],
}


def surface(angle: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Return the points (..., 3) mm of the shade at angles (rad) and heights (mm)."""
    total = len(MODULES) * HEIGHT
    radius = 84.0 - 12.0 * np.sin(np.pi * (z / total - 0.5))
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), z], axis=-1)


def wanted(module: int) -> np.ndarray:
    """Return where the joints (9, 3) of a module of the first column are wanted on the shade."""
    bottom = HEIGHT * (len(MODULES) - 1 - module)
    angle, z = np.meshgrid(
        np.pi / AROUND * np.linspace(-1, 1, 3), bottom + HEIGHT / 2 * np.arange(3)
    )
    return surface(angle, z).reshape(9, 3)


def seen_from_centre(points: np.ndarray) -> np.ndarray:
    """Return points (9, 3) as the fixed joint sees them: x around, y up, z outwards, mm."""
    x = points[5] - points[3]
    y = points[7] - points[1]
    x, z = x / np.linalg.norm(x), np.cross(x, y)
    z /= np.linalg.norm(z)
    return (points - points[4]) @ np.stack([x, np.cross(z, x), z]).T


def task(
    module: int, seconds: float = 30.0, iterations: int = 1000, engine: str = "learned"
) -> Task:
    """Return the task of a module."""
    targets = seen_from_centre(wanted(module)).tolist()
    return task_from_dict(
        {
            "schema": "simulearn.task/1",
            "grid": grid_to_dict(make("flat", length=55.0)),
            "goals": [
                {"vertex": ["joint", k, "centre"], "target": place}
                for k, place in enumerate(targets)
            ],
            "free": {"pairs": PAIRS},
            "engine": engine,
            "limits": {"seconds": seconds, "iterations": iterations},
        }
    )


def main(words: list[str] | None = None) -> list[SearchResult]:
    """Fit the modules and put them together."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("-o", "--output", type=Path, default=Path("out/lampshade"))
    parser.add_argument("--seconds", type=float, default=30.0)
    parser.add_argument("--iterations", type=int, default=1000)
    parser.add_argument("--engine", default="learned")
    options = parser.parse_args(words)
    options.output.mkdir(parents=True, exist_ok=True)
    searches, parts = [], []
    for k, name in enumerate(MODULES):
        wanting = task(k, options.seconds, options.iterations, options.engine)
        write_task(wanting, options.output / f"{name}-task.json")
        search = optimize(wanting)
        assert search.check is not None
        result = search.check.shape
        place = Place.fitting(result.centres[-1], wanted(k))
        parts += [(result, Place.about_z(360 / AROUND * n).after(place)) for n in range(AROUND)]
        write_grid(search.grid, options.output / f"{name}.json")
        searches.append(search)
        print(
            f"{name}: {search.error_mm:.2f} mm by the engine, "
            f"{search.check.error_fea_mm:.2f} mm by finite elements, "
            f"{search.iterations} iterations, {search.designs} designs, {search.seconds:.0f} s"
        )
    mean = np.mean([search.check.error_fea_mm for search in searches])
    seconds = sum(search.seconds for search in searches)
    print(f"mean fitting error {mean:.2f} mm in {seconds:.0f} s (paper: 4.44 mm in 12 min)")
    text = f"{AROUND} x {len(MODULES)} modules, mean fitting error {mean:.2f} mm"
    assembly(parts, text).savefig(options.output / "assembly.png")
    return searches


if __name__ == "__main__":
    main()

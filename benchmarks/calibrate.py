"""Fit what the sources do not give: the shrinkage of the active half, and the creep.

The shrinkage e(active) is such that the middle half of a free, fully actuated beam bends as
measured (1.95 deg/mm over 50 mm). The creep is such that stage 2 moves the median of random 2x2
grids a twentieth as far as stage 1 did. Shell and active half are printed alike: same e.

    python benchmarks/calibrate.py [--write]
"""

import argparse
import re

import numpy as np
from scipy.optimize import brentq

from simulearn.fea import simulate_grid
from simulearn.fea.bar import bar, curvature
from simulearn.files import replacing
from simulearn.grid import Rules, draw_valid
from simulearn.material import Material, load_material
from simulearn.material.reading import HERE

NAME = "pla-hot-water"
CREEP_SHARE = 1 / 20
DESIGNS = 24


def changed(material: Material, part: str, **values: float) -> Material:
    """Return a material with some values of one part changed."""
    new = getattr(material, part).model_copy(update=values)
    return material.model_copy(update={part: new})


def bending(material: Material, active: float) -> float:
    """Return the curvature (deg/mm) of the free beam when e(active) is `active`."""
    free = changed(material, "gravity", acceleration=0.0)
    free = changed(free, "shrinkage", active=active, shell=active)
    trial = simulate_grid(bar(material.calibration.length, 1.0, material), free)
    return curvature(trial.solid, trial.displacements[-2])


def creep_share(material: Material, amplitude: float) -> float:
    """Return the median over random designs of stage 2's motion over stage 1's."""
    creeping = changed(material, "creep", amplitude=amplitude)
    shares = []
    for k in range(DESIGNS):
        grid, _ = draw_valid(Rules(), 2020, k)
        joints = simulate_grid(grid, creeping).joints.mean(axis=2)
        first, second = (
            np.linalg.norm(joints[a] - joints[b], axis=-1).mean() for a, b in [(10, 0), (11, 10)]
        )
        shares.append(second / first)
    return float(np.median(shares))


def main() -> None:
    """Fit, print, and on request write the material file."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--write", action="store_true", help="write the values to the file")
    write = parser.parse_args().write
    material = load_material(NAME)

    goal = material.calibration.curvature
    active = brentq(lambda e: bending(material, e) - goal, 0.05, 0.16, xtol=1e-6)
    active = round(float(active), 5)
    print(f"e(active) = {active}: {bending(material, active):.4f} deg/mm, wanted {goal}")
    material = changed(material, "shrinkage", active=active, shell=active)

    low, high = 0.02, 1.0
    amplitude = brentq(lambda a: creep_share(material, a) - CREEP_SHARE, low, high, xtol=2e-3)
    amplitude = round(float(amplitude), 3)
    print(
        f"creep amplitude = {amplitude}: median share {creep_share(material, amplitude):.4f} "
        f"of {DESIGNS} designs, wanted {CREEP_SHARE}"
    )
    if write:
        path = HERE / f"{NAME}.toml"
        text = path.read_text(encoding="utf-8")
        for key, value in (("active", active), ("shell", active), ("amplitude", amplitude)):
            pattern = rf"(?m)^({key} *= *)[\d.]+(?=.*(?:half; calibrated|same e|elastic strain))"
            text, count = re.subn(pattern, rf"\g<1>{value}", text)
            assert count == 1, key
        with replacing(path) as temporary:
            temporary.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()

"""How well a comparison finds the joints of scanned prints, and a change of the material.

The prints are simulated by finite elements in changed materials; scans of them have noise, strays,
a table, a hole around one joint, and lie anywhere.

    python benchmarks/compare.py
"""

import time

import numpy as np
from scipy.spatial.transform import Rotation

from report import Report
from simulearn.compare import JointPlaces, Scan, compare
from simulearn.compare.aligning import rigid
from simulearn.compare.changes import parameters
from simulearn.grid import Grid, make
from simulearn.material import Material, load_material
from simulearn.simulate import Result, engine, one, skin
from simulearn.simulate.engines import Engine

BASE = load_material("pla-hot-water")
CASES = (
    ("saddle", "strain", 1.15),
    ("saddle", "curl", 0.02),
    ("scroll", "strain", 1.15),
    ("twist", "curl", 0.02),
    ("bowl", "strain", 0.85),
)
POINTS, NOISE, TOUCH = 40_000, 0.2, 0.1  # of a scan; mm; mm, of touched joints


def printed(grid: Grid, name: str, value: float) -> Result:
    """Return the simulation of a print in a changed material."""
    from simulearn.fea import simulate_grid

    parameter = next(p for p in parameters(BASE) if p.name == name)
    material: Material = parameter.apply(BASE, value)

    def solver(design, _, *, progress, cancel):
        return simulate_grid(design, material, progress=progress, cancel=cancel)

    return one(Engine("fea", solver).simulate([grid])[0])


def scanned(result: Result, rng: np.random.Generator) -> Scan:
    """Return a scan of a print on a table, with strays and a hole, anywhere."""
    surface = skin(result)
    q = surface.vertices[-1][surface.quads]
    across = np.cross(q[:, 2] - q[:, 0], q[:, 3] - q[:, 1])
    area = np.linalg.norm(across, axis=1)
    at = rng.choice(len(q), POINTS, p=area / area.sum())
    u, v = rng.random((2, POINTS, 1))
    points = (1 - u) * ((1 - v) * q[at, 0] + v * q[at, 3]) + u * ((1 - v) * q[at, 1] + v * q[at, 2])
    points += NOISE * rng.normal(size=(POINTS, 1)) * across[at] / area[at, None]
    points = points[np.linalg.norm(points - result.centres[-1][0], axis=1) > 25.0]
    low, high = points.min(axis=0), points.max(axis=0)
    flat = rng.uniform(low[:2] - 60, high[:2] + 60, (2 * POINTS, 2))
    table = np.c_[flat, low[2] - 1 + NOISE * rng.normal(size=2 * POINTS)]
    strays = rng.uniform(low - 20, high + 20, (POINTS // 100, 3))
    turn = Rotation.random(random_state=int(rng.integers(10**6))).as_matrix()
    return Scan(np.concatenate([points, table, strays]) @ turn.T + rng.uniform(-300, 300, 3))


def main() -> None:
    """Measure and write the page."""
    report = Report("compare", "Comparing prints")
    rng = np.random.default_rng(2020)
    fea = engine("fea")
    scans, causes = [], []
    for name, parameter, value in CASES:
        grid = make(name, (3, 2) if name == "scroll" else (2, 2))
        hidden = printed(grid, parameter, value)
        scan = scanned(hidden, rng)
        begun = time.process_time()
        found = compare(grid, scan, fea, explain=False)
        seconds = time.process_time() - begun
        off = found.deviation
        seen = off.measured
        # A symmetric grid may be found turned: joints then have the numbers of others.
        true = hidden.centres[-1]
        orders = [np.arange(len(true)), np.arange(len(true))[::-1]]
        errors = []
        for order in orders:
            pose = rigid(true[order][seen], off.simulated[seen])
            errors.append(np.linalg.norm(off.joints[seen] - pose(true[order][seen]), axis=1))
        error = min(errors, key=np.mean)
        scans.append(
            (name, f"{parameter} {value:g}", f"{off.mean:.2f}", f"{seen.sum()} of {len(seen)}",
             f"{error.mean():.3f}", f"{error.max():.3f}", f"{found.noise:.2f}", f"{seconds:.1f}")
        )  # fmt: skip
        touched = true + TOUCH * rng.normal(size=true.shape)
        if name != "scroll":
            best = compare(grid, JointPlaces(touched, np.arange(len(true))), fea).explanations
            causes.append(
                (name, f"{parameter} {value:g}",
                 *(f"{e.name} {e.value:.4g}: {e.explained:.1%}" for e in best[:3]))
            )  # fmt: skip
    report.say(
        f"Scans of {POINTS:,} points with a noise of {NOISE} mm, a table, strays and a hole of 25 "
        "mm around joint 0, without normals, in random poses; prints are finite elements in a "
        "changed material. The time is of one processor, with the simulation."
    )
    report.table(
        ("design", "hidden change", "mean deviation, mm", "joints found", "their mean error, mm",
         "largest", "noise by the report, mm", "time, s"),
        scans,
    )  # fmt: skip
    report.say(
        f"Joints touched with a noise of {TOUCH} mm: the best value of each parameter and what "
        "part of the squared deviation it explains, the best three."
    )
    report.table(("design", "hidden change", "first", "second", "third"), causes)
    report.save()


if __name__ == "__main__":
    main()

"""How close the search comes to surfaces that can be reached, and how fast closest points are.

Each task is a smooth surface (a thin plate) through the nine joint centres of a random design's
shape by finite elements; the joints of a flat grid are wanted on it, anywhere. Every answer is
checked by finite elements. What is done is kept in a file, so the benchmark can be stopped and goes
on.

    python benchmarks/surface_tasks.py [--tasks 10] [--seconds 30] [--out out/surface_tasks]
    with the environment of the Makefile's ONE_THREAD
"""

import argparse
import json
import time
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import RBFInterpolator
from scipy.spatial import KDTree

from report import Report
from simulearn.grid import Rules, draw_valid, grid_to_dict, make
from simulearn.inverse import optimize, task_from_dict
from simulearn.simulate import engine
from simulearn.surfaces import Surface

SEED = 712  # no data set is drawn from it
LENGTH = 60.0  # mm, of the beams to begin with
MARGIN = 25.0  # mm, of the surface around the joints
NODES = 121  # of the surface along a side
FLOOR = 0.3  # mm
POINTS = 10_000


def centres_of(k: int, folder: Path) -> np.ndarray:
    """Return the joint centres (9, 3) mm of a random design by finite elements."""
    path = folder / f"centres-{k}.json"
    if not path.exists():
        (result,) = engine("fea").simulate([draw_valid(Rules(), SEED, k)[0]])
        path.write_text(json.dumps(result.centres[-1].tolist()), "utf-8")
    return np.array(json.loads(path.read_text("utf-8")))


def heights_through(points: np.ndarray) -> dict[str, Any]:
    """Return the surface of a task through points (N, 3) mm: a thin plate over a rectangle."""
    low, high = points[:, :2].min(axis=0) - MARGIN, points[:, :2].max(axis=0) + MARGIN
    u, v = (np.linspace(a, b, NODES) for a, b in zip(low, high, strict=True))
    places = np.stack(np.meshgrid(u, v), axis=-1).reshape(-1, 2)
    plate = RBFInterpolator(points[:, :2], points[:, 2], kernel="thin_plate_spline")
    heights = plate(places).reshape(NODES, NODES)
    return {"heights": heights.tolist(), "x": [low[0], high[0]], "y": [low[1], high[1]]}


def run(k: int, seconds: float, pose: str, folder: Path) -> dict[str, Any]:
    """Return what the search makes of a task."""
    task = task_from_dict(
        {
            "schema": "simulearn.task/1",
            "grid": grid_to_dict(make("flat", length=LENGTH)),
            "goals": [{"vertices": "joints", "surface": heights_through(centres_of(k, folder))}],
            "pose": pose,
            "limits": {"seconds": seconds},
        }
    )
    found = optimize(task)
    assert found.check is not None
    shape = found.check.shape
    assert shape is not None
    away = found.goals.distances(found.goals.points(shape.joints[-1], shape.beams[-1]))
    return {
        "start_mm": found.steps[0].error_mm,
        "error_mm": found.error_mm,
        "error_fea_mm": found.check.error_fea_mm,
        "median_mm": float(np.median(away)),
        "most_mm": float(away.max()),
        "designs": found.designs,
        "seconds": found.seconds,
    }


def runs_of(tasks: int, seconds: float, pose: str, folder: Path) -> list[dict[str, Any]]:
    """Run all tasks, one file for each."""
    folder.mkdir(parents=True, exist_ok=True)
    runs = []
    for k in range(tasks):
        path = folder / f"{pose}-{seconds:g}s-{k}.json"
        if not path.exists():
            path.write_text(json.dumps(run(k, seconds, pose, folder)), "utf-8")
        runs.append(json.loads(path.read_text("utf-8")))
        print(k, pose, runs[-1], flush=True)
    return runs


def waves(triangles: int) -> Surface:
    """Return a wavy surface of about so many triangles."""
    side = round((triangles / 2) ** 0.5) + 1
    x, y = np.meshgrid(np.linspace(-100, 100, side), np.linspace(-100, 100, side))
    z = 20 * np.sin(x / 30) * np.cos(y / 25)
    k = np.arange(side * side).reshape(side, side)
    a, b, c, d = (part.ravel() for part in (k[:-1, :-1], k[:-1, 1:], k[1:, 1:], k[1:, :-1]))
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return Surface(np.stack([x, y, z], axis=-1).reshape(-1, 3), faces)


def near(surface: Surface, away: float) -> np.ndarray:
    """Return POINTS places (N, 3) mm at most so far from a wavy surface, seen along z."""
    source = np.random.default_rng(0)
    at = source.integers(0, len(surface.vertices), POINTS)
    places: np.ndarray = surface.vertices[at] + [0, 0, 1] * source.uniform(-away, away, (POINTS, 1))
    return places


def best(call: Any) -> float:
    """Return the time of the quickest of five calls, ms of this process."""
    spent = []
    for _ in range(5):
        begun = time.process_time()
        call()
        spent.append(1000 * (time.process_time() - begun))
    return min(spent)


def by_candidates(surface: Surface, points: np.ndarray, count: int) -> np.ndarray:
    """Return distances (N,) mm from the triangles whose centres are nearest, which may be wrong."""
    from trimesh.triangles import closest_point

    corners = surface.vertices[surface.faces]
    _, which = KDTree(corners.mean(axis=1)).query(points, count)
    flat = closest_point(corners[which.ravel()], np.repeat(points, count, axis=0))
    away = np.linalg.norm(flat.reshape(len(points), count, 3) - points[:, None], axis=-1)
    least: np.ndarray = away.min(axis=1)
    return least


def speeds() -> tuple[list[list[str]], list[list[str]]]:
    """Return rows of times by triangles and distances, and of the other ways to do it."""
    rows = []
    for triangles in (1000, 10_000, 100_000, 1_000_000, 4_000_000):
        surface = waves(triangles)
        begun = time.process_time()
        surface.closest(np.zeros((1, 3)))
        tree = time.process_time() - begun
        times = [best(lambda s=surface, a=a: s.closest(near(s, a))) for a in (1.0, 10.0, 30.0)]
        rows.append([f"{len(surface.faces):,}", f"{tree:.2f}", *(f"{t:.0f}" for t in times)])
        print(rows[-1], flush=True)
    surface = waves(100_000)
    points = near(surface, 10.0)
    exact = surface.distance(points)
    others = [["tree of boxes", f"{best(lambda: surface.distance(points)):.0f}", "0"]]
    for count in (8, 32):
        spent = best(lambda c=count: by_candidates(surface, points, c))
        off = float((by_candidates(surface, points, count) - exact).max())
        others.append([f"{count} nearest centres (SciPy)", f"{spent:.0f}", f"{off:.1e}"])
    try:
        import trimesh

        mesh = trimesh.Trimesh(surface.vertices, surface.faces, process=False)
        few = points[:1000]
        spent = 10 * best(lambda: trimesh.proximity.closest_point(mesh, few))
        off = float(np.abs(trimesh.proximity.closest_point(mesh, few)[1] - exact[:1000]).max())
        others.append(["trimesh.proximity (with rtree)", f"{spent:.0f}", f"{off:.1e}"])
    except ImportError:
        pass
    return rows, others


def main() -> None:
    """Measure and report."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--tasks", type=int, default=10)
    parser.add_argument("--seconds", type=float, default=30.0)
    parser.add_argument("--out", type=Path, default=Path("out/surface_tasks"))
    given = parser.parse_args()
    report = Report("surface_tasks", "Surfaces as targets")
    report.say(
        f"{given.tasks} surfaces that can be reached: thin plates through the nine joint centres "
        f"of random designs (seed {SEED}) by finite elements. The joints of a flat grid of "
        f"{LENGTH:g} mm beams are wanted on them, anywhere; the limit is {given.seconds:g} s with "
        "all checks. Distances are along the normal, after the check by finite elements. With a "
        "free pose the shape may be placed anywhere on the surface."
    )
    rows = []
    for pose in ("fixed", "free"):
        runs = runs_of(given.tasks, given.seconds, pose, given.out)
        errors = np.array([r["error_fea_mm"] for r in runs], float)
        rows.append(
            [
                pose,
                f"{np.median([r['start_mm'] for r in runs]):.1f}",
                f"{np.median([r['median_mm'] for r in runs]):.2f}",
                f"{np.median(errors):.2f}",
                f"{errors.max():.2f}",
                f"{max(r['most_mm'] for r in runs):.2f}",
                f"{(errors <= FLOOR).sum()} of {len(errors)}",
                f"{np.median([r['seconds'] for r in runs]):.1f}",
            ]
        )
    head = ["pose", "to begin with, mm", "median distance", "mean distance: median", "worst"]
    report.table([*head, "farthest joint", f"mean to {FLOOR:g} mm", "seconds"], rows)
    speed, others = speeds()
    report.say(
        f"Closest points of {POINTS:,} points on a wavy surface of 200 mm, one thread, warm. They "
        "lie at most so far above or below it."
    )
    report.table(
        ["triangles", "tree, s", "1 mm: ms", "10 mm: ms", "30 mm: ms"],
        speed,
    )
    report.say(f"The same by others, {POINTS:,} points at most 10 mm away, 100,000 triangles:")
    report.table(["by", "ms", "too far by at most, mm"], others)
    report.save()


if __name__ == "__main__":
    main()

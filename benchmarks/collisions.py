"""Compare reported collisions with where the surfaces of a fine solid mesh run into each other.

Designs are drawn at random, of several kinds and materials, half of them with long actuators that
curl one way; the learned engine picks as many that collide as that do not. Finite elements on the
fine mesh simulate each. The surface of each part (the outer faces of its bricks) is sampled; a part
runs as deep into another as the deepest of its samples lies below the other's surface. Samples of
two joined parts within a beam's width of their joint are left out. This shares nothing with what it
tests but the solid.

    python benchmarks/collisions.py [--designs 100] [--folder FOLDER]

The folder keeps what is done; the same command goes on.
"""

import argparse
import json
import time
from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from skfem import ElementHexS2

from report import Report
from simulearn.collisions import Collision, find_all
from simulearn.dataset import read_config
from simulearn.grid import Grid, draw_kind
from simulearn.material import load_material
from simulearn.simulate import Result, engine, read_npz, write_npz
from simulearn.simulate.colliding import with_collisions
from simulearn.simulate.learned import Learned, designs_of

Array = NDArray[np.float64]
Pairs = dict[tuple[str, str], float]  # parts -> depth, mm

SEED = 4100
SPACING = 0.6  # mm between samples
STEPS = 3  # moments from each frame to the next
NEAREST = 6  # samples that must all say that a point is below the surface
MISS = 0.3  # mm, deeper than which none may be missed
MOST_BEAMS = 13  # of a design, so that finite elements take seconds
CORNERS = ElementHexS2.doflocs[:8]


def design(k: int) -> Grid:
    """Return random design k; every second one has long actuators on one side."""
    config = read_config("family")
    assert config.kinds is not None
    base = load_material("pla-hot-water")
    grid, material, _, _ = draw_kind(config.kinds, config.rules, base, SEED, k)
    if k % 2:
        grid = replace(grid, actuators=np.full(len(grid.beams), 1.0 if k % 4 == 1 else -1.0))
    return replace(grid, material=material)


def picked(count: int, folder: Path) -> list[int]:
    """Return the numbers of designs, half of which collide by the learned engine."""
    path = folder / f"designs-{count}.json"
    if path.exists():
        return list(json.loads(path.read_text()))
    learned = engine("learned")
    with_, without = [], []
    for k in range(100_000):
        grid = design(k)
        if len(grid.beams) > MOST_BEAMS:
            continue
        (outcome,) = learned.simulate([grid])
        if not isinstance(outcome, Result) or outcome.snaps:
            continue
        (with_ if outcome.collisions else without).append(k)
        if len(with_) >= count // 2 and len(without) >= count // 2:
            break
    numbers = sorted(with_[: count // 2] + without[: count // 2])
    path.write_text(json.dumps(numbers))
    return numbers


class Surface(NamedTuple):
    """The sampled surface of a part.

    Attributes:
        nodes: (N, 20) of the solid.
        shape: (N, 20) shares of them in each sample; along: the same of its two tangents.
        sign: (N,) of the cross product of the tangents, outwards.
        near: joint -> (N,) whether a sample is within a beam's width of it.
    """

    nodes: NDArray[np.int64]
    shape: Array
    along: tuple[Array, Array]
    sign: Array
    near: dict[int, NDArray[np.bool_]]

    def at(self, places: Array) -> tuple[Array, Array]:
        """Return samples and outward normals (N, 3) where the solid's nodes are at places."""
        x = places[self.nodes]
        a, b = (np.einsum("nk,nkx->nx", d, x) for d in self.along)
        normal = np.cross(a, b) * self.sign[:, None]
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        return np.einsum("nk,nkx->nx", self.shape, x), normal


def basis(points: Array) -> tuple[Array, Array]:
    """Return shape functions (N, 20) and their gradients (N, 3, 20) at unit points (N, 3)."""
    element = ElementHexS2()
    pairs = [element.lbasis(points.T, i) for i in range(20)]
    return np.stack([p for p, _ in pairs], -1), np.stack([d.T for _, d in pairs], -1)


def surfaces(result: Result) -> dict[str, Surface]:
    """Return the surface of each part of a solid by its name."""
    solid, grid = result.solid, result.grid
    assert solid is not None
    parts: dict[str, list[int]] = {}
    for k, (beam, number) in enumerate(solid.parts):
        parts.setdefault(f"beam {beam}" if beam >= 0 else f"joint {number}", []).append(k)
    width = load_material(grid.material).section.width
    centres = result.beams[0].mean(axis=2)
    found = {}
    for name, bricks in parts.items():
        rows = [*_faces(solid.bricks[bricks], solid.nodes)]
        nodes, shape, a, b, sign = (np.concatenate(x) for x in zip(*rows, strict=True))
        places = np.einsum("nk,nkx->nx", shape, solid.nodes[nodes])
        number = int(name.split()[1])
        near = {number: np.ones(len(places), bool)}
        if name.startswith("beam"):
            start, _, end = centres[number]
            along = (end - start) / np.linalg.norm(end - start)
            j0, j1 = (int(j) for j in grid.beams[number])
            near = {j0: (places - start) @ along < width, j1: (end - places) @ along < width}
        found[name] = Surface(nodes, shape, (a, b), sign, near)
    return found


def _faces(bricks: NDArray[np.int64], nodes: Array) -> Iterator[tuple[Array, ...]]:
    """Yield samples on each outer face of a part's bricks."""
    sides = [(axis, end) for axis in range(3) for end in (0.0, 1.0)]
    keys = np.array(
        [[np.sort(brick[:8][CORNERS[:, axis] == end]) for axis, end in sides] for brick in bricks]
    )
    _, index, counts = np.unique(
        keys.reshape(-1, 4), axis=0, return_inverse=True, return_counts=True
    )
    outer = (counts[index.ravel()] == 1).reshape(len(bricks), 6)
    for k, s in zip(*np.nonzero(outer), strict=True):
        axis, end = sides[s]
        others = [i for i in range(3) if i != axis]
        x = nodes[bricks[k]]
        unit = np.zeros((2, 3))
        grids = []
        for i in others:
            unit[:] = 0.5
            unit[:, axis], unit[0, i], unit[1, i] = end, 0.0, 1.0
            length = float(np.linalg.norm(np.diff(basis(unit)[0] @ x, axis=0)))
            grids.append(np.linspace(0, 1, 1 + max(1, round(length / SPACING))))
        points = np.empty((len(grids[0]), len(grids[1]), 3))
        points[..., axis] = end
        points[..., others[0]], points[..., others[1]] = np.meshgrid(*grids, indexing="ij")
        points = points.reshape(-1, 3)
        shape, slopes = basis(points)
        a, b = slopes[:, others[0]], slopes[:, others[1]]
        out = np.cross(a @ x, b @ x)[0] @ (shape.mean(axis=0) @ x - x[:8].mean(axis=0))
        count = len(points)
        yield (np.repeat(bricks[k][None], count, 0), shape, a, b, np.full(count, np.sign(out)))


def measured(result: Result) -> dict[str, float]:
    """Return how deep pairs of parts ever run into each other, by the solid's surfaces."""
    solid = result.solid
    assert solid is not None
    assert result.displacements is not None
    parts = surfaces(result)
    joined = {
        (a, b): set(parts[a].near) & set(parts[b].near) for a, b in combinations(sorted(parts), 2)
    }
    joined = {pair: same for pair, same in joined.items() if not _apart(result, pair)}
    deepest: dict[str, float] = {}
    shares = np.arange(STEPS) / STEPS
    moments = [(f, s) for f in range(len(result.joints) - 1) for s in shares]
    for f, share in [*moments, (len(result.joints) - 1, 0.0)]:
        after = result.displacements[min(f + 1, len(result.joints) - 1)]
        before = result.displacements[f]
        places = solid.nodes + before + share * (after - before)
        now = {name: part.at(places) for name, part in parts.items()}
        box = {name: (x.min(axis=0), x.max(axis=0)) for name, (x, _) in now.items()}
        trees: dict[str, Any] = {}
        for (a, b), same in joined.items():
            low = np.maximum(box[a][0], box[b][0])
            high = np.minimum(box[a][1], box[b][1])
            if (low >= high).any():
                continue
            joint = next(iter(same)) if same and _share(result, a, b, same) else -1
            for one, other in ((a, b), (b, a)):
                x, n = now[other]
                inside = ((now[one][0] > low) & (now[one][0] < high)).all(axis=1)
                if other not in trees:
                    trees[other] = cKDTree(x)
                points = now[one][0][inside]
                if not len(points):
                    continue
                _, k = trees[other].query(points, k=NEAREST)
                deep = -np.einsum("pkx,pkx->pk", points[:, None] - x[k], n[k]).max(axis=1)
                if joint >= 0:
                    near = parts[one].near[joint][inside] & parts[other].near[joint][k[:, 0]]
                    deep[near] = 0.0
                key = f"{a}, {b}"
                deepest[key] = max(deepest.get(key, 0.0), float(deep.max()))
    return {key: deep for key, deep in deepest.items() if deep > 0}


def _share(result: Result, a: str, b: str, same: set[int]) -> bool:
    """Return whether two parts are joined: numbers of a joint and a beam's joints may agree."""
    return bool(same) and ("beam" in a or "beam" in b)


def _apart(result: Result, pair: tuple[str, str]) -> bool:
    """Return whether the boxes of two parts around all frames, sections' bulge included, differ."""
    boxes = []
    for name in pair:
        kind, k = name.split()
        x = (result.beams if kind == "beam" else result.joints)[:, int(k)].reshape(-1, 3)
        bulge = 15.0 if kind == "beam" else 0.0
        boxes.append((x.min(axis=0) - bulge, x.max(axis=0) + bulge))
    (a, b), (c, d) = boxes
    return bool((a > d).any() or (c > b).any())


def reported(collisions: tuple[Collision, ...]) -> dict[str, float]:
    """Return the depths of collisions by their parts."""
    return {", ".join(sorted(one.parts)): one.depth_mm for one in collisions}


def answered(numbers: list[int], folder: Path) -> Iterator[tuple[Result, dict[str, float]]]:
    """Yield the result of each design by finite elements, and what its surfaces say."""
    fine = engine("fea", mesh="fine")
    for k in numbers:
        path = folder / f"{k}.npz"
        failed = path.with_suffix(".failed")
        if failed.exists():
            continue
        if not path.exists():
            (outcome,) = fine.simulate([design(k)])
            if not isinstance(outcome, Result):
                failed.write_text(outcome.message)
                continue
            write_npz(outcome, path)
        result = read_npz(path)
        said = path.with_suffix(".json")
        if not said.exists():
            said.write_text(json.dumps(measured(result)))
        print(k, "measured", flush=True)
        yield result, json.loads(said.read_text())


def compared(pairs: dict[str, float], said: dict[str, float]) -> tuple[int, list[float], int]:
    """Return right, missed (their depths) and false reports of a design."""
    missed = [deep for key, deep in pairs.items() if key not in said]
    right = sum(key in pairs for key in said)
    return right, missed, len(said) - right


def cost(count: int = 60) -> list[tuple[str, str, str, str]]:
    """Return rows of the time that collisions take beside that of a warm rollout."""
    from simulearn.grid import Rules, draw_valid

    learned = engine("learned")
    assert isinstance(learned, Learned)
    grids = [draw_valid(Rules(), 77, k)[0].centred for k in range(count)]
    rows = []
    for many in (1, count):
        spent: list[tuple[float, float]] = []
        for k in range(0, count) if many == 1 else range(9):
            some = grids[k : k + 1] if many == 1 else grids
            asked = designs_of(some, learned.material)
            for _ in range(2):  # the first is a warm-up
                begun = time.perf_counter()
                frames = learned.bundle.model.rollout(asked)
                between = time.perf_counter()
                find_all(frames.joints, frames.sections, asked.beams, asked.actuators)
                ended = time.perf_counter()
            spent.append(((between - begun) / many, (ended - between) / many))
        rollout, found = (1000 * float(np.median(x)) for x in zip(*spent, strict=True))
        rows.append((str(many), f"{rollout:.2f}", f"{found:.3f}", f"{100 * found / rollout:.1f} %"))
    return rows


def main() -> None:
    """Compare and report."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--designs", type=int, default=100)
    parser.add_argument("--folder", type=Path, default=Path("data/collisions"))
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    learned = engine("learned")
    # By whose sections; then designs that touch, pairs, right, false, missed deeper than .3 mm.
    names = ("fea, fine mesh", "the same, three sections of each beam", "learned")
    sums = {name: {"right": 0, "false": 0, "missed": [], "off": []} for name in names}
    designs = touching = pairs_all = deep_pairs = 0
    for result, pairs in answered(picked(given.designs, given.folder), given.folder):
        designs += 1
        touching += any(deep > MISS for deep in pairs.values())
        pairs_all += len(pairs)
        deep_pairs += sum(deep > MISS for deep in pairs.values())
        bare = replace(result, collisions=(), warnings=())
        (other,) = learned.simulate([result.grid])
        for name, one in zip(
            names,
            (with_collisions(bare), with_collisions(replace(bare, solid=None)), other),
            strict=True,
        ):
            if not isinstance(one, Result):
                continue
            said = reported(one.collisions)
            right, missed, false = compared(pairs, said)
            row: dict[str, Any] = sums[name]
            row["right"] += right
            row["false"] += false
            row["missed"] += missed
            shallow = [(said[k], pairs[k]) for k in said if k in pairs and pairs[k] < 1.5]
            row["off"] += [abs(a - b) for a, b in shallow]
            if name == names[0] and (false or any(deep > MISS for deep in missed)):
                print(
                    "false",
                    {k: v for k, v in said.items() if k not in pairs},
                    "missed",
                    {k: v for k, v in pairs.items() if k not in said},
                    flush=True,
                )
    report = Report("collisions", "Collisions")
    report.say(
        f"{designs} random designs of several kinds and materials; in {touching} of them parts run "
        f"into each other by more than {MISS} mm, by the sampled surfaces of the fine solid mesh, "
        f"in all frames and between them: {pairs_all} pairs of parts, {deep_pairs} of these deeper "
        f"than {MISS} mm."
    )
    report.table(
        [
            "collisions of",
            "right",
            "false",
            f"missed, deeper than {MISS} mm",
            "deepest missed, mm",
            "median difference of shallow depths, mm",
        ],
        [
            (
                name,
                row["right"],
                row["false"],
                sum(deep > MISS for deep in row["missed"]),
                f"{max(row['missed'], default=0.0):.2f}",
                f"{np.median(row['off'] or [0.0]):.2f}",
            )
            for name, row in ((name, dict[str, Any](sums[name])) for name in names)
        ],
    )
    report.say("Time beside that of a warm rollout of 2x2 designs, side by side, the median:")
    report.table(["designs at once", "rollout, ms a design", "collisions, ms", "ratio"], cost())
    report.save()


if __name__ == "__main__":
    main()

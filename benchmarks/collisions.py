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
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
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
from simulearn.grid import Grid, Rules, draw_kind, draw_valid
from simulearn.material import load_material
from simulearn.simulate import Result, engine, read_npz, write_npz
from simulearn.simulate.colliding import with_collisions
from simulearn.simulate.designs import designs_of
from simulearn.simulate.learned import Learned

Array = NDArray[np.float64]
Pair = tuple[str, str]  # names of two parts
Confirm = Callable[[Collision], bool]

SEED = 4100
SPACING = 0.6  # mm between samples
STEPS = 3  # moments from each frame to the next
NEAREST = 6  # samples that must all say that a point is below the surface
THICK = 4.0  # mm; twice as deep as a point can be in a part
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


class Reference:
    """How deep parts of a solid are in each other.

    Args:
        result: with its solid.
    """

    def __init__(self, result: Result) -> None:
        assert result.solid is not None
        assert result.displacements is not None
        self.nodes, self.moved = result.solid.nodes, result.displacements
        self.parts = surfaces(result)
        self.pairs = [
            pair for pair in combinations(sorted(self.parts), 2) if not _apart(result, pair)
        ]

    def depths(self, frame: int, share: float, pairs: Iterable[Pair]) -> dict[Pair, float]:
        """Return the depths of pairs that are in each other at a moment, mm."""
        before, after = self.moved[frame], self.moved[min(frame + 1, len(self.moved) - 1)]
        places = self.nodes + before + share * (after - before)
        now = {name: part.at(places) for name, part in self.parts.items()}
        box = {name: (x.min(axis=0), x.max(axis=0)) for name, (x, _) in now.items()}
        trees: dict[str, Any] = {}
        found: dict[Pair, float] = {}
        for a, b in pairs:
            low = np.maximum(box[a][0], box[b][0])
            high = np.minimum(box[a][1], box[b][1])
            if (low >= high).any():
                continue
            both = set(self.parts[a].near) & set(self.parts[b].near)
            for one, other in ((a, b), (b, a)):
                x, n = now[other]
                inside = ((now[one][0] > low) & (now[one][0] < high)).all(axis=1)
                if not inside.any():
                    continue
                if other not in trees:
                    trees[other] = cKDTree(x)
                # No point is deeper than half of what is thinnest.
                away, _ = trees[other].query(now[one][0][inside], distance_upper_bound=THICK)
                inside[inside] = np.isfinite(away)
                points = now[one][0][inside]
                if not len(points):
                    continue
                _, k = trees[other].query(points, k=NEAREST)
                deep = -np.einsum("pkx,pkx->pk", points[:, None] - x[k], n[k]).max(axis=1)
                for joint in both:
                    near = self.parts[one].near[joint][inside]
                    deep[near & self.parts[other].near[joint][k[:, 0]]] = 0.0
                if deep.max() > 0:
                    found[a, b] = max(found.get((a, b), 0.0), float(deep.max()))
        return found

    def deepest(self) -> dict[Pair, float]:
        """Return how deep pairs are ever in each other, mm."""
        last = len(self.moved) - 1
        moments = [(f, s / STEPS) for f in range(last) for s in range(STEPS)]
        deepest: dict[Pair, float] = {}
        for f, share in [*moments, (last, 0.0)]:
            for pair, deep in self.depths(f, share, self.pairs).items():
                deepest[pair] = max(deepest.get(pair, 0.0), deep)
        return deepest

    def confirms(self, one: Collision) -> bool:
        """Return whether a collision is there at its moment."""
        a, b = sorted(one.parts)
        return bool(self.depths(one.frame, one.share, [(a, b)]))


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


def answered(numbers: list[int], folder: Path) -> Iterator[tuple[int, Result, dict[Pair, float]]]:
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
        named = replace(result.grid, material=design(k).material)
        result = replace(result, grid=named)  # files name the material alone
        said = path.with_suffix(".json")
        if not said.exists():
            rows = [[*pair, deep] for pair, deep in Reference(result).deepest().items()]
            said.write_text(json.dumps(rows))
            print(k, len(rows), flush=True)
        yield k, result, {(a, b): deep for a, b, deep in json.loads(said.read_text())}


@dataclass
class Tally:
    """What came of the reports by one kind of sections.

    Attributes:
        right: pairs that are in each other.
        false: pairs that are not, with their depths.
        missed: depths of pairs that were not reported.
        off: differences of depths that are less than 1.5 mm: deeper ones are measured otherwise.
        designs: with a false report.
    """

    right: int = 0
    false: list[float] = field(default_factory=list)
    missed: list[float] = field(default_factory=list)
    off: list[float] = field(default_factory=list)
    designs: int = 0

    def add(
        self, collisions: Sequence[Collision], pairs: dict[Pair, float], confirms: Confirm
    ) -> str:
        """Add the reports of a design; return what is wrong with them."""
        said = {tuple(sorted(one.parts)): one for one in collisions}
        new = [one for pair, one in said.items() if pair not in pairs and not confirms(one)]
        missed = {pair: deep for pair, deep in pairs.items() if pair not in said}
        self.right += len(said) - len(new)
        self.false += [one.depth_mm for one in new]
        self.designs += bool(new)
        self.missed += missed.values()
        self.off += [
            abs(said[pair].depth_mm - deep)  # type: ignore[index]
            for pair, deep in pairs.items()
            if pair in said and deep < 1.5
        ]
        wrong = [f"false {one.parts} {one.frame}+{one.share:.2f} {one.depth_mm:.2f}" for one in new]
        wrong += [f"missed {pair} {deep:.2f}" for pair, deep in missed.items() if deep > MISS]
        return "; ".join(wrong)

    @property
    def row(self) -> tuple[object, ...]:
        """Right, false, designs with false ones, missed, the deepest missed, differences."""
        missed, off = np.array(self.missed or [0.0]), self.off or [0.0]
        return (self.right, len(self.false), self.designs, int((missed > MISS).sum()),
                f"{missed.max():.2f}", f"{np.median(off):.2f}")  # fmt: skip


def cost(count: int = 60) -> list[tuple[str, str, str, str]]:
    """Return rows of the time that collisions take beside that of a warm rollout."""
    learned = engine("learned")
    assert isinstance(learned, Learned)
    grids = [draw_valid(Rules(), 77, k)[0].centred for k in range(count)]
    rows = []
    for many in (1, count):
        spent: list[tuple[float, float]] = []
        for k in range(0, count) if many == 1 else range(9):
            some = grids[k : k + 1] if many == 1 else grids
            batch = designs_of(some, learned.material)
            for _ in range(2):  # the first is a warm-up
                begun = time.perf_counter()
                frames = learned.bundle.model.rollout(batch)
                between = time.perf_counter()
                find_all(frames.joints, frames.sections, batch.beams, batch.actuators)
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
    names = ("fea, the solid", "fea, three sections of each beam", "learned")
    tallies = [Tally() for _ in names]
    every: list[dict[Pair, float]] = []
    for k, result, pairs in answered(picked(given.designs, given.folder), given.folder):
        every.append(pairs)
        bare = replace(result, collisions=(), warnings=())
        solid, three = with_collisions(bare), with_collisions(replace(bare, solid=None))
        (other,) = learned.simulate([result.grid])
        reference = Reference(result) if solid.collisions or three.collisions else None
        confirms: Confirm = (lambda one: False) if reference is None else reference.confirms
        for name, tally, outcome in zip(names, tallies, (solid, three, other), strict=True):
            if isinstance(outcome, Result):
                wrong = tally.add(outcome.collisions, pairs, confirms)
                if wrong and tally is not tallies[-1]:
                    print(k, f"{name}: {wrong}", flush=True)
    deep = [sum(depth > MISS for depth in pairs.values()) for pairs in every]
    report = Report("collisions", "Collisions")
    report.say(
        f"{len(every)} random designs of several kinds and materials. By the sampled surfaces of "
        f"the fine solid mesh, in all frames and at two moments between each two, parts run into "
        f"each other by more than {MISS} mm in {sum(map(bool, deep))} of them: {sum(deep)} pairs "
        f"of parts, and {sum(map(len, every)) - sum(deep)} pairs that do by less."
    )
    report.table(
        ["sections of the beams", "right", "false", "designs with a false one",
         f"missed, deeper than {MISS} mm", "deepest missed, mm", "median difference, mm"],
        [(name, *tally.row) for name, tally in zip(names, tallies, strict=True)],
    )  # fmt: skip
    report.say("Time beside that of a warm rollout of 2x2 designs, side by side, the median:")
    report.table(["designs at once", "rollout, ms a design", "collisions, ms", "ratio"], cost())
    report.save()


if __name__ == "__main__":
    main()

"""Drawings of known grids, clean and messy."""

import itertools
from collections.abc import Callable
from math import cos, pi, sin

import numpy as np

from simulearn.drawings.drawing import Drawing, Line

L = {(0, 0), (65, 0), (130, 0), (0, 65), (65, 65), (130, 65), (0, 130), (65, 130)}
SIDE = 65.0


def lattice_like(shape: Callable[[float, float], tuple[float, float]]) -> list[np.ndarray]:
    """Return the beams (2, 2) of the grid of three cells in an L, its joints moved by `shape`."""
    pairs = [
        ((x, y), (x + dx, y + dy))
        for x, y in sorted(L)
        for dx, dy in ((65, 0), (0, 65))
        if (x + dx, y + dy) in L
    ]
    return [np.array([shape(*a), shape(*b)]) for a, b in pairs]


def l_grid() -> list[np.ndarray]:
    """Return ten beams of 65 mm in three cells; the cell at the upper right is missing."""
    return lattice_like(lambda x, y: (x, y))


def skew() -> list[np.ndarray]:
    """Return the same cells as parallelograms, with angles of 52 degrees."""
    return lattice_like(lambda x, y: (x + 0.6 * y, 0.8 * y + 0.03 * x))


def triangles() -> list[np.ndarray]:
    """Return a net of triangles of 60 mm, two rows of three points and one of two."""
    h = 60 * sin(pi / 3)
    rows = [[(60 * k + 30 * (row % 2), row * h) for k in range(3 - row % 2)] for row in range(3)]
    lines = []
    points = [p for row in rows for p in row]
    for i, a in enumerate(points):
        for b in points[i + 1 :]:
            if abs(np.hypot(a[0] - b[0], a[1] - b[1]) - 60) < 1e-6:
                lines.append(np.array([a, b]))
    return lines


def honeycomb() -> list[np.ndarray]:
    """Return seven cells of six beams of 40 mm."""
    sides = {}
    for q in range(-1, 2):
        for r in range(-1, 2):
            if abs(q + r) > 1:
                continue
            middle = (40 * 3**0.5 * (q + r / 2), 60 * r)
            corner = [
                (middle[0] + 40 * sin(k * pi / 3), middle[1] + 40 * cos(k * pi / 3))
                for k in range(7)
            ]
            for a, b in itertools.pairwise(corner):
                key = frozenset([tuple(np.round(a, 3) + 0.0), tuple(np.round(b, 3) + 0.0)])
                sides.setdefault(key, np.array([a, b]))
    return list(sides.values())


def radial() -> list[np.ndarray]:
    """Return two rings of nine corners and spokes between them."""
    ring = [
        [(r * cos(2 * pi * k / 9), r * sin(2 * pi * k / 9)) for k in range(9)] for r in (80, 150)
    ]
    return [
        np.array(pair)
        for k in range(9)
        for pair in (
            (ring[0][k], ring[0][(k + 1) % 9]),
            (ring[1][k], ring[1][(k + 1) % 9]),
            (ring[0][k], ring[1][k]),
        )
    ]


NETS = {
    "L": l_grid,
    "skew": skew,
    "triangles": triangles,
    "honeycomb": honeycomb,
    "radial": radial,
}


def ends_moved(lines: list[np.ndarray], random: np.random.Generator, most: float) -> list:
    """Return lines with ends moved along their own axes, inwards and outwards."""
    moved = []
    for a, b in lines:
        direction = (b - a) / np.hypot(*(b - a))
        first, last = random.uniform(-most, most, 2)
        moved.append(np.array([a + first * direction, b + last * direction]))
    return moved


def doubled(lines: list[np.ndarray], random: np.random.Generator) -> list[np.ndarray]:
    """Return lines, some of them twice, some the other way round."""
    return [*lines, *(line[::-1] for line in lines if random.random() < 0.4)]


def overlapped(lines: list[np.ndarray], random: np.random.Generator) -> list[np.ndarray]:
    """Return lines, some of them as two pieces that overlap by a few millimetres."""
    pieces = []
    for a, b in lines:
        if random.random() < 0.5:
            cut, more = random.uniform(0.3, 0.6), random.uniform(0.05, 0.2)
            pieces += [np.array([a, a + (cut + more) * (b - a)]), np.array([b, a + cut * (b - a)])]
        else:
            pieces.append(np.array([a, b]))
    return pieces


def with_crumbs(lines: list[np.ndarray], random: np.random.Generator) -> list[np.ndarray]:
    """Return lines and crumbs near their ends."""
    ends = np.concatenate(lines)[random.integers(0, 2 * len(lines), 4)]
    return [*lines, *(np.array([p, p + random.uniform(-0.3, 0.3, 2)]) for p in ends)]


def with_stubs(lines: list[np.ndarray], random: np.random.Generator) -> list[np.ndarray]:
    """Return lines and some that go on past an end by 3 to 12 mm."""
    stubs = []
    for k in random.integers(0, len(lines), 3):
        a, b = lines[k]
        direction = (b - a) / np.hypot(*(b - a))
        turn = random.uniform(0.5, 1.0) * random.choice([-1, 1])
        direction = np.array([[cos(turn), -sin(turn)], [sin(turn), cos(turn)]]) @ direction
        stubs.append(np.array([b, b + random.uniform(3, 12) * direction]))
    return [*lines, *stubs]


def shuffled(lines: list[np.ndarray], random: np.random.Generator) -> list[np.ndarray]:
    """Return lines in another order, some the other way round."""
    return [lines[k][:: random.choice([-1, 1])] for k in random.permutation(len(lines))]


def noisy(lines: list[np.ndarray], random: np.random.Generator) -> list[np.ndarray]:
    """Return lines whose points are off by up to a micrometre."""
    return [line + random.uniform(-1e-3, 1e-3, line.shape) for line in lines]


def turned(lines: list[np.ndarray], angle: float) -> list[np.ndarray]:
    """Return lines turned about the origin."""
    turn = np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])
    return [line @ turn.T for line in lines]


def drawing(lines: list, layers: list[str] | None = None, **more: object) -> Drawing:
    """Return a drawing of plain lines, in mm unless another unit is given."""
    spatial = [np.column_stack([line, np.zeros(len(line))]) for line in map(np.asarray, lines)]
    names = layers or [""] * len(lines)
    drawn = [
        Line(points, name, where=f"line {k}")
        for k, (points, name) in enumerate(zip(spatial, names, strict=True))
    ]
    return Drawing("test", drawn, **{"plain": True, **more})


def beams_of(grid) -> list[tuple]:
    """Return the beams of a grid as sorted pairs of places."""
    return places_of([grid.joints[list(pair)] for pair in grid.beams])


def places_of(lines: list[np.ndarray]) -> list[tuple]:
    """Return lines as pairs of places, ends and lines in rising order."""
    return sorted(tuple(sorted(map(tuple, (np.round(line, 2) + 0.0).tolist()))) for line in lines)


def at_the_origin(lines: list[np.ndarray]) -> list[np.ndarray]:
    """Return lines with the lower left corner of all at the origin."""
    corner = np.concatenate([np.asarray(line) for line in lines]).min(axis=0)
    return [np.asarray(line) - corner for line in lines]


def same(grid, lines: list[np.ndarray], within: float = 0.01) -> bool:
    """Return whether a grid has exactly the beams of clean lines moved to the origin, within mm."""
    if len(grid.beams) != len(lines):
        return False
    left = at_the_origin(lines)
    for pair in grid.beams:
        ends = grid.joints[pair]
        for k, line in enumerate(left):
            if min(abs(ends - line).max(), abs(ends[::-1] - line).max()) <= within:
                del left[k]
                break
        else:
            return False
    return True

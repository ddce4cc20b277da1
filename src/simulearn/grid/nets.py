"""Plain nets of beams of length one, from which random designs of several kinds begin.

A joint has at most four beams.
"""

from collections.abc import Callable
from math import cos, pi, sin, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulearn.grid.lattice import lattice

Uniform = Callable[[], float]  # draws from [0, 1)


class Net(NamedTuple):
    """A net: joints (J, 2) in lengths of a beam, and beams (B, 2)."""

    joints: NDArray[np.float64]
    beams: list[tuple[int, int]]


def _among(uniform: Uniform, least: int, most: int) -> int:
    return least + int(uniform() * (most + 1 - least))


def _cells(nx: int, ny: int) -> Net:
    grid = lattice((nx, ny), 1.0)
    return Net(grid.joints, [(int(a), int(b)) for a, b in grid.beams])


def chain(uniform: Uniform) -> Net:
    """Return one to four beams in line, or turning at every joint."""
    count, turn = _among(uniform, 1, 4), (uniform() - 0.5) * 1.6
    at, angle, joints = np.zeros(2), 0.0, [np.zeros(2)]
    for k in range(count):
        at = at + np.array([cos(angle), sin(angle)])
        joints.append(at)
        angle += turn * (-1) ** k if uniform() < 0.5 else turn
    return Net(np.array(joints), [(k, k + 1) for k in range(count)])


def strip(uniform: Uniform) -> Net:
    """Return two to six cells in a row."""
    return _cells(_among(uniform, 2, 6), 1)


def polygon(uniform: Uniform) -> Net:
    """Return a ring of three to eight beams."""
    sides = _among(uniform, 3, 8)
    angle = 2 * pi * np.arange(sides) / sides
    radius = 1 / (2 * sin(pi / sides))
    joints = radius * np.stack([np.cos(angle), np.sin(angle)], -1)
    return Net(joints, [(k, (k + 1) % sides) for k in range(sides)])


def radial(uniform: Uniform) -> Net:
    """Return two or three rings of four to seven joints with spokes between them."""
    spokes, rings = _among(uniform, 4, 7), _among(uniform, 2, 3)
    angle = 2 * pi * np.arange(spokes) / spokes
    inner = max(0.75, 1 / (2 * sin(pi / spokes)))
    joints = [
        (inner + ring) * np.stack([np.cos(angle), np.sin(angle)], -1) for ring in range(rings)
    ]
    around = [
        (spokes * ring + k, spokes * ring + (k + 1) % spokes)
        for ring in range(rings)
        for k in range(spokes)
    ]
    outwards = [
        (spokes * ring + k, spokes * (ring + 1) + k)
        for ring in range(rings - 1)
        for k in range(spokes)
    ]
    return Net(np.concatenate(joints), around + outwards)


def skew(uniform: Uniform) -> Net:
    """Return a lattice of two cells by two or three that is sheared by up to 35 degrees."""
    joints, beams = _cells(2, _among(uniform, 2, 3))
    angle = pi / 2 - (uniform() - 0.5) * 2 * 35 * pi / 180
    return Net(joints @ np.array([[1.0, 0.0], [cos(angle), sin(angle)]]), beams)


def honeycomb(uniform: Uniform) -> Net:
    """Return one to four hexagons that share sides."""
    count = _among(uniform, 1, 4)
    places = [(0.0, 0.0), (sqrt(3), 0.0), (sqrt(3) / 2, 1.5), (-sqrt(3) / 2, 1.5)][:count]
    return _merged_rings([_ring(6, pi / 6) + np.array(place) for place in places])


def brick(uniform: Uniform) -> Net:
    """Return courses of cells that are each half a cell from the next, as in a wall."""
    rows, wide = _among(uniform, 2, 3), _among(uniform, 1, 2)
    points: list[tuple[float, float]] = []
    pairs = []
    for row in range(rows):
        for k in range(wide):
            x = 2 * k + (row % 2)
            ring = [(x, row), (x + 1, row), (x + 2, row), (x + 2, row + 1), (x + 1, row + 1),
                    (x, row + 1)]  # fmt: skip
            pairs += list(zip(ring, ring[1:] + ring[:1], strict=True))
    for pair in pairs:
        points += [(float(x), float(y)) for x, y in pair]
    return _merged(np.array(points).reshape(-1, 2, 2))


def truss(uniform: Uniform) -> Net:
    """Return a strip of three to seven triangles."""
    count = _among(uniform, 3, 7)
    joints = [(k / 2, sqrt(3) / 2 * (k % 2)) for k in range(count + 2)]
    beams = [(k, k + 1) for k in range(count + 1)] + [(k, k + 2) for k in range(count)]
    return Net(np.array(joints), beams)


def kagome(uniform: Uniform) -> Net:
    """Return a hexagon with three to six triangles on its sides, a piece of a kagome net."""
    hexagon = np.array([[cos(pi * k / 3), sin(pi * k / 3)] for k in range(6)])
    segments = [(hexagon[k], hexagon[(k + 1) % 6]) for k in range(6)]
    count = _among(uniform, 3, 6)
    for k in range(count):
        a, b = hexagon[k], hexagon[(k + 1) % 6]
        tip = a + b
        segments += [(a, tip), (b, tip)]
    return _merged(np.array(segments))


def wheel(uniform: Uniform) -> Net:
    """Return a hub with three or four spokes to a rim of triangles."""
    spokes = _among(uniform, 3, 4)
    angle = 2 * pi * np.arange(spokes) / spokes
    rim = np.stack([np.cos(angle), np.sin(angle)], -1)
    around = [(1 + k, 1 + (k + 1) % spokes) for k in range(spokes)]
    return Net(np.vstack([np.zeros(2), rim]), [(0, 1 + k) for k in range(spokes)] + around)


def octagon(uniform: Uniform) -> Net:
    """Return an octagon with one to four squares on every other side."""
    places, reach = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)], 1 + sqrt(0.5)
    rings = [_ring(8, pi / 8)]
    for x, y in places[: _among(uniform, 1, 4)]:
        rings.append(_ring(4, pi / 4) + np.array([x, y]) * reach)
    return _merged_rings(rings)


def diamonds(uniform: Uniform) -> Net:
    """Return a row of two to four diamonds that meet at their corners."""
    half = pi / 6 + uniform() * pi / 12
    across, up = cos(half), sin(half)
    diamond = np.array([[-across, 0.0], [0.0, -up], [across, 0.0], [0.0, up]])
    step = np.array([2 * across, 0.0])
    return _merged_rings([diamond + k * step for k in range(_among(uniform, 2, 4))])


def pinwheel(uniform: Uniform) -> Net:
    """Return a square with one to four cells around it, each passing it by half its length."""
    cell = np.array([[0, 0], [1, 0], [2, 0], [2, 1], [1, 1], [0, 1]]) - np.array([0.5, 1.5])
    turn = np.array([[0.0, -1.0], [1.0, 0.0]])
    rings = [_ring(4, pi / 4)]
    for _ in range(_among(uniform, 1, 4)):
        rings.append(cell)
        cell = cell @ turn.T
    return _merged_rings(rings)


def _ring(sides: int, turn: float) -> NDArray[np.float64]:
    """Return the corners (sides, 2) of a regular polygon with sides of length one."""
    angle = turn + 2 * pi * np.arange(sides) / sides
    return np.stack([np.cos(angle), np.sin(angle)], -1) / (2 * sin(pi / sides))


def _merged_rings(rings: list[NDArray[np.float64]]) -> Net:
    """Return the net of closed rings of corners; beams that two of them share are one."""
    pairs = [np.stack([ring, np.roll(ring, -1, axis=0)], axis=1) for ring in rings]
    return _merged(np.concatenate(pairs))


def _merged(segments: NDArray[np.float64]) -> Net:
    """Return the net of segments (N, 2, 2), points in the same place being one joint."""
    keys: dict[tuple[float, float], int] = {}
    joints: list[NDArray[np.float64]] = []
    beams: list[tuple[int, int]] = []
    for segment in segments:
        ends = []
        for point in segment:
            key = (round(float(point[0]), 6) + 0.0, round(float(point[1]), 6) + 0.0)
            if key not in keys:
                keys[key] = len(joints)
                joints.append(point)
            ends.append(keys[key])
        pair = (min(ends), max(ends))
        if pair not in beams:
            beams.append(pair)
    return Net(np.array(joints), beams)


def _two_by_two(uniform: Uniform) -> Net:
    return _cells(2, 2)


def _two_by_three(uniform: Uniform) -> Net:
    return _cells(2, 3)


def _three_by_three(uniform: Uniform) -> Net:
    return _cells(3, 3)


def removed(uniform: Uniform) -> Net:
    """Return a lattice of 2 x 2 cells with one to three beams taken out."""
    joints, beams = _cells(2, 2)
    order = np.argsort([uniform() for _ in beams], kind="stable")
    out = set(order[: _among(uniform, 1, 3)].tolist())
    return Net(joints, [beam for k, beam in enumerate(beams) if k not in out])


NETS: dict[str, Callable[[Uniform], Net]] = {
    "2x2": _two_by_two,
    "removed": removed,
    "2x3": _two_by_three,
    "3x3": _three_by_three,
    "chain": chain,
    "strip": strip,
    "polygon": polygon,
    "honeycomb": honeycomb,
    "radial": radial,
    "skew": skew,
    "brick": brick,
    "truss": truss,
    "kagome": kagome,
    "wheel": wheel,
    "octagon": octagon,
    "diamonds": diamonds,
    "pinwheel": pinwheel,
}

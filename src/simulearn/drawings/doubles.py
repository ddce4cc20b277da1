"""Pieces that lie on each other become one: lines drawn twice, and pieces that overlap.

The axis of what they become is the straight line that fits them by least squares, in which pieces
that are off the others count less.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.drawings.parts import parts
from simulearn.drawings.pieces import EXACT

Numbers = NDArray[np.float64]
Indices = NDArray[np.int64]

# The sine of the angle up to which pieces lie along each other.
ALIKE = 0.1
# An axis is fitted so often; each time pieces that are off it count less, so that it follows those
# that agree.
ROUNDS = 4


@dataclass(frozen=True, eq=False)
class Runs:
    """Straight runs: each is one piece, or several that lie on each other.

    Attributes:
        ends: (R, 2, 2) mm.
        run: (P,) of each piece.
        double: (D, 2) mm, the middles of pieces that were drawn before.
        overlap: (O, 2) mm, the middles of pieces that overlap another one.
    """

    ends: Numbers
    run: Indices
    double: Numbers
    overlap: Numbers


def united(
    ends: Numbers, pairs: tuple[Indices, Indices], tolerance: float, overlaps: bool = True
) -> Runs:
    """Return the runs of straight pieces.

    Args:
        ends: (P, 2, 2) mm.
        pairs: numbers of pieces that are near each other, lower first.
        tolerance: within it two pieces lie on each other, and overlap by more than it, mm.
        overlaps: whether pieces that only overlap are united; if not, those drawn twice.
    """
    a, b = pairs
    double = _double(ends[a], ends[b], tolerance)
    on = double | _overlap(ends[a], ends[b], tolerance) if overlaps else double
    a, b, double = a[on], b[on], double[on]
    none = np.zeros((0, 2))
    if not len(a):
        return Runs(ends, np.arange(len(ends)), none, none)
    _, group = np.unique(parts(len(ends), a, b), return_inverse=True)
    for loose in _loose(ends, group, tolerance):
        group[loose] = group.max() + 1 + _split(ends[loose], tolerance)
    # Runs are numbered by their first pieces, so that those of a clean drawing keep their order.
    _, first, group = np.unique(group, return_index=True, return_inverse=True)
    rank = np.argsort(np.argsort(first))
    run = rank[group]
    alone = np.bincount(run)[run] == 1
    heft = np.ones(len(ends))
    for _ in range(ROUNDS):
        runs, aside = _fitted(ends, run, heft)
        heft = 1 / (aside**2 + (EXACT * tolerance) ** 2)
    runs[run[alone]] = ends[alone]
    again = np.zeros(len(ends), bool)
    again[b[double & (run[a] == run[b])]] = True
    more = ~alone & ~again
    more[np.sort(first)] = False
    middle = ends.mean(axis=1)
    return Runs(runs, run, middle[again], middle[more])


def _double(a: Numbers, b: Numbers, tolerance: float) -> NDArray[np.bool_]:
    """Return whether pieces (n, 2, 2) have both ends near those of others, either way round."""

    def near(other: Numbers) -> NDArray[np.bool_]:
        return (np.hypot(*np.moveaxis(a - other, 2, 0)) <= tolerance).all(axis=1)

    return near(b) | near(b[:, ::-1])


def _overlap(a: Numbers, b: Numbers, tolerance: float) -> NDArray[np.bool_]:
    """Return whether pieces (n, 2, 2) run along others for more than the tolerance."""
    size = [np.hypot(*(x[:, 1] - x[:, 0]).T) for x in (a, b)]
    swap = (size[0] < size[1])[:, None, None]
    long, short = np.where(swap, b, a), np.where(swap, a, b)
    length = np.maximum(*size)
    along = (long[:, 1] - long[:, 0]) / length[:, None]
    apart = short - long[:, :1]
    place = (apart * along[:, None]).sum(axis=2)
    aside = apart[..., 0] * along[:, None, 1] - apart[..., 1] * along[:, None, 0]
    common = np.minimum(place.max(axis=1), length) - np.maximum(place.min(axis=1), 0)
    turn = abs(aside[:, 1] - aside[:, 0]) / np.minimum(*size)
    on: NDArray[np.bool_] = (abs(aside).max(axis=1) <= tolerance) & (turn <= ALIKE)
    return on & (common > tolerance)


def _fitted(ends: Numbers, group: Indices, heft: Numbers) -> tuple[Numbers, Numbers]:
    """Return for each group the straight piece that fits it (G, 2, 2), and how far pieces are off.

    Pieces count by the cubes of their lengths, too: short ones hardly say where the axis is.

    Args:
        ends: (P, 2, 2) mm.
        group: (P,) numbers from 0.
        heft: (P,) how much each piece counts.
    """
    count = int(group.max()) + 1
    along = ends[:, 1] - ends[:, 0]
    length = np.hypot(*along.T)

    def total(values: Numbers) -> Numbers:
        return np.asarray(np.bincount(group, values, count), np.float64)

    heft = heft * length**3
    weight = total(heft)
    middle = ends.mean(axis=1)
    centre = np.stack([total(heft * middle[:, k]) / weight for k in (0, 1)], axis=1)
    apart = middle - centre[group]
    xx, xy, yy = (
        total(heft * (apart[:, i] * apart[:, j] + along[:, i] * along[:, j] / 12))
        for i, j in ((0, 0), (0, 1), (1, 1))
    )
    angle = np.arctan2(2 * xy, xx - yy) / 2
    axis = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    apart = ends - centre[group][:, None]
    main, normal = axis[group][:, None], np.stack([-axis[:, 1], axis[:, 0]], axis=1)[group][:, None]
    place, aside = (apart * main).sum(axis=2), abs((apart * normal).sum(axis=2)).max(axis=1)
    low, high = np.full(count, np.inf), np.full(count, -np.inf)
    np.minimum.at(low, group, place.min(axis=1))
    np.maximum.at(high, group, place.max(axis=1))
    reach = np.stack([low, high], axis=1)[..., None]
    return centre[:, None] + reach * axis[:, None], aside


def _loose(ends: Numbers, group: Indices, tolerance: float) -> list[Indices]:
    """Return the pieces of each group that no straight line fits within the tolerance."""
    off = _fitted(ends, group, np.ones(len(ends)))[1] > tolerance
    return [np.flatnonzero(group == k) for k in np.unique(group[off]).tolist()]


def _split(ends: Numbers, tolerance: float) -> Indices:
    """Return numbers of groups (n,) of pieces, in each of which all lie along the longest one."""
    part = np.full(len(ends), -1)
    length = np.hypot(*(ends[:, 1] - ends[:, 0]).T)
    for leader in np.argsort(-length, kind="stable").tolist():
        if part[leader] < 0:
            free = np.flatnonzero(part < 0)
            one = np.broadcast_to(ends[leader], (len(free), 2, 2))
            on = _overlap(one, ends[free], tolerance) | (free == leader)
            part[free[on]] = leader
    return part

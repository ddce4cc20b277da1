"""Lines as straight pieces in the plane, without crumbs and needless points."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import dist

import numpy as np
import shapely
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.grid.sketch import cross

Numbers = NDArray[np.float64]
Indices = NDArray[np.int64]

# A point so near to a straight line lies on it, as a part of the tolerance. What rounding and
# conversions of units leave is less.
EXACT = 0.01
# More pieces that touch are no grid that can be computed; they are not even listed.
MOST_PAIRS = 300_000
# So many pairs whose boxes touch are tried.
MOST_TRIED = 20_000_000
# So many pairs at a time are sought, which bounds the memory.
AT_ONCE = 500_000


@dataclass(frozen=True, eq=False)
class Pieces:
    """Straight pieces, and what was left out to get them.

    Attributes:
        ends: (P, 2, 2) mm.
        line: (P,) number of the line that each belongs to.
        crumbs: (n, 2) mm, where something shorter than the tolerance was left out.
        needless: (n, 2) mm, points in the middle of straight stretches that were left out.
    """

    ends: Numbers
    line: Indices
    crumbs: Numbers
    needless: Numbers


def pieces_of(lines: Sequence[Numbers], tolerance: float, straighten: bool = True) -> Pieces:
    """Return the straight pieces of polylines.

    Args:
        lines: each (n, 2) mm, n at least 2.
        tolerance: what is shorter is a crumb, mm.
        straighten: whether points on a straight stretch are left out.
    """
    count = np.array([len(line) for line in lines], np.int64)
    points = np.concatenate([np.zeros((0, 2)), *lines])
    line = np.repeat(np.arange(len(lines)), count)
    points, line, crumbs = _without_crumbs(points, line, tolerance)
    needless = np.zeros((0, 2))
    if straighten:
        points, line, needless = _straightened(points, line, EXACT * tolerance)
    inside = np.flatnonzero(line[1:] == line[:-1])
    ends = np.stack([points[inside], points[inside + 1]], axis=1)
    return Pieces(ends, line[inside], crumbs, needless)


def _without_crumbs(
    points: Numbers, line: Indices, tolerance: float
) -> tuple[Numbers, Indices, Numbers]:
    """Return points and their lines without those that make a piece shorter than the tolerance."""
    short = np.hypot(*(points[1:] - points[:-1]).T) < tolerance
    short &= line[1:] == line[:-1]
    stay, crumb = np.ones(len(points), bool), np.zeros(len(points), bool)
    for k in np.unique(line[:-1][short]).tolist():
        first, end = np.searchsorted(line, [k, k + 1])
        stay[first:end] = _far_apart(points[first:end].tolist(), tolerance)
        # A line that goes as a whole is one crumb.
        crumb[first:end] = ~stay[first:end]
        crumb[first + 1 : end] &= stay[first]
    return points[stay], line[stay], points[crumb]


def _far_apart(points: list[list[float]], tolerance: float) -> list[bool]:
    """Return which points of a line stay so that each is a tolerance from the one before.

    The ends stay; of a line that is a crumb as a whole nothing stays.
    """
    stay, kept = [False] * len(points), [0]
    for k in range(1, len(points)):
        if dist(points[k], points[kept[-1]]) >= tolerance:
            kept.append(k)
    if len(kept) == 1:
        return stay
    kept[-1] = len(points) - 1
    if len(kept) > 2 and dist(points[kept[-1]], points[kept[-2]]) < tolerance:
        del kept[-2]
    for k in kept:
        stay[k] = True
    return stay


def _straightened(points: Numbers, line: Indices, least: float) -> tuple[Numbers, Indices, Numbers]:
    """Return points and their lines without those that lie on the stretch between their neighbours.

    Args:
        points: (n, 2) mm.
        line: (n,) of each.
        least: how far from a stretch a point stays, mm.
    """
    many = np.flatnonzero(np.bincount(line) > 2)
    if not len(many):
        return points, line, np.zeros((0, 2))
    stay = np.ones(len(points), bool)
    bounds = np.searchsorted(line, np.stack([many, many + 1]))
    points = points.copy()
    for first, end in bounds.T.tolist():
        # A closed line may begin on a straight side: then it is turned to begin at a corner.
        if (points[first] == points[end - 1]).all():
            points[first:end] = _from_a_corner(points[first:end])
        stay[first:end] = simplified(points[first:end], least)
    return points[stay], line[stay], points[~stay]


def _from_a_corner(ring: Numbers) -> Numbers:
    """Return a closed line (n, 2), its last point its first, turned to begin at its sharpest turn.

    It begins where it did if that is as sharp.
    """
    step = np.diff(ring, axis=0)
    step /= np.maximum(np.hypot(*step.T), 1e-300)[:, None]
    ahead = (step * np.roll(step, 1, axis=0)).sum(axis=1)
    first = int(np.argmin(ahead.round(6)))
    return np.concatenate([ring[first:-1], ring[: first + 1]])


def simplified(points: Numbers, least: float) -> NDArray[np.bool_]:
    """Return which points (n,) of a polyline stay so that the rest lie within `least` of it."""
    kept = shapely.get_coordinates(
        shapely.simplify(shapely.linestrings(points), least, preserve_topology=False)
    )
    stay = np.zeros(len(points), bool)
    k = 0
    for place in kept:  # they are some of the points, in their order
        while (points[k] != place).any():
            k += 1
        stay[k] = True
        k += 1
    return stay


def neighbours(ends: Numbers, reach: float) -> tuple[Indices, Indices]:
    """Return the pairs of straight pieces (P, 2, 2) within a reach of each other, lower first.

    Raises:
        InputError: there are too many.
    """
    pairs = [np.zeros((2, 0), np.int64), *_near(ends, reach)]
    a, b = np.concatenate(pairs, axis=1)
    order = np.lexsort((b, a))
    return a[order], b[order]


def _near(ends: Numbers, reach: float) -> Iterator[Indices]:
    """Yield pairs (2, n) of pieces within a reach of each other, a part of them at a time."""
    low, high = ends.min(axis=1), ends.max(axis=1)
    tree = shapely.STRtree(shapely.box(*low.T, *high.T))
    wide = shapely.box(*(low - reach).T, *(high + reach).T)
    begin, step, found, tried = 0, 64, 0, 0
    while begin < len(ends):
        pairs = tree.query(wide[begin : begin + step])
        hits = pairs.shape[1]
        pairs[0] += begin
        pairs = pairs[:, pairs[0] < pairs[1]]
        pairs = pairs[:, _apart(ends[pairs[0]], ends[pairs[1]]) <= reach]
        yield pairs
        found, tried = found + pairs.shape[1], tried + hits
        if found > MOST_PAIRS or tried > MOST_TRIED:
            text = f"the lines touch each other at more than {MOST_PAIRS:,} places"
            if found <= MOST_PAIRS:
                text = f"{len(ends):,} pieces of lines lie too close together"
            raise InputError(f"{text}; that is no grid that can be computed", "too-large")
        begin += step
        step = max(1, min(4 * step, step * AT_ONCE // max(1, hits)))


def _apart(a: Numbers, b: Numbers) -> Numbers:
    """Return the distances (n,) of straight pieces (n, 2, 2) from others."""
    sides = [
        cross(one[:, 1] - one[:, 0], other[:, k] - one[:, 0])
        for one, other in ((a, b), (b, a))
        for k in (0, 1)
    ]
    across = (sides[0] * sides[1] < 0) & (sides[2] * sides[3] < 0)
    apart = [_to_point(one, other[:, k]) for one, other in ((a, b), (b, a)) for k in (0, 1)]
    return np.where(across, 0.0, np.minimum.reduce(apart))


def _to_point(piece: Numbers, point: Numbers) -> Numbers:
    """Return the distances (n,) of points (n, 2) from straight pieces (n, 2, 2)."""
    along, to = piece[:, 1] - piece[:, 0], point - piece[:, 0]
    place = np.clip((along * to).sum(axis=1) / (along**2).sum(axis=1), 0, 1)
    return np.hypot(*(to - place[:, None] * along).T)

"""From drawn lines to a grid: ends that nearly meet are joined, crossings become joints.

First the joints: every corner of a line and every crossing of two, unless one is near already.
Then the beams: each straight piece of a line runs through the joints near it, in their order.
So T-junctions split the line they touch, and lines drawn twice give their beams once.
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from simulearn.errors import InputError
from simulearn.grid.grid import Grid

Numbers = NDArray[np.float64]
# Neighbours are searched a little beyond the tolerance, so that rounding leaves none out (mm).
SLACK = 1e-6


def sketch(
    lines: Sequence[ArrayLike], tolerance: float = 1.0, material: str = "pla-hot-water"
) -> Grid:
    """Return the grid that polylines draw, without actuators.

    Args:
        lines: polylines, each (n, 2) mm.
        tolerance: how near two points are the same, mm.
        material: name of the material system.

    Returns:
        The grid; fixed is the joint nearest to the middle of the drawing, the first of several.

    Raises:
        InputError: there are no lines, or one is not a list of two or more points.
    """
    pairs = [pair for k, line in enumerate(lines) for pair in pairwise(_points(line, k))]
    if not pairs:
        raise InputError("the sketch has no lines; a grid needs some")
    pieces = np.array(pairs)
    places = _distinct(np.concatenate([pieces.reshape(-1, 2), _crossings(pieces)]), tolerance)
    beams: dict[tuple[int, int], None] = {}  # a set that keeps its order
    for through in _through(places, pieces, tolerance):
        for i, j in pairwise(through):
            if (j, i) not in beams:
                beams[i, j] = None
    return Grid(places, list(beams), np.zeros(len(beams)), middle_joint(places), material)


def middle_joint(joints: Numbers) -> int:
    """Return which of the joints (J, 2) is nearest to the middle of all, the first of several."""
    middle = (joints.min(axis=0) + joints.max(axis=0)) / 2
    # Rounded, so that ties do not hang on the last bit.
    return int(np.argmin(np.linalg.norm(joints - middle, axis=1).round(6)))


def _points(line: ArrayLike, k: int) -> Numbers:
    """Return a polyline's points (n, 2)."""
    try:
        points = np.asarray(line, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError(f"line {k} is not a list of points [x, y]") from error
    if points.ndim != 2 or points.shape[1] != 2 or len(points) < 2:
        raise InputError(f"line {k} is not a list of two or more points [x, y]")
    if not np.isfinite(points).all():
        raise InputError(f"line {k} has a coordinate that is not a finite number")
    return points


def _crossings(pieces: Numbers) -> Numbers:
    """Return the points (n, 2) where straight pieces (P, 2, 2) cross, by the numbers of the pieces.

    Parallel pieces have none: where they overlap, their ends are joints.
    """
    lines = shapely.linestrings(pieces)
    a, b = shapely.STRtree(lines).query(lines)
    a, b = a[a < b], b[a < b]
    order = np.lexsort((b, a))
    a, b = pieces[a[order]], pieces[b[order]]
    along, across, apart = a[:, 1] - a[:, 0], b[:, 1] - b[:, 0], b[:, 0] - a[:, 0]
    turn = cross(along, across)
    with np.errstate(divide="ignore", invalid="ignore"):
        s, t = cross(apart, across) / turn, cross(apart, along) / turn
    meet = (turn != 0) & (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    points: Numbers = a[meet, 0] + s[meet, None] * along[meet]
    return points


def cross(a: Numbers, b: Numbers) -> Numbers:
    """Return the cross products (n,) of vectors (n, 2) in the plane."""
    product: Numbers = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return product


def _distinct(points: Numbers, tolerance: float) -> Numbers:
    """Return the points (n, 2) without those that are within a tolerance of an earlier one."""
    marks = shapely.points(points)
    k, earlier = shapely.STRtree(marks).query(marks, "dwithin", tolerance + SLACK)
    near = (earlier < k) & (np.linalg.norm(points[k] - points[earlier], axis=1) <= tolerance)
    stay = np.ones(len(points), bool)
    order = np.lexsort((earlier[near], k[near]))
    for point, other in zip(k[near][order].tolist(), earlier[near][order].tolist(), strict=True):
        if stay[other]:
            stay[point] = False
    return points[stay]


def _through(joints: Numbers, pieces: Numbers, tolerance: float) -> list[list[int]]:
    """Return for each straight piece the joints within a tolerance of it, in order along it."""
    tree = shapely.STRtree(shapely.points(joints))
    piece, joint = tree.query(shapely.linestrings(pieces), "dwithin", tolerance + SLACK)
    start, along = pieces[piece, 0], pieces[piece, 1] - pieces[piece, 0]
    square = (along**2).sum(axis=1)
    apart = joints[joint] - start
    place = (apart * along).sum(axis=1) / np.where(square > 0, square, 1.0)
    nearest = np.clip(place, 0, 1)[:, None] * along
    near = np.linalg.norm(apart - nearest, axis=1) <= tolerance
    order = np.lexsort((joint[near], place[near], piece[near]))
    through: list[list[int]] = [[] for _ in pieces]
    for p, j in zip(piece[near][order].tolist(), joint[near][order].tolist(), strict=True):
        through[p].append(j)
    return through

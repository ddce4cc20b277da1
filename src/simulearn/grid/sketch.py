"""From drawn lines to a grid: ends that nearly meet are joined, crossings become joints.

First the joints: every corner of a line and every crossing of two, unless one is near already.
Then the beams: each straight piece of a line runs through the joints near it, in their order.
So T-junctions split the line they touch, and lines drawn twice give their beams once.
"""

from collections.abc import Sequence
from itertools import combinations, pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from simulearn.errors import InputError
from simulearn.grid.grid import Grid

Point = NDArray[np.float64]


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
    pieces = [piece for k, line in enumerate(lines) for piece in pairwise(_points(line, k))]
    if not pieces:
        raise InputError("the sketch has no lines; a grid needs some")
    corners = [point for piece in pieces for point in piece]
    crossings = [point for a, b in combinations(pieces, 2) for point in _crossing(a, b)]
    joints: list[Point] = []
    for point in corners + crossings:
        if not any(np.linalg.norm(point - joint) <= tolerance for joint in joints):
            joints.append(point)
    places = np.array(joints)

    beams: dict[tuple[int, int], None] = {}  # a set that keeps its order
    for piece in pieces:
        for i, j in pairwise(_through(places, *piece, tolerance)):
            if (j, i) not in beams:
                beams[i, j] = None
    middle = (places.min(axis=0) + places.max(axis=0)) / 2
    # Rounded, so that ties do not hang on the last bit.
    fixed = np.argmin(np.linalg.norm(places - middle, axis=1).round(6))
    return Grid(places, list(beams), np.zeros(len(beams)), int(fixed), material)


def _points(line: ArrayLike, k: int) -> Point:
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


def _crossing(a: tuple[Point, Point], b: tuple[Point, Point]) -> list[Point]:
    """Return the point where two straight pieces cross, if they do."""
    along, across, apart = a[1] - a[0], b[1] - b[0], b[0] - a[0]
    turn = _cross(along, across)
    if turn == 0:  # parallel: where they overlap, their ends do the work
        return []
    s, t = _cross(apart, across) / turn, _cross(apart, along) / turn
    return [a[0] + s * along] if 0 <= s <= 1 and 0 <= t <= 1 else []


def _cross(a: Point, b: Point) -> float:
    return float(a[0] * b[1] - a[1] * b[0])


def _through(joints: Point, start: Point, end: Point, tolerance: float) -> list[int]:
    """Return the joints within a tolerance of a straight piece, in order along it."""
    along = end - start
    square = along @ along
    place = (joints - start) @ along / square if square else np.zeros(len(joints))
    nearest = start + np.clip(place, 0, 1)[:, None] * along
    near = np.linalg.norm(joints - nearest, axis=1) <= tolerance
    return [int(k) for k in np.argsort(place, kind="stable") if near[k]]

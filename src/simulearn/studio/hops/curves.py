"""Curves of Rhino as lines of a drawing, and lines as curves of Rhino."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.drawings.drawing import Curve, Line
from simulearn.errors import InputError
from simulearn.studio.hops import archives
from simulearn.studio.hops.schemas import Item
from simulearn.studio.hops.values import coordinates, parsed

Points = NDArray[np.float64]

STRAIGHT = 1e-6  # of a curve's length, that a straight one may be off
ROUGHEST, FINEST = 8, 4096  # chords of a curve


def curve_of(item: Item, place: str) -> Line | Curve:
    """Return a line, or a curve that is none.

    Args:
        item: a curve in any of the forms that Grasshopper sends.
        place: what it is, for messages.

    Raises:
        InputError: the item is no curve.
    """
    data = parsed(item)
    if isinstance(data, Mapping):
        if "data" in data:
            return _decoded(archives.decoded(data, place), place)
        ends = {str(key).lower(): value for key, value in data.items()}
        if "from" in ends and "to" in ends:
            return _line([coordinates(ends[key], place) for key in ("from", "to")], place)
    if isinstance(data, list) and len(data) > 1:
        return _line([coordinates(one, f"{place}, point {k}") for k, one in enumerate(data)], place)
    kind = item.type.rpartition(".")[2][:60]
    raise InputError(f"{place} is a {kind}; it is a curve made of straight lines", "curve", place)


def polyline(points: Points) -> Any:
    """Return points (n, 3) as a curve of Rhino."""
    rhino = archives.library()
    line = rhino.Polyline()
    for x, y, z in np.asarray(points, float).tolist():
        line.Add(x, y, z)
    return line.ToPolylineCurve()


def _decoded(found: Any, place: str) -> Line | Curve:
    rhino = archives.library()
    if not isinstance(found, rhino.Curve):
        text = f"{place} is a {type(found).__name__}; it is a curve"
        raise InputError(text, "curve", place)
    if not found.IsValid:
        raise InputError(f"{place} is a curve that Rhino would not accept", "curve", place)
    points = found.TryGetPolyline() if found.IsPolyline() else None
    if points is not None:
        return _line([[p.X, p.Y, p.Z] for p in points], place)
    ends = [found.PointAtStart, found.PointAtEnd]
    length = float(
        np.linalg.norm([ends[1].X - ends[0].X, ends[1].Y - ends[0].Y, ends[1].Z - ends[0].Z])
    )
    if length > 0 and found.IsLinear(STRAIGHT * length):
        return _line([[p.X, p.Y, p.Z] for p in ends], place)
    kind = type(found).__name__
    return Curve(kind, lambda chord: _flattened(found, chord), where=place)


def _line(points: list[list[float]], place: str) -> Line:
    array = np.array(points, float)
    if not np.isfinite(array).all():
        raise InputError(f"{place} has a point that is not finite", "curve", place)
    return Line(array, where=place)


def _flattened(curve: Any, chord: float) -> Points:
    """Return points of a curve so close that chords are off by less than requested."""
    count = ROUGHEST
    while True:
        t = np.linspace(curve.Domain.T0, curve.Domain.T1, 2 * count + 1)
        found = np.array([[p.X, p.Y, p.Z] for p in map(curve.PointAt, t.tolist())])
        middles = (found[:-2:2] + found[2::2]) / 2
        if count >= FINEST or np.linalg.norm(found[1::2] - middles, axis=1).max() < chord:
            return found[::2]
        count *= 2

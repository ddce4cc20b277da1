"""Surfaces with a chart of their own: of revolution, of heights, between two curves."""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline, RectBivariateSpline

from simulearn.errors import InputError
from simulearn.tile.charts import Array, Chart

Heights = Callable[[Array, Array], Array]  # x (N,), y (N,) -> z (N,), mm


def revolution(profile: ArrayLike, degrees: float = 360.0) -> Chart:
    """Return the surface that a profile sweeps around the z axis, outside away from the axis.

    Args:
        profile: (N, 2) mm, radius and height; a smooth curve goes through the points.
        degrees: how far around, from the x axis.

    Raises:
        InputError: the profile is no such list, or comes to the axis; or the angle is wrong.
    """
    points = _points(profile, 2, "profile")
    if not 0 < degrees <= 360:
        raise _wrong("degrees", f"is {degrees:g}; it is more than 0 and at most 360")
    if points[:, 0].min() <= 0:
        k = int(points[:, 0].argmin())
        text = f"has the radius {points[k, 0]:g}; a profile keeps off the axis"
        raise _wrong(f"profile[{k}]", text)
    along = np.diff(points, axis=0)
    # To the right of the profile is outside where it goes up; of one that goes down, to the left.
    if (along[:, 1] * (points[1:, 0] + points[:-1, 0])).sum() < 0:
        points = points[::-1]
    curve, turn = smooth(points), np.radians(degrees)

    def at(u: Array, v: Array) -> Array:
        radius, z = curve(v).T
        return np.stack([radius * np.cos(turn * u), radius * np.sin(turn * u), z], axis=1)

    return Chart(at, (degrees == 360, False))


def heights(z: Heights, x: tuple[float, float], y: tuple[float, float]) -> Chart:
    """Return the surface of heights over a rectangle, outside being up.

    Args:
        z: gives heights (N,) mm over places x (N,), y (N,) mm.
        x: range of the places along x, mm.
        y: the same along y.
    """

    def at(u: Array, v: Array) -> Array:
        places = x[0] + (x[1] - x[0]) * u, y[0] + (y[1] - y[0]) * v
        return np.stack([*places, np.broadcast_to(z(*places), u.shape)], axis=1)

    return Chart(at)


def interpolated(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Heights:
    """Return the smooth heights through values z (Y, X) mm over places x (X,) and y (Y,) mm.

    Raises:
        InputError: the lists do not fit together, or do not rise.
    """
    try:
        xs, ys, zs = (np.asarray(a, float) for a in (x, y, z))
    except ValueError as error:
        raise _wrong("z", "is no table; each row has as many numbers as the others") from error
    if zs.shape != (len(ys), len(xs)):
        text = f"is {' x '.join(map(str, zs.shape))} numbers; y and x are {len(ys)} x {len(xs)}"
        raise _wrong("z", text)
    for name, line in (("x", xs), ("y", ys)):
        if len(line) < 2 or not (np.diff(line) > 0).all():
            raise _wrong(name, "is no list of rising numbers, at least two")
    spline = RectBivariateSpline(ys, xs, zs, kx=min(3, len(ys) - 1), ky=min(3, len(xs) - 1))
    return lambda a, b: spline.ev(b, a)


def between(
    first: ArrayLike,
    second: ArrayLike,
    leaving: ArrayLike | None = None,
    arriving: ArrayLike | None = None,
) -> Chart:
    """Return the surface from one edge curve to another: ruled, or smooth where it is led.

    Args:
        first: (N, 3) mm, a smooth curve goes through the points.
        second: likewise; turned round where it runs against the first.
        leaving: (3,) mm, direction in which the surface leaves the first; its length says how
            stiffly. None: straight to the second.
        arriving: (3,) mm, direction in which it comes to the second.

    Returns:
        u along the curves, v from the first to the second; cubic in v (Hermite).
    """
    start, end = _points(first, 3, "first"), _points(second, 3, "second")
    if np.linalg.norm(start[[0, -1]] - end[[0, -1]]) > np.linalg.norm(
        start[[0, -1]] - end[[-1, 0]]
    ):
        end = end[::-1]
    curves = smooth(start), smooth(end)
    leads = [None if lead is None else _direction(lead) for lead in (leaving, arriving)]

    def at(u: Array, v: Array) -> Array:
        a, b, w = curves[0](u), curves[1](u), v[:, None]
        out, into = (b - a if lead is None else lead for lead in leads)
        return (
            (1 + 2 * w) * (1 - w) ** 2 * a
            + w * (1 - w) ** 2 * out
            + w**2 * (3 - 2 * w) * b
            + w**2 * (w - 1) * into
        )

    return Chart(at)


def smooth(points: Array) -> Callable[[Array], Array]:
    """Return the curve (0 to 1 by chord length) through points (N, D): a cubic spline."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    at = np.append(0.0, np.cumsum(steps)) / steps.sum()
    if len(points) == 2:
        return lambda t: points[0] + np.multiply.outer(t, points[1] - points[0])
    spline = CubicSpline(at, points, bc_type="natural" if len(points) == 3 else "not-a-knot")
    curve: Callable[[Array], Array] = spline
    return curve


def _points(given: ArrayLike, columns: int, name: str) -> Array:
    try:
        points: NDArray[np.float64] = np.asarray(given, float)
    except (TypeError, ValueError):
        points = np.zeros(0)
    what = "[radius, height]" if columns == 2 else "[x, y, z]"
    if points.ndim != 2 or points.shape[1:] != (columns,) or len(points) < 2:
        raise _wrong(name, f"is no list of at least two {what} in mm")
    if not np.isfinite(points).all():
        raise _wrong(name, "holds what is not a finite number")
    if (np.linalg.norm(np.diff(points, axis=0), axis=1) < 1e-9).any():
        raise _wrong(name, "has the same point twice, one after the other")
    return points


def _direction(given: ArrayLike) -> Array:
    direction = np.asarray(given, float)
    if direction.shape != (3,) or not np.isfinite(direction).all():
        raise _wrong("a direction", "is [x, y, z] in mm")
    return direction


def _wrong(where: str, text: str) -> InputError:
    return InputError(f"{where} {text}", "chart", where)

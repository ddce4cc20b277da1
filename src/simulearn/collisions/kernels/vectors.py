"""Vectors of three numbers as tuples, which the compiler keeps in registers."""

from math import sqrt
from typing import Any

from simulearn.native import inlined

Array = Any


@inlined
def dot(a: Any, b: Any) -> float:
    """Return a . b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inlined
def cross(a: Any, b: Any) -> Any:
    """Return a x b."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


@inlined
def plus(a: Any, share: float, b: Any) -> Any:
    """Return a + share b."""
    return a[0] + share * b[0], a[1] + share * b[1], a[2] + share * b[2]


@inlined
def minus(a: Any, b: Any) -> Any:
    """Return a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@inlined
def length(a: Any) -> float:
    """Return |a|."""
    return sqrt(dot(a, a))


@inlined
def unit(a: Any) -> Any:
    """Return a / |a|; a vector without length as it is."""
    size = length(a)
    over = 1.0 / size if size > 0.0 else 1.0
    return a[0] * over, a[1] * over, a[2] * over


@inlined
def section_frame(corners: Array) -> Any:
    """Return centre, half width (to the left) and half thickness (up) of a section (4, 3)."""
    a, b, c, d = corners[0], corners[1], corners[2], corners[3]
    centre = (
        (a[0] + b[0] + c[0] + d[0]) / 4,
        (a[1] + b[1] + c[1] + d[1]) / 4,
        (a[2] + b[2] + c[2] + d[2]) / 4,
    )
    left = (
        (b[0] + d[0] - a[0] - c[0]) / 4,
        (b[1] + d[1] - a[1] - c[1]) / 4,
        (b[2] + d[2] - a[2] - c[2]) / 4,
    )
    up = (
        (c[0] + d[0] - a[0] - b[0]) / 4,
        (c[1] + d[1] - a[1] - b[1]) / 4,
        (c[2] + d[2] - a[2] - b[2]) / 4,
    )
    return centre, left, up

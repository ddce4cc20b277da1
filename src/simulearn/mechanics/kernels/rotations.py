"""Coefficients of rotations at any angle, exact to rounding.

Formulas: J. Sola, J. Deray, D. Atchuthan, A micro Lie theory for state estimation in robotics,
2018.
"""

from fractions import Fraction
from math import atan2, comb, factorial, sin, sqrt, tan
from typing import Any

from simulearn.native import native

Array = Any
TERMS = 18
SERIES_TO = 4.0  # rad2, up to which the series below are exact to rounding


def _bernoulli(most: int) -> list[Fraction]:
    """Return Bernoulli's numbers B(0) to B(most)."""
    numbers = [Fraction(1)]
    for m in range(1, most + 1):
        total = sum((comb(m + 1, k) * b for k, b in enumerate(numbers)), Fraction(0))
        numbers.append(-total / (m + 1))
    return numbers


COEFFICIENTS = tuple(
    float(abs(number) / factorial(2 * n))
    for n, number in enumerate(_bernoulli(2 * TERMS)[::2])
    if n > 0
)


@native(entry=False)
def exponential(square: float) -> Any:
    """Return sin t / t, (1 - cos t) / t2 and (t - sin t) / t3 at t2 = square."""
    x = square
    if x < 0.05:
        return (
            1.0 - x / 6 * (1.0 - x / 20 * (1.0 - x / 42 * (1.0 - x / 72 * (1.0 - x / 110)))),
            0.5 - x / 24 * (1.0 - x / 30 * (1.0 - x / 56 * (1.0 - x / 90 * (1.0 - x / 132)))),
            (1.0 - x / 20 * (1.0 - x / 42 * (1.0 - x / 72 * (1.0 - x / 110 * (1.0 - x / 156)))))
            / 6,
        )
    t = sqrt(x)
    s, half = sin(t), sin(t / 2)
    return s / t, 2.0 * half * half / x, (t - s) / (t * x)


@native(entry=False)
def inverse_left(x: float) -> Any:
    """Return k(x) = (1 - t sin t / (2 (1 - cos t))) / t2 at t2 = x, and its two derivatives.

    The series is the sum of |B(2 n)| x^(n - 1) / (2 n)!, B being Bernoulli's numbers.
    """
    if x < SERIES_TO:
        k, first, second = COEFFICIENTS[TERMS - 1], 0.0, 0.0
        for n in range(TERMS - 1):
            second = second * x + 2 * first
            first = first * x + k
            k = k * x + COEFFICIENTS[TERMS - 2 - n]
        return k, first, second
    t = sqrt(x)
    y = 1.0 / tan(t / 2)
    z = 1.0 + y * y
    k = (1.0 - t * y / 2) / x
    first = (-1.0 / x + y / (4 * t) + z / 8) / x
    second = (4.0 / x - 0.75 * y / t - 0.375 * z - y * z * t / 8) / (2 * x * x)
    return k, first, second


@native(entry=False)
def rotation_vector(
    r0: float,
    r1: float,
    r2: float,
    r3: float,
    r4: float,
    r5: float,
    r6: float,
    r7: float,
    r8: float,
) -> Any:
    """Return the rotation vector of a matrix and its angle squared; near pi it is not exact."""
    x, y, z = (r7 - r5) / 2, (r2 - r6) / 2, (r3 - r1) / 2
    sine = sqrt(x * x + y * y + z * z)
    angle = atan2(sine, (r0 + r4 + r8 - 1.0) / 2)
    factor = angle / sine if sine > 0.0 else 1.0
    return x * factor, y * factor, z * factor, angle * angle


@native(entry=False)
def move(R: Array, p: Array, i: int, x: Array, share: float) -> None:
    """Move pose i, R (N, 9) and p (N, 3), by a share of a twist x (6,) about the origin."""
    u0, u1, u2 = share * x[0], share * x[1], share * x[2]
    a, b, c = share * x[3], share * x[4], share * x[5]
    first, second, third = exponential(a * a + b * b + c * c)
    # v = u + second w x u + third w x (w x u)
    s0, s1, s2 = b * u2 - c * u1, c * u0 - a * u2, a * u1 - b * u0
    v0 = u0 + second * s0 + third * (b * s2 - c * s1)
    v1 = u1 + second * s1 + third * (c * s0 - a * s2)
    v2 = u2 + second * s2 + third * (a * s1 - b * s0)
    for k in range(4):  # the columns of R, then p
        if k < 3:
            q0, q1, q2 = R[i, k], R[i, 3 + k], R[i, 6 + k]
        else:
            q0, q1, q2 = p[i, 0], p[i, 1], p[i, 2]
        s0, s1, s2 = b * q2 - c * q1, c * q0 - a * q2, a * q1 - b * q0
        q0 += first * s0 + second * (b * s2 - c * s1)
        q1 += first * s1 + second * (c * s0 - a * s2)
        q2 += first * s2 + second * (a * s1 - b * s0)
        if k < 3:
            R[i, k], R[i, 3 + k], R[i, 6 + k] = q0, q1, q2
        else:
            p[i, 0], p[i, 1], p[i, 2] = q0 + v0, q1 + v1, q2 + v2


@native(entry=False)
def matrix_product(a: Array, b: Array, c: Array) -> None:
    """Set c = a b, each (9,)."""
    for i in range(3):
        p, q, r = a[3 * i], a[3 * i + 1], a[3 * i + 2]
        for j in range(3):
            c[3 * i + j] = p * b[j] + q * b[3 + j] + r * b[6 + j]


@native(entry=False)
def matrix_product_t(a: Array, b: Array, c: Array) -> None:
    """Set c = a b^T, each (9,)."""
    for i in range(3):
        p, q, r = a[3 * i], a[3 * i + 1], a[3 * i + 2]
        for j in range(3):
            c[3 * i + j] = p * b[3 * j] + q * b[3 * j + 1] + r * b[3 * j + 2]


@native(entry=False)
def copy(a: Array, b: Array) -> None:
    """Set b = a, both one after the other in memory, (N, K)."""
    for i in range(a.shape[0]):
        for k in range(a.shape[1]):
            b[i, k] = a[i, k]

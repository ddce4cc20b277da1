"""Algebra of 3 x 3 matrices and vectors, sixteen beams at a time.

Row r of an array (rows, WIDE) holds one 3 x 3 matrix of each of sixteen beams, its lanes: entry
(i, j) of lane n is at LANES (3 i + j) + n. A vector uses the first places: entry i is at
LANES i + n. Loops over lanes become vector instructions (shorter ones do not). An argument pair
`a, i` is row i of array a. Every function sets or changes its last pair.
"""

from typing import Any

from simulearn.native import native

LANES = 16
WIDE = 9 * LANES  # numbers in a row
FAST = {"contract"}  # a product and a sum in one instruction; nothing else changes
A1, A2, A3, A4, A5, A6, A7, A8 = (LANES * k for k in range(1, 9))

Array = Any  # of numbers; their type is that of the first call


@native(entry=False, fastmath=FAST)
def nine(a: Array, n: int) -> Any:
    """Return the entries of the matrix of a lane, row by row."""
    return (
        a[n], a[A1 + n], a[A2 + n],
        a[A3 + n], a[A4 + n], a[A5 + n],
        a[A6 + n], a[A7 + n], a[A8 + n],
    )  # fmt: skip


@native(entry=False, fastmath=FAST)
def product(a: Array, i: int, b: Array, j: int, c: Array, k: int) -> None:
    """Set c = a b."""
    x, y, z = a[i], b[j], c[k]
    for n in range(LANES):
        p, q, r, s, t, u, v, w, o = nine(x, n)
        a0, a1, a2, b0, b1, b2, c0, c1, c2 = nine(y, n)
        z[n], z[A1 + n], z[A2 + n] = (
            p * a0 + q * b0 + r * c0,
            p * a1 + q * b1 + r * c1,
            p * a2 + q * b2 + r * c2,
        )
        z[A3 + n], z[A4 + n], z[A5 + n] = (
            s * a0 + t * b0 + u * c0,
            s * a1 + t * b1 + u * c1,
            s * a2 + t * b2 + u * c2,
        )
        z[A6 + n], z[A7 + n], z[A8 + n] = (
            v * a0 + w * b0 + o * c0,
            v * a1 + w * b1 + o * c1,
            v * a2 + w * b2 + o * c2,
        )


@native(entry=False, fastmath=FAST)
def add_product(a: Array, i: int, b: Array, j: int, sign: float, c: Array, k: int) -> None:
    """Add sign a b to c."""
    x, y, z = a[i], b[j], c[k]
    for n in range(LANES):
        p, q, r, s, t, u, v, w, o = nine(x, n)
        a0, a1, a2, b0, b1, b2, c0, c1, c2 = nine(y, n)
        z[n] += sign * (p * a0 + q * b0 + r * c0)
        z[A1 + n] += sign * (p * a1 + q * b1 + r * c1)
        z[A2 + n] += sign * (p * a2 + q * b2 + r * c2)
        z[A3 + n] += sign * (s * a0 + t * b0 + u * c0)
        z[A4 + n] += sign * (s * a1 + t * b1 + u * c1)
        z[A5 + n] += sign * (s * a2 + t * b2 + u * c2)
        z[A6 + n] += sign * (v * a0 + w * b0 + o * c0)
        z[A7 + n] += sign * (v * a1 + w * b1 + o * c1)
        z[A8 + n] += sign * (v * a2 + w * b2 + o * c2)


@native(entry=False, fastmath=FAST)
def add_product_t(a: Array, i: int, b: Array, j: int, sign: float, c: Array, k: int) -> None:
    """Add sign a^T b to c."""
    x, y, z = a[i], b[j], c[k]
    for n in range(LANES):
        p, s, v, q, t, w, r, u, o = nine(x, n)
        a0, a1, a2, b0, b1, b2, c0, c1, c2 = nine(y, n)
        z[n] += sign * (p * a0 + q * b0 + r * c0)
        z[A1 + n] += sign * (p * a1 + q * b1 + r * c1)
        z[A2 + n] += sign * (p * a2 + q * b2 + r * c2)
        z[A3 + n] += sign * (s * a0 + t * b0 + u * c0)
        z[A4 + n] += sign * (s * a1 + t * b1 + u * c1)
        z[A5 + n] += sign * (s * a2 + t * b2 + u * c2)
        z[A6 + n] += sign * (v * a0 + w * b0 + o * c0)
        z[A7 + n] += sign * (v * a1 + w * b1 + o * c1)
        z[A8 + n] += sign * (v * a2 + w * b2 + o * c2)


@native(entry=False, fastmath=FAST)
def transposed(a: Array, i: int, c: Array, k: int) -> None:
    """Set c = a^T."""
    x, z = a[i], c[k]
    for n in range(LANES):
        p, q, r, s, t, u, v, w, o = nine(x, n)
        z[n], z[A1 + n], z[A2 + n] = p, s, v
        z[A3 + n], z[A4 + n], z[A5 + n] = q, t, w
        z[A6 + n], z[A7 + n], z[A8 + n] = r, u, o


@native(entry=False, fastmath=FAST)
def add(a: Array, i: int, sign: float, c: Array, k: int) -> None:
    """Add sign a to c."""
    x, z = a[i], c[k]
    for n in range(WIDE):
        z[n] += sign * x[n]


@native(entry=False, fastmath=FAST)
def add_cross(v: Array, i: int, at: int, sign: float, c: Array, k: int) -> None:
    """Add sign times the cross product's matrix to c; of the vector that begins at entry `at`."""
    x, z = v[i, LANES * at : LANES * (at + 3)], c[k]
    for n in range(LANES):
        p, q, r = sign * x[n], sign * x[A1 + n], sign * x[A2 + n]
        z[A1 + n] -= r
        z[A2 + n] += q
        z[A3 + n] += r
        z[A5 + n] -= p
        z[A6 + n] -= q
        z[A7 + n] += p


@native(entry=False, fastmath=FAST)
def add_applied(
    a: Array, i: int, v: Array, j: int, at: int, sign: float, c: Array, k: int, to: int
) -> None:
    """Add sign a v to the vector of c that begins at entry `to`; v's begins at entry `at`."""
    x, y, z = a[i], v[j, LANES * at : LANES * (at + 3)], c[k, LANES * to : LANES * (to + 3)]
    for n in range(LANES):
        p, q, r, s, t, u, e, f, g = nine(x, n)
        b0, b1, b2 = y[n], y[A1 + n], y[A2 + n]
        z[n] += sign * (p * b0 + q * b1 + r * b2)
        z[A1 + n] += sign * (s * b0 + t * b1 + u * b2)
        z[A2 + n] += sign * (e * b0 + f * b1 + g * b2)


@native(entry=False, fastmath=FAST)
def add_applied_t(
    a: Array, i: int, v: Array, j: int, at: int, sign: float, c: Array, k: int, to: int
) -> None:
    """Add sign a^T v to the vector of c that begins at entry `to`; v's begins at entry `at`."""
    x, y, z = a[i], v[j, LANES * at : LANES * (at + 3)], c[k, LANES * to : LANES * (to + 3)]
    for n in range(LANES):
        p, s, e, q, t, f, r, u, g = nine(x, n)
        b0, b1, b2 = y[n], y[A1 + n], y[A2 + n]
        z[n] += sign * (p * b0 + q * b1 + r * b2)
        z[A1 + n] += sign * (s * b0 + t * b1 + u * b2)
        z[A2 + n] += sign * (e * b0 + f * b1 + g * b2)


@native(entry=False, fastmath=FAST)
def inverse(a: Array, i: int, c: Array, k: int) -> None:
    """Set c to the inverse of a, whose columns are cross products of rows."""
    x, z = a[i], c[k]
    for n in range(LANES):
        p, q, r, s, t, u, v, w, o = nine(x, n)
        d0, d1, d2 = t * o - u * w, u * v - s * o, s * w - t * v
        over = 1.0 / (p * d0 + q * d1 + r * d2)
        z[n], z[A1 + n], z[A2 + n] = d0 * over, (r * w - q * o) * over, (q * u - r * t) * over
        z[A3 + n], z[A4 + n], z[A5 + n] = (
            d1 * over,
            (p * o - r * v) * over,
            (r * s - p * u) * over,
        )
        z[A6 + n], z[A7 + n], z[A8 + n] = (
            d2 * over,
            (q * v - p * w) * over,
            (p * t - q * s) * over,
        )


@native(entry=False)
def negatives(a: Array, i: int, lanes: int) -> int:
    """Return the number of negative eigenvalues of symmetric matrices in the first lanes."""
    count, x = 0, a[i]
    for n in range(lanes):
        p, q, r, _, t, u, _, _, o = nine(x, n)
        second = t - q * q / p
        mixed = u - q * r / p
        third = o - r * r / p - mixed * mixed / second
        count += (p < 0.0) + (second < 0.0) + (third < 0.0)
    return count

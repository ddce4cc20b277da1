"""Wrenches and stiffness of half-beams, sixteen beams at a time.

The mechanics is that of `mechanics.forces` and `mechanics.stiffness`. Here the stiffness may also
be exact: the energy of a half is d.K.d / 2; where its middle moves by z relative to its joint, d
changes by C z + B(z, z) / 2 with C its inverse right Jacobian, so that B weighted by K d adds to
C^T K C (`add_second_order`).
"""

from typing import Any

import numpy as np

from simulearn.mechanics.kernels.lanes import (
    A1,
    A2,
    A3,
    A4,
    A5,
    A6,
    A7,
    A8,
    FAST,
    LANES,
    WIDE,
    add,
    add_applied,
    add_applied_t,
    add_cross,
    add_product,
    add_product_t,
    product,
    transposed,
)
from simulearn.mechanics.kernels.rotations import inverse_left, rotation_vector
from simulearn.native import native

Array = Any

# Rows are NumPy's integers: for each literal one a called kernel would be compiled anew.
# Rows of the workspace. Rows of both ends: add the end.
JOINT, MIDDLE, AT_JOINT, AT_MIDDLE = np.arange(4)  # rotations and positions
TURN, RELATIVE, VECTORS, SCALARS = np.arange(4, 8)  # VECTORS: u, w, K d's force
J, D, T, L = np.arange(8, 12)  # of the inverse right Jacobian, and of how twists change
WRENCH = np.int64(12)  # 12, 13: force, moment
KT, KL, KB, KC = np.arange(14, 18)
N, Z, X, Y = np.arange(18, 22)
SAA, SAB, SBB = np.arange(22, 28, 2)  # stiffness, of both ends
# Rows of an element (of one end of sixteen beams)
REST, AT_REST, KAA, KAB, KBB, HALF_BEAM = np.arange(6)
# Where a vector begins in a row
FIRST, SECOND, THIRD = np.arange(0, 9, 3)


@native(entry=False)
def clear(w: Array, row: int) -> None:
    """Set a row to zero."""
    x = w[row]
    for n in range(WIDE):
        x[n] = 0.0


@native(entry=False)
def gather(w: Array, R: Array, p: Array, joint: Array, first: int, end: int, joints: int) -> None:
    """Put the poses that sixteen half-beams join into the workspace; their middles in own axes."""
    count = len(joint)
    sign = 1.0 if end == 0 else -1.0
    for n in range(LANES):
        beam = min(first + n, count - 1)
        a, m = joint[beam], joints + beam
        for k in range(9):
            w[JOINT, LANES * k + n] = R[a, k]
            w[MIDDLE, LANES * k + n] = R[m, k] if k % 3 == 2 else sign * R[m, k]
        for k in range(3):
            w[AT_JOINT, LANES * k + n] = p[a, k]
            w[AT_MIDDLE, LANES * k + n] = p[m, k]


@native(entry=False, fastmath=FAST)
def twist(w: Array, half_beams: Array, row: int, lanes: int) -> float:
    """Find how far middles have left their places at rest, and the coefficients there.

    Returns:
        The largest square of an angle.
    """
    product(w, JOINT, half_beams, row + REST, w, TURN)
    x, at, mid, v = w[SCALARS], w[AT_JOINT], w[AT_MIDDLE], w[VECTORS]
    for n in range(3 * LANES):
        x[n] = mid[n] - at[n]
    for n in range(WIDE):
        v[n] = 0.0
        w[RELATIVE, n] = 0.0
    add_applied(w, JOINT, half_beams, row + AT_REST, FIRST, -1.0, w, SCALARS, FIRST)
    add_applied_t(w, TURN, w, SCALARS, FIRST, 1.0, w, VECTORS, FIRST)
    add_product_t(w, TURN, w, MIDDLE, 1.0, w, RELATIVE)
    most, r = 0.0, w[RELATIVE]
    for n in range(LANES):
        a, b, c, square = rotation_vector(
            r[n], r[A1 + n], r[A2 + n], r[A3 + n], r[A4 + n], r[A5 + n], r[A6 + n], r[A7 + n],
            r[A8 + n],
        )  # fmt: skip
        k, first, second = inverse_left(square)
        if n < lanes:
            most = max(most, square)
        v[A3 + n], v[A4 + n], v[A5 + n] = a, b, c
        x[n], x[A1 + n], x[A2 + n], x[A3 + n] = square, k, first, second
    for n in range(LANES):
        a, b, c, k = v[A3 + n], v[A4 + n], v[A5 + n], x[A1 + n]
        p, q, s = v[n], v[A1 + n], v[A2 + n]
        e, f, g = b * s - c * q, c * p - a * s, a * q - b * p
        v[n] = p - e / 2 + k * (b * g - c * f)
        v[A1 + n] = q - f / 2 + k * (c * e - a * g)
        v[A2 + n] = s - g / 2 + k * (a * f - b * e)
    return most


@native(entry=False, fastmath=FAST)
def pull(w: Array, half_beams: Array, row: int, end: int) -> None:
    """Find wrenches on middles from twists, and how twists change as middles move."""
    v, x, j, d = w[VECTORS], w[SCALARS], w[J], w[D]
    for n in range(LANES):
        p, q, s = v[n], v[A1 + n], v[A2 + n]
        a, b, c = v[A3 + n], v[A4 + n], v[A5 + n]
        square, k, first = x[n], x[A1 + n], x[A2 + n]
        both = p * a + q * b + s * c
        g = 2 * both * first
        j[n] = 1 + k * (a * a - square)
        j[A4 + n] = 1 + k * (b * b - square)
        j[A8 + n] = 1 + k * (c * c - square)
        j[A1 + n], j[A3 + n] = k * a * b - c / 2, k * a * b + c / 2
        j[A2 + n], j[A6 + n] = k * a * c + b / 2, k * a * c - b / 2
        j[A5 + n], j[A7 + n] = k * b * c - a / 2, k * b * c + a / 2
        d[n] = k * (2 * a * p - 2 * both) + g * (a * a - square)
        d[A4 + n] = k * (2 * b * q - 2 * both) + g * (b * b - square)
        d[A8 + n] = k * (2 * c * s - 2 * both) + g * (c * c - square)
        e = k * (a * q + b * p) + g * a * b
        d[A1 + n], d[A3 + n] = e - s / 2, e + s / 2
        e = k * (a * s + c * p) + g * a * c
        d[A2 + n], d[A6 + n] = e + q / 2, e - q / 2
        e = k * (b * s + c * q) + g * b * c
        d[A5 + n], d[A7 + n] = e - p / 2, e + p / 2
    transposed(w, MIDDLE, w, N)
    product(w, J, w, N, w, T)
    product(w, D, w, N, w, L)
    t, f, at = w[T], w[L], w[AT_MIDDLE]
    for n in range(LANES):  # along: cross products of the place with the rows of T
        a, b, c = at[n], at[A1 + n], at[A2 + n]
        p, q, s = t[n], t[A1 + n], t[A2 + n]
        f[n] += b * s - c * q
        f[A1 + n] += c * p - a * s
        f[A2 + n] += a * q - b * p
        p, q, s = t[A3 + n], t[A4 + n], t[A5 + n]
        f[A3 + n] += b * s - c * q
        f[A4 + n] += c * p - a * s
        f[A5 + n] += a * q - b * p
        p, q, s = t[A6 + n], t[A7 + n], t[A8 + n]
        f[A6 + n] += b * s - c * q
        f[A7 + n] += c * p - a * s
        f[A8 + n] += a * q - b * p
    # VECTORS: 6 to 11 hold the wrench K d in the middle's axes, in 9 rows: force at 6; moment in X.
    for n in range(A6, WIDE):
        v[n] = 0.0
    clear(w, X)
    clear(w, WRENCH + end)
    add_applied(half_beams, row + KAA, w, VECTORS, FIRST, 1.0, w, VECTORS, THIRD)
    add_applied(half_beams, row + KAB, w, VECTORS, SECOND, 1.0, w, VECTORS, THIRD)
    add_applied_t(half_beams, row + KAB, w, VECTORS, FIRST, 1.0, w, X, FIRST)
    add_applied(half_beams, row + KBB, w, VECTORS, SECOND, 1.0, w, X, FIRST)
    add_applied_t(w, T, w, VECTORS, THIRD, 1.0, w, WRENCH + end, FIRST)
    add_applied_t(w, L, w, VECTORS, THIRD, 1.0, w, WRENCH + end, SECOND)
    add_applied_t(w, T, w, X, FIRST, 1.0, w, WRENCH + end, SECOND)


@native(entry=False)
def energy(w: Array, lanes: int) -> float:
    """Return the elastic energy of the first lanes, after `pull`."""
    v, x, total = w[VECTORS], w[X], 0.0
    for n in range(lanes):
        for k in range(3):
            total += v[LANES * k + n] * v[LANES * (6 + k) + n]
            total += v[LANES * (3 + k) + n] * x[LANES * k + n]
    return total / 2


@native(entry=False)
def stiffen(w: Array, half_beams: Array, row: int, end: int, exact: bool) -> None:
    """Find the stiffness C^T K C of half-beams, with second order terms where it is exact."""
    product(half_beams, row + KAA, w, T, w, KT)
    product(half_beams, row + KAA, w, L, w, KL)
    add_product(half_beams, row + KAB, w, T, 1.0, w, KL)
    clear(w, KB)
    add_product_t(half_beams, row + KAB, w, L, 1.0, w, KB)
    add_product(half_beams, row + KBB, w, T, 1.0, w, KB)
    clear(w, SAA + end)
    clear(w, SAB + end)
    clear(w, SBB + end)
    add_product_t(w, T, w, KT, 1.0, w, SAA + end)
    add_product_t(w, T, w, KL, 1.0, w, SAB + end)
    add_product_t(w, L, w, KL, 1.0, w, SBB + end)
    add_product_t(w, T, w, KB, 1.0, w, SBB + end)
    if exact:
        _add_second_order(w, end)


@native(entry=False, fastmath=FAST)
def _add_second_order(w: Array, end: int) -> None:
    """Add the second derivatives of twists, weighted by the wrenches."""
    v, x, moment, nn, zz = w[VECTORS], w[SCALARS], w[X], w[N], w[Z]
    for n in range(LANES):
        u0, u1, u2 = v[n], v[A1 + n], v[A2 + n]
        a0, a1, a2 = v[A3 + n], v[A4 + n], v[A5 + n]
        f0, f1, f2 = v[A6 + n], v[A7 + n], v[A8 + n]
        m0, m1, m2 = moment[n], moment[A1 + n], moment[A2 + n]
        square, k, first, second = x[n], x[A1 + n], x[A2 + n], x[A3 + n]
        wf, wm, wu = (
            a0 * f0 + a1 * f1 + a2 * f2,
            a0 * m0 + a1 * m1 + a2 * m2,
            a0 * u0 + a1 * u1 + a2 * u2,
        )
        uf = u0 * f0 + u1 * f1 + u2 * f2
        # With q(f) = w (w.f) - w2 f: J^T f = f - w x f / 2 + k q(f).
        q0, q1, q2 = a0 * wf - square * f0, a1 * wf - square * f1, a2 * wf - square * f2
        s0, s1, s2 = a0 * wm - square * m0, a1 * wm - square * m1, a2 * wm - square * m2
        # Its derivative along w: hat(f) / 2 + 2 k' q w^T + k (w.f + w f^T - 2 f w^T).
        nn[n] = 2 * first * q0 * a0 + k * (wf - a0 * f0)
        nn[A1 + n] = 2 * first * q0 * a1 + k * (a0 * f1 - 2 * f0 * a1) - f2 / 2
        nn[A2 + n] = 2 * first * q0 * a2 + k * (a0 * f2 - 2 * f0 * a2) + f1 / 2
        nn[A3 + n] = 2 * first * q1 * a0 + k * (a1 * f0 - 2 * f1 * a0) + f2 / 2
        nn[A4 + n] = 2 * first * q1 * a1 + k * (wf - a1 * f1)
        nn[A5 + n] = 2 * first * q1 * a2 + k * (a1 * f2 - 2 * f1 * a2) - f0 / 2
        nn[A6 + n] = 2 * first * q2 * a0 + k * (a2 * f0 - 2 * f2 * a0) - f1 / 2
        nn[A7 + n] = 2 * first * q2 * a1 + k * (a2 * f1 - 2 * f2 * a1) + f0 / 2
        nn[A8 + n] = 2 * first * q2 * a2 + k * (wf - a2 * f2)
        # The same of the moment, and the second derivative along u and w.
        t0, t1, t2 = (
            u0 * wf + a0 * uf - 2 * wu * f0,
            u1 * wf + a1 * uf - 2 * wu * f1,
            u2 * wf + a2 * uf - 2 * wu * f2,
        )
        e, g = 4 * second * wu, 2 * first
        h0, h1, h2 = e * q0 + g * (t0 + s0), e * q1 + g * (t1 + s1), e * q2 + g * (t2 + s2)
        c, o = g * wu, g * wu * wf + k * (uf + wm)
        zz[n] = h0 * a0 + g * q0 * u0 - c * f0 * a0 - k * (f0 * u0 + m0 * a0) + o
        zz[A1 + n] = (
            h0 * a1 + g * q0 * u1 + c * (a0 * f1 - 2 * f0 * a1)
            + k * (u0 * f1 - 2 * f0 * u1 + a0 * m1 - 2 * m0 * a1) - m2 / 2
        )  # fmt: skip
        zz[A2 + n] = (
            h0 * a2 + g * q0 * u2 + c * (a0 * f2 - 2 * f0 * a2)
            + k * (u0 * f2 - 2 * f0 * u2 + a0 * m2 - 2 * m0 * a2) + m1 / 2
        )  # fmt: skip
        zz[A3 + n] = (
            h1 * a0 + g * q1 * u0 + c * (a1 * f0 - 2 * f1 * a0)
            + k * (u1 * f0 - 2 * f1 * u0 + a1 * m0 - 2 * m1 * a0) + m2 / 2
        )  # fmt: skip
        zz[A4 + n] = h1 * a1 + g * q1 * u1 - c * f1 * a1 - k * (f1 * u1 + m1 * a1) + o
        zz[A5 + n] = (
            h1 * a2 + g * q1 * u2 + c * (a1 * f2 - 2 * f1 * a2)
            + k * (u1 * f2 - 2 * f1 * u2 + a1 * m2 - 2 * m1 * a2) - m0 / 2
        )  # fmt: skip
        zz[A6 + n] = (
            h2 * a0 + g * q2 * u0 + c * (a2 * f0 - 2 * f2 * a0)
            + k * (u2 * f0 - 2 * f2 * u0 + a2 * m0 - 2 * m2 * a0) - m1 / 2
        )  # fmt: skip
        zz[A7 + n] = (
            h2 * a1 + g * q2 * u1 + c * (a2 * f1 - 2 * f2 * a1)
            + k * (u2 * f1 - 2 * f2 * u1 + a2 * m1 - 2 * m2 * a1) + m0 / 2
        )  # fmt: skip
        zz[A8 + n] = h2 * a2 + g * q2 * u2 - c * f2 * a2 - k * (f2 * u2 + m2 * a2) + o
    product(w, N, w, T, w, KT)
    product(w, MIDDLE, w, KT, w, KC)
    add(w, KC, 0.5, w, SAB + end)
    transposed(w, KC, w, KB)
    add(w, KB, 0.5, w, SAB + end)
    product(w, N, w, L, w, KL)
    add_product(w, Z, w, T, 1.0, w, KL)
    product(w, MIDDLE, w, KL, w, Y)
    clear(w, KT)
    add_cross(w, AT_MIDDLE, FIRST, 1.0, w, KT)
    add_product(w, KT, w, KC, 1.0, w, Y)
    add(w, Y, 0.5, w, SBB + end)
    transposed(w, Y, w, KT)
    add(w, KT, 0.5, w, SBB + end)

"""Layers of a network in single precision, as loops that become vector instructions."""

from math import floor
from typing import Any

import numpy as np

from simulearn.native import native

Array = Any

FAST = {"contract"}
STRIP = 64  # columns at a time
DOUBLE, TRIPLE = 2 * STRIP, 3 * STRIP
ONE, HALF, TOP = np.float32(1.0), np.float32(0.5), np.float32(87.0)
LOG2, LN2_HIGH, LN2_LOW = np.float32(1.442695041), np.float32(0.693359375), np.float32(-2.12194440e-4)
# exp(r) - 1 - r over r2, |r| below ln 2 / 2: coefficients of Cephes' expf (S. Moshier)
E0, E1, E2 = np.float32(1.9875691500e-4), np.float32(1.3981999507e-3), np.float32(8.3334519073e-3)
E3, E4, E5 = np.float32(4.1665795894e-2), np.float32(1.6666665459e-1), np.float32(5.0000001201e-1)


@native(entry=False, fastmath=FAST)
def affine(x: Array, inner: int, matrix: Array, bias: Array, out: Array, sums: Array) -> None:
    """Set out = x[:, :inner] @ matrix + bias; the number of rows is a multiple of four.

    Args:
        x: (n, at least inner).
        inner: columns of x that count.
        matrix: (inner, m).
        bias: (m,).
        out: (n, at least m).
        sums: (4 STRIP,) workspace.
    """
    width = matrix.shape[1]
    for left in range(0, width, STRIP):
        count = min(STRIP, width - left)
        own = bias[left : left + count]
        for row in range(0, len(x), 4):
            x0, x1, x2, x3 = x[row], x[row + 1], x[row + 2], x[row + 3]
            for j in range(count):
                sums[j] = sums[STRIP + j] = sums[DOUBLE + j] = sums[TRIPLE + j] = own[j]
            k = 0
            while k + 4 <= inner:
                w0, w1 = matrix[k, left : left + count], matrix[k + 1, left : left + count]
                w2, w3 = matrix[k + 2, left : left + count], matrix[k + 3, left : left + count]
                a0, a1, a2, a3 = x0[k], x0[k + 1], x0[k + 2], x0[k + 3]
                b0, b1, b2, b3 = x1[k], x1[k + 1], x1[k + 2], x1[k + 3]
                c0, c1, c2, c3 = x2[k], x2[k + 1], x2[k + 2], x2[k + 3]
                d0, d1, d2, d3 = x3[k], x3[k + 1], x3[k + 2], x3[k + 3]
                for j in range(count):
                    p, q, r, s = w0[j], w1[j], w2[j], w3[j]
                    sums[j] += a0 * p + a1 * q + a2 * r + a3 * s
                    sums[STRIP + j] += b0 * p + b1 * q + b2 * r + b3 * s
                    sums[DOUBLE + j] += c0 * p + c1 * q + c2 * r + c3 * s
                    sums[TRIPLE + j] += d0 * p + d1 * q + d2 * r + d3 * s
                k += 4
            while k < inner:
                w0 = matrix[k, left : left + count]
                a0, b0, c0, d0 = x0[k], x1[k], x2[k], x3[k]
                for j in range(count):
                    sums[j] += a0 * w0[j]
                    sums[STRIP + j] += b0 * w0[j]
                    sums[DOUBLE + j] += c0 * w0[j]
                    sums[TRIPLE + j] += d0 * w0[j]
                k += 1
            for j in range(count):
                out[row, left + j] = sums[j]
                out[row + 1, left + j] = sums[STRIP + j]
                out[row + 2, left + j] = sums[DOUBLE + j]
                out[row + 3, left + j] = sums[TRIPLE + j]


@native(entry=False, fastmath=FAST)
def activate(x: Array, width: int, powers: Array, bits: Array, scales: Array) -> None:
    """Set the first columns of x to x / (1 + exp(-x)).

    Args:
        x: (n, at least width).
        width: columns that count.
        powers: (width,) workspace.
        bits, scales: (width,) workspace, the same memory as integers and as numbers.
    """
    for i in range(len(x)):
        row = x[i]
        for j in range(width):
            y = min(max(-row[j], -TOP), TOP)
            n = np.float32(floor(y * LOG2 + HALF))
            r = y - n * LN2_HIGH - n * LN2_LOW
            p = ((((E0 * r + E1) * r + E2) * r + E3) * r + E4) * r + E5
            powers[j] = p * r * r + r + ONE
            bits[j] = np.int32((np.int32(n) + np.int32(127)) << np.int32(23))
        for j in range(width):
            row[j] = row[j] / (ONE + powers[j] * scales[j])

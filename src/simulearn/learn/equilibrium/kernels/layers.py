"""Layers of a network in single precision, as loops that become vector instructions."""

from math import floor
from typing import Any

import numpy as np

from simulearn.native import native

Array = Any

FAST = {"contract"}
ALONE = 64**3  # multiplications that one thread does
ONE, HALF, TOP = np.float32(1.0), np.float32(0.5), np.float32(87.0)
LOG2, LN2_HIGH, LN2_LOW = (
    np.float32(1.442695041),
    np.float32(0.693359375),
    np.float32(-2.12194440e-4),
)
# exp(r) - 1 - r over r2, |r| below ln 2 / 2: coefficients of Cephes' expf (S. Moshier)
E0, E1, E2 = np.float32(1.9875691500e-4), np.float32(1.3981999507e-3), np.float32(8.3334519073e-3)
E3, E4, E5 = np.float32(4.1665795894e-2), np.float32(1.6666665459e-1), np.float32(5.0000001201e-1)


@native(entry=False)
def product(x: Array, matrix: Array, out: Array) -> None:
    """Set out = x @ matrix, in blocks of rows that BLAS does not share among threads.

    OpenBLAS uses one thread up to 64 x 64 x 64 products; rollout batches have threads of their own.
    """
    count = max(1, ALONE // (matrix.shape[0] * matrix.shape[1]))
    for row in range(0, len(x), count):
        np.dot(x[row : row + count], matrix, out[row : row + count])


@native(entry=False)
def add_rows(x: Array, row: Array) -> None:
    """Add a row to all rows."""
    for i in range(len(x)):
        own = x[i]
        for k in range(len(row)):
            own[k] += row[k]


@native(entry=False, fastmath=FAST)
def activate(x: Array, width: int, powers: Array, bits: Array, scales: Array) -> None:
    """Set the first columns of x to x / (1 + exp(-x)).

    Args:
        x: (n, at least width).
        width: columns that count.
        powers: (width,) workspace.
        bits: (width,) workspace, integers.
        scales: (width,) the same memory as numbers.
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

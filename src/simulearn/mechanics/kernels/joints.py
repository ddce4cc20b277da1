"""Factors of the joints' stiffness: a sparse symmetric matrix of 6 x 6 blocks.

Joints are eliminated in an order that keeps new blocks few (see `mechanics.ordering`). Blocks lie
in an array (blocks, 36): first the diagonal ones in that order, then those below, column by column.
Pivots need not be positive; how many are negative is the number of directions in which the energy
falls (Sylvester's law of inertia).
"""

from typing import Any

import numpy as np

from simulearn.native import native

Array = Any


@native(entry=False)
def factorise(blocks: Array, columns: Array, rows: Array, targets: Array, scratch: Array) -> int:
    """Factorise in place as L D L^T; the inverses of D take the diagonal's place.

    Args:
        blocks: (blocks, 36).
        columns: (n + 1,) where the blocks below each diagonal begin in `rows`.
        rows: of the blocks below.
        targets: for each column, for each pair of its blocks (first >= second), the block that
            they change.
        scratch: (most in a column, 36).

    Returns:
        How many pivots are negative.
    """
    count = len(columns) - 1
    negative, pair = 0, 0
    for k in range(count):
        negative += _invert(blocks[k])
        begin, end = columns[k], columns[k + 1]
        inverse = blocks[k]
        for i in range(begin, end):
            block, old = blocks[count + i], scratch[i - begin]
            for m in range(36):
                old[m] = block[m]
            for r in range(6):
                for c in range(6):
                    total = 0.0
                    for m in range(6):
                        total += old[6 * r + m] * inverse[6 * m + c]
                    block[6 * r + c] = total
        for i in range(begin, end):
            left = blocks[count + i]
            for j in range(begin, i + 1):
                right, target = scratch[j - begin], blocks[targets[pair]]
                pair += 1
                for r in range(6):
                    for c in range(6):
                        total = 0.0
                        for m in range(6):
                            total += left[6 * r + m] * right[6 * c + m]
                        target[6 * r + c] -= total
    return negative


@native(entry=False)
def _invert(a: Array) -> int:
    """Invert a symmetric (36,) matrix in place by sweeps; return how many pivots are negative."""
    negative = 0
    for k in range(6):
        pivot = a[7 * k]
        if pivot < 0.0:
            negative += 1
        over = 1.0 / pivot
        for i in range(6):
            if i != k:
                share = a[6 * i + k] * over
                for j in range(6):
                    if j != k:
                        a[6 * i + j] -= share * a[6 * k + j]
        for i in range(6):
            if i != k:
                a[6 * i + k] *= over
                a[6 * k + i] *= -over
        a[7 * k] = over
    return negative


@native(entry=False)
def substitute(blocks: Array, columns: Array, rows: Array, x: Array) -> None:
    """Solve in place for a right side x (n, 6)."""
    count = len(columns) - 1
    own = np.empty(6)
    for k in range(count):
        a, b, c, d, e, f = x[k, 0], x[k, 1], x[k, 2], x[k, 3], x[k, 4], x[k, 5]
        for i in range(columns[k], columns[k + 1]):
            row, block = rows[i], blocks[count + i]
            for r in range(6):
                x[row, r] -= (
                    block[6 * r] * a + block[6 * r + 1] * b + block[6 * r + 2] * c
                    + block[6 * r + 3] * d + block[6 * r + 4] * e + block[6 * r + 5] * f
                )  # fmt: skip
    for k in range(count - 1, -1, -1):
        a, b, c, d, e, f = x[k, 0], x[k, 1], x[k, 2], x[k, 3], x[k, 4], x[k, 5]
        block = blocks[k]
        for r in range(6):
            own[r] = (
                block[6 * r] * a + block[6 * r + 1] * b + block[6 * r + 2] * c
                + block[6 * r + 3] * d + block[6 * r + 4] * e + block[6 * r + 5] * f
            )  # fmt: skip
        for i in range(columns[k], columns[k + 1]):
            row, block = rows[i], blocks[count + i]
            for m in range(6):
                share = x[row, m]
                for r in range(6):
                    own[r] -= block[6 * m + r] * share
        for r in range(6):
            x[k, r] = own[r]

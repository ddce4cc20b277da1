"""Elimination of unknowns front by front: the multifrontal method (Duff and Reid 1983).

A front is a small dense symmetric matrix of the nodes that are eliminated in it (its own) and of
those that they are coupled to (the rest). It gathers the stiffness of its bricks and what its
children leave, eliminates its own nodes and leaves a matrix on the rest for its parent. Forces are
one more column. Factors are L D L^T without pivoting: the number of negative pivots is that of
negative eigenvalues of the stiffness (Sylvester's law of inertia).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulearn.fea.kernels.law import FUSED
from simulearn.native import native

PANEL = 6  # rows eliminated at once; a front's own rows are a multiple of three
TILE = 512  # columns of a panel
ROWS = 4  # that an update takes at a time
SUMMED = {"contract", "reassoc"}  # sums of products may be added in any order


class Fronts(NamedTuple):
    """The fronts of a solid, children before their parents, depth first.

    Attributes:
        nodes: nodes of front after front, own ones first; fixed nodes are in none.
        start: (T + 1,) where the nodes of each front begin.
        own: (T,) how many of them are eliminated there.
        bricks: bricks of front after front.
        first_brick: (T + 1,) where the bricks of each front begin.
        children: (T,) number of children; they are the last fronts not yet taken up.
        factors: (T + 1,) where the factor of each front begins.
        pivots: (T + 1,) where its pivots begin.
        space: (2,) largest front, and most room for what waits for a parent, in numbers.
    """

    nodes: NDArray[np.int64]
    start: NDArray[np.int64]
    own: NDArray[np.int64]
    bricks: NDArray[np.int64]
    first_brick: NDArray[np.int64]
    children: NDArray[np.int64]
    factors: NDArray[np.int64]
    pivots: NDArray[np.int64]
    space: NDArray[np.int64]


@native(entry=False, fastmath=FUSED)
def add_brick(front, ld, place, nodes, e, stiffness, forces):
    """Add a brick's stiffness to the upper triangle of a front, and its forces to the last column.

    Args:
        front: the matrix, row after row.
        ld: length of a row; the last column is for forces.
        place: (N,) place of each node in the front, -1 where it is fixed.
        nodes: (E, 20) of the bricks.
        e: the brick.
        stiffness: (20, 120), see `brick.tangent`.
        forces: (3, 20) internal forces, subtracted.
    """
    for a in range(20):
        p = place[nodes[e, a]]
        if p < 0:
            continue
        row = 3 * p * ld
        for k in range(3):
            front[row + k * ld + ld - 1] -= forces[k, a]
        for b in range(20):
            q = place[nodes[e, b]]
            if q < p:
                continue
            at = row + 3 * q
            front[at] += stiffness[a, b]
            front[at + 1] += stiffness[a, 20 + b]
            front[at + 2] += stiffness[a, 40 + b]
            at += ld
            front[at] += stiffness[b, 20 + a]
            front[at + 1] += stiffness[a, 60 + b]
            front[at + 2] += stiffness[a, 80 + b]
            at += ld
            front[at] += stiffness[b, 40 + a]
            front[at + 1] += stiffness[b, 80 + a]
            front[at + 2] += stiffness[a, 100 + b]


@native(entry=False, fastmath=FUSED)
def add_child(front, ld, place, nodes, first, count, waiting, at):
    """Add what a child left, a matrix on `count` nodes with a column of forces, to a front."""
    wide = 3 * count + 1
    # Nodes that follow each other in both are added in one run.
    runs = np.ones(count, dtype=np.int64)
    for b in range(count - 2, -1, -1):
        if place[nodes[first + b + 1]] == place[nodes[first + b]] + 1:
            runs[b] = runs[b + 1] + 1
    for a in range(count):
        p = place[nodes[first + a]]
        for k in range(3):
            here = at + (3 * a + k) * wide
            row = (3 * p + k) * ld
            front[row + ld - 1] += waiting[here + 3 * count]
            b = a
            while b < count:
                q, run = place[nodes[first + b]], runs[b]
                if q < p:
                    for c in range(run):
                        for l in range(3):  # noqa: E741
                            front[(3 * (q + c) + l) * ld + 3 * p + k] += waiting[
                                here + 3 * (b + c) + l
                            ]
                else:
                    _add(front, row + 3 * q, waiting, here + 3 * b, 3 * run)
                b += run


@native(entry=False, fastmath=FUSED)
def eliminate(front, rows, own, factors, at, pivots, first):
    """Eliminate the first `own` of a front's rows; what is left stands in the others.

    Args:
        front: (rows, rows + 1) upper triangle and forces, row after row.
        rows: number of unknowns.
        own: of which are eliminated; a multiple of three.
        factors: where the rows over their pivots are written, from `at` on.
        at: place in `factors`.
        pivots: where the pivots are written, from `first` on.
        first: place in `pivots`.

    Returns:
        number of negative pivots.
    """
    ld = rows + 1
    panel = np.zeros(PANEL * TILE)
    negative = 0
    begin = 0
    while begin < own:
        wide = PANEL if own - begin >= PANEL else 3
        end = begin + wide
        for k in range(begin, end):
            row = k * ld
            pivot = front[row + k]
            pivots[first + k] = pivot
            negative += not pivot > 0
            over = 1 / pivot
            for r in range(k + 1, end):
                _subtract(front, r * ld + r, front[row + r] * over, row + r, ld - r)
            scale(front, row + k + 1, over, factors, at + row + k + 1, ld - k - 1)
        _update(front, ld, begin, wide, rows, factors, at + begin * ld, panel)
        begin = end
    return negative


@native(entry=False, fastmath=FUSED)
def _subtract(front, to, factor, source, many):
    """Subtract a multiple of `many` numbers from others of the same matrix."""
    u, v, n = np.uintp(to), np.uintp(source), np.uintp(many)  # see `_rows`
    for j in range(n):
        front[u + j] -= factor * front[v + j]


@native(entry=False, fastmath=FUSED)
def _add(out, to, numbers, source, many):
    """Add `many` numbers to others."""
    u, v, n = np.uintp(to), np.uintp(source), np.uintp(many)
    for j in range(n):
        out[u + j] += numbers[v + j]


@native(entry=False, fastmath=FUSED)
def scale(front, source, factor, out, to, many):
    """Write a multiple of `many` numbers."""
    u, v, n = np.uintp(to), np.uintp(source), np.uintp(many)
    for j in range(n):
        out[u + j] = factor * front[v + j]


@native(entry=False, fastmath=FUSED)
def _update(front, ld, begin, wide, rows, factors, w, panel):
    """Subtract what `wide` eliminated rows from `begin` on do to the rows below them.

    The compiler only vectorises the loops if it can tell that nothing overlaps. So the rows over
    their pivots are copied, tile by tile, to a panel whose rows lie a constant apart.
    """
    end = begin + wide
    panel[wide * TILE :] = 0.0
    of = np.zeros((ROWS, PANEL))
    for left in range(end, ld, TILE):
        many = min(TILE, ld - left)
        for t in range(wide):
            scale(factors, w + t * ld + left, 1.0, panel, t * TILE, many)
        for i in range(end, min(left + many, rows), ROWS):
            # Some rows at a time; what the lower ones have before their diagonals is not used.
            high = min(ROWS, rows - i)
            for t in range(wide):
                for r in range(ROWS):
                    of[r, t] = front[(begin + t) * ld + i + r] if r < high else 0.0
            first = max(i, left)
            at = i * ld + first
            _rows(
                front,
                at,
                at + ld if high > 1 else at,
                at + 2 * ld if high > 2 else at,
                at + 3 * ld if high > 3 else at,
                panel,
                first - left,
                left + many - first,
                of,
            )


@native(entry=False, fastmath=FUSED)
def _rows(front, first, second, third, fourth, panel, x, many, of):
    """Subtract multiples of a panel's rows, from column x on, from four rows of a front."""
    # Unsigned indices are not taken for places counted from the end.
    u0, u1, u2, u3 = np.uintp(first), np.uintp(second), np.uintp(third), np.uintp(fourth)
    p0, p1, p2, n = np.uintp(x), np.uintp(x + TILE), np.uintp(x + 2 * TILE), np.uintp(many)
    p3, p4, p5 = np.uintp(x + 3 * TILE), np.uintp(x + 4 * TILE), np.uintp(x + 5 * TILE)
    a0, a1, a2, a3, a4, a5 = of[0, 0], of[0, 1], of[0, 2], of[0, 3], of[0, 4], of[0, 5]
    b0, b1, b2, b3, b4, b5 = of[1, 0], of[1, 1], of[1, 2], of[1, 3], of[1, 4], of[1, 5]
    c0, c1, c2, c3, c4, c5 = of[2, 0], of[2, 1], of[2, 2], of[2, 3], of[2, 4], of[2, 5]
    d0, d1, d2, d3, d4, d5 = of[3, 0], of[3, 1], of[3, 2], of[3, 3], of[3, 4], of[3, 5]
    for j in range(n):
        w0, w1, w2 = panel[p0 + j], panel[p1 + j], panel[p2 + j]
        w3, w4, w5 = panel[p3 + j], panel[p4 + j], panel[p5 + j]
        front[u0 + j] -= a0 * w0 + a1 * w1 + a2 * w2 + a3 * w3 + a4 * w4 + a5 * w5
        front[u1 + j] -= b0 * w0 + b1 * w1 + b2 * w2 + b3 * w3 + b4 * w4 + b5 * w5
        front[u2 + j] -= c0 * w0 + c1 * w1 + c2 * w2 + c3 * w3 + c4 * w4 + c5 * w5
        front[u3 + j] -= d0 * w0 + d1 * w1 + d2 * w2 + d3 * w3 + d4 * w4 + d5 * w5


@native(entry=False, fastmath=FUSED)
def back_substitute(fronts, factors, x, local):
    """Write the solution x (N, 3); the factors' last columns hold the forces over the pivots."""
    for f in range(len(fronts.own) - 1, -1, -1):
        first, count = fronts.start[f], fronts.start[f + 1] - fronts.start[f]
        rows, own = 3 * count, 3 * fronts.own[f]
        ld, at = rows + 1, fronts.factors[f]
        for a in range(fronts.own[f], count):
            for k in range(3):
                local[3 * a + k] = x[fronts.nodes[first + a], k]
        for r in range(own - 1, -1, -1):
            row = at + r * ld
            local[r] = factors[row + rows] - _dot(factors, row + r + 1, local, r + 1, rows - r - 1)
        for a in range(fronts.own[f]):
            for k in range(3):
                x[fronts.nodes[first + a], k] = local[3 * a + k]


@native(entry=False, fastmath=SUMMED)
def _dot(factors, at, local, first, many):
    """Return the sum of products of `many` numbers."""
    u, v, n = np.uintp(at), np.uintp(first), np.uintp(many)
    total = 0.0
    for j in range(n):
        total += factors[u + j] * local[v + j]
    return total


@native(entry=False, fastmath=FUSED)
def forward_substitute(fronts, factors, pivots, load, local):
    """Overwrite the forces over the pivots in the factors with those of another load (N, 3).

    The load is overwritten.
    """
    for f in range(len(fronts.own)):
        first, count = fronts.start[f], fronts.start[f + 1] - fronts.start[f]
        rows, own = 3 * count, 3 * fronts.own[f]
        ld, at = rows + 1, fronts.factors[f]
        for a in range(count):
            for k in range(3):
                local[3 * a + k] = load[fronts.nodes[first + a], k]
        for r in range(own):
            row = at + r * ld
            y = local[r]
            factors[row + rows] = y / pivots[fronts.pivots[f] + r]
            _subtract_from(local, r + 1, y, factors, row + r + 1, rows - r - 1)
        for a in range(fronts.own[f], count):
            for k in range(3):
                load[fronts.nodes[first + a], k] = local[3 * a + k]


@native(entry=False, fastmath=FUSED)
def _subtract_from(local, to, factor, factors, source, many):
    """Subtract a multiple of `many` numbers from others."""
    u, v, n = np.uintp(to), np.uintp(source), np.uintp(many)
    for j in range(n):
        local[u + j] -= factor * factors[v + j]

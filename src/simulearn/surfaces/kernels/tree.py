"""A tree of boxes over triangles.

Triangles are halved along the longest side of their centres' box until LEAF or fewer are left. All
halves of one level differ by one triangle at most, so the tree is complete: the children of node k
are 2 k + 1 and 2 k + 2.
"""

from typing import Any

import numpy as np

from simulearn.native import native

Array = Any
LEAF = 4  # triangles


def depth_of(count: int) -> int:
    """Return how often so many triangles are halved."""
    depth = 0
    while -(-count >> depth) > LEAF:
        depth += 1
    return depth


@native()
def build(corners: Array, depth: int) -> Any:
    """Return the order (T,) of triangles, the first of each leaf and T, boxes (nodes, 2, 3).

    Args:
        corners: (T, 3, 3) of the triangles.
        depth: of `depth_of`.
    """
    count = len(corners)
    order = np.arange(count)
    centres = np.empty((count, 3))
    for t in range(count):
        for k in range(3):
            centres[t, k] = (corners[t, 0, k] + corners[t, 1, k] + corners[t, 2, k]) / 3
    inner = (1 << depth) - 1
    nodes = 2 * inner + 1
    boxes = np.empty((nodes, 2, 3))
    first, last = np.empty(nodes, np.int64), np.empty(nodes, np.int64)
    first[0], last[0] = 0, count
    for node in range(inner):
        a, z = first[node], last[node]
        middle = (a + z) // 2
        _part(order, centres, a, z, middle, _longest(order, centres, a, z))
        first[2 * node + 1], last[2 * node + 1] = a, middle
        first[2 * node + 2], last[2 * node + 2] = middle, z
    for node in range(nodes - 1, -1, -1):
        for k in range(3):
            if node >= inner:
                low, high = np.inf, -np.inf
                for i in range(first[node], last[node]):
                    for c in range(3):
                        low = min(low, corners[order[i], c, k])
                        high = max(high, corners[order[i], c, k])
            else:
                low = min(boxes[2 * node + 1, 0, k], boxes[2 * node + 2, 0, k])
                high = max(boxes[2 * node + 1, 1, k], boxes[2 * node + 2, 1, k])
            boxes[node, 0, k], boxes[node, 1, k] = low, high
    starts = np.empty(inner + 2, np.int64)
    starts[:-1], starts[-1] = first[inner:], count
    return order, starts, boxes


@native(entry=False)
def _longest(order: Array, centres: Array, a: int, z: int) -> int:
    """Return the axis along which centres a to z are spread most."""
    best, most = 0, -1.0
    for k in range(3):
        low, high = np.inf, -np.inf
        for i in range(a, z):
            low, high = min(low, centres[order[i], k]), max(high, centres[order[i], k])
        if high - low > most:
            best, most = k, high - low
    return best


@native(entry=False)
def _part(order: Array, centres: Array, a: int, z: int, middle: int, axis: int) -> None:
    """Order a to z so that none before the middle lies behind one after it along an axis.

    Source: Hoare, Algorithm 65: FIND, 1961.
    """
    left, right = a, z - 1
    while left < right:
        pivot = centres[order[(left + right) // 2], axis]
        i, j = left, right
        while i <= j:
            while centres[order[i], axis] < pivot:
                i += 1
            while centres[order[j], axis] > pivot:
                j -= 1
            if i <= j:
                order[i], order[j] = order[j], order[i]
                i += 1
                j -= 1
        if middle <= j:
            right = j
        elif middle >= i:
            left = i
        else:
            return

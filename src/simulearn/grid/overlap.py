"""Which convex pieces of the plane overlap: two do unless an edge of one separates them."""

import numpy as np
import shapely
from numpy.typing import NDArray

Numbers = NDArray[np.float64]
Indices = NDArray[np.int64]

# Pieces whose neighbours are searched together, and pairs that are compared together: they bound
# the memory where everything lies on everything.
AT_ONCE = 256
PAIRS = 2**16
NONE = np.zeros((0, 2), np.int64)
NEXT = np.array([1, 2, 3, 0])


def overlaps(
    pieces: Numbers,
    tolerance: float = 1e-6,
    ends: Indices | None = None,
    groups: Indices | None = None,
    most: int | None = None,
) -> Indices:
    """Return the pairs of convex quadrilaterals that overlap; to touch is not to overlap.

    Args:
        pieces: (P, 4, 2) mm, corners counter-clockwise.
        tolerance: how deep one may lie in another, mm.
        ends: (P, 2) numbers of ends; pieces with a common end are known not to overlap.
        groups: (P,) pieces of different groups do not overlap; one group unless given.
        most: stop after so many pairs.

    Returns:
        (pairs, 2) indices, the lower first, in rising order.
    """
    if not len(pieces):
        return NONE
    low, high = pieces.min(axis=1), pieces.max(axis=1)
    if groups is not None:  # the boxes of each group lie beside those of the one before
        shift = groups * (high[:, 0].max() - low[:, 0].min() + 1.0)
        low[:, 0] += shift
        high[:, 0] += shift
    boxes = shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1])
    tree = shapely.STRtree(boxes)
    overlapping = [NONE]
    for k in range(0, len(boxes), AT_ONCE):
        pairs = tree.query(boxes[k : k + AT_ONCE]).T
        pairs[:, 0] += k
        pairs = pairs[pairs[:, 0] < pairs[:, 1]]
        if ends is not None:
            a, b = ends[pairs].swapaxes(0, 1)
            pairs = pairs[((a != b) & (a != b[:, ::-1])).all(axis=1)]
        overlapping += [
            some[~_separated(pieces[some], tolerance)]
            for some in (pairs[m : m + PAIRS] for m in range(0, len(pairs), PAIRS))
        ]
        if most is not None and sum(map(len, overlapping)) >= most:
            break
    pairs = np.concatenate(overlapping)[:most]
    return pairs[np.lexsort(pairs.T[::-1])]


def _separated(pairs: Numbers, tolerance: float) -> NDArray[np.bool_]:
    """Return for pairs of pieces (N, 2, 4, 2) whether an edge of one separates them."""
    edges = pairs[:, :, NEXT] - pairs
    edges /= np.hypot(edges[..., 0], edges[..., 1])[..., None]
    outwards = np.stack([edges[..., 1], -edges[..., 0]], axis=-1)
    away = (outwards * pairs).sum(axis=-1, keepdims=True)
    # How far each corner of the other lies outside each edge: (N, 2, edge, corner).
    outside = outwards @ pairs[:, ::-1].swapaxes(2, 3) - away
    return (outside.min(axis=3) >= -tolerance).any(axis=(1, 2))

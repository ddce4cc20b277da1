"""Which convex pieces of the plane overlap: two do unless an edge of one separates them."""

import numpy as np
from numpy.typing import NDArray

AT_ONCE = 32  # pieces compared with all others


def overlaps(pieces: NDArray[np.float64], tolerance: float = 1e-6) -> NDArray[np.int64]:
    """Return the pairs of convex polygons that overlap; to touch is not to overlap.

    Args:
        pieces: (P, n, 2) mm, corners counter-clockwise.
        tolerance: how deep one may lie in another, mm.

    Returns:
        (pairs, 2) indices, the lower first, in rising order.
    """
    edges = np.roll(pieces, -1, axis=1) - pieces
    edges /= np.linalg.norm(edges, axis=2, keepdims=True)
    outwards = np.stack([edges[..., 1], -edges[..., 0]], axis=2)
    away = np.sum(outwards * pieces, axis=2)
    separated = np.zeros((len(pieces), len(pieces)), dtype=bool)
    for k in range(0, len(pieces), AT_ONCE):
        some = slice(k, k + AT_ONCE)
        # How far each corner of each piece lies outside each edge: (some, edge, piece, corner).
        outside = np.tensordot(outwards[some], pieces, axes=(2, 2))
        outside -= away[some, :, None, None]
        separated[some] = (outside.min(axis=3) >= -tolerance).any(axis=1)
    return np.argwhere(np.triu(~(separated | separated.T), k=1))

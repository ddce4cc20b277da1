"""Which convex pieces of the plane overlap: two do unless an edge of one separates them."""

import numpy as np
from numpy.typing import NDArray


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
    separated = np.zeros((len(pieces), len(pieces)), dtype=bool)
    for k, (corners, normals) in enumerate(zip(pieces, outwards, strict=True)):
        # How far each corner of each piece lies outside each edge: (edge, piece, corner).
        outside = np.einsum("ex,pcx->epc", normals, pieces)
        outside -= np.sum(normals * corners, axis=1)[:, None, None]
        separated[k] = (outside.min(axis=2) >= -tolerance).any(axis=0)
    return np.argwhere(np.triu(~(separated | separated.T), k=1))

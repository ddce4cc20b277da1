"""The surface of a solid as the painter needs it: small triangles, and which edges are drawn."""

import numpy as np
from numpy.typing import NDArray

from simulearn.simulate import Skin

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

CREASE = np.cos(np.radians(25.0))  # of the angle between faces from which their edge is drawn
MOST_PIECES = 60  # along an edge


def solid(vertices: Array, faces: Indices, size: float) -> Skin:
    """Return a surface cut into triangles about as large as the quadrilaterals of beams.

    Args:
        vertices: (V, 3) mm.
        faces: (T, 3) vertex indices, seen from outside counter-clockwise.
        size: longest edge of the triangles, mm.
    """
    drawn = _creases(vertices, faces)
    corners = vertices[faces]
    longest = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2).max(axis=1)
    pieces = np.clip(np.ceil(longest / size), 1, MOST_PIECES).astype(int)
    triangles, edges = [], []
    for count in np.unique(pieces).tolist():
        mine = pieces == count
        shares = _cut(count)
        triangles.append(np.einsum("scw,twx->tscx", shares, corners[mine]).reshape(-1, 3, 3))
        # An edge from corner k to k + 1 is part of the triangle's own where both ends have no
        # share of the corner k + 2.
        ends = np.stack([shares, np.roll(shares, -1, axis=1)])
        rim = (ends == 0).all(axis=0)  # (S, edge, corner without a share)
        own = np.stack([rim[:, :, (k + 2) % 3] for k in range(3)], axis=-1)  # (S, edge, own edge)
        edges.append(np.einsum("sek,tk->tse", own, drawn[mine]).reshape(-1, 3))
    points = np.concatenate(triangles).reshape(1, -1, 3)
    sharp = np.concatenate(edges)
    count = len(sharp)
    a, b, c = np.arange(3 * count).reshape(-1, 3).T
    return Skin(
        vertices=points,
        quads=np.stack([a, b, c, c], axis=1),
        ratio=np.zeros(count),
        joint=np.full(count, -1),
        sharp=np.stack([*sharp.T[:2], np.zeros(count, bool), sharp[:, 2]], axis=1),
    )


def _cut(count: int) -> Array:
    """Return the corners (S, 3, 3) of a triangle cut into count squared, in shares of its own."""
    found: list[list[tuple[int, int]]] = []
    for i, j in np.ndindex(count, count):
        if i + j < count:
            found.append([(i, j), (i + 1, j), (i, j + 1)])
        if i + j < count - 1:
            found.append([(i + 1, j), (i + 1, j + 1), (i, j + 1)])
    steps = np.array(found)
    return np.concatenate([count - steps.sum(axis=2, keepdims=True), steps], axis=2) / count


def _creases(vertices: Array, faces: Indices) -> NDArray[np.bool_]:
    """Return which edges (T, 3) from corner k to k + 1 are drawn: creases, and open ones."""
    # Corners at one place are one, whether or not the file says so.
    _, number = np.unique(np.round(vertices, 6), axis=0, return_inverse=True)
    index = number.reshape(-1)[faces]
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    ends = np.sort(np.stack([index, np.roll(index, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    _, edge, many = np.unique(ends, axis=0, return_inverse=True, return_counts=True)
    edge = edge.reshape(-1)
    total = np.zeros((len(many), 3))
    np.add.at(total, edge, np.repeat(normals, 3, axis=0))
    # Of two unit normals the sum is 2 cos(half their angle) long.
    smooth = (many == 2) & ((total**2).sum(axis=1) > 2 + 2 * CREASE)
    return ~smooth[edge].reshape(-1, 3)

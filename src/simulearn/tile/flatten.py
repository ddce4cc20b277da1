"""The flat layout of a patch: as near to isometric as the patch allows.

A beam is as long as the arc between its ends; the diagonals of the cells keep them from shearing.
The layout is the least-squares answer to all these lengths.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from simulearn.grid import Grid

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

DIAGONAL = 0.3  # weight of a diagonal; a beam's is 1


def arcs(points: Array, normals: Array, pairs: Indices) -> Array:
    """Return the lengths (..., B) mm of circular arcs between points.

    Args:
        points: (..., K, 3) mm.
        normals: (..., K, 3) unit, of the surface there.
        pairs: (B, 2) ends.
    """
    chord = np.linalg.norm(points[..., pairs[:, 1], :] - points[..., pairs[:, 0], :], axis=-1)
    half = np.abs(turns(points, normals, pairs)) / 2
    longer: Array = chord * half / np.where(half < 1e-9, 1.0, np.sin(half))
    return np.where(half < 1e-9, chord, longer)


def turns(points: Array, normals: Array, pairs: Indices) -> Array:
    """Return by how much (..., B) rad a surface turns from end to end along beams.

    It is positive where the ends bend towards the normal. Arguments as for `arcs`.
    """
    a, b = points[..., pairs[:, 0], :], points[..., pairs[:, 1], :]
    along = (b - a) / np.linalg.norm(b - a, axis=-1, keepdims=True)
    # On a circle the tangent leaves the chord by half of the turn at either end.
    sines = [(normals[..., pairs[:, k], :] * along).sum(-1) for k in (0, 1)]
    turn: Array = np.arcsin(np.clip(sines[0], -1, 1)) - np.arcsin(np.clip(sines[1], -1, 1))
    return turn


def frame(points: Array, normals: Array, grid: Grid) -> Array:
    """Return the axes (3, 3; rows) of a patch at its fixed joint: z the normal, x along the grid.

    Args:
        points: (K, 3) mm.
        normals: (K, 3).
        grid: the lattice whose joints they are.
    """
    z, k = normals[grid.fixed], grid.fixed
    ends = grid.joints - grid.joints[k]
    steps = (points - points[k]) * np.sign(ends[:, :1]) * (ends[:, 1:] == 0)
    x = steps.sum(axis=0)
    x = x - (x @ z) * z
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z])


def flattened(points: Array, normals: Array, grid: Grid) -> Array:
    """Return the flat layout (K, 2) mm of a patch, its fixed joint at the origin.

    Args:
        points: (K, 3) mm.
        normals: (K, 3) unit.
        grid: the lattice whose joints they are.
    """
    diagonals = _diagonals(grid)
    pairs = np.concatenate([grid.beams, diagonals])
    wanted = arcs(points, normals, pairs)
    weights = np.r_[np.ones(len(grid.beams)), np.full(len(diagonals), DIAGONAL)]
    axes = frame(points, normals, grid)
    start = (points - points[grid.fixed]) @ axes[:2].T

    def away(x: Array) -> Array:
        flat = x.reshape(-1, 2)
        lengths = np.linalg.norm(flat[pairs[:, 1]] - flat[pairs[:, 0]], axis=1)
        return np.append(weights * (lengths - wanted), flat[grid.fixed])

    flat: Array = least_squares(away, start.ravel(), method="trf").x.reshape(-1, 2)
    flat = flat - flat[grid.fixed]
    # Turned so that it lies over its projection.
    c = np.sum(flat * start)
    s = np.sum(flat[:, 0] * start[:, 1] - flat[:, 1] * start[:, 0])
    turn = np.array([[c, -s], [s, c]]) / max(np.hypot(c, s), 1e-300)
    return flat @ turn.T


def _diagonals(grid: Grid) -> Indices:
    """Return the pairs of joints (D, 2) across the cells of a lattice."""
    places = {
        tuple(p): k for k, p in enumerate(np.round(grid.joints / _step(grid)).astype(int).tolist())
    }
    pairs = [
        (k, places[i + 1, j + step])
        for (i, j), k in places.items()
        for step in (1, -1)
        if (i + 1, j + step) in places
    ]
    return np.array(pairs)


def _step(grid: Grid) -> float:
    a, b = grid.joints[grid.beams[0]]
    return float(np.linalg.norm(b - a))

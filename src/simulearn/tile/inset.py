"""Room for the beams of neighbours: joints of a module's rim moved inwards, along the surface.

Two modules both have beams on their common border. With joints moved inwards by half the width of a
beam the outer faces of these beams lie on the border, side by side.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from simulearn.tile.patches import Tiling

Array = NDArray[np.float64]

SHARPEST = 0.9  # cosine of the angle at a corner; a sharper one is taken for this


def with_inset(tiling: Tiling, distance: float) -> Tiling:
    """Return a tiling whose modules keep a distance (mm) from the borders of their patches."""
    if distance == 0:
        return replace(tiling, inset=0.0, tilt=0.0)
    nx, ny = tiling.cells
    shape = (-1, ny + 1, nx + 1, 3)
    points = tiling.points[tiling.modules].reshape(shape)
    normals = tiling.normals[tiling.modules].reshape(shape)
    along = [np.gradient(points, axis=axis) for axis in (2, 1)]
    # Across the borders, in the surface: from those at the beginning of x and of y inwards.
    across = [_unit(np.cross(along[1], normals)), _unit(np.cross(normals, along[0]))]
    across = [
        a * np.sign((a * b).sum(-1, keepdims=True)) for a, b in zip(across, along, strict=True)
    ]
    inwards = np.zeros((2, ny + 1, nx + 1))
    inwards[0, :, 0], inwards[0, :, -1] = 1.0, -1.0
    inwards[1, 0], inwards[1, -1] = 1.0, -1.0
    rim, corner = (inwards != 0).any(axis=0), (inwards != 0).all(axis=0)
    skew = np.clip((across[0] * across[1]).sum(-1), -SHARPEST, SHARPEST) * corner
    shares = [distance * (a - skew * b) / (1 - skew**2) for a, b in (inwards, inwards[::-1])]
    moved = points + sum(s[..., None] * a for s, a in zip(shares, across, strict=True))
    moved = tiling.surface.closest(moved.reshape(-1, 3))[0].reshape(shape)
    steps = np.where(rim[..., None], moved - points, 0.0)
    tilt = _changes(steps, along, [np.gradient(normals, axis=axis) for axis in (2, 1)])
    flat = (*tiling.modules.shape, 3)
    return replace(tiling, inset=steps.reshape(flat), tilt=tilt.reshape(flat))


def _changes(steps: Array, along: list[Array], rates: list[Array]) -> Array:
    """Return the changes (..., 3) of what changes by two rates along two directions, by steps."""
    frame = np.stack(along, axis=-1)
    shares = np.linalg.pinv(frame) @ steps[..., None]
    changes: Array = (np.stack(rates, axis=-1) @ shares)[..., 0]
    return changes


def _unit(vectors: Array) -> Array:
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    unit: Array = vectors / np.maximum(length, 1e-12)
    return unit

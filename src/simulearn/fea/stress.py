"""The stress that a trial reports at its sampling points.

It is what is still locked in, (1 - s) times the printed-in stress, turned with the material, plus
the Cauchy stress of the elastic deformation: frame 0 shows the design, the last what is left.
"""

import numpy as np
from numpy.typing import NDArray

from simulearn.fea.kernels.brick import COLUMN, ROW
from simulearn.fea.solid import Solid

Array = NDArray[np.float64]


def sample_points(solid: Solid) -> NDArray[np.int64]:
    """Return the integration points (B, 4, 4, 8) around the stress samples, among all points."""
    # The bricks of beams follow those of joints.
    return solid.samples + len(solid.weights) * int((solid.parts[:, 0] < 0).sum())


def cauchy_stress(F: Array, P: Array) -> Array:
    """Return the Cauchy stress P F^T / det F (..., 3, 3) of gradients F and stresses P."""
    return P @ F.swapaxes(-1, -2) / np.linalg.det(F)[..., None, None]


def sampled_stress(solid: Solid, released: float, F: Array, cauchy: Array) -> Array:
    """Return the stress (B, 4, 4, 6) MPa at the sampling points.

    Args:
        solid: the solid.
        released: fraction of the residual stress that is released.
        F: (B, 4, 4, 8, 3, 3) elastic deformation gradient at `sample_points`.
        cauchy: (B, 4, 4, 8, 3, 3) MPa, elastic stress there.
    """
    at = sample_points(solid)
    brick = at // len(solid.weights)
    c, s = np.cos(solid.angle)[brick], np.sin(solid.angle)[brick]
    zero, one = np.zeros_like(c), np.ones_like(c)
    frame = np.stack([[c, s, zero], [-s, c, zero], [zero, zero, one]])
    frame = np.moveaxis(frame, (0, 1), (-2, -1))  # rows are the axes of the printing frame
    grown = 1 + released * solid.growth.reshape(-1, 3)[at]
    growth = frame.swapaxes(-1, -2) @ (grown[..., None] * frame)
    total = np.einsum("bsci,bscikl->bsckl", solid.shares, F @ growth)
    left, _, right = np.linalg.svd(total)
    turn = left @ right
    axes = np.einsum("bsckm,bscam->bscak", turn, frame[..., 0, :, :])  # turned printing axes
    printed = solid.stress.reshape(-1, 3)[at[..., 0]]
    locked = (1 - released) * np.einsum("bsca,bscai,bscaj->bscij", printed, axes, axes)
    elastic = np.einsum("bsci,bscikl->bsckl", solid.shares, cauchy)
    return np.asarray((elastic + locked)[..., ROW, COLUMN])

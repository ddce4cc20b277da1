"""The stress that a trial reports at its sampling points, and that of each brick.

It is what is still locked in, (1 - s) times the printed-in stress, turned with the material, plus
the Cauchy stress of the elastic deformation: frame 0 shows the design, the last what is left.
"""

import numpy as np
from numpy.typing import NDArray

from simulearn.fea.kernels import entries
from simulearn.fea.kernels.brick import COLUMN, ROW
from simulearn.fea.kernels.law import ConstitutiveLaw
from simulearn.fea.points import bricks_of
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
    frame, growth = _frames(solid, released, at)
    total = np.einsum("bsci,bscikl->bsckl", solid.shares, F @ growth)
    printed = solid.stress.reshape(-1, 3)[at[..., 0]]
    locked = (1 - released) * _turned(printed, total, frame[..., 0, :, :])
    elastic = np.einsum("bsci,bscikl->bsckl", solid.shares, cauchy)
    return np.asarray((elastic + locked)[..., ROW, COLUMN])


def brick_stress(
    solid: Solid, law: ConstitutiveLaw, u: Array, released: float, softening: float = 1.0
) -> Array:
    """Return the stress (E, 6) MPa of the bricks, the mean over the volume of each.

    Args:
        solid: the solid.
        law: its constitutive law.
        u: (N, 3) mm, displacements of its nodes.
        released: fraction of the residual stress that is released.
        softening: what the elastic energy is divided by.

    Returns:
        components 11 22 33 12 13 23 in global axes.
    """
    bricks = bricks_of(solid)[0]
    _, _, F, P, _ = entries.internal(law, bricks, u, released)
    frame, growth = _frames(solid, released, np.arange(len(F)))
    printed = solid.stress.reshape(-1, 3)
    locked = (1 - released) * _turned(printed, F @ growth, frame)
    stress = cauchy_stress(F, P) / softening + locked
    weights = bricks.volumes / bricks.volumes.sum(axis=1, keepdims=True)
    each = stress[:, ROW, COLUMN].reshape(*weights.shape, 6)
    return np.asarray(np.einsum("eq,eqc->ec", weights, each))


def _frames(solid: Solid, released: float, at: NDArray[np.int64]) -> tuple[Array, Array]:
    """Return at points the printing frames, their axes as rows, and the growth; (..., 3, 3)."""
    brick = at // len(solid.weights)
    c, s = np.cos(solid.angle)[brick], np.sin(solid.angle)[brick]
    zero, one = np.zeros_like(c), np.ones_like(c)
    frame = np.stack([[c, s, zero], [-s, c, zero], [zero, zero, one]])
    frame = np.moveaxis(frame, (0, 1), (-2, -1))
    grown = 1 + released * solid.growth.reshape(-1, 3)[at]
    return frame, frame.swapaxes(-1, -2) @ (grown[..., None] * frame)


def _turned(printed: Array, gradient: Array, frame: Array) -> Array:
    """Return printed-in stresses (..., 3) as tensors, turned with the material."""
    left, _, right = np.linalg.svd(gradient)
    axes = np.einsum("...km,...am->...ak", left @ right, frame)
    return np.einsum("...a,...ai,...aj->...ij", printed, axes, axes)

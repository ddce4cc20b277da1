"""Turning designs to a common direction before a network sees them, and answers back.

A network that has to answer for every direction needs many examples of each. The mean direction
of a grid's beams, but for quarter turns, is known; turned back by it, all grids lie alike,
and an answer turns with its design. Four-fold, since joints have four sides.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from simulearn.dataset import Batch
from simulearn.dataset.augment import turned
from simulearn.learn.common.model import Designs, Frames

Array = NDArray[np.float64]


def direction(flat: Array, beams: NDArray[np.int64]) -> Array:
    """Return the mean direction of the beams of T grids, (T,) rad in (-pi/4, pi/4].

    The mean of exp(4 i angle), each beam weighted with its squared length.

    Args:
        flat: (T, J, 2) mm.
        beams: (B, 2) joint indices.
    """
    axis = flat[:, beams[:, 1]] - flat[:, beams[:, 0]]
    z = axis[..., 0] + 1j * axis[..., 1]
    turns = (z**4 / np.maximum(abs(z), 1e-9) ** 2).sum(axis=1)
    return np.asarray(np.angle(turns) / 4)


def aligned_batch(batch: Batch) -> Batch:
    """Return trials with their beams along x and y, as nearly as may be."""
    return turned(batch, -direction(batch.flat, batch.beams))


def aligned(designs: Designs) -> tuple[Designs, Array]:
    """Return designs with their beams along x and y, and the angles (T,) they were turned back."""
    angle = direction(designs.flat, designs.beams)
    c, s = np.cos(angle), np.sin(angle)
    back = np.stack([np.stack([c, -s], axis=-1), np.stack([s, c], axis=-1)], axis=-2)
    return replace(designs, flat=designs.flat @ back), angle


def turned_back(frames: Frames, angle: Array, first: Array) -> Frames:
    """Return the answer to the designs as they were.

    Args:
        frames: the answer to the aligned designs; without stress.
        angle: (T,) rad, from `aligned`.
        first: (T, J, 8, 3) corners of the flat joints of the designs, in their order.
    """
    c, s = np.cos(angle), np.sin(angle)
    turn = np.zeros((len(angle), 3, 3))  # acts from the right
    turn[:, 0, 0], turn[:, 0, 1], turn[:, 1, 0], turn[:, 1, 1] = c, s, -s, c
    turn[:, 2, 2] = 1

    def forth(x: Array) -> Array:
        return (x.reshape(len(x), -1, 3) @ turn).reshape(x.shape)

    joints = forth(frames.joints)
    # Corners are numbered by their angle, so a turn numbers them anew.
    away = np.linalg.norm(first[:, :, :4, None] - joints[:, 0, :, None, :4], axis=-1)
    order = away.argmin(axis=-1)
    order = np.concatenate([order, order + 4], axis=-1)[:, None, :, :, None]
    joints = np.take_along_axis(joints, order, axis=3)
    return replace(frames, joints=joints, sections=forth(frames.sections))

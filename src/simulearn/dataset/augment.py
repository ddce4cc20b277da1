"""Trials turned about z and mirrored: the same physics in other axes.

Turned corners are numbered anew by the convention of `Result`: those of a joint counter-clockwise
from the smallest angle of the flat grid, those of a beam right and left of its direction.
Variants of a trial keep its number and stay on its side of the split.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from simulearn.dataset.packed import Array, Batch
from simulearn.grid import outline

BINS = 10  # of the full turn, in each of which a trial is turned once (the paper's)

TENSOR = np.array([[0, 3, 4], [3, 1, 5], [4, 5, 2]])  # where a component lies in 11 22 33 12 13 23
VECTOR = (0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2)


def turned(batch: Batch, angle: ArrayLike) -> Batch:
    """Return trials turned about z, counter-clockwise seen from above.

    Args:
        batch: trials of one topology.
        angle: for all, or (T,) one for each, rad.
    """
    angle = np.broadcast_to(np.asarray(angle, np.float64), (len(batch),))
    c, s = np.cos(angle), np.sin(angle)
    turn = np.zeros((len(batch), 3, 3))
    turn[:, 0, 0], turn[:, 0, 1], turn[:, 1, 0], turn[:, 1, 1] = c, -s, s, c
    turn[:, 2, 2] = 1
    return _renumbered(_moved(batch, turn))


def mirrored(batch: Batch) -> Batch:
    """Return trials mirrored in the plane x = 0: right and left of every beam change places."""
    other = _moved(batch, np.tile(np.diag([-1.0, 1.0, 1.0]), (len(batch), 1, 1)))
    swap = [1, 0, 3, 2]
    stress = None if other.stress is None else other.stress[:, :, :, :, swap]
    return _renumbered(replace(other, sections=other.sections[:, :, :, :, swap], stress=stress))


def variants(batch: Batch, seed: int, bins: int = BINS, mirror: bool = True) -> Iterator[Batch]:
    """Yield variants of trials: turned once into each bin of the full turn, mirrored and not.

    Args:
        batch: trials of one topology.
        seed: of the angles within their bins.
        bins: how many parts the full turn has.
        mirror: whether mirror images are among them.
    """
    rng = np.random.default_rng(seed)
    for image in (batch, mirrored(batch)) if mirror else (batch,):
        for k in range(bins):
            yield turned(image, 2 * np.pi / bins * (k + rng.random(len(batch))))


def _moved(batch: Batch, matrix: NDArray[np.float64]) -> Batch:
    """Return trials after an orthogonal map (T, 3, 3), corners in their old order."""

    def points(x: Array) -> Array:
        flat = x.reshape(len(x), -1, 3)
        return (flat @ matrix.transpose(0, 2, 1).astype(x.dtype)).reshape(x.shape)

    stress = batch.stress
    if stress is not None:
        m = matrix.astype(stress.dtype)
        tensor: Any = stress.reshape(len(stress), -1, 6)[..., TENSOR]
        tensor = m[:, None] @ tensor @ m.transpose(0, 2, 1)[:, None]
        stress = np.ascontiguousarray(tensor[..., *VECTOR]).reshape(stress.shape)
    return replace(
        batch,
        flat=batch.flat @ matrix[:, :2, :2].transpose(0, 2, 1),
        joints=points(batch.joints),
        sections=points(batch.sections),
        stress=stress,
    )


def _renumbered(batch: Batch) -> Batch:
    """Return trials with the joints' corners in the order of the convention."""
    section = batch.material.section
    right = np.stack([outline(batch.grid(t), section).joints for t in range(len(batch))])
    here = batch.joints[:, 0, :, :4, :2]
    away = np.linalg.norm(right[:, :, :, None] - here[:, :, None], axis=-1)
    order = away.argmin(axis=-1)  # (T, J, 4)
    order = np.concatenate([order, order + 4], axis=-1)
    return replace(
        batch, joints=np.take_along_axis(batch.joints, order[:, None, :, :, None], axis=3)
    )

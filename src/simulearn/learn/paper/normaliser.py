"""Normalisers: from features to the few numbers of zero mean and unit variance a network likes.

Elements are moved to their own centre, interaction pairs to the centre of their conduit. Each
feature is divided by the 95th percentile of its deviation; principal components that hold 98 % of
the variance are used, those of geometry and of stress apart; each is scaled again. Together these
are one affine map, and the move is another, so for a pair it can be applied to sender, conduit and
receiver apart and then added. Yang et al., SimuLearn, UIST 2020, data normalization.
"""

from collections.abc import Sequence
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import Array
from numpy.typing import NDArray

from simulearn.dataset.features import EDGE_PLAIN, NODE, STRESS

PERCENTILE = 95
FLOOR = 1e-6  # of a deviation; below it a feature is constant (mm, MPa)


class Normaliser(NamedTuple):
    """An affine map from features (N) to components (K).

    Attributes:
        matrix: (N, K).
        offset: (K,).
        shift: (3, K) what moving everything by 1 mm along x, y, z adds.
    """

    matrix: Array
    offset: Array
    shift: Array

    @property
    def size(self) -> int:
        """How many components there are."""
        return int(self.offset.shape[0])

    def element(self, x: Array, centre: Array) -> Array:
        """Return the components (..., K) of elements (..., N), relative to centres (..., 3)."""
        return x @ self.matrix + self.offset - centre @ self.shift


def placed(length: int) -> NDArray[np.float64]:
    """Return (3, N): what moving an element by 1 mm along x, y and z adds to its features."""
    points = 1 + (24 if length == NODE else 36) // 3  # its centre and its corners
    block = np.zeros((3, length))
    block[:, : 3 * points] = np.tile(np.eye(3), points)
    return block


def is_stress(length: int) -> NDArray[np.bool_]:
    """Return which features (N,) of an element are stresses."""
    stress = np.zeros(length, bool)
    if length > EDGE_PLAIN:
        stress[STRESS] = True
    return stress


def fit(x: NDArray[np.floating], lengths: tuple[int, ...], variance: Sequence[float]) -> Normaliser:
    """Fit a normaliser.

    Args:
        x: (M, N) examples, already moved; an element, or sender, conduit and receiver.
        lengths: how many features each of the elements has.
        variance: the part of it that the components hold, of geometry and of stress.
    """
    x = np.asarray(x, np.float64)
    mean = x.mean(axis=0)
    reach = np.percentile(abs(x - mean), PERCENTILE, axis=0)
    # What hardly ever differs (one joint in nine is fixed) is scaled by its standard deviation.
    reach = np.where(reach > FLOOR, reach, x.std(axis=0))
    alive = reach > FLOOR
    scale = np.where(alive, 1 / np.where(alive, reach, 1), 0.0)
    stress = np.concatenate([is_stress(n) for n in lengths])
    columns = []
    for group, least in zip((~stress, stress), variance, strict=True):
        if not group.any():
            continue
        values, vectors = np.linalg.eigh(np.cov(((x - mean) * scale)[:, group].T))
        values, vectors = values[::-1].clip(0), vectors[:, ::-1]
        held = np.cumsum(values) / values.sum()
        count = 1 + int(np.searchsorted(held, least))
        count = min(count, int((values > 1e-12 * values[0]).sum()))
        block = np.zeros((len(scale), count))
        block[group] = vectors[:, :count] / np.sqrt(values[:count])
        columns.append(block)
    matrix = scale[:, None] * np.concatenate(columns, axis=1)
    shift = np.concatenate([placed(n) for n in lengths], axis=1) @ matrix
    return Normaliser(*(jnp.asarray(a, jnp.float32) for a in (matrix, -mean @ matrix, shift)))

"""Signs by which a model knows how far off an answer may be.

What it corrected, how much the beams are strained, how far the grid sags, its size, material and
actuators, how it hangs together, and how unlike those of the training its beams and joints are.
"""

from collections.abc import Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulearn.learn.common.model import Designs
from simulearn.learn.equilibrium.parameters import Prediction
from simulearn.mechanics.properties import DEVIATIONS, properties_of, signs_of, stacked

Numbers = NDArray[np.float64]


class Seen(NamedTuple):
    """What half-beams of the training are like.

    Attributes:
        usual: (D,) mean of what is seen of them; see `Prediction.seen`.
        spread: (D, D) that whitens their difference from it.
    """

    usual: Numbers
    spread: Numbers


def seen_of(halves: Sequence[Numbers]) -> Seen:
    """Return what half-beams, arrays (..., D), are like."""
    rows = np.concatenate([x.reshape(-1, x.shape[-1]) for x in halves])
    usual = rows.mean(axis=0)
    values, vectors = np.linalg.eigh(np.cov((rows - usual).T) + 1e-6 * np.eye(rows.shape[1]))
    return Seen(usual, vectors / np.sqrt(np.maximum(values, 1e-3)))


def signs_of_error(designs: Designs, prediction: Prediction, seen: Seen) -> Numbers:
    """Return what the estimate goes by: (T, K), the first 1.

    Args:
        designs: T of them.
        prediction: of the model.
        seen: what half-beams of the training are like.
    """
    size = np.log(designs.dimensions / 90)
    apart = _log(prediction.apart)
    count = np.log(len(designs.beams) / 12)
    far = ((np.asarray(prediction.seen) - seen.usual) @ seen.spread) ** 2  # (T, 2 B, D)
    unlike = np.log(1e-2 + far.mean(axis=(1, 2)))
    most = np.log(1e-2 + far.mean(axis=2).max(axis=1))
    materials = designs.materials or (designs.material,)
    p = stacked([properties_of(m) for m in materials])
    of_material = np.delete(np.abs(signs_of(p, np)), MESH, axis=0)
    hangs = structure_of(designs)
    mean_actuator = np.abs(np.mean(designs.actuators, axis=1))
    rows = [
        1.0, apart, apart**2, _log(prediction.strain), _log(prediction.sag), size,
        count, hangs.free, hangs.loops / len(designs.beams), hangs.depth, mean_actuator, unlike,
        most, np.abs(p.strain - 1), *of_material,
    ]  # fmt: skip
    signs = np.empty((len(designs), SIGNS))
    for k, row in enumerate(rows):
        signs[:, k] = row
    return signs


MESH = 5  # which of a material's signs is the mesh
SIGNS = 14 + DEVIATIONS + 1  # those of the design, and of the material without the mesh


class Structure(NamedTuple):
    """How a grid hangs together.

    Attributes:
        loops: how many beams could be taken out before it falls into parts.
        free: joints with one beam, over the number of beams.
        depth: logarithm of the mean number of beams between a joint and the fixed one.
    """

    loops: int
    free: float
    depth: float


def structure_of(designs: Designs) -> Structure:
    """Return how grids of one topology hang together."""
    pairs = np.asarray(designs.beams, np.int64)
    return _structure(pairs.tobytes(), designs.flat.shape[1], designs.fixed)


@lru_cache(256)
def _structure(pairs: bytes, joints: int, fixed: int) -> Structure:
    beams = np.frombuffer(pairs, np.int64).reshape(-1, 2)
    far = np.full(joints, joints)
    far[fixed] = 0
    for _ in range(joints):  # neighbours are one beam further
        before = far.copy()
        np.minimum.at(far, beams[:, 0], before[beams[:, 1]] + 1)
        np.minimum.at(far, beams[:, 1], before[beams[:, 0]] + 1)
        if (far == before).all():
            break
    ends = (np.bincount(beams.ravel(), minlength=joints) == 1).sum()
    depth = np.log(max(far.sum() / max(joints - 1, 1), 1.0))
    return Structure(len(beams) - joints + 1, float(ends / len(beams)), float(depth))


def _log(x: Any) -> Numbers:
    return np.log(np.maximum(np.asarray(x), 1e-3))

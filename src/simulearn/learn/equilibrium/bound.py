"""How far off an answer may be: an estimate in mm that nine designs of ten stay below.

It goes by what the model knows of its own answer: how much the network had to correct, how much the
beams are strained, how far the grid sags, its size, its material, how many of its beams end freely
or close a loop, and how unlike those of the training its beams and joints are. The logarithm of the
error's quantile is a linear function of these signs, fitted to trials that the model did not learn
from. It is then moved so far that the required part of all designs is below with some confidence (a
tolerance limit), counting how these trials differ from what weights fitted to all other kinds of
grids say of each kind: kinds differ by more than chance, and a new one shall be covered, too.

R. Koenker, G. Bassett, Regression quantiles, Econometrica 46, 1978; Y. Romano, E. Patterson,
E. Candes, Conformalized quantile regression, NeurIPS 2019; S. S. Wilks, Determination of sample
sizes for setting tolerance limits, Annals of Mathematical Statistics 12, 1941.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.learn.common.model import Designs
from simulearn.learn.equilibrium.learnt import Learnt
from simulearn.learn.equilibrium.parameters import Prediction
from simulearn.mechanics.properties import DEVIATIONS, properties_of, signs_of, stacked

if TYPE_CHECKING:  # answering needs none of it
    from simulearn.dataset import Batch

PART = 0.9  # of the designs that stay below
SURE = 0.95  # confidence that so many do, as far as the number of trials is concerned
OUTSIDE = 2.0  # by how much the logarithm grows per width of a training range beyond it
RIDGE = 1e-3  # keeps weights small that the trials do not determine
MOST = 3.0  # standard deviations of a sign beyond its mean that still count

Numbers = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ErrorBound:
    """An error estimate.

    Attributes:
        weights: (K,) of the signs of error.
        limits: (2, K) least and most of each sign that counts.
        ranges: (2, 2) least and most grid dimension and beam length of the training, in
            thicknesses.
        usual: (D,) mean of what is seen of half-beams in the training.
        spread: (D, D) that whitens their difference from it.
    """

    weights: Numbers
    limits: Numbers
    ranges: Numbers
    usual: Numbers
    spread: Numbers

    def to_arrays(self) -> dict[str, Numbers]:
        """Return the arrays by name."""
        return dict(vars(self))

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, NDArray[Any]]) -> "ErrorBound":
        """Return the estimate of a bundle.

        Raises:
            InputError: an array is missing.
        """
        for field in fields(cls):
            if field.name not in arrays:
                raise InputError(f"weight trust.{field.name} is missing")
        if len(arrays["weights"]) != SIGNS:
            raise InputError(
                f"trust.weights are {len(arrays['weights'])} numbers and not {SIGNS}: the error "
                "estimate is of another version; train the model again"
            )
        return cls(*(np.asarray(arrays[field.name], np.float64) for field in fields(cls)))

    def bound(self, designs: Designs, prediction: Prediction, learnt: Learnt) -> Numbers:
        """Return the mean vertex error of the last frame that nine of ten stay below: (T,) mm."""
        signs = signs_of_error(designs, prediction, self.usual, self.spread)
        log = np.clip(signs, *self.limits) @ self.weights
        log += OUTSIDE * (beyond(designs, self.ranges) + _material_beyond(designs, learnt))
        return np.exp(log)


def signs_of_error(
    designs: Designs, prediction: Prediction, usual: Numbers, spread: Numbers
) -> Numbers:
    """Return what the estimate goes by: (T, K), the first 1.

    Args:
        designs: T of them.
        prediction: of the model.
        usual: (D,) see `ErrorBound`.
        spread: (D, D).
    """
    size = np.log(designs.dimensions / 90)
    apart = _log(prediction.apart)
    count = np.full(len(designs), np.log(len(designs.beams) / 12))
    far = ((np.asarray(prediction.seen) - usual) @ spread) ** 2  # (T, 2 B, D)
    unlike = np.log(1e-2 + far.mean(axis=(1, 2)))
    most = np.log(1e-2 + far.mean(axis=2).max(axis=1))
    materials = designs.materials or (designs.material,)
    p = stacked([properties_of(m) for m in materials])
    of_material = np.delete(np.abs(signs_of(p, np)), MESH, axis=0)
    beams, joints = len(designs.beams), designs.flat.shape[1]
    free = float((np.bincount(designs.beams.ravel(), minlength=joints) == 1).sum() / beams)
    loops = (beams - joints + 1) / beams
    rows = [
        np.ones_like(size), apart, apart**2, _log(prediction.strain), _log(prediction.sag), size,
        count, free, loops, unlike, most, np.abs(p.strain - 1), *of_material,
    ]  # fmt: skip
    return np.stack([np.broadcast_to(row, size.shape) for row in rows], axis=1)


MESH = 5  # which of a material's signs is the mesh
SIGNS = 12 + DEVIATIONS + 1  # those of the design, and of the material without the mesh


def _log(x: Any) -> Numbers:
    return np.log(np.maximum(np.asarray(x), 1e-3))


def fitted_weights(signs: Numbers, error: Numbers, part: float = PART) -> Numbers:
    """Return the weights (K,) with which a part of the errors (T,) lies below exp(signs weights).

    The least pinball loss, as a linear programme, with a small price on each weight's size.
    """
    from scipy.optimize import linprog

    count, many = signs.shape
    log = np.log(np.maximum(error, 1e-6))
    price = RIDGE * count * np.r_[0.0, signs[:, 1:].std(axis=0)]
    # Weights above and below zero, then what is missed above and below.
    cost = np.concatenate([price, price, np.full(count, part), np.full(count, 1 - part)])
    equal = np.hstack([signs, -signs, np.eye(count), -np.eye(count)])
    found = linprog(cost, A_eq=equal, b_eq=log, bounds=(0, None), method="highs").x
    return np.asarray(found[:many] - found[many : 2 * many])


def error_bound_of(
    signs: Numbers,
    error: Numbers,
    kinds: NDArray[Any],
    counted: NDArray[np.bool_],
    seen: tuple[Numbers, Numbers],
    learnt: "Sequence[Batch]",
) -> ErrorBound:
    """Return the estimate for a model.

    Args:
        signs: (T, K) of trials that the model did not learn from, the first sign 1.
        error: (T,) of the model's answers to them, mm.
        kinds: (T,) the kind of grid of each.
        counted: (T,) whether a trial counts for the coverage, or only for the weights.
        seen: usual (D,) and spread (D, D) of half-beams; see `seen_of`.
        learnt: the trials it learnt from.
    """
    from scipy.stats import binom

    from simulearn.dataset.statistics import beam_lengths

    middle, width = signs.mean(axis=0), signs.std(axis=0)
    limits = np.stack([middle - MOST * width, middle + MOST * width])
    clipped, log = np.clip(signs, *limits), np.log(np.maximum(error, 1e-6))
    weights = fitted_weights(clipped, error)
    left = []
    for kind in np.unique(kinds[counted]):
        others, mine = kinds != kind, (kinds == kind) & counted
        left.append(log[mine] - clipped[mine] @ fitted_weights(clipped[others], error[others]))
    above = np.sort(np.concatenate(left))
    # The least of them that the required part of all designs is below, as sure as is wanted.
    weights[0] += above[min(int(binom.ppf(SURE, len(above), PART)), len(above) - 1)]
    thick = np.concatenate([_thickness(b) for b in learnt])
    size = np.concatenate([b.dimensions for b in learnt]) / thick
    length = np.concatenate([(beam_lengths(b) / _thickness(b)[:, None]).ravel() for b in learnt])
    ranges = [[x.min() for x in (size, length)], [x.max() for x in (size, length)]]
    return ErrorBound(weights, limits, np.array(ranges, np.float64), *seen)


def seen_of(halves: Sequence[Numbers]) -> tuple[Numbers, Numbers]:
    """Return the mean (D,) of what is seen of half-beams, and what whitens the difference from it.

    Args:
        halves: arrays (..., D).
    """
    rows = np.concatenate([x.reshape(-1, x.shape[-1]) for x in halves])
    usual = rows.mean(axis=0)
    values, vectors = np.linalg.eigh(np.cov((rows - usual).T) + 1e-6 * np.eye(rows.shape[1]))
    return usual, vectors / np.sqrt(np.maximum(values, 1e-3))


def _thickness(batch: "Batch") -> Numbers:
    materials = batch.materials or (batch.material,) * len(batch)
    return np.array([material.section.thickness for material in materials])


def beyond(designs: Designs, ranges: Numbers) -> Numbers:
    """Return how far designs (T,) are outside the training ranges, in widths of the ranges.

    Args:
        designs: T of them.
        ranges: (2, 2) least and most of dimension and beam length, in thicknesses.
    """
    ends = designs.flat[:, designs.beams]
    materials = designs.materials or (designs.material,)
    thick = np.array([material.section.thickness for material in materials])
    length = np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=-1) / thick[:, None]
    size = designs.dimensions / thick
    far = np.zeros(len(designs))
    for (least, most), low, high in (
        (ranges[:, 0], size, size),
        (ranges[:, 1], length.min(axis=1), length.max(axis=1)),
    ):
        far += (np.maximum(least - low, 0) + np.maximum(high - most, 0)) / (most - least)
    return far


def _material_beyond(designs: Designs, learnt: Learnt) -> Numbers:
    """Return how far the materials (T,) are outside what was learnt, in widths of the ranges."""
    materials = designs.materials or (designs.material,)
    far = [sum(min(v[3], 10.0) for v in learnt.beyond(m).values()) for m in materials]
    return np.broadcast_to(np.array(far, np.float64), (len(designs),))

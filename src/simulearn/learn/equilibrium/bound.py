"""How far off an answer may be: an estimate in mm that nine designs of ten stay below.

It goes by what the model knows of its own answer: how much the network had to correct, how much
the beams are strained, how far the grid sags, and its size; by linear quantile regression of
the logarithm on trials that the model did not learn from. It grows outside the ranges of the
training.

R. Koenker, G. Bassett, Regression quantiles, Econometrica 46, 1978; Y. Romano, E. Patterson,
E. Candes, Conformalized quantile regression, NeurIPS 2019.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.learn.common.model import Designs
from simulearn.learn.equilibrium.parameters import Prediction

if TYPE_CHECKING:  # answering needs none of it
    from simulearn.dataset import Batch

PART = 0.9  # of the designs that stay below
OUTSIDE = 2.0  # by how much the logarithm grows per width of the training range beyond it
UNLIKE = 2.5  # times as much for other topologies, see docs/models/equilibrium.md

Numbers = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ErrorBound:
    """An error estimate.

    Attributes:
        weights: (K,) of the signs of error.
        ranges: (2, 2) least and most grid dimension and beam length of the training, mm.
        counts: (2,) how many joints and beams its grids had.
    """

    weights: Numbers
    ranges: Numbers
    counts: Numbers

    def to_arrays(self) -> dict[str, Numbers]:
        """Return the arrays by name."""
        return dict(vars(self))

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, NDArray[Any]]) -> "ErrorBound":
        """Return the estimate of a bundle.

        Raises:
            InputError: an array is missing.
        """
        for name in ("weights", "ranges", "counts"):
            if name not in arrays:
                raise InputError(f"weight trust.{name} is missing")
        return cls(*(np.asarray(arrays[n], np.float64) for n in ("weights", "ranges", "counts")))

    def bound(self, designs: Designs, prediction: Prediction) -> Numbers:
        """Return the mean vertex error of the last frame that nine of ten stay below: (T,) mm."""
        log = signs(designs, prediction) @ self.weights + OUTSIDE * beyond(designs, self.ranges)
        here = (designs.flat.shape[1], len(designs.beams))
        return np.exp(log) * (1.0 if here == tuple(self.counts) else UNLIKE)


def _log(x: Any) -> Numbers:
    return np.log(np.maximum(np.asarray(x), 1e-3))


def signs(designs: Designs, prediction: Prediction) -> Numbers:
    """Return what the estimate goes by: (T, 6)."""
    apart, size = _log(prediction.apart), np.log(designs.dimensions / 90)
    rows = [
        np.ones_like(size),
        apart,
        apart**2,
        _log(prediction.strain),
        _log(prediction.sag),
        size,
    ]
    return np.stack(rows, axis=1)


def error_bound_of(signs: Numbers, error: Numbers, learnt: "Sequence[Batch]") -> ErrorBound:
    """Return the estimate for a model.

    Args:
        signs: (T, K) of trials that the model did not learn from, the first sign 1.
        error: (T,) of the model's answers to them, mm.
        learnt: the trials it learnt from.
    """
    from scipy.optimize import linprog

    from simulearn.dataset.statistics import beam_lengths

    count, many = signs.shape
    log = np.log(np.maximum(error, 1e-6))
    # Pinball loss as a linear programme: coefficients, then what is missed above and below.
    cost = np.concatenate([np.zeros(many), np.full(count, PART), np.full(count, 1 - PART)])
    equal = np.hstack([signs, np.eye(count), -np.eye(count)])
    bounds = [(None, None)] * many + [(0, None)] * (2 * count)
    weights = linprog(cost, A_eq=equal, b_eq=log, bounds=bounds, method="highs").x[:many]
    # As many below as required, counting the next trial to come.
    weights[0] += np.quantile(log - signs @ weights, min(1.0, PART * (count + 1) / count))
    size = np.concatenate([b.dimensions for b in learnt])
    length = np.concatenate([beam_lengths(b).ravel() for b in learnt])
    ranges = [[x.min(), x.max()] for x in (size, length)]
    counts = (learnt[0].flat.shape[1], len(learnt[0].beams))
    return ErrorBound(weights, np.array(ranges, np.float64), np.array(counts, np.float64))


def beyond(designs: Designs, ranges: Numbers) -> Numbers:
    """Return how far designs (T,) are outside the training ranges, in widths of the ranges."""
    ends = designs.flat[:, designs.beams]
    length = np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=-1)
    size = designs.dimensions
    far = np.zeros(len(designs))
    for (least, most), low, high in (
        (ranges[0], size, size),
        (ranges[1], length.min(axis=1), length.max(axis=1)),
    ):
        far += (np.maximum(least - low, 0) + np.maximum(high - most, 0)) / (most - least)
    return far

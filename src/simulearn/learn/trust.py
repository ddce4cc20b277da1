"""How far off an answer may be: an estimate in mm that nine designs of ten stay below.

It goes by what the model knows of its own answer: how much the network had to correct, how much
the beams are strained, how far the grid sags, and its size; by linear quantile regression of
the logarithm on trials that the model has not seen. Outside the ranges of the training it grows.

R. Koenker, G. Bassett, Regression quantiles, Econometrica 46, 1978; Y. Romano, E. Patterson,
E. Candes, Conformalized quantile regression, NeurIPS 2019.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from simulearn.learn.model import Designs
from simulearn.learn.shapes import Shapes

if TYPE_CHECKING:  # answering needs none of it
    from simulearn.dataset import Batch

PART = 0.9  # of the designs that stay below
OUTSIDE = 2.0  # by how much the logarithm grows per width of the training range beyond it
UNLIKE = 2.5  # times as much for other topologies, see docs/models/equilibrium.md

Numbers = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Trust:
    """An error estimate.

    Attributes:
        weights: (K,) of the signs of error.
        ranges: (2, 2) least and most grid dimension and beam length of the training, mm.
        counts: (2,) how many joints and beams its grids had.
    """

    weights: Numbers
    ranges: Numbers
    counts: Numbers

    def bound(self, designs: Designs, told: Shapes) -> Numbers:
        """Return the mean vertex error of the last frame that nine of ten stay below: (T,) mm."""
        log = signs(designs, told) @ self.weights + OUTSIDE * beyond(designs, self.ranges)
        here = (designs.flat.shape[1], len(designs.beams))
        return np.exp(log) * (1.0 if here == tuple(self.counts) else UNLIKE)


def signs(designs: Designs, told: Shapes) -> Numbers:
    """Return what the estimate goes by: (T, 6)."""
    log = lambda x: np.log(np.maximum(np.asarray(x), 1e-3))  # noqa: E731
    apart, size = log(told.apart), np.log(designs.dimensions / 90)
    rows = [np.ones_like(size), apart, apart**2, log(told.strain), log(told.sag), size]
    return np.stack(rows, axis=1)


def trust_of(signs: Numbers, error: Numbers, learnt: "Sequence[Batch]") -> Trust:
    """Return the estimate for a model.

    Args:
        signs: (T, K) of trials that the model has not seen, the first of them 1.
        error: (T,) of the model's answers to them, mm.
        learnt: what it has seen.
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
    # As many below as asked for, counting the next trial to come.
    weights[0] += np.quantile(log - signs @ weights, min(1.0, PART * (count + 1) / count))
    size = np.concatenate([b.dimensions for b in learnt])
    length = np.concatenate([beam_lengths(b).ravel() for b in learnt])
    ranges = [[x.min(), x.max()] for x in (size, length)]
    counts = (learnt[0].flat.shape[1], len(learnt[0].beams))
    return Trust(weights, np.array(ranges, np.float64), np.array(counts, np.float64))


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

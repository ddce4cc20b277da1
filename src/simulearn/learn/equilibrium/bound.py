"""How far off an answer may be: an estimate in mm that nine designs of ten stay below.

The logarithm of the error has a mean and a spread that are linear in signs of difficulty (see
`signs`), and a margin for trees, for single rings and for all other grids. The estimate grows
outside the ranges of the training. How it is fitted: see `bound_fit`.
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.learn.common.model import Designs
from simulearn.learn.equilibrium.learnt import Learnt
from simulearn.learn.equilibrium.parameters import Prediction
from simulearn.learn.equilibrium.signs import SIGNS, Numbers, Seen, signs_of_error, structure_of

CLASSES = 3  # of grids; see `class_of`
AGAIN = ": the error estimate is of another version; train the model again"
OUTSIDE = 2.0  # by how much the logarithm grows per width of a training range beyond it


class ErrorQuantile(NamedTuple):
    """What nine of ten errors stay below, by their signs.

    Attributes:
        weights: (K,) of the signs, for the mean of the logarithm of the error.
        spreads: (K,) the same for the logarithm of its spread.
        margins: (CLASSES,) spreads above the mean; see `class_of`.
        limits: (2, K) least and most of each sign that counts.
    """

    weights: Numbers
    spreads: Numbers
    margins: Numbers
    limits: Numbers

    def of(self, signs: Numbers, classes: int | NDArray[np.int64]) -> Numbers:
        """Return it for signs (T, K) of grids of a class each, mm."""
        x = np.clip(signs, *self.limits)
        return np.exp(x @ self.weights + self.margins[classes] * np.exp(x @ self.spreads))


@dataclass(frozen=True, eq=False)
class ErrorBound:
    """An error estimate.

    Attributes:
        weights, spreads, margins, limits: see `ErrorQuantile`.
        ranges: (2, 2) least and most grid dimension and beam length of the training, in
            thicknesses.
        usual, spread: of half-beams of the training; see `Seen`.
    """

    weights: Numbers
    spreads: Numbers
    margins: Numbers
    limits: Numbers
    ranges: Numbers
    usual: Numbers
    spread: Numbers

    @property
    def seen(self) -> Seen:
        """What half-beams of the training are like."""
        return Seen(self.usual, self.spread)

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
                raise InputError(f"weight trust.{field.name} is missing{AGAIN}")
        if len(arrays["weights"]) != SIGNS:
            raise InputError(
                f"trust.weights are {len(arrays['weights'])} numbers and not {SIGNS}{AGAIN}"
            )
        return cls(*(np.asarray(arrays[field.name], np.float64) for field in fields(cls)))

    def bound(self, designs: Designs, prediction: Prediction, learnt: Learnt) -> Numbers:
        """Return the mean vertex error of the last frame that nine of ten stay below: (T,) mm."""
        quantile = ErrorQuantile(self.weights, self.spreads, self.margins, self.limits)
        signs = signs_of_error(designs, prediction, self.seen)
        outside = beyond(designs, self.ranges) + _material_beyond(designs, learnt)
        return quantile.of(signs, class_of(designs)) * np.exp(OUTSIDE * outside)


def class_of(designs: Designs) -> int:
    """Return the class of grids of one topology: 0 trees, 1 single rings, 2 all others."""
    return min(structure_of(designs).loops, CLASSES - 1)


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

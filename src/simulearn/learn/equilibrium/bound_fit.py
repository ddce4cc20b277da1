"""Fitting the error estimate to trials that the model did not learn from.

1. The mean of the logarithm of the error, as a linear function of the signs.
2. How far single errors are from it, likewise: grids of few beams scatter more.
3. How many such distances nine of ten errors stay below, for each class of grids by itself. Trials
   are judged by fits to others for it; those of kinds that the model does not learn, by fits
   without their kind.

H. Papadopoulos et al., Normalized nonconformity measures for regression conformal prediction, 2008;
V. Vovk, Conditional validity of inductive conformal predictors, Machine Learning 92, 2013.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulearn.compiled import double_precision
from simulearn.dataset import Batch
from simulearn.dataset.statistics import beam_lengths
from simulearn.errors import InputError
from simulearn.learn.common.first_frame import designs_of
from simulearn.learn.common.metrics import errors
from simulearn.learn.equilibrium.bound import CLASSES, ErrorBound, ErrorQuantile, class_of
from simulearn.learn.equilibrium.model import Equilibrium
from simulearn.learn.equilibrium.signs import Numbers, Seen, signs_of_error

PART = 0.9  # of the designs that stay below
FOLDS = 10
RIDGE, RIDGE_SPREAD = 10.0, 100.0  # keep weights small that the trials do not determine
LEAST = 0.1  # added to distances before their logarithm
ENOUGH = 20  # trials that a class must have for a margin of its own
LEAST_TRIALS = 8  # in all
MOST = 3.0  # standard deviations of a sign beyond its mean that still count


class JudgedTrials(NamedTuple):
    """Trials that a model did not learn from, T of them, and how far its answers are off.

    Attributes:
        signs: (T, K).
        error: (T,) mean vertex error of the last frame, mm.
        classes: (T,) see `bound.class_of`.
        kinds: (T,) names of their kinds, empty where none is known.
    """

    signs: Numbers
    error: Numbers
    classes: NDArray[np.int64]
    kinds: NDArray[np.str_]


def error_bound_of(
    model: Equilibrium,
    calibration: Sequence[Batch],
    unfamiliar: Sequence[Batch],
    seen: Seen,
    ranges: Numbers,
) -> ErrorBound:
    """Return the error estimate of a model.

    Args:
        model: of any estimate or none.
        calibration: trials that it did not learn from, of kinds that it learns, by the mesh whose
            answers are wanted. Those whose answer snaps, which carries no bound, and those without
            one are left out.
        unfamiliar: the same of kinds that it does not learn.
        seen: what half-beams of the training are like.
        ranges: (2, 2) of the training; see `ErrorBound`.

    Raises:
        InputError: the trials are too few.
    """
    if not calibration:
        raise InputError("all trials of the calibration set are kept for testing")
    trials = judged_trials(model, calibration, seen)
    others = judged_trials(model, unfamiliar, seen) if unfamiliar else None
    return ErrorBound(*quantile_of(trials, others), ranges, *seen)


def quantile_of(trials: JudgedTrials, unfamiliar: JudgedTrials | None) -> ErrorQuantile:
    """Return the quantile that errors show.

    Args:
        trials: of kinds that the model learns.
        unfamiliar: of others, or None.

    Raises:
        InputError: the trials are too few.
    """
    folds = np.arange(len(trials.error)) % FOLDS
    if unfamiliar is not None:
        folds = np.r_[folds, FOLDS + np.unique(unfamiliar.kinds, return_inverse=True)[1]]
        trials = JudgedTrials(*(np.concatenate(x) for x in zip(trials, unfamiliar, strict=True)))
    if len(trials.error) < LEAST_TRIALS:
        raise InputError(
            f"the error estimate is fitted to {len(trials.error)} trials with an answer that does "
            f"not snap; it takes at least {LEAST_TRIALS}"
        )
    return fitted_bound(trials.signs, trials.error, trials.classes, folds)


@double_precision
def judged_trials(model: Equilibrium, batches: Sequence[Batch], seen: Seen) -> JudgedTrials:
    """Return how far a model's answers are off that carry a bound.

    Args:
        model: of any estimate or none.
        batches: trials that it did not learn from.
        seen: what half-beams of the training are like.
    """
    rows: list[tuple[Any, ...]] = []
    for batch in batches:
        designs = designs_of(batch)
        prediction = model.predict(designs)
        frames = model.frames(designs, prediction)
        snaps = frames.snaps or ((),) * len(batch)  # None where they are not known
        answered = frames.converged & ~np.array([bool(x) for x in snaps])
        columns = (
            signs_of_error(designs, prediction, seen),
            errors(frames, batch).vertex[:, -1],
            np.full(len(batch), class_of(designs)),
            np.array(batch.kinds or [""] * len(batch)),
        )
        rows.append(tuple(x[answered] for x in columns))
    return JudgedTrials(*(np.concatenate(x) for x in zip(*rows, strict=True)))


def ranges_of(learnt: Sequence[Batch]) -> Numbers:
    """Return the ranges (2, 2) of trials that a model learnt from; see `ErrorBound`."""
    thick = [
        np.array([m.section.thickness for m in b.materials or (b.material,) * len(b)])
        for b in learnt
    ]
    size = np.concatenate([b.dimensions / t for b, t in zip(learnt, thick, strict=True)])
    length = np.concatenate(
        [(beam_lengths(b) / t[:, None]).ravel() for b, t in zip(learnt, thick, strict=True)]
    )
    return np.array([[x.min() for x in (size, length)], [x.max() for x in (size, length)]])


def fitted_bound(
    signs: Numbers, error: Numbers, classes: NDArray[np.int64], folds: NDArray[np.int64]
) -> ErrorQuantile:
    """Return the quantile that errors show.

    Args:
        signs: (T, K) of trials, the first sign 1.
        error: (T,) of the answers to them, mm.
        classes: (T,) see `bound.class_of`.
        folds: (T,) trials of one number are judged by a fit to all others.
    """
    middle, width = signs.mean(axis=0), signs.std(axis=0)
    limits = np.stack([middle - MOST * width, middle + MOST * width])
    log, x = np.log(np.maximum(error, 1e-6)), np.clip(signs, *limits)
    off = log - _judged(x, log, folds, RIDGE)
    size = np.log(np.abs(off) + LEAST)
    part = off / np.exp(_judged(x, size, folds, RIDGE_SPREAD))
    everywhere = _quantile(part)
    margins = [
        _quantile(part[classes == c]) if (classes == c).sum() >= ENOUGH else everywhere
        for c in range(CLASSES)
    ]
    weights, spreads = _fit(x, log, RIDGE), _fit(x, size, RIDGE_SPREAD)
    return ErrorQuantile(weights, spreads, np.array(margins), limits)


def _judged(x: Numbers, y: Numbers, folds: NDArray[np.int64], ridge: float) -> Numbers:
    """Return what fits to all other folds say of each (T,)."""
    out = np.empty_like(y)
    for fold in np.unique(folds):
        mine = folds == fold
        out[mine] = x[mine] @ _fit(x[~mine], y[~mine], ridge)
    return out


def _fit(x: Numbers, y: Numbers, ridge: float) -> Numbers:
    """Return the weights (K,) of x (T, K), the first 1, that fit y (T,) with a price on size."""
    middle, width = x[:, 1:].mean(axis=0), np.maximum(x[:, 1:].std(axis=0), 1e-9)
    z = (x[:, 1:] - middle) / width
    price = ridge * np.eye(z.shape[1])
    slope = np.linalg.solve(z.T @ z + price, z.T @ (y - y.mean())) / width
    return np.r_[y.mean() - middle @ slope, slope]


def _quantile(values: Numbers) -> float:
    """Return what a further value is below with the probability PART (conformal prediction)."""
    ordered = np.sort(values)
    return float(ordered[min(int(np.ceil(PART * (len(ordered) + 1))), len(ordered)) - 1])

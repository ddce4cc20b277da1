"""Evaluating a model on a data set, by the paper's protocol; the reference is always the set's."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from simulearn.dataset import Batch, Dataset
from simulearn.errors import InputError
from simulearn.learn.common.first_frame import designs_of
from simulearn.learn.common.metrics import Errors, errors, together
from simulearn.learn.common.model import Frames, Model

AT_ONCE = 50  # trials


@dataclass(frozen=True, eq=False)
class Evaluation:
    """Answers to the trials of a data set, and how far they are off.

    Attributes:
        batches: the trials, by topology.
        frames: the predictions, in the same order.
        errors: of all trials, in the order of the batches.
    """

    batches: list[Batch]
    frames: list[Frames]
    errors: Errors

    def trial(self, k: int) -> tuple[Batch, Frames, int]:
        """Return batch, prediction and index within both of the k-th of all trials."""
        for batch, frames in zip(self.batches, self.frames, strict=True):
            if k < len(batch):
                return batch, frames, k
            k -= len(batch)
        raise IndexError(k)

    def example(self, quantile: float) -> int:
        """Return which of all trials has the error of a quantile (0 best, 1 worst)."""
        order = np.argsort(self.errors.percent[:, -1])
        return int(order[round(quantile * (len(order) - 1))])


def for_testing(data: Dataset) -> list[Batch]:
    """Return the trials to evaluate on: those kept for testing, or all if none is to train on."""
    testing = [b.take(b.test) for b in data.batches if b.test.any()]
    if not testing and len(data):
        raise InputError(
            f"{data.config.name}: has no trials kept for testing (test_every is 0); a model is "
            "not judged by what it may have learnt from"
        )
    return testing


def evaluate(
    model: Model,
    batches: Sequence[Batch],
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> Evaluation:
    """Return the predictions of a model to the designs of trials, and their errors.

    Args:
        model: to evaluate.
        batches: the trials; all of them count.
        progress: called with (trials done, trials in all).
    """
    total = sum(map(len, batches))
    parts, predictions, measured, done = [], [], [], 0
    for batch in batches:
        for begin in range(0, len(batch), AT_ONCE):
            part = batch.take(slice(begin, begin + AT_ONCE))
            prediction = model.rollout(designs_of(part))
            parts.append(part)
            predictions.append(prediction)
            measured.append(errors(prediction, part))
            done += len(part)
            progress(done, total)
    return Evaluation(parts, predictions, together(measured))

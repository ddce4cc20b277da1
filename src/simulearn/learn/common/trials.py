"""Which trials of a data set a run learns from, which it is watched by, and its fingerprint."""

import hashlib
import json
from collections.abc import Sequence

import numpy as np

from simulearn.dataset import Batch, Dataset
from simulearn.errors import InputError
from simulearn.learn.common.config import RunConfig
from simulearn.learn.common.first_frame import designs_of
from simulearn.learn.common.metrics import errors, together
from simulearn.learn.common.model import Model


def split(config: RunConfig, data: Dataset) -> tuple[list[Batch], list[Batch]]:
    """Return the trials to learn from and those set aside, by topology.

    Raises:
        InputError: there are too few.
    """
    batches = [batch.take(~batch.test) for batch in data.batches if (~batch.test).any()]
    numbers = np.sort(np.concatenate([b.numbers for b in batches])) if batches else np.array([])
    numbers = np.random.default_rng([config.seed, 0]).permutation(numbers)
    if config.trials:
        numbers = numbers[: config.trials]
    if len(numbers) < 2 * config.validation:
        raise InputError(
            f"{data.config.name}: has {len(numbers)} trials to learn from; "
            f"with {config.validation} set aside it takes at least {2 * config.validation}"
        )
    aside, learnt = numbers[: config.validation], numbers[config.validation :]
    return [
        [part for b in batches if len(part := b.take(np.isin(b.numbers, which)))]
        for which in (learnt, aside)
    ]  # type: ignore[return-value]


def validate(model: Model, batches: Sequence[Batch]) -> float:
    """Return the mean vertex error of the last frame, % of dimension."""
    parts = [errors(model.rollout(designs_of(batch)), batch) for batch in batches]
    return float(together(parts).percent[:, -1].mean())


def fingerprint(config: RunConfig, *data: Dataset) -> str:
    """Return what a run must share with a checkpoint to go on with it.

    Args:
        config: of the run.
        data: all sets that it learns from.
    """
    shared = config.model_dump(mode="json") | {"data": [one.sha256 for one in data]}
    return hashlib.sha256(json.dumps(shared, sort_keys=True).encode()).hexdigest()

"""Fitting a model that solves for equilibrium: what its configuration says, stage by stage.

1. The law of sections, without a network.
2. The first shapes of all trials by that law, from which the network takes its features.
3. The network that corrects it, its polish, and the network for stresses.
4. The error estimate, on a data set of its own.

FOLDER/law.safetensors, network.safetensors, polish..., stress...   checkpoints
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import jax
import numpy as np

from simulearn.compiled import double_precision
from simulearn.dataset import Batch, Dataset, read_dataset
from simulearn.learn.common.first_frame import designs_of
from simulearn.learn.common.metrics import errors
from simulearn.learn.common.trials import fingerprint, split
from simulearn.learn.equilibrium import corrector
from simulearn.learn.equilibrium.bound import (
    ErrorBound,
    error_bound_of,
    seen_of,
    signs_of_error,
)
from simulearn.learn.equilibrium.config import EquilibriumConfig, Stage
from simulearn.learn.equilibrium.examples import examples_of
from simulearn.learn.equilibrium.learnt import learnt_of
from simulearn.learn.equilibrium.model import Equilibrium
from simulearn.learn.equilibrium.parameters import (
    CORRECTIONS,
    STRESSES,
    NetworkWeights,
    Parameters,
    Prediction,
)
from simulearn.learn.equilibrium.stages import (
    Keeper,
    Report,
    StageRow,
    fit_law,
    fit_network,
    fit_stress,
    no_report,
)
from simulearn.mechanics.model import unfitted


@double_precision
def train(
    config: EquilibriumConfig,
    data: Dataset,
    folder: Path | None = None,
    report: Report = no_report,
) -> tuple[Equilibrium, list[StageRow]]:
    """Fit a model, or go on with one.

    Args:
        config: of the run.
        data: to learn from, with stresses if the configuration has a stage for them.
        folder: for checkpoints; None keeps none.
        report: called with (row of the loss curve or None, updates done, updates in all).

    Raises:
        InputError: a checkpoint is of another run, the trials are too few, or the calibration set
            or the one by the fine mesh is not there.
        ComputationError: a loss is not finite.
    """
    batches, aside = split(config, data)
    more = [read_dataset(path) for path in config.more]
    batches += [batch for one in more for batch in _for_learning(one)]
    sets, fine = [data, *more], list[Batch]()
    if config.fine is not None:
        sets.append(read_dataset(config.fine))
        fine = _for_learning(sets[-1])
    calibration: list[Batch] | None = None
    if config.calibration is not None:  # what is wrong with it is said before all the work
        calibration = _for_learning(read_dataset(config.calibration, stress=False))
    material = batches[0].material
    identity = fingerprint(config, *sets)
    stages = (config.law, config.network, config.polish, config.stress)
    total = sum(stage.updates for stage in stages if stage is not None)
    every: list[StageRow] = []
    before = 0

    def keeper(name: str) -> Keeper:
        def overall(row: StageRow | None, done: int, _: int) -> None:
            report(row, before + done, total)

        path = None if folder is None else folder / f"{name}.safetensors"
        return Keeper(name, path, identity, overall)

    def finished(stage: Stage, keep: Keeper) -> int:
        every.extend(keep.rows)
        return before + stage.updates

    keep = keeper("law")
    examples = examples_of(batches)
    law = fit_law(examples, unfitted(), config.law, config.seed, keep)
    law = jax.tree.map(np.asarray, law)
    before = finished(config.law, keep)
    networks: dict[str, NetworkWeights] = {}
    if config.network is not None or config.stress is not None:
        examples = examples_of(batches, law)
        for name, stage, heads, task in (
            ("network", config.network, CORRECTIONS, fit_network),
            ("polish", config.polish, CORRECTIONS, partial(fit_network, full=True)),
            ("stress", config.stress, STRESSES, fit_stress),
        ):
            if stage is None:
                continue
            if name != "network" and fine:  # then it learns what the fine mesh says differently
                examples = examples + examples_of(fine, law, examples, config.fine_share)
                batches, fine = batches + fine, []
            begin = networks.get("network") if name == "polish" else None
            if begin is None:
                key = jax.random.key(config.seed)
                begin = corrector.initial_weights(
                    key, heads, config.width, config.message, config.rounds
                )
            keep = keeper(name)
            fitted = task(law, examples, begin, stage, config.seed, keep)
            networks["network" if name == "polish" else name] = fitted
            before = finished(stage, keep)
    network, stress = networks.get("network"), networks.get("stress")
    sizes = (config.width, config.message, config.rounds)
    as_numpy: Any = jax.tree.map(np.asarray, Parameters(law, network, stress))
    batches += fine
    seen = [m for b in batches for m in (b.materials or (b.material,))]
    learnt = learnt_of(seen, max(b.mesh for b in batches))
    model = Equilibrium(as_numpy, material, learnt, sizes, None, config.kind)
    if calibration is not None:
        model = replace(model, bound=calibrated(model, calibration, aside, batches))
    return model, every


def _for_learning(data: Dataset) -> list[Batch]:
    """Return the trials of a set that are not kept for testing, by topology."""
    return [batch.take(~batch.test) for batch in data.batches if (~batch.test).any()]


@double_precision
def calibrated(
    model: Equilibrium,
    calibration: Sequence[Batch],
    aside: Sequence[Batch],
    learnt: Sequence[Batch],
) -> ErrorBound:
    """Return the error estimate of a model, by trials that it did not learn from.

    Args:
        model: without an estimate.
        calibration: trials that count for the coverage, by the mesh whose answers are wanted.
        aside: further trials that the model did not learn from, for the weights of signs.
        learnt: trials that it learnt from.
    """
    seen = seen_of([model.predict(designs_of(b), last=True).seen for b in learnt])
    rows: list[tuple[Any, ...]] = []
    for k, batch in enumerate((*calibration, *aside)):
        prediction, error, ended = _answered(model, batch)
        signs = signs_of_error(designs_of(batch), prediction, *seen)
        kinds = np.array(batch.kinds or _fifths(batch))
        counted = np.full(len(batch), k < len(calibration))
        rows.append(tuple(x[ended] for x in (signs, error, kinds, counted)))
    every, error, kinds, counted = (np.concatenate(x) for x in zip(*rows, strict=True))
    return error_bound_of(every, error, kinds, counted, seen, learnt)


def _fifths(batch: Batch) -> list[str]:
    """Return one of five names for each trial, which stand for kinds where none is known."""
    return [f"{number % 5} of 5" for number in batch.numbers]


def _answered(model: Equilibrium, batch: Batch) -> tuple[Prediction, Any, Any]:
    """Return the prediction of trials, its errors in the last frame (mm), and which have one."""
    prediction, frames = model.predict(designs_of(batch)), model.rollout(designs_of(batch))
    return prediction, errors(frames, batch).vertex[:, -1], frames.converged

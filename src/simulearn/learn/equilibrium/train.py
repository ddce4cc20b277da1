"""Fitting a model that solves for equilibrium: what its configuration says, stage by stage.

1. The law of sections, without a network.
2. The first shapes of all trials by that law, from which the network takes its features.
3. The network that corrects it, its polish, and the network for stresses.
4. The error estimate, on data sets of its own, or else on the trials set aside.

FOLDER/law.safetensors, network.safetensors, polish..., stress...   checkpoints
"""

import hashlib
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from simulearn.compiled import double_precision
from simulearn.dataset import Batch, Dataset, read_dataset
from simulearn.errors import InputError
from simulearn.learn.common.first_frame import designs_of
from simulearn.learn.common.trials import fingerprint, split
from simulearn.learn.equilibrium import corrector
from simulearn.learn.equilibrium.bound_fit import error_bound_of, ranges_of
from simulearn.learn.equilibrium.config import EquilibriumConfig, Stage
from simulearn.learn.equilibrium.examples import examples_of
from simulearn.learn.equilibrium.learnt import learnt_of
from simulearn.learn.equilibrium.model import Equilibrium
from simulearn.learn.equilibrium.parameters import (
    CORRECTIONS,
    STRESSES,
    NetworkWeights,
    Parameters,
)
from simulearn.learn.equilibrium.signs import seen_of
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
    begin: Equilibrium | None = None,
) -> tuple[Equilibrium, list[StageRow]]:
    """Fit a model, or go on with one.

    Args:
        config: of the run.
        data: to learn from, with stresses if the configuration has a stage for them.
        folder: for checkpoints; None keeps none.
        report: called with (row of the loss curve or None, updates done, updates in all).
        begin: a model whose law and networks are gone on with: the polish comes first.

    Raises:
        InputError: a checkpoint is of another run, the trials are too few, the calibration set
            or the one by the fine mesh is not there, or the run cannot go on from `begin`.
        ComputationError: a loss is not finite.
    """
    batches, aside = split(config, data)
    more = [read_dataset(path) for path in config.more]
    batches += [batch for one in more for batch in _for_learning(one)]
    sets, fine = [data, *more], list[Batch]()
    if config.fine is not None:
        sets.append(read_dataset(config.fine))
        fine = _for_learning(sets[-1])
    calibration = _calibration(config)  # what is wrong with it is said before all the work
    material = batches[0].material
    identity = fingerprint(config, *sets)
    stages: tuple[Stage | None, ...] = (config.law, config.network, config.polish, config.stress)
    if begin is not None:
        identity = _identity_from(begin, config, identity)
        stages = stages[2:]
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

    networks: dict[str, NetworkWeights] = {}
    if begin is None:
        keep = keeper("law")
        examples = examples_of(batches)
        law = fit_law(examples, unfitted(), config.law, config.seed, keep)
        law = jax.tree.map(np.asarray, law)
        before = finished(config.law, keep)
    else:
        law, networks = begin.parameters.law, _networks_of(begin)
    if config.network is not None or config.stress is not None:
        examples = examples_of(batches, law)
        for name, stage, heads, task in (
            ("network", config.network, CORRECTIONS, fit_network),
            ("polish", config.polish, CORRECTIONS, partial(fit_network, full=True)),
            ("stress", config.stress, STRESSES, fit_stress),
        ):
            if stage is None or (begin is not None and name == "network"):
                continue
            if name != "network" and fine:  # then it learns what the fine mesh says differently
                examples = examples + examples_of(fine, law, examples, config.fine_share)
                batches, fine = batches + fine, []
            which = "network" if name == "polish" else name
            first = networks.get(which)
            if first is None:
                key = jax.random.key(config.seed)
                first = corrector.initial_weights(
                    key, heads, config.width, config.message, config.rounds
                )
            keep = keeper(name)
            networks[which] = task(law, examples, first, stage, config.seed, keep)
            before = finished(stage, keep)
    network, stress = networks.get("network"), networks.get("stress")
    sizes = (config.width, config.message, config.rounds)
    as_numpy: Any = jax.tree.map(np.asarray, Parameters(law, network, stress))
    batches += fine
    seen = [m for b in batches for m in (b.materials or (b.material,))]
    learnt = learnt_of(seen, max(b.mesh for b in batches))
    model = Equilibrium(as_numpy, material, learnt, sizes, None, config.kind)
    seen_halves = [model.predict(designs_of(b), last=True).seen for b in batches]
    ours = seen_of(seen_halves), ranges_of(batches)
    try:
        bound = error_bound_of(model, *(calibration or (aside, [])), *ours)
    except InputError:  # too few were set aside, or too few of them have an answer: no estimate
        if calibration is not None:
            raise
        return model, every
    return replace(model, bound=bound), every


def _networks_of(model: Equilibrium) -> dict[str, NetworkWeights]:
    """Return the networks of a model that a run goes on with, by stage."""
    own = {"network": model.parameters.network, "stress": model.parameters.stress}
    return {name: jax.tree.map(jnp.asarray, one) for name, one in own.items() if one is not None}


def _identity_from(begin: Equilibrium, config: EquilibriumConfig, identity: str) -> str:
    """Return the identity of a run that goes on from a model.

    Raises:
        InputError: the run has no polish, or networks of other sizes.
    """
    if config.polish is None:
        raise InputError(f'the run "{config.name}" has no polish by which a model could go on')
    if begin.parameters.network is None:
        raise InputError("the model has no network that could be gone on with")
    sizes = (config.width, config.message, config.rounds)
    if begin.sizes != sizes:
        raise InputError(
            f"width, message and rounds of the model's networks are {begin.sizes}, those of the "
            f"run {sizes}"
        )
    digest = hashlib.sha256(identity.encode())
    for array in begin.to_arrays().values():
        digest.update(array.tobytes())
    return digest.hexdigest()


def with_new_bound(model: Equilibrium, config: EquilibriumConfig) -> Equilibrium:
    """Return a model with its error estimate fitted anew to the calibration sets of a run.

    Raises:
        InputError: the run has none, one is not there, or the model has no estimate yet.
    """
    calibration = _calibration(config)
    if calibration is None:
        raise InputError(f'the configuration "{config.name}" has no calibration set')
    if model.bound is None:
        raise InputError("the model has no error estimate that could be fitted anew")
    bound = error_bound_of(model, *calibration, model.bound.seen, model.bound.ranges)
    return replace(model, bound=bound)


def _calibration(config: EquilibriumConfig) -> tuple[list[Batch], list[Batch]] | None:
    """Return the trials of kinds that are learnt, and of others, that an estimate is fitted to."""
    if config.calibration is None:
        return None
    sets = (config.calibration, config.unfamiliar)
    learnt, others = (
        _for_learning(read_dataset(path, stress=False)) if path is not None else [] for path in sets
    )
    return learnt, others


def _for_learning(data: Dataset) -> list[Batch]:
    """Return the trials of a set that are not kept for testing, by topology."""
    return [batch.take(~batch.test) for batch in data.batches if (~batch.test).any()]

"""Fitting a model that solves for equilibrium: what its configuration says, stage by stage.

1. The law of the section, without a network.
2. The first shapes of all trials by that law, which the network looks at.
3. The network that corrects it, its polish, and the network for stresses.
4. The error estimate, on a data set of its own.

FOLDER/law.safetensors, network.safetensors, polish..., stress...   checkpoints
"""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import jax
import numpy as np

from simulearn.dataset import Batch, Dataset, read_dataset
from simulearn.errors import InputError
from simulearn.learn import local
from simulearn.learn.config import Fit, Stage
from simulearn.learn.equilibrium import Equilibrium
from simulearn.learn.flat import designs_of
from simulearn.learn.metrics import errors
from simulearn.learn.shapes import Parameters
from simulearn.learn.stages import Keeper, Row, examples_of, fit_law, fit_network, fit_stress
from simulearn.learn.train import fingerprint, split
from simulearn.learn.trust import Trust, signs, trust_of
from simulearn.material import load_material

Tell = Callable[[Row | None, int, int], None]


def fit(
    config: Fit,
    data: Dataset,
    folder: Path | None = None,
    tell: Tell = lambda row, done, total: None,
) -> tuple[Equilibrium, list[Row]]:
    """Fit a model, or go on with one.

    Args:
        config: of the run.
        data: to learn from, with stresses if the configuration has a stage for them.
        folder: for checkpoints; None keeps none.
        tell: called with (row of the loss curve or None, updates done, updates in all).

    Raises:
        InputError: a checkpoint is of another run, the trials are too few or of several
            topologies, or the calibration set is not there.
        ComputationError: a loss is not finite.
    """
    batch = _only(split(config, data)[0], data)
    calibration = None
    if config.calibration is not None:  # what is wrong with it is told before all the work
        calibration = read_dataset(config.calibration, stress=False).batches
    material = load_material(batch.material)
    identity = fingerprint(config, data)
    plan = (config.law, config.network, config.polish, config.stress)
    total = sum(stage.updates for stage in plan if stage is not None)
    every: list[Row] = []
    before = 0

    def keeper(name: str) -> Keeper:
        def told(row: Row | None, done: int, _: int) -> None:
            tell(row, before + done, total)

        path = None if folder is None else folder / f"{name}.safetensors"
        return Keeper(name, path, identity, told)

    def finished(stage: Stage, keep: Keeper) -> int:
        every.extend(keep.rows)
        return before + stage.updates

    keep = keeper("law")
    law = fit_law(batch, material, config.law, config.seed, keep)
    before = finished(config.law, keep)
    networks: dict[str, local.Weights] = {}
    if config.network is not None or config.stress is not None:
        examples = examples_of(law, batch, material)
        for name, stage, heads, task in (
            ("network", config.network, local.CORRECTIONS, fit_network),
            ("polish", config.polish, local.CORRECTIONS, partial(fit_network, whole=True)),
            ("stress", config.stress, local.STRESSES, fit_stress),
        ):
            if stage is None:
                continue
            begin = networks.get("network") if name == "polish" else None
            if begin is None:
                key = jax.random.key(config.seed)
                begin = local.weights(key, heads, config.width, config.message, config.rounds)
            keep = keeper(name)
            found = task(law, examples, material, begin, stage, config.seed, keep)
            networks["network" if name == "polish" else name] = found
            before = finished(stage, keep)
    network, stress = networks.get("network"), networks.get("stress")
    sizes = (config.width, config.message, config.rounds)
    as_numpy: Any = jax.tree.map(np.asarray, Parameters(law, network, stress))
    model = Equilibrium(as_numpy, sizes, None, config.kind, batch.material)
    if calibration is not None:
        model = Equilibrium(
            as_numpy, sizes, calibrated(model, calibration, [batch]), config.kind, batch.material
        )
    return model, every


def calibrated(model: Equilibrium, calibration: Sequence[Batch], learnt: Sequence[Batch]) -> Trust:
    """Return the error estimate of a model, by trials that it has not seen."""
    told, wrong = [], []
    for batch in calibration:
        frames = model.rollout(designs_of(batch))
        good = frames.converged
        told.append(signs(designs_of(batch), model.told(designs_of(batch)))[good])
        wrong.append(errors(frames, batch).vertex[good, -1])
    return trust_of(np.concatenate(told), np.concatenate(wrong), learnt)


def _only(batches: Sequence[Batch], data: Dataset) -> Batch:
    if len(batches) != 1:
        raise InputError(
            f"{data.config.name}: has {len(batches)} topologies; these models learn from one, and "
            "answer for all"
        )
    return batches[0]

"""Training: epochs over turned trials, a checkpoint after each, a bundle at the end.

Everything random is drawn from the seed, the epoch and the number of the update, so that a run
that was stopped goes on bit for bit as if it had not been.
"""

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import optax  # type: ignore[import-untyped]
import optax.contrib  # type: ignore[import-untyped]
from jax import Array

from simulearn.compiled import double_precision
from simulearn.dataset import Batch, Dataset
from simulearn.dataset.augment import mirrored, turned
from simulearn.errors import ComputationError, InputError
from simulearn.learn.common import checkpoint
from simulearn.learn.common.trials import fingerprint, split, validate
from simulearn.learn.paper.aligning import aligned_batch
from simulearn.learn.paper.config import PaperConfig
from simulearn.learn.paper.graph import Graph
from simulearn.learn.paper.loss import Examples, LossWeights, Prepared, loss
from simulearn.learn.paper.model import Paper
from simulearn.learn.paper.network import DoubleInteraction, Normalisers, Sizes
from simulearn.learn.paper.normalisers import normalisers

PARTS = ("loss", "release", "creep", "stress", "dislocation")
# Their rate is applied afterwards. Muon makes the update of a matrix orthogonal (Jordan et al.,
# 2024) and leaves biases to Adam.
OPTIMISERS = {"adam": optax.adam(1.0), "muon": optax.contrib.muon(1.0, adam_b2=0.99)}
SIZE = 90.0  # mm, a dimension of average weight


@dataclass(frozen=True)
class EpochRow:
    """An epoch in the loss curve.

    Attributes:
        epoch: from 1.
        unroll: steps before the simulator is judged.
        rate: learning rate at its end.
        loss: mean over its updates, and its parts.
        release, creep, stress, dislocation: parts of the loss, before their weights.
        validation_percent: mean vertex error of the trials set aside, % of dimension.
        seconds: it took.
    """

    epoch: int
    unroll: int
    rate: float
    loss: float
    release: float
    creep: float
    stress: float
    dislocation: float
    validation_percent: float
    seconds: float


class TrainingState(eqx.Module):
    """What changes in the course of a run."""

    model: Paper
    optimiser: Any


Progress = Callable[[EpochRow | None, int, int], None]  # (last epoch, updates done, updates in all)


@double_precision
def train(
    config: PaperConfig,
    data: Dataset,
    path: Path | None = None,
    progress: Progress = lambda row, done, total: None,
) -> tuple[Paper, list[EpochRow]]:
    """Train a model, or go on with one.

    Args:
        config: of the run.
        data: whose trials to learn from are used; those to test on are not looked at.
        path: of the checkpoint; None keeps none.
        progress: called after every update and every epoch.

    Raises:
        InputError: the checkpoint is of another run, or the trials are too few or of several
            materials.
        ComputationError: the loss is not finite.
    """
    if len({material.physics for batch in data.batches for material in batch.materials}) > 1:
        raise InputError(
            f"{data.config.name}: its trials are of several materials; a model of the kind paper "
            "learns one, and those of the kind equilibrium a family"
        )
    batches, watched = split(config, data)
    if config.orientation == "aligned":
        batches = [aligned_batch(batch) for batch in batches]
    total = sum(_updates(config, batches, epoch) for epoch in range(config.epochs))
    run = begin(config, batches)
    rows: list[EpochRow] = []
    identity = fingerprint(config, data)
    if path is not None and path.exists():
        header = checkpoint.header(path)
        if header.get("identity") != identity:
            raise InputError(
                f"{path}: is of another run (its configuration or data differ); name another "
                "folder, or delete it to begin anew"
            )
        run = checkpoint.load(path, run)
        rows = [EpochRow(**row) for row in header["rows"]]
    done = sum(_updates(config, batches, epoch) for epoch in range(len(rows)))
    progress(rows[-1] if rows else None, done, total)
    schedule = _schedule(config, total)
    for epoch in range(len(rows), config.epochs):
        begun, phase = time.perf_counter(), config.phase(epoch)
        weights = LossWeights(
            *(jnp.float32(x) for x in (phase.noise, config.penalty, config.stress))
        )
        parts: list[Array] = []
        for examples, shape, ends in _epoch(config, batches, epoch):
            key = jax.random.fold_in(jax.random.key(config.seed), done)
            rates = jnp.float32(schedule(done)), jnp.float32(config.clip)
            fixed = (weights, shape, ends, key, rates)
            run, value, parts_now = _update(fixed, run, examples, phase.unroll, config.optimiser)
            done += 1
            parts.append(jnp.concatenate([value[None], parts_now]))
            progress(None, done, total)
        mean = np.mean(np.asarray(jnp.stack(parts), np.float64), axis=0)
        if not np.isfinite(mean).all():
            raise ComputationError(
                f"epoch {epoch + 1}: the loss is not finite; lower rate ({config.rate:g}) or clip"
            )
        percent = validate(run.model, watched)
        seconds = time.perf_counter() - begun
        rate = float(schedule(done))
        named = dict(zip(PARTS, map(float, mean), strict=True))
        rows.append(
            EpochRow(
                epoch + 1,
                phase.unroll,
                rate,
                **named,
                validation_percent=percent,
                seconds=seconds,
            )
        )
        if path is not None:
            checkpoint.save(path, run, {"identity": identity, "rows": [asdict(r) for r in rows]})
        progress(rows[-1], done, total)
    return run.model, rows


@double_precision
def begin(config: PaperConfig, batches: Sequence[Batch]) -> TrainingState:
    """Return a run before its first update: normalisers fitted to trials, weights drawn."""
    aligned = config.orientation == "aligned"
    release, creep = normalisers(batches, config.variance, config.seed, aligned)
    sizes = config.release.sizes, config.creep.sizes
    key = jax.random.key(config.seed)
    run: TrainingState = _drawn(release, creep, key, sizes, aligned, config.optimiser)
    return run


@eqx.filter_jit  # one kernel for all weights is quicker to compile than one for each
def _drawn(
    release: Normalisers,
    creep: Normalisers,
    key: Array,
    sizes: tuple[Sizes, Sizes],
    aligned: bool,
    optimiser: str,
) -> TrainingState:
    """Return a run whose weights are drawn by a key; see `begin`."""
    keys = jax.random.split(key)
    engines = (
        DoubleInteraction(release, sizes[0], keys[0]),
        DoubleInteraction(creep, sizes[1], keys[1]),
    )
    model = Paper(*engines, sizes, aligned)
    return TrainingState(model, OPTIMISERS[optimiser].init(_learnt(model)[0]))


def _learnt(model: Paper) -> tuple[Paper, Paper]:
    """Return what is learnt, the weights, and the rest, as two trees."""
    mask = jax.tree.map(eqx.is_inexact_array, model)

    def normalisers_of(m: Paper) -> list[Normalisers]:
        return [engine.normalisers for engine in (m.release, m.creep)]

    constant = [jax.tree.map(lambda _: False, n) for n in normalisers_of(mask)]
    mask = eqx.tree_at(normalisers_of, mask, constant)
    parts: tuple[Paper, Paper] = eqx.partition(model, mask)
    return parts


def _schedule(config: PaperConfig, total: int) -> optax.Schedule:
    return optax.warmup_cosine_decay_schedule(
        0.0, config.rate, round(config.warm * total), total, config.rate * config.last
    )


def _updates(config: PaperConfig, batches: Sequence[Batch], epoch: int) -> int:
    size = config.phase(epoch).batch
    return sum(max(1, len(batch) // size) for batch in batches)


def _epoch(
    config: PaperConfig, batches: Sequence[Batch], epoch: int
) -> Iterator[tuple[Examples, Graph, Array]]:
    """Yield the examples of an epoch: turned, perhaps mirrored, in random order."""
    rng = np.random.default_rng([config.seed, 1, epoch])
    size = config.phase(epoch).batch
    drawn: list[tuple[int, np.ndarray]] = []
    prepared = []
    for k, batch in enumerate(batches):
        image = mirrored(batch) if config.mirrored and epoch % 2 else batch
        if config.orientation == "any":
            angles = rng.uniform(0, 2 * np.pi, len(batch))
        else:
            angles = rng.integers(4, size=len(batch)) * np.pi / 2
        image = turned(image, angles)
        prepared.append(Prepared.of(image))
        order, count = rng.permutation(len(batch)), max(1, len(batch) // size)
        # All updates have the same number of trials, so that one kernel serves them.
        drawn += [(k, order[n * size : (n + 1) * size]) for n in range(count)]
    for n in rng.permutation(len(drawn)):
        k, which = drawn[n]
        one = prepared[k]
        yield one.examples(which, SIZE), one.shape, one.ends


@eqx.filter_jit(donate="all-except-first")
@jax.default_matmul_precision("float32")
def _update(
    fixed: tuple[LossWeights, Graph, Array, Array, tuple[Array, Array]],
    run: TrainingState,
    examples: Examples,
    unroll: int,
    optimiser: str,
) -> tuple[TrainingState, Array, Array]:
    """Return the run after one more update, its loss and the parts of it.

    Args:
        fixed: weights of the loss, topology, its ends, key of the noise, and learning rate and
            largest norm of the gradient.
        run: before.
        examples: to learn from.
        unroll: steps before the simulator is judged.
        optimiser: one of OPTIMISERS.
    """
    weights, shape, ends, key, (rate, clip) = fixed
    learnt, rest = _learnt(run.model)

    def value(part: Paper) -> tuple[Array, Array]:
        return loss(eqx.combine(part, rest), examples, shape, ends, weights, unroll, key)

    (total, parts), slope = eqx.filter_value_and_grad(value, has_aux=True)(learnt)
    norm = jnp.sqrt(sum((x**2).sum() for x in jax.tree.leaves(slope)))
    slope = jax.tree.map(lambda x: x * jnp.minimum(1.0, clip / norm), slope)
    moves, state = OPTIMISERS[optimiser].update(slope, run.optimiser, learnt)
    learnt = eqx.apply_updates(learnt, jax.tree.map(lambda x: rate * x, moves))
    return TrainingState(eqx.combine(learnt, rest), state), total, parts

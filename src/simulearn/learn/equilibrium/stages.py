"""The stages of training a model that solves for equilibrium: law, network, stresses.

Each makes a loss at the true poses small (see `first_order`), and can be stopped and gone on with.
Everything random is drawn from the seed, the stage and the number of the update.
"""

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
import optax  # type: ignore[import-untyped]
import optax.contrib  # type: ignore[import-untyped]

from simulearn.compiled import double_precision
from simulearn.errors import ComputationError, InputError
from simulearn.learn.common import checkpoint
from simulearn.learn.equilibrium.config import Stage
from simulearn.learn.equilibrium.examples import StageExamples, take
from simulearn.learn.equilibrium.first_order import first_order_errors, loss
from simulearn.learn.equilibrium.parameters import NetworkWeights, Parameters
from simulearn.learn.equilibrium.prediction import elastic
from simulearn.learn.equilibrium.reference import (
    TrialPoses,
)
from simulearn.mechanics.forces import BeamState
from simulearn.mechanics.model import SectionLaw, section_of
from simulearn.mechanics.poses import Array
from simulearn.mechanics.rollout import RELEASED, half_beams_at, loads

# How far each coefficient may be expected to go from that of a layered beam.
STEP = SectionLaw(0.01, 0.01, 0.04, 0.04, 0.02, 0.01, 0.01, 0.01, 0.3, 0.3, 0.2, 0.5)
# Muon (Jordan et al., 2024) makes the update of a matrix orthogonal and leaves biases to Adam.
OPTIMISERS = {"adam": optax.adam, "muon": partial(optax.contrib.muon, adam_b2=0.99)}
ROUND = 250  # updates between two checkpoints
PASSED_OVER = 10  # updates without a slope, one after another, at most
FINITE = 0.95  # of the losses of a round, at least
LATE = 0.3  # of the examples are of the last two frames


@dataclass(frozen=True)
class StageRow:
    """A round in the loss curve.

    Attributes:
        stage: what is fitted.
        update: updates of the stage so far.
        loss: mean over the round, without updates that had none.
        seconds: it took.
    """

    stage: str
    update: int
    loss: float
    seconds: float


class StageState(NamedTuple):
    """What changes in the course of a stage."""

    fitted: Any
    optimiser: Any


Report = Callable[[StageRow | None, int, int], None]  # (row or None, updates done, updates in all)


def no_report(row: StageRow | None, done: int, total: int) -> None:
    """Report nothing."""


@double_precision
def fit_law(
    examples: Sequence[StageExamples], begin: SectionLaw, stage: Stage, seed: int, keep: "Keeper"
) -> SectionLaw:
    """Return the law of sections that fits trials best."""

    def law_of(moved: SectionLaw) -> SectionLaw:
        return jax.tree.map(lambda a, b, c: a + b * c, begin, STEP, moved)

    def value(moved: SectionLaw, some: TrialPoses, frame: Array) -> Array:
        parameters = Parameters(law_of(moved))
        off = jax.vmap(lambda t, f: first_order_errors(parameters, t, f, None, None))(some, frame)
        return _mean_loss(off, some, frame)

    def draw(some: StageExamples, k: np.ndarray, f: np.ndarray) -> tuple[Any, ...]:
        return take(some.trials, k), f

    zero = jax.tree.map(jnp.zeros_like, begin)
    fitted = descend(zero, value, draw, stage, examples, seed, keep)
    return law_of(fitted)


def _mean_loss(off: tuple[Array, Array], some: TrialPoses, frame: Array) -> Array:
    counts = some.real, some.topology.real
    return jax.vmap(loss)(*off, some.size, jnp.array(RELEASED)[frame], counts).mean()


@double_precision
def fit_network(
    law: SectionLaw,
    examples: Sequence[StageExamples],
    begin: NetworkWeights,
    stage: Stage,
    seed: int,
    keep: "Keeper",
    full: bool = False,
) -> NetworkWeights:
    """Return the network that corrects a law of sections; see `first_order_errors` for `full`."""

    def value(
        network: NetworkWeights, some: TrialPoses, frame: Array, begun: Any, twist: Any
    ) -> Array:
        parameters = Parameters(law, network)

        def errors(t: TrialPoses, f: Array, b: BeamState, w: Array) -> tuple[Array, Array]:
            return first_order_errors(parameters, t, f, b, w, full)

        return _mean_loss(jax.vmap(errors)(some, frame, begun, twist), some, frame)

    def draw(some: StageExamples, k: np.ndarray, f: np.ndarray) -> tuple[Any, ...]:
        begun = jax.tree.map(lambda x: x[k, f], some.begun)
        return take(some.trials, k), f, begun, some.twist[k, f]

    return descend(begin, value, draw, stage, examples, seed, keep)


@double_precision
def fit_stress(
    law: SectionLaw,
    examples: Sequence[StageExamples],
    begin: NetworkWeights,
    stage: Stage,
    seed: int,
    keep: "Keeper",
) -> NetworkWeights:
    """Return the network that predicts stresses from true poses."""

    def value(network: NetworkWeights, some: TrialPoses, frame: Array, stress: Array) -> Array:
        def one(t: TrialPoses, f: Array, true: Array) -> Array:
            p = t.properties
            section_model, load = section_of(law, p, jnp), loads(p)
            s, gravity = jnp.array(RELEASED)[f], load.gravity[f]
            state = jax.tree.map(lambda x: x[f], t.state)
            bare = half_beams_at(section_model, t.topology, t.geometry, t.ratio, load, s, gravity)
            own = elastic(network, t.topology, t.geometry, t.ratio, bare, state, s, gravity, p)
            off = jnp.sqrt((((own - true) / 0.01) ** 2).sum(-1) + 0.01).mean((0, 2, 3))
            return (off * t.topology.real).sum() / t.topology.real.sum()

        return jax.vmap(one)(some, frame, stress).mean()

    def draw(some: StageExamples, k: np.ndarray, f: np.ndarray) -> tuple[Any, ...]:
        return take(some.trials, k), f, some.stress[k, f]

    return descend(begin, value, draw, stage, examples, seed, keep)


class Keeper:
    """Keeps checkpoints of a stage and reports how far it is.

    Args:
        stage: its name.
        path: of the stage's checkpoint, or None.
        identity: of the run; a checkpoint of another is refused.
        report: called with (row, updates done, updates in all).
    """

    def __init__(
        self,
        stage: str,
        path: Path | None = None,
        identity: str = "",
        report: Report = no_report,
    ) -> None:
        self.stage, self.path, self.identity, self.report = stage, path, identity, report
        self.rows: list[StageRow] = []

    def load(self, run: StageState) -> tuple[StageState, int]:
        """Return the run as it was last saved, and its updates.

        Raises:
            InputError: the checkpoint is of another run.
        """
        if self.path is None or not self.path.exists():
            return run, 0
        header = checkpoint.header(self.path)
        if header.get("identity") != self.identity or header.get("stage") != self.stage:
            raise InputError(
                f"{self.path}: is of another run (its configuration or data differ); name another "
                "folder, or delete it to begin anew"
            )
        self.rows = [StageRow(**row) for row in header["rows"]]
        return checkpoint.load(self.path, run), int(header["done"])

    def save(self, run: StageState, done: int, row: StageRow) -> None:
        """Keep a run after a round."""
        self.rows.append(row)
        if self.path is not None:
            header = {"identity": self.identity, "stage": self.stage, "done": done}
            checkpoint.save(self.path, run, {**header, "rows": [asdict(r) for r in self.rows]})


@double_precision
def descend(
    begin: Any,
    value: Callable[..., Array],
    draw: Callable[[StageExamples, np.ndarray, np.ndarray], tuple[Any, ...]],
    stage: Stage,
    examples: Sequence[StageExamples],
    seed: int,
    keep: Keeper,
) -> Any:
    """Return what is left of `value` at its least, over random trials and frames."""
    warm = min(100, stage.updates // 10)
    schedule = optax.warmup_cosine_decay_schedule(0.0, stage.rate, warm, stage.updates)
    chain = optax.chain(optax.clip_by_global_norm(1.0), OPTIMISERS[stage.optimiser](schedule))
    # A grid that buckles under parameters that are far off has no slope; it is passed over.
    optimiser = optax.apply_if_finite(chain, max_consecutive_errors=PASSED_OVER)

    @jax.jit
    def update(run: StageState, *args: Any) -> tuple[StageState, Array]:
        value_now, slope = jax.value_and_grad(value)(run.fitted, *args)
        moves, state = optimiser.update(slope, run.optimiser, run.fitted)
        return StageState(optax.apply_updates(run.fitted, moves), state), value_now

    run, done = keep.load(StageState(begin, optimiser.init(begin)))
    name = sum(keep.stage.encode())
    shares = np.cumsum([some.weight.sum() for some in examples])
    shares /= shares[-1]
    for until in _rounds(done, stage.updates):
        begun, values = time.perf_counter(), []
        frames = len(RELEASED)
        for k in range(done, until):
            rng = np.random.default_rng([seed, name, k])
            some = examples[min(int(np.searchsorted(shares, rng.random())), len(examples) - 1)]
            odds = np.cumsum(some.weight) / some.weight.sum()
            which = np.minimum(np.searchsorted(odds, rng.random(stage.batch)), len(odds) - 1)
            frame = rng.integers(frames, size=stage.batch)
            late = rng.random(stage.batch) < LATE
            frame = np.where(late, rng.integers(frames - 2, frames, size=stage.batch), frame)
            run, now = update(run, *draw(some, which, frame))
            values.append(now)
            keep.report(None, k + 1, stage.updates)
        every = np.asarray(jnp.stack(values))
        finite = every[np.isfinite(every)]
        if len(finite) < FINITE * len(every):
            raise ComputationError(
                f"{keep.stage}: the loss is not finite in {len(every) - len(finite)} of "
                f"{len(every)} updates; lower its rate ({stage.rate:g})"
            )
        mean = float(finite.mean())
        done, row = until, StageRow(keep.stage, until, mean, time.perf_counter() - begun)
        keep.save(run, done, row)
        keep.report(row, done, stage.updates)
    return run.fitted


def _rounds(done: int, updates: int) -> Iterator[int]:
    while done < updates:
        done = min(done + ROUND, updates)
        yield done

"""The stages of training a model that solves for equilibrium: section model, network, stresses.

Each makes a loss at the true poses small (see `first_order`), and can be stopped and gone on with.
Everything random is drawn from the seed, the stage and the number of the update.
"""

import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
import optax  # type: ignore[import-untyped]

from simulearn.compiled import double_precision
from simulearn.dataset import Batch
from simulearn.errors import ComputationError, InputError
from simulearn.learn.common import checkpoint
from simulearn.learn.equilibrium import stresses
from simulearn.learn.equilibrium.config import Stage
from simulearn.learn.equilibrium.first_order import first_order_errors, loss
from simulearn.learn.equilibrium.parameters import NetworkWeights, Parameters
from simulearn.learn.equilibrium.prediction import elastic, first
from simulearn.learn.equilibrium.reference import TrialPoses, trial_poses
from simulearn.material import Material
from simulearn.mechanics.forces import BeamState
from simulearn.mechanics.model import SectionModel
from simulearn.mechanics.poses import Array
from simulearn.mechanics.rollout import RELEASED, every_frame, half_beams_at, loads
from simulearn.mechanics.section import first_guess

# How far each property of the section_model may be expected to go from the first guess.
STEP = SectionModel(0.01, 0.01, 0.01, 0.01, 0.02, 0.01, 0.01, 0.01, 0.3, 0.3)
ROUND = 250  # updates between two checkpoints
LATE = 0.3  # of the examples are of the last two frames
AT_ONCE = 50  # trials whose first shapes are computed together


@dataclass(frozen=True)
class StageRow:
    """A round in the loss curve.

    Attributes:
        stage: what is fitted.
        update: updates of the stage so far.
        loss: mean over the round.
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


class StageExamples(NamedTuple):
    """Trials with their first shapes, and their stresses in the axes of halves."""

    trials: TrialPoses
    begun: Any
    twist: Any
    stress: Any


Report = Callable[[StageRow | None, int, int], None]  # (row or None, updates done, updates in all)


def no_report(row: StageRow | None, done: int, total: int) -> None:
    """Report nothing."""


@double_precision
def fit_section_model(
    batch: Batch, material: Material, stage: Stage, seed: int, keep: "Keeper"
) -> SectionModel:
    """Return the section_model of the section that fits trials best."""
    load, trials = loads(material), trial_poses(batch, material)
    guess = first_guess(material)

    def model_of(moved: SectionModel) -> SectionModel:
        return jax.tree.map(lambda a, b, c: a + b * c, guess, STEP, moved)

    def value(moved: SectionModel, some: TrialPoses, frame: Array) -> Array:
        parameters = Parameters(model_of(moved))
        off = jax.vmap(lambda t, f: first_order_errors(parameters, load, t, f, None, None))(
            some, frame
        )
        return jax.vmap(loss)(*off, some.size, jnp.array(RELEASED)[frame]).mean()

    zero = jax.tree.map(jnp.zeros_like, guess)

    def draw(k: np.ndarray, f: np.ndarray) -> tuple[Any, ...]:
        return _take(trials, k), f

    fitted = descend(zero, value, draw, stage, len(batch), seed, keep)
    return model_of(fitted)


@double_precision
def fit_network(
    section_model: SectionModel,
    examples: StageExamples,
    material: Material,
    begin: NetworkWeights,
    stage: Stage,
    seed: int,
    keep: "Keeper",
    full: bool = False,
) -> NetworkWeights:
    """Return the network that corrects a section model; see `first_order_errors` for `full`."""
    load = loads(material)

    def value(
        network: NetworkWeights, some: TrialPoses, frame: Array, begun: Any, twist: Any
    ) -> Array:
        parameters = Parameters(section_model, network)

        def errors(t: TrialPoses, f: Array, b: BeamState, w: Array) -> tuple[Array, Array]:
            return first_order_errors(parameters, load, t, f, b, w, full)

        off = jax.vmap(errors)(some, frame, begun, twist)
        return jax.vmap(loss)(*off, some.size, jnp.array(RELEASED)[frame]).mean()

    def draw(k: np.ndarray, f: np.ndarray) -> tuple[Any, ...]:
        begun = jax.tree.map(lambda x: x[k, f], examples.begun)
        return _take(examples.trials, k), f, begun, examples.twist[k, f]

    return descend(begin, value, draw, stage, len(examples.twist), seed, keep)


@double_precision
def fit_stress(
    section_model: SectionModel,
    examples: StageExamples,
    material: Material,
    begin: NetworkWeights,
    stage: Stage,
    seed: int,
    keep: "Keeper",
) -> NetworkWeights:
    """Return the network that predicts stresses from true poses."""
    load = loads(material)

    def value(network: NetworkWeights, some: TrialPoses, frame: Array, stress: Array) -> Array:
        def one(t: TrialPoses, f: Array, true: Array) -> Array:
            s, gravity = jnp.array(RELEASED)[f], load.gravity[f]
            state = jax.tree.map(lambda x: x[f], t.state)
            bare = half_beams_at(section_model, t.topology, t.geometry, t.ratio, load, s, gravity)
            own = elastic(network, t.topology, t.geometry, t.ratio, bare, state, s, gravity)
            return jnp.sqrt((((own - true) / 0.01) ** 2).sum(-1) + 0.01).mean()

        return jax.vmap(one)(some, frame, stress).mean()

    def draw(k: np.ndarray, f: np.ndarray) -> tuple[Any, ...]:
        return _take(examples.trials, k), f, examples.stress[k, f]

    return descend(begin, value, draw, stage, len(examples.twist), seed, keep)


@double_precision
def examples_of(section_model: SectionModel, batch: Batch, material: Material) -> StageExamples:
    """Return trials with their first shapes; those that have none are left out."""
    load, trials = loads(material), trial_poses(batch, material)

    def one(t: TrialPoses) -> tuple[BeamState, Array, Array]:
        return first(
            t.topology,
            t.geometry,
            every_frame(section_model, t.topology, t.geometry, t.ratio, load),
        )

    find = jax.jit(jax.vmap(one))
    parts = []
    for a in range(0, len(batch), AT_ONCE):
        which = np.arange(a, a + AT_ONCE) % len(batch)
        parts.append(jax.tree.map(np.asarray, find(_take(trials, which))))
    begun, twist, motions = jax.tree.map(lambda *x: np.concatenate(x)[: len(batch)], *parts)
    converged = motions.max(axis=1) < 0.05
    own = np.zeros(0)
    if batch.stress is not None:
        printed = jax.vmap(lambda t: stresses.printed(material, t.geometry, t.ratio))(trials)
        fraction = 1 - jnp.array(RELEASED)
        local_of = jax.jit(
            jax.vmap(
                lambda t, sigma, first: jax.vmap(
                    lambda state, x, s: (
                        stresses.in_halves(t.topology, t.geometry, state, x) - s * first
                    )
                )(t.state, sigma, fraction)
            )
        )
        pieces = [
            np.asarray(local_of(_take(trials, k), batch.stress[k, 1:], printed[k]), np.float32)
            for k in np.array_split(np.arange(len(batch)), max(1, len(batch) // AT_ONCE))
        ]
        own = np.concatenate(pieces)[converged]

    def take(x: Any) -> Any:
        return np.asarray(x)[converged]

    return StageExamples(
        jax.tree.map(take, trials), jax.tree.map(take, begun), twist[converged], own
    )


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
    draw: Callable[[np.ndarray, np.ndarray], tuple[Any, ...]],
    stage: Stage,
    trials: int,
    seed: int,
    keep: Keeper,
) -> Any:
    """Return what is left of `value` at its least, by Adam over random trials and frames."""
    warm = min(100, stage.updates // 10)
    schedule = optax.warmup_cosine_decay_schedule(0.0, stage.rate, warm, stage.updates)
    optimiser = optax.chain(optax.clip_by_global_norm(1.0), optax.adam(schedule))

    @jax.jit
    def update(run: StageState, *args: Any) -> tuple[StageState, Array]:
        value_now, slope = jax.value_and_grad(value)(run.fitted, *args)
        moves, state = optimiser.update(slope, run.optimiser)
        return StageState(optax.apply_updates(run.fitted, moves), state), value_now

    run, done = keep.load(StageState(begin, optimiser.init(begin)))
    name = sum(keep.stage.encode())
    for until in _rounds(done, stage.updates):
        begun, values = time.perf_counter(), []
        frames = len(RELEASED)
        for k in range(done, until):
            rng = np.random.default_rng([seed, name, k])
            which = rng.integers(trials, size=stage.batch)
            frame = rng.integers(frames, size=stage.batch)
            late = rng.random(stage.batch) < LATE
            frame = np.where(late, rng.integers(frames - 2, frames, size=stage.batch), frame)
            run, now = update(run, *draw(which, frame))
            values.append(now)
            keep.report(None, k + 1, stage.updates)
        mean = float(np.mean(np.asarray(jnp.stack(values))))
        if not np.isfinite(mean):
            raise ComputationError(
                f"{keep.stage}: the loss is not finite; lower its rate ({stage.rate:g})"
            )
        done, row = until, StageRow(keep.stage, until, mean, time.perf_counter() - begun)
        keep.save(run, done, row)
        keep.report(row, done, stage.updates)
    return run.fitted


def _rounds(done: int, updates: int) -> Iterator[int]:
    while done < updates:
        done = min(done + ROUND, updates)
        yield done


def _take(tree: Any, which: Any) -> Any:
    return jax.tree.map(lambda x: x[which], tree)

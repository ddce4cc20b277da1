"""The stages of fitting a model that solves for equilibrium: its law, its network, its stresses.

Each makes a loss at the true poses small (see `balance`), and can be stopped and gone on with.
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

from simulearn.dataset import Batch
from simulearn.errors import ComputationError, InputError
from simulearn.learn import checkpoint, local, stresses
from simulearn.learn.balance import loss, misses
from simulearn.learn.config import Stage
from simulearn.learn.shapes import Parameters, elastic, first
from simulearn.learn.truth import Truth, truth
from simulearn.material import Material
from simulearn.mechanics.forces import State
from simulearn.mechanics.poses import Array
from simulearn.mechanics.rollout import RELEASED, elements, every_frame, loads
from simulearn.mechanics.section import Law, first_guess

# How far each property of the law may be expected to go from the first guess.
STEP = Law(0.01, 0.01, 0.01, 0.01, 0.02, 0.01, 0.01, 0.01, 0.3, 0.3)  # type: ignore[arg-type]
ROUND = 250  # updates between two checkpoints
LATE = 0.3  # of the examples are of the last two frames
AT_ONCE = 50  # trials whose first shapes are found together


@dataclass(frozen=True)
class Row:
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


class Run(NamedTuple):
    """What changes in the course of a stage."""

    fitted: Any
    optimiser: Any


class Examples(NamedTuple):
    """Trials with their first shapes, and their stresses in the axes of halves."""

    trials: Truth
    begun: Any
    twist: Any
    stress: Any


Tell = Callable[[Row | None, int, int], None]


def fit_law(batch: Batch, material: Material, stage: Stage, seed: int, keep: "Keeper") -> Law:
    """Return the law of the section that fits trials best."""
    load, trials = loads(material), truth(batch, material)
    guess = first_guess()
    whole = lambda moved: jax.tree.map(lambda a, b, c: a + b * c, guess, STEP, moved)  # noqa: E731

    def value(moved: Law, some: Truth, frame: Array) -> Array:
        parameters = Parameters(whole(moved))
        off = jax.vmap(lambda t, f: misses(parameters, load, t, f, None, None))(some, frame)  # type: ignore[arg-type]
        return jax.vmap(loss)(*off, some.size, jnp.array(RELEASED)[frame]).mean()

    zero = jax.tree.map(jnp.zeros_like, guess)
    draw = lambda k, f: (_take(trials, k), f)  # noqa: E731
    fitted = descend(zero, value, draw, stage, len(batch), seed, keep)
    return whole(fitted)


def fit_network(
    law: Law,
    examples: Examples,
    material: Material,
    begin: local.Weights,
    stage: Stage,
    seed: int,
    keep: "Keeper",
    whole: bool = False,
) -> local.Weights:
    """Return the network that corrects a law; see `misses` for `whole`."""
    load = loads(material)

    def value(network: local.Weights, some: Truth, frame: Array, begun: Any, twist: Any) -> Array:
        parameters = Parameters(law, network)
        one = lambda t, f, b, w: misses(parameters, load, t, f, b, w, whole)  # noqa: E731
        off = jax.vmap(one)(some, frame, begun, twist)
        return jax.vmap(loss)(*off, some.size, jnp.array(RELEASED)[frame]).mean()

    def draw(k: np.ndarray, f: np.ndarray) -> tuple[Any, ...]:
        begun = jax.tree.map(lambda x: x[k, f], examples.begun)
        return _take(examples.trials, k), f, begun, examples.twist[k, f]

    return descend(begin, value, draw, stage, len(examples.twist), seed, keep)


def fit_stress(
    law: Law,
    examples: Examples,
    material: Material,
    begin: local.Weights,
    stage: Stage,
    seed: int,
    keep: "Keeper",
) -> local.Weights:
    """Return the network that tells stresses from true poses."""
    load = loads(material)

    def value(network: local.Weights, some: Truth, frame: Array, stress: Array) -> Array:
        def one(t: Truth, f: Array, true: Array) -> Array:
            s, gravity = jnp.array(RELEASED)[f], load.gravity[f]
            state = jax.tree.map(lambda x: x[f], t.state)
            bare = elements(law, t.bones, t.plan, t.ratio, load, s, gravity)
            own = elastic(network, t.bones, t.plan, t.ratio, bare, state, s, gravity)
            return jnp.sqrt((((own - true) / 0.01) ** 2).sum(-1) + 0.01).mean()

        return jax.vmap(one)(some, frame, stress).mean()

    def draw(k: np.ndarray, f: np.ndarray) -> tuple[Any, ...]:
        return _take(examples.trials, k), f, examples.stress[k, f]

    return descend(begin, value, draw, stage, len(examples.twist), seed, keep)


def examples_of(law: Law, batch: Batch, material: Material) -> Examples:
    """Return trials with their first shapes; those that have none are left out."""
    load, trials = loads(material), truth(batch, material)

    def one(t: Truth) -> tuple[State, Array, Array]:
        return first(t.bones, t.plan, every_frame(law, t.bones, t.plan, t.ratio, load))

    find = jax.jit(jax.vmap(one))
    parts = []
    for a in range(0, len(batch), AT_ONCE):
        which = np.arange(a, a + AT_ONCE) % len(batch)
        parts.append(jax.tree.map(np.asarray, find(_take(trials, which))))
    begun, twist, ways = jax.tree.map(lambda *x: np.concatenate(x)[: len(batch)], *parts)
    good = ways.max(axis=1) < 0.05
    own = np.zeros(0)
    if batch.stress is not None:
        printed = jax.vmap(lambda t: stresses.printed(material, t.plan, t.ratio))(trials)
        fraction = 1 - jnp.array(RELEASED)
        local_of = jax.jit(
            jax.vmap(
                lambda t, sigma, first: jax.vmap(
                    lambda state, x, s: stresses.in_halves(t.bones, t.plan, state, x) - s * first
                )(t.state, sigma, fraction)
            )
        )
        pieces = [
            np.asarray(local_of(_take(trials, k), batch.stress[k, 1:], printed[k]), np.float32)
            for k in np.array_split(np.arange(len(batch)), max(1, len(batch) // AT_ONCE))
        ]
        own = np.concatenate(pieces)[good]
    keep = lambda x: np.asarray(x)[good]  # noqa: E731
    return Examples(jax.tree.map(keep, trials), jax.tree.map(keep, begun), twist[good], own)


class Keeper:
    """Keeps checkpoints of a stage and tells how far it is.

    Args:
        stage: its name.
        path: of the stage's checkpoint, or None.
        identity: of the run; a checkpoint of another is refused.
        tell: called with (row, updates done, updates in all).
    """

    def __init__(
        self,
        stage: str,
        path: Path | None = None,
        identity: str = "",
        tell: Tell = lambda row, done, total: None,
    ) -> None:
        self.stage, self.path, self.identity, self.tell = stage, path, identity, tell
        self.rows: list[Row] = []

    def load(self, run: Run) -> tuple[Run, int]:
        """Return the run as it was last kept, and its updates.

        Raises:
            InputError: the checkpoint is of another run.
        """
        if self.path is None or not self.path.exists():
            return run, 0
        told = checkpoint.told(self.path)
        if told.get("identity") != self.identity or told.get("stage") != self.stage:
            raise InputError(
                f"{self.path}: is of another run (its configuration or data differ); name another "
                "folder, or delete it to begin anew"
            )
        self.rows = [Row(**row) for row in told["rows"]]
        return checkpoint.load(self.path, run), int(told["done"])

    def save(self, run: Run, done: int, row: Row) -> None:
        """Keep a run after a round."""
        self.rows.append(row)
        if self.path is not None:
            told = {"identity": self.identity, "stage": self.stage, "done": done}
            checkpoint.save(self.path, run, {**told, "rows": [asdict(r) for r in self.rows]})


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
    def update(run: Run, *args: Any) -> tuple[Run, Array]:
        told, slope = jax.value_and_grad(value)(run.fitted, *args)
        moves, state = optimiser.update(slope, run.optimiser)
        return Run(optax.apply_updates(run.fitted, moves), state), told

    run, done = keep.load(Run(begin, optimiser.init(begin)))
    name = sum(keep.stage.encode())
    for until in _rounds(done, stage.updates):
        begun, told = time.perf_counter(), []
        for k in range(done, until):
            rng = np.random.default_rng([seed, name, k])
            which = rng.integers(trials, size=stage.batch)
            frame = rng.integers(11, size=stage.batch)
            late = rng.random(stage.batch) < LATE
            frame = np.where(late, rng.integers(9, 11, size=stage.batch), frame)
            run, now = update(run, *draw(which, frame))
            told.append(now)
            keep.tell(None, k + 1, stage.updates)
        mean = float(np.mean(np.asarray(jnp.stack(told))))
        if not np.isfinite(mean):
            raise ComputationError(
                f"{keep.stage}: the loss is not finite; lower its rate ({stage.rate:g})"
            )
        done, row = until, Row(keep.stage, until, mean, time.perf_counter() - begun)
        keep.save(run, done, row)
        keep.tell(row, done, stage.updates)
    return run.fitted


def _rounds(done: int, updates: int) -> Iterator[int]:
    while done < updates:
        done = min(done + ROUND, updates)
        yield done


def _take(tree: Any, which: Any) -> Any:
    return jax.tree.map(lambda x: x[which], tree)

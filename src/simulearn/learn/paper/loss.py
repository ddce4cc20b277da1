"""What training makes small: the distance to the trials, and the dislocation of joints and beams.

Both are squared, in units of the root mean square of an increment, and counted from the states
after k steps that begin at true frames, disturbed by noise in proportion to what has happened so
far: N(0, gamma^2) (G_t - G_0). Yang et al., SimuLearn, UIST 2020, loss function and training.
"""

from dataclasses import dataclass
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from numpy.typing import NDArray

from simulearn.dataset import Batch
from simulearn.dataset.features import end_modes, touching
from simulearn.learn.paper.graph import Graph, Meetings, graph_of, meetings
from simulearn.learn.paper.model import STEPS, Paper, roll
from simulearn.learn.paper.state import GraphState


class Examples(NamedTuple):
    """Trials in the form of training; frames first, then elements, then trials.

    Attributes:
        frames: the state in all 12 frames: (12, J, T, 24), (12, B, T, 36), (12, B, T, 96).
        ratio: (B, T, 1) actuators.
        meet: adjacency modes of the pairs.
        touch: (B, 2, T, 4, 8) which corner of a joint each corner of a beam's end touches.
        weight: (T,) of each trial.
    """

    frames: GraphState
    ratio: Array
    meet: Meetings
    touch: Array
    weight: Array


@dataclass(frozen=True, eq=False)
class Prepared:
    """Trials of one topology, ready to be drawn from.

    Attributes:
        batch: the trials.
        modes: (T, B, 2) adjacency modes of the beams' ends.
        shape: the topology.
        ends: (2 B, J) incidence of the beams' ends on joints.
    """

    batch: Batch
    modes: NDArray[np.int64]
    shape: Graph
    ends: Array

    @classmethod
    def of(cls, batch: Batch) -> "Prepared":
        """Return trials with their modes."""
        joints = batch.flat.shape[1]
        return cls(
            batch,
            end_modes(batch),
            graph_of(batch.beams, joints, batch.fixed),
            jnp.asarray(np.eye(joints, dtype=np.float32)[batch.beams.ravel()]),
        )

    def examples(self, which: NDArray[np.int64], size: float) -> Examples:
        """Return some of the trials; errors count relative to dimension over size (mm)."""
        batch, modes = self.batch.take(which), self.modes[which]
        assert batch.stress is not None

        def put(x: NDArray[np.float32]) -> Array:
            flat = x.reshape(*x.shape[:3], -1).transpose(1, 2, 0, 3)
            return jnp.asarray(np.ascontiguousarray(flat, np.float32))

        return Examples(
            GraphState(put(batch.joints), put(batch.sections), put(batch.stress)),
            jnp.asarray(batch.actuators.T[..., None], jnp.float32),
            meetings(batch.beams, modes),
            jnp.asarray(np.eye(8, dtype=np.float32)[touching(modes).transpose(1, 2, 0, 3)]),
            jnp.asarray((size / batch.dimensions) ** 2, jnp.float32),
        )


class LossWeights(NamedTuple):
    """What counts how much.

    Attributes:
        noise: gamma, the standard deviation of the noise in parts of the cumulative update.
        penalty: of dislocation, the paper's a.
        stress: of the stresses among the features.
    """

    noise: Array
    penalty: Array
    stress: Array


def dislocation(joints: Array, sections: Array, touch: Array, ends: Array) -> Array:
    """Return the vectors from joint corners to the beam corners that touch them.

    Args:
        joints: (J, T, 24) mm.
        sections: (B, T, 36) mm.
        touch: (B, 2, T, 4, 8) incidence: which corner of the joint.
        ends: (2 B, J) incidence: which joint.

    Returns:
        (B, 2, T, 4, 3) mm.
    """
    trials = joints.shape[1]
    there = (ends @ joints.reshape(len(joints), -1)).reshape(-1, 2, trials, 8, 3)
    corners = sections.reshape(-1, trials, 3, 4, 3)
    here = jnp.stack([corners[:, :, 0], corners[:, :, 2]], axis=1)
    return here - jnp.einsum("betkc,betcx->betkx", touch, there)


def loss(
    model: Paper,
    examples: Examples,
    shape: Graph,
    ends: Array,
    weights: LossWeights,
    unroll: int,
    key: Array,
) -> tuple[Array, Array]:
    """Return the loss, and its parts: release, creep, stress, dislocation.

    Args:
        model: the simulator.
        examples: T trials.
        shape: their topology.
        ends: (2 B, J) incidence of the beams' ends on joints.
        weights: what counts how much.
        unroll: steps k from a true frame on; ten is all of the first stage, and then the second
            begins where the first has come to.
        key: of the noise.
    """
    windows = STEPS // unroll
    frames = examples.frames
    keys = jax.random.split(key, 2)
    starts = jax.tree.map(lambda x: x[:STEPS:unroll][:windows], frames)
    begin = _noisy(starts, frames, weights.noise, keys[0])
    flat = jax.tree.map(_side_by_side, begin)  # windows and trials in one axis

    def many(x: Array, axis: int) -> Array:
        return jnp.concatenate([x] * windows, axis=axis)

    meet = jax.tree.map(lambda x: many(x, 1), examples.meet)
    predicted = roll(model.release, flat, unroll, many(examples.ratio, 1), shape, meet)

    # Window w, step k is frame w unroll + k + 1.
    def true(x: Array) -> Array:
        x = x[1 : STEPS + 1].reshape(windows, unroll, *x.shape[1:])
        return jax.vmap(_side_by_side, in_axes=1)(x)

    wanted = jax.tree.map(true, frames)
    weight = jnp.tile(examples.weight, windows)
    norm = model.release.normalisers
    size, of_stress = jax.lax.stop_gradient(norm.unit)
    off = jax.tree.map(lambda a, b: a - b, predicted, wanted)
    release = _mean(off.joints / size, weight) + _mean(off.sections / size, weight)
    stress = _mean(off.stress / of_stress, weight)

    if unroll == STEPS:
        before = jax.tree.map(lambda x: x[-1], predicted).plain
    else:
        tenth = jax.tree.map(lambda x: x[STEPS : STEPS + 1], frames)
        noisy = _noisy(tenth, frames, weights.noise, keys[1])
        before = jax.tree.map(_side_by_side, noisy).plain
    crept = model.creep(before, examples.ratio, shape, examples.meet)
    last = jax.tree.map(lambda x: x[STEPS + 1], frames)
    creep = _mean((crept.joints - last.joints) / size, examples.weight) + _mean(
        (crept.sections - last.sections) / size, examples.weight
    )

    apart = jax.vmap(dislocation, in_axes=(0, 0, None, None))(
        predicted.joints, predicted.sections, many(examples.touch, 2), ends
    )
    gaps = dislocation(crept.joints, crept.sections, examples.touch, ends)
    # Trials lie third from the end; the shares of windows and of creep are those of its frames.
    split = (STEPS * ((apart / size) ** 2).mean() + ((gaps / size) ** 2).mean()) / (STEPS + 1)
    total = (
        (STEPS * release + creep) / (STEPS + 1) + weights.stress * stress + weights.penalty * split
    )
    return total, jnp.stack([release, creep, stress, split])


def _side_by_side(x: Array) -> Array:
    """Return (W, N, T, n) as (N, W T, n)."""
    return x.swapaxes(0, 1).reshape(x.shape[1], -1, x.shape[-1])


def _noisy(states: GraphState, frames: GraphState, gamma: Array, key: Array) -> GraphState:
    """Return states (W, N, T, n) with noise in proportion to what happened since frame 0."""
    keys = GraphState(*jax.random.split(key, 3))
    return GraphState(
        *(
            x + gamma * (x - first[:1]) * jax.random.normal(k, x.shape, jnp.float32)
            for x, first, k in zip(states, frames, keys, strict=True)
        )
    )


def _mean(x: Array, weight: Array) -> Array:
    """Return the weighted mean square over (..., N, T, n)."""
    return (x**2 * weight[:, None]).mean()

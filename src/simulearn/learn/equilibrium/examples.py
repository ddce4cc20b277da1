"""Trials made ready to be learnt from: stacked by size, with their first shapes and stresses."""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray

from simulearn.compiled import double_precision
from simulearn.dataset import Batch
from simulearn.files import cores
from simulearn.grid.outline import corner_topology
from simulearn.learn.equilibrium import stresses
from simulearn.learn.equilibrium.reference import (
    TrialPoses,
    bucket_of,
    buckets,
    filled,
    joined,
    trial_poses,
)
from simulearn.mechanics.forces import BeamState
from simulearn.mechanics.model import SectionLaw, section_of
from simulearn.mechanics.path import coefficients, grid_of, schedule_frames, trace
from simulearn.mechanics.poses import Array, Pose
from simulearn.mechanics.properties import Properties
from simulearn.mechanics.rollout import RELEASED

AT_ONCE = 50  # trials whose stresses are turned together


class StageExamples(NamedTuple):
    """Trials of one size with their first shapes, their stresses in the axes of halves, odds."""

    trials: TrialPoses
    begun: Any
    twist: Any
    stress: Any
    weight: Any


@double_precision
def examples_of(
    batches: Sequence[Batch],
    law: SectionLaw | None = None,
    like: Sequence[StageExamples] = (),
    often: float = 1.0,
) -> list[StageExamples]:
    """Return trials by size, with their first shapes where a law is given.

    Those that snap, and those that have no first shape, are left out.

    Args:
        batches: by topology.
        law: of sections.
        like: further examples, whose sizes are used again as far as there is room in them.
        often: how many times as often these trials are drawn as others.
    """
    batches = [
        part for b in batches if len(part := b.take(~np.array(b.snapped or [False] * len(b))))
    ]
    sizes = [(b.flat.shape[1], len(b.beams)) for b in batches for _ in range(len(b))]
    rooms = [(x.trials.real.shape[1], x.trials.ratio.shape[1]) for x in like]
    rooms += buckets(sizes)
    parts: list[list[StageExamples]] = [[] for _ in rooms]
    for batch in batches:
        room = bucket_of((batch.flat.shape[1], len(batch.beams)), rooms)
        parts[room].append(_examples(batch, law, rooms[room], often))
    whole = [joined(some) for some in parts if sum(len(x.weight) for x in some)]
    if law is None:
        return whole
    return [some._replace(stress=_elastic(some)) for some in whole]


def _examples(
    batch: Batch, law: SectionLaw | None, room: tuple[int, int], often: float
) -> StageExamples:
    trials = trial_poses(batch)
    weight = np.full(len(batch), often)
    if law is None:
        none = np.zeros((len(batch), 0))
        return StageExamples(filled(trials, *room), none, none, none, weight)
    begun, twist, ended = first_shapes(batch, trials, law)
    whole = filled(trials._replace(state=begun), *room)
    extra = room[1] - twist.shape[3]

    def grown(x: Any, axis: int) -> Any:
        return np.pad(x, [(0, extra if k == axis else 0) for k in range(x.ndim)])

    examples = StageExamples(
        whole._replace(state=filled(trials, *room).state),
        whole.state,
        grown(twist, 3),
        np.zeros((len(batch), 0)) if batch.stress is None else grown(batch.stress[:, 1:], 2),
        weight,
    )
    return jax.tree.map(lambda x: np.asarray(x)[ended], examples)


def first_shapes(
    batch: Batch, trials: TrialPoses, law: SectionLaw
) -> tuple[BeamState, NDArray[np.float64], NDArray[np.bool_]]:
    """Return the shapes of trials by a law alone in frames 1 to 11, twists, and which have them."""
    count, joints, beams = len(batch), batch.flat.shape[1], len(batch.beams)
    R: Any = np.tile(np.eye(3), (count, 11, joints + beams, 1, 1))
    p: Any = np.zeros((count, 11, joints + beams, 3))
    twist, ended = np.zeros((count, 11, 2, beams, 6)), np.zeros(count, np.bool_)
    corners = corner_topology(batch.beams, batch.flat)

    def one(t: int) -> None:
        own = Properties(*(float(x[t]) for x in trials.properties))
        grid = grid_of(
            batch.beams, batch.fixed, batch.flat[t], batch.actuators[t],
            tuple(x[t] for x in corners), coefficients(section_of(law, own)), own,
        )  # fmt: skip
        path = trace(grid, schedule_frames(beams, own.creep))
        ended[t] = path.ended and not path.snaps
        if ended[t]:
            R[t], p[t] = path.R[1:].reshape(R[t].shape), path.p[1:]
            twist[t] = path.twists[1:]

    with ThreadPoolExecutor(cores()) as pool:
        list(pool.map(one, range(count)))
    ends = Pose(R[:, :, :joints], p[:, :, :joints])
    middles = Pose(R[:, :, joints:], p[:, :, joints:])
    return BeamState(ends, middles), twist, ended


def _elastic(examples: StageExamples) -> Any:
    """Return the elastic stresses (T, 11, 2, B, 2, 4, 6) in the halves' axes, MPa, if there are."""
    if examples.stress.ndim == 2:
        return examples.stress
    fraction = 1 - jnp.array(RELEASED)

    def one(t: TrialPoses, sigma: Array) -> Array:
        first = stresses.printed(t.properties, t.geometry, t.ratio)
        return jax.vmap(
            lambda state, x, s: stresses.in_halves(t.topology, t.geometry, state, x) - s * first
        )(t.state, sigma, fraction)

    find, count, parts = jax.jit(jax.vmap(one)), len(examples.weight), []
    for begin in range(0, count, AT_ONCE):
        which = np.arange(begin, begin + AT_ONCE) % count
        parts.append(
            np.asarray(find(take(examples.trials, which), examples.stress[which]), np.float32)
        )
    return np.concatenate(parts)[:count]


def take(tree: Any, which: Any) -> Any:
    """Return some of the trials of a tree of arrays."""
    return jax.tree.map(lambda x: x[which], tree)

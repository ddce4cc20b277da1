"""What a model is fitted to: the poses of joints and middles in finite-element trials."""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from simulearn.dataset import Batch
from simulearn.material import Material
from simulearn.mechanics.corners import poses_of
from simulearn.mechanics.forces import State
from simulearn.mechanics.poses import Array, Pose
from simulearn.mechanics.skeleton import Flat, Skeleton, flat, skeletons


class Truth(NamedTuple):
    """Trials, T of them, frames 1 to 11.

    Attributes:
        bones, plan: (T, ...) the flat grids.
        ratio: (T, B) signed actuator ratios.
        size: (T,) grid dimension, mm.
        state: (T, 11, ...) poses of joints and middles.
        joints: (T, 11, J, 8, 3) corners in the joints' own axes, mm.
        middles: (T, 11, B, 4, 3) corners of the middle sections in theirs, mm.
    """

    bones: Skeleton
    plan: Flat
    ratio: Array
    size: Array
    state: State
    joints: Array
    middles: Array


def truth(batch: Batch, material: Material) -> Truth:
    """Return trials as mechanics sees them."""
    bones = jax.tree.map(jnp.asarray, skeletons(batch.beams, batch.fixed, batch.flat))
    plan = jax.jit(jax.vmap(lambda b, j: flat(b, j, material.section)))(
        bones, jnp.asarray(batch.flat)
    )
    joints, sections = (
        batch.joints[:, 1:].astype(np.float64),
        batch.sections[:, 1:, :, 1].astype(np.float64),
    )
    R, p = poses_of(joints, np.asarray(plan.corners)[:, None])
    # The fixed joint stays; what of it moves is its warping.
    R[:, :, batch.fixed] = np.eye(3)
    p[:, :, batch.fixed] = np.asarray(plan.centre)[:, None, batch.fixed]
    Rm, pm = poses_of(sections, np.asarray(plan.section)[:, None])
    own = lambda R, p, x: np.einsum("tfjik,tfjci->tfjck", R, x - p[:, :, :, None])  # noqa: E731
    return Truth(
        bones,
        plan,
        jnp.asarray(batch.actuators),
        jnp.asarray(batch.dimensions),
        State(Pose(jnp.asarray(R), jnp.asarray(p)), Pose(jnp.asarray(Rm), jnp.asarray(pm))),
        jnp.asarray(own(R, p, joints)),
        jnp.asarray(own(Rm, pm, sections)),
    )

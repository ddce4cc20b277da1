"""What a model is fitted to: the poses of joints and middles in finite-element trials."""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from simulearn.compiled import double_precision
from simulearn.dataset import Batch
from simulearn.material import Material
from simulearn.mechanics.forces import BeamState
from simulearn.mechanics.poses import Array, Pose
from simulearn.mechanics.topology import FlatGeometry, Topology, flat_geometry, topologies
from simulearn.rigid import fit_rotation


class TrialPoses(NamedTuple):
    """Trials, T of them, frames 1 to 11.

    Attributes:
        topology, geometry: (T, ...) the flat grids.
        ratio: (T, B) signed actuator ratios.
        size: (T,) grid dimension, mm.
        state: (T, 11, ...) poses of joints and middles.
        joints: (T, 11, J, 8, 3) corners in the joints' own axes, mm.
        middles: (T, 11, B, 4, 3) corners of the middle sections in theirs, mm.
    """

    topology: Topology
    geometry: FlatGeometry
    ratio: Array
    size: Array
    state: BeamState
    joints: Array
    middles: Array


@double_precision
def trial_poses(batch: Batch, material: Material) -> TrialPoses:
    """Return trials as mechanics sees them."""
    topology = jax.tree.map(jnp.asarray, topologies(batch.beams, batch.fixed, batch.flat))
    geometry = jax.jit(jax.vmap(lambda b, j: flat_geometry(b, j, material.section)))(
        topology, jnp.asarray(batch.flat)
    )
    joints, sections = (
        batch.joints[:, 1:].astype(np.float64),
        batch.sections[:, 1:, :, 1].astype(np.float64),
    )
    R, p = fit_rotation(joints, np.asarray(geometry.corners)[:, None])
    # The fixed joint stays; what of it moves is its warping.
    R[:, :, batch.fixed] = np.eye(3)
    p[:, :, batch.fixed] = np.asarray(geometry.centre)[:, None, batch.fixed]
    Rm, pm = fit_rotation(sections, np.asarray(geometry.section)[:, None])

    def own(R: Any, p: Any, x: Any) -> Any:
        return np.einsum("tfjik,tfjci->tfjck", R, x - p[:, :, :, None])

    return TrialPoses(
        topology,
        geometry,
        jnp.asarray(batch.actuators),
        jnp.asarray(batch.dimensions),
        BeamState(Pose(jnp.asarray(R), jnp.asarray(p)), Pose(jnp.asarray(Rm), jnp.asarray(pm))),
        jnp.asarray(own(R, p, joints)),
        jnp.asarray(own(Rm, pm, sections)),
    )

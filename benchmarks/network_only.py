"""A network without mechanics, to compare with: the default model's, asked for poses instead.

Every half-beam predicts how its joint and its middle have moved and turned, in its own axes; the
predictions of the halves at a joint are averaged. In place of strains, which only mechanics knows,
the network is given where its joint lies relative to the fixed one.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from simulearn.dataset import Batch
from simulearn.learn.common.model import Designs, Frames
from simulearn.learn.equilibrium import corrector
from simulearn.learn.equilibrium.compiled import first_frame
from simulearn.learn.equilibrium.config import Stage
from simulearn.learn.equilibrium.examples import StageExamples
from simulearn.learn.equilibrium.first_order import loss
from simulearn.learn.equilibrium.parameters import (
    TWIST_FLIP,
    TWIST_MIRROR,
    TWIST_SIZE,
    NetworkWeights,
    joined,
    signed,
)
from simulearn.learn.equilibrium.prediction import plain
from simulearn.learn.equilibrium.reference import TrialPoses, trial_poses
from simulearn.learn.equilibrium.stages import Keeper, descend
from simulearn.material import load_material
from simulearn.mechanics.corners import local_corners, placed
from simulearn.mechanics.forces import BeamState
from simulearn.mechanics.model import section_of, unfitted
from simulearn.mechanics.poses import Array, Pose, exp_so3
from simulearn.mechanics.properties import properties_of
from simulearn.mechanics.rollout import RELEASED, loads, start
from simulearn.mechanics.topology import FlatGeometry, Topology, flat_geometry, topologies

USUAL = np.array([20, 20, 20, 0.5, 0.5, 0.5])  # mm, rad: how far things move and turn
POSES = joined(
    signed(TWIST_MIRROR, TWIST_FLIP, USUAL),
    signed(TWIST_MIRROR, TWIST_FLIP, USUAL),
)
FAR = 50.0  # mm, what is usual
MATERIAL = load_material("pla-hot-water")
PROPERTIES = properties_of(MATERIAL, 0.0)
SECTION = section_of(unfitted(), PROPERTIES)
LOAD = loads(PROPERTIES)


def poses(
    weights: NetworkWeights,
    topology: Topology,
    geometry: FlatGeometry,
    ratio: Array,
    s: Array,
    gravity: Array,
) -> BeamState:
    """Return the poses that the network predicts for one frame."""
    away = geometry.centre[topology.ends] - geometry.centre[topology.fixed]
    away = jnp.einsum("hbji,hbj->hbi", geometry.frame, away) / FAR
    place = jnp.concatenate([away, jnp.zeros_like(away)], -1) * TWIST_SIZE
    features = corrector.features_of(
        topology, geometry, ratio, start(geometry), place, s, gravity, PROPERTIES
    )
    predicted = corrector.outputs(weights, topology, features, POSES)
    predicted = jnp.einsum(
        "hbij,hbkj->hbki", geometry.frame, predicted.reshape(*predicted.shape[:-1], 4, 3)
    )  # shift, turn; of joint, of middle
    total = jnp.zeros((len(geometry.centre), 2, 3)).at[topology.ends].add(predicted[:, :, :2])
    count = jnp.zeros(len(geometry.centre)).at[topology.ends].add(1.0)
    joint = (total / count[:, None, None]).at[topology.fixed].set(0.0)
    middle = predicted[:, :, 2:].mean(0)
    return BeamState(
        Pose(exp_so3(joint[:, 1]), geometry.centre + joint[:, 0]),
        Pose(exp_so3(middle[:, 1]) @ geometry.frame[0], geometry.middle + middle[:, 0]),
    )


def _placed(at: Pose, own: Array) -> Array:
    return jnp.einsum("kij,kcj->kci", at.R, own) + at.p[:, None]


def _own(topology: Topology, geometry: FlatGeometry, s: Array) -> tuple[Array, Array]:
    warps = plain(topology.ends.shape[1])
    return local_corners(SECTION, topology, geometry, s, warps.face, warps.middle)


def fit_network_only(
    batch: Batch, sizes: tuple[int, int, int], stage: Stage, seed: int, keep: Keeper
) -> "NetworkOnly":
    """Return a network fitted to trials."""
    trials = trial_poses(batch)
    released, gravity = jnp.array(RELEASED), LOAD.gravity

    def one(weights: NetworkWeights, t: TrialPoses, f: Array) -> Array:
        s = released[f]
        predicted = poses(weights, t.topology, t.geometry, t.ratio, s, gravity[f])
        true = jax.tree.map(lambda x: x[f], t.state)
        own = _own(t.topology, t.geometry, s)
        joints = _placed(predicted.joints, own[0]) - _placed(true.joints, t.joints[f])
        middles = _placed(predicted.middles, own[1]) - _placed(true.middles, t.middles[f])
        counts = t.real, t.topology.real
        return loss(joints.at[t.topology.fixed, :4].set(0.0), middles, t.size, s, counts)

    def value(weights: NetworkWeights, some: TrialPoses, frame: Array) -> Array:
        return jax.vmap(lambda t, f: one(weights, t, f))(some, frame).mean()

    def draw(some: StageExamples, k: np.ndarray, f: np.ndarray) -> tuple[Any, ...]:
        return jax.tree.map(lambda x: x[k], some.trials), f

    begin = corrector.initial_weights(jax.random.key(seed), POSES, *sizes)
    examples = [StageExamples(trials, None, None, None, np.ones(len(batch)))]
    return NetworkOnly(descend(begin, value, draw, stage, examples, seed, keep))


@dataclass(frozen=True, eq=False)
class NetworkOnly:
    """A model by a network alone.

    Attributes:
        weights: fitted.
    """

    weights: NetworkWeights
    kind: str = "network"

    @cached_property
    def _kernel(self) -> Any:
        def one(topology: Topology, joints: Array, ratio: Array) -> tuple[Array, Array]:
            geometry = flat_geometry(topology, joints, PROPERTIES)

            def frame(s: Array, gravity: Array) -> tuple[Array, Array]:
                state = poses(self.weights, topology, geometry, ratio, s, gravity)
                return placed(topology, geometry, state, *_own(topology, geometry, s))

            later = jax.vmap(frame)(jnp.array(RELEASED), LOAD.gravity)
            before = first_frame(SECTION, topology, geometry)
            joined: tuple[Array, Array] = jax.tree.map(
                lambda a, b: jnp.concatenate([a[None], b]), tuple(before), later
            )
            return joined

        return jax.jit(jax.vmap(one))

    def rollout(self, designs: Designs) -> Frames:
        """Return the twelve frames of designs of one topology."""
        topology = topologies(designs.beams, designs.fixed, designs.flat)
        joints, sections = self._kernel(topology, designs.flat, designs.actuators)
        good = np.ones(len(designs), bool)
        return Frames(np.asarray(joints), np.asarray(sections), None, None, good)

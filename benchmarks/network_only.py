"""A network without mechanics, to compare with: the default model's, asked for poses instead.

Every half of a beam tells how its joint and its middle have moved and turned, in its own axes; what
the halves at a joint tell is averaged. In place of strains, which only mechanics tells, the network
sees where its joint lies as seen from the fixed one.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from simulearn.dataset import Batch
from simulearn.learn import local
from simulearn.learn.balance import loss
from simulearn.learn.config import Stage
from simulearn.learn.equilibrium import first_frame
from simulearn.learn.model import Designs, Frames
from simulearn.learn.shapes import Parameters, plain
from simulearn.learn.stages import Keeper, descend
from simulearn.learn.truth import Truth, truth
from simulearn.material import load_material
from simulearn.mechanics.corners import local_corners, placed
from simulearn.mechanics.forces import State
from simulearn.mechanics.poses import Array, Pose, exp_so3
from simulearn.mechanics.rollout import RELEASED, loads, start
from simulearn.mechanics.section import first_guess
from simulearn.mechanics.skeleton import Flat, Skeleton, flat, skeletons

USUAL = np.array([20, 20, 20, 0.5, 0.5, 0.5])  # mm, rad: how far things move and turn
POSES = local.joined(
    local.signed(local.TWIST_MIRROR, local.TWIST_FLIP, USUAL),
    local.signed(local.TWIST_MIRROR, local.TWIST_FLIP, USUAL),
)
FAR = 50.0  # mm, what is usual
MATERIAL = load_material("pla-hot-water")
LOAD = loads(MATERIAL)


def poses(
    weights: local.Weights, bones: Skeleton, plan: Flat, ratio: Array, s: Array, gravity: Array
) -> State:
    """Return the poses that the network tells for one frame."""
    away = plan.centre[bones.ends] - plan.centre[bones.fixed]
    away = jnp.einsum("hbji,hbj->hbi", plan.frame, away) / FAR
    place = jnp.concatenate([away, jnp.zeros_like(away)], -1) * local.TWIST_SIZE
    seen = local.look(bones, plan, ratio, start(plan), place, s, gravity)
    told = local.spoken(weights, bones, seen, POSES)
    turned = lambda x: jnp.einsum("hbij,hbkj->hbki", plan.frame, x)  # noqa: E731
    told = turned(told.reshape(*told.shape[:-1], 4, 3))  # shift, turn; of joint, of middle
    total = jnp.zeros((len(plan.centre), 2, 3)).at[bones.ends].add(told[:, :, :2])
    count = jnp.zeros(len(plan.centre)).at[bones.ends].add(1.0)
    joint = (total / count[:, None, None]).at[bones.fixed].set(0.0)
    middle = told[:, :, 2:].mean(0)
    return State(
        Pose(exp_so3(joint[:, 1]), plan.centre + joint[:, 0]),
        Pose(exp_so3(middle[:, 1]) @ plan.frame[0], plan.middle + middle[:, 0]),
    )


def _own(bones: Skeleton, plan: Flat, s: Array) -> tuple[Array, Array]:
    warps = plain(bones.ends.shape[1])
    return local_corners(first_guess(), bones, plan, s, warps.face, warps.middle)


def fit_network_only(
    batch: Batch, sizes: tuple[int, int, int], stage: Stage, seed: int, keep: Keeper
) -> "NetworkOnly":
    """Return a network fitted to trials."""
    trials = truth(batch, MATERIAL)
    released, gravity = jnp.array(RELEASED), LOAD.gravity

    def one(weights: local.Weights, t: Truth, f: Array) -> Array:
        s = released[f]
        told = poses(weights, t.bones, t.plan, t.ratio, s, gravity[f])
        true = jax.tree.map(lambda x: x[f], t.state)
        put = lambda at, own: jnp.einsum("kij,kcj->kci", at.R, own) + at.p[:, None]  # noqa: E731
        own = _own(t.bones, t.plan, s)
        joints = put(told.joints, own[0]) - put(true.joints, t.joints[f])
        middles = put(told.middles, own[1]) - put(true.middles, t.middles[f])
        return loss(joints.at[t.bones.fixed, :4].set(0.0), middles, t.size, s)

    def value(weights: local.Weights, some: Truth, frame: Array) -> Array:
        return jax.vmap(lambda t, f: one(weights, t, f))(some, frame).mean()

    def draw(k: np.ndarray, f: np.ndarray) -> tuple[Any, ...]:
        return jax.tree.map(lambda x: x[k], trials), f

    begin = local.weights(jax.random.key(seed), POSES, *sizes)
    return NetworkOnly(descend(begin, value, draw, stage, len(batch), seed, keep))


@dataclass(frozen=True, eq=False)
class NetworkOnly:
    """A model by a network alone.

    Attributes:
        weights: fitted.
    """

    weights: local.Weights
    kind: str = "network"

    @cached_property
    def _kernel(self) -> Any:
        def one(bones: Skeleton, joints: Array, ratio: Array) -> tuple[Array, Array]:
            plan = flat(bones, joints, MATERIAL.section)

            def frame(s: Array, gravity: Array) -> tuple[Array, Array]:
                state = poses(self.weights, bones, plan, ratio, s, gravity)
                return placed(bones, plan, state, *_own(bones, plan, s))

            later = jax.vmap(frame)(jnp.array(RELEASED), LOAD.gravity)
            before = first_frame(Parameters(first_guess()), bones, plan)
            joined: tuple[Array, Array] = jax.tree.map(
                lambda a, b: jnp.concatenate([a[None], b]), tuple(before), later
            )
            return joined

        return jax.jit(jax.vmap(one))

    def rollout(self, designs: Designs) -> Frames:
        """Return the twelve frames of designs of one topology."""
        bones = skeletons(designs.beams, designs.fixed, designs.flat)
        joints, sections = self._kernel(bones, designs.flat, designs.actuators)
        good = np.ones(len(designs), bool)
        return Frames(np.asarray(joints), np.asarray(sections), None, None, good)

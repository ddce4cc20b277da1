"""How far a grid of beams is off the true shape, to first order, without solving for its own.

At the true poses the beams are not quite in balance. One Newton step tells where they would go;
that way, with the warping that is missed, is the error of a corner. It can be computed for any
parameters, however bad, and costs no iteration, so it is what models are fitted by.

Gauss-Newton's stiffness always has an answer; the whole stiffness tells the way of slender
grids rightly, once the parameters are good enough to be nearly in balance.
"""

import jax
import jax.numpy as jnp

from simulearn.learn import local
from simulearn.learn.shapes import Parameters, corrected, plain
from simulearn.learn.truth import Truth
from simulearn.mechanics.corners import local_corners
from simulearn.mechanics.forces import State
from simulearn.mechanics.poses import Array, Pose
from simulearn.mechanics.rollout import RELEASED, Loads, elements
from simulearn.mechanics.stiffness import balance, solve

SMALL = 3e-4  # squared % of dimension, below which errors count by their square


def misses(
    parameters: Parameters,
    load: Loads,
    trial: Truth,
    frame: Array,
    begun: State,
    twist: Array,
    whole: bool = False,
) -> tuple[Array, Array]:
    """Return the errors of the corners of joints (J, 8, 3) and middle sections (B, 4, 3), mm.

    Args:
        parameters: law, and network if there is one.
        load: weights.
        trial: one trial.
        frame: 0 to 10, for frames 1 to 11.
        begun: what the law alone gives in that frame; looked at by the network.
        twist: (2, B, 6) of the halves there.
        whole: whether the stiffness of forces that turn counts, where the grid is stable with it.
    """
    bones, plan, ratio = trial.bones, trial.plan, trial.ratio
    s, gravity = jnp.array(RELEASED)[frame], load.gravity[frame]
    el, told = elements(parameters.law, bones, plan, ratio, load, s, gravity), plain(len(ratio))
    if parameters.network is not None:
        seen = local.look(bones, plan, ratio, begun, twist, s, gravity)
        told = local.answer(parameters.network, bones, seen)
        el = corrected(el, told)
    at = jax.tree.map(lambda x: x[frame], trial.state)
    share: Array | float = 0.0
    if whole:
        root = balance(bones, jax.lax.stop_gradient(el), at, 1.0)[1].root
        share = jnp.where(jnp.isfinite(root).all(), 1.0, 0.0)
    joints, middles = solve(bones, *balance(bones, el, at, share))
    own = local_corners(parameters.law, bones, plan, s, told.face, told.middle)

    def off(pose: Pose, step: Array, true: Array, told: Array) -> Array:
        own = lambda x: jnp.einsum("kij,kcj->kci", pose.R, x)  # noqa: E731
        place = pose.p[:, None] + own(true)
        return step[:, None, :3] + jnp.cross(step[:, None, 3:], place) + own(told - true)

    missed = off(at.joints, joints, trial.joints[frame], own[0])
    missed = missed.at[bones.fixed, :4].set(0.0)  # the held corners
    return missed, off(at.middles, middles, trial.middles[frame], own[1])


def loss(joints: Array, middles: Array, size: Array, s: Array) -> Array:
    """Return the loss of a trial's errors: about the mean vertex error in % of its dimension.

    Sections at the ends of beams are faces of joints, so joints count twice. Early frames, whose
    errors are smaller, count more.
    """
    soft = lambda e: jnp.sqrt((e**2).sum(-1) * (100 / size) ** 2 + SMALL).mean()  # noqa: E731
    return (2 * soft(joints) + soft(middles)) / 3 / (0.3 + s)

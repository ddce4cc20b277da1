"""How far a grid of beams is off the true shape, to first order, without solving for its own.

At the true poses the beams are not quite in balance. One Newton step leads to where they would
be; that step, with the warping that is missed, is the error of a corner. It can be computed for any
parameters, however bad, and costs no iteration, so it is what models are fitted by.

Gauss-Newton's stiffness always has an answer; the full tangent is right for slender grids,
once the parameters are good enough to be nearly in balance.
"""

import jax
import jax.numpy as jnp

from simulearn.learn.equilibrium import corrector
from simulearn.learn.equilibrium.parameters import Parameters
from simulearn.learn.equilibrium.prediction import corrected, plain
from simulearn.learn.equilibrium.reference import TrialPoses
from simulearn.mechanics.corners import local_corners
from simulearn.mechanics.forces import BeamState
from simulearn.mechanics.model import section_of
from simulearn.mechanics.poses import Array, Pose
from simulearn.mechanics.rollout import RELEASED, half_beams_at, loads
from simulearn.mechanics.stiffness import balance, solve

SMALL = 3e-4  # squared % of dimension, below which errors count by their square


def first_order_errors(
    parameters: Parameters,
    trial: TrialPoses,
    frame: Array,
    begun: BeamState | None,
    twist: Array | None,
    full: bool = False,
) -> tuple[Array, Array]:
    """Return the errors of the corners of joints (J, 8, 3) and middle sections (B, 4, 3), mm.

    Args:
        parameters: law of sections, and network if there is one.
        trial: one trial.
        frame: 0 to 10, for frames 1 to 11.
        begun: the shape by the section model alone in that frame; the network's features are of it.
        twist: (2, B, 6) of the halves there.
        full: whether the stiffness of forces that turn counts, where the grid is stable with it.
    """
    topology, geometry, ratio, p = trial.topology, trial.geometry, trial.ratio, trial.properties
    section_model, load = section_of(parameters.law, p, jnp), loads(p)
    s, gravity = jnp.array(RELEASED)[frame], load.gravity[frame]
    half_beams = half_beams_at(section_model, topology, geometry, ratio, load, s, gravity)
    corrections = plain(len(ratio))
    if parameters.network is not None:
        assert begun is not None
        assert twist is not None
        features = corrector.features_of(topology, geometry, ratio, begun, twist, s, gravity, p)
        corrections = corrector.corrections(parameters.network, topology, features)
        half_beams = corrected(half_beams, corrections)
    at = jax.tree.map(lambda x: x[frame], trial.state)
    share: Array | float = 0.0
    if full:
        root = balance(topology, jax.lax.stop_gradient(half_beams), at, 1.0)[1].root
        share = jnp.where(jnp.isfinite(root).all(), 1.0, 0.0)
    joints, middles = solve(topology, *balance(topology, half_beams, at, share))
    own = local_corners(section_model, topology, geometry, s, corrections.face, corrections.middle)

    def off(pose: Pose, step: Array, true: Array, predicted: Array) -> Array:
        def own(x: Array) -> Array:
            return jnp.einsum("kij,kcj->kci", pose.R, x)

        place = pose.p[:, None] + own(true)
        return step[:, None, :3] + jnp.cross(step[:, None, 3:], place) + own(predicted - true)

    missed = off(at.joints, joints, trial.joints[frame], own[0])
    missed = missed.at[topology.fixed, :4].set(0.0)  # the held corners
    return missed, off(at.middles, middles, trial.middles[frame], own[1])


def loss(
    joints: Array, middles: Array, size: Array, s: Array, counts: tuple[Array, Array]
) -> Array:
    """Return the loss of a trial's errors: about the mean vertex error in % of its dimension.

    Sections at the ends of beams are faces of joints, so joints count twice. Early frames, whose
    errors are smaller, count more.

    Args:
        joints: (J, 8, 3) errors, mm.
        middles: (B, 4, 3) errors, mm.
        size: of the grid, mm.
        s: released fraction.
        counts: (J,), (B,) 1 where a joint, a beam counts, 0 where it only fills up.
    """

    def soft(e: Array, counts: Array) -> Array:
        each = jnp.sqrt((e**2).sum(-1) * (100 / size) ** 2 + SMALL).mean(-1)
        return (each * counts).sum() / counts.sum()

    return (2 * soft(joints, counts[0]) + soft(middles, counts[1])) / 3 / (0.3 + s)

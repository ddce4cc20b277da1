"""Beam mechanics, corrected by a small network, in equilibrium again: frames from a design.

The section model alone gives a first shape of every frame. The network takes its features from it
and predicts how rest, stiffness and sections differ; with that the grid is brought into equilibrium
once more. Nothing can come apart, and frame 0 is the design.
"""

import jax
import jax.numpy as jnp

from simulearn.learn.equilibrium import corrector, stresses
from simulearn.learn.equilibrium.parameters import NetworkWeights, Parameters, Prediction
from simulearn.mechanics.corners import local_corners, placed
from simulearn.mechanics.equilibrium import solve_equilibrium
from simulearn.mechanics.forces import BeamState, HalfBeams, each, twists
from simulearn.mechanics.model import section_of
from simulearn.mechanics.poses import Array, Pose, exp_se3
from simulearn.mechanics.properties import REFERENCE_STIFFNESS, Properties
from simulearn.mechanics.rollout import RELEASED, every_frame, loads, rollout
from simulearn.mechanics.topology import FlatGeometry, Topology

TOLERANCE = 0.05  # mm, of the last motion; what is left after it is far less
MOST = 25  # iterations
STOPS = (4, 9, 10)  # of frames 1 to 11, on the way to the last alone


def plain(beams: int) -> corrector.Corrections:
    """Return the corrections of a network that corrects nothing."""
    twist, corners = jnp.zeros((2, beams, 6)), jnp.zeros((2, beams, 4, 3))
    return corrector.Corrections(twist, twist, corners, corners)


def corrected(half_beams: HalfBeams, corrections: corrector.Corrections) -> HalfBeams:
    """Return elements with the network's corrections of rest and stiffness."""
    root = jnp.exp(corrections.stiff / 2)
    return half_beams._replace(
        rest=half_beams.rest @ exp_se3(corrections.rest),
        stiffness=root[..., :, None] * half_beams.stiffness * root[..., None, :],
    )


def first(
    topology: Topology, geometry: FlatGeometry, half_beams: HalfBeams, tolerance: float = TOLERANCE
) -> tuple[BeamState, Array, Array]:
    """Return the shapes by mechanics alone (11), the halves' twists, and the last motions."""
    states, motions = rollout(topology, geometry, half_beams, tolerance)
    return (
        states,
        jax.vmap(lambda e, state: twists(topology, e, state))(half_beams, states),
        motions,
    )


def corrected_equilibria(
    topology: Topology, half_beams: HalfBeams, begun: BeamState, tolerance: float
) -> tuple[BeamState, Array]:
    """Return the equilibria of corrected elements in all frames (11), and the last motions.

    Each begins where the first shape is, moved on as the two frames before let expect.
    """

    def frame(
        moves: tuple[BeamState, BeamState], now: tuple[HalfBeams, BeamState]
    ) -> tuple[tuple[BeamState, BeamState], tuple[BeamState, Array]]:
        here, first = now
        state, motion = solve_equilibrium(
            topology, here, each(_expected, first, *moves), tolerance, MOST
        )
        return (moves[1], each(_move, first, state)), (state, motion)

    start = jax.tree.map(lambda x: x[0], begun)
    none = each(_move, start, start)
    return jax.lax.scan(frame, (none, none), (half_beams, begun))[1]


def _move(a: Pose, b: Pose) -> Pose:
    """Return how poses turn and move from a to b."""
    return Pose(b.R @ jnp.swapaxes(a.R, -1, -2), b.p - a.p)


def _expected(pose: Pose, before: Pose, last: Pose) -> Pose:
    """Return a pose after the move that would follow two."""
    turn = last.R @ jnp.swapaxes(before.R, -1, -2) @ last.R
    return Pose(turn @ pose.R, pose.p + 2 * last.p - before.p)


def predict(
    parameters: Parameters,
    topology: Topology,
    geometry: FlatGeometry,
    ratio: Array,
    p: Properties,
    tolerance: float = TOLERANCE,
    last: bool = False,
) -> Prediction:
    """Return frames 1 to 11 of a design.

    Args:
        parameters: fitted.
        topology: how the grid hangs together.
        geometry: the flat grid.
        ratio: (B,) signed actuator ratios.
        p: numbers of the material.
        tolerance: of the last motion of an iteration, mm.
        last: whether only the last frame is needed, which costs half.
    """
    law, network, stress = parameters
    section_model, load = section_of(law, p, jnp), loads(p)
    released, gravity = jnp.array(RELEASED), load.gravity
    bare = every_frame(section_model, topology, geometry, ratio, load)
    if last:
        stops = jnp.array(STOPS)
        bare, released, gravity = jax.tree.map(lambda x: x[stops], (bare, released, gravity))
    begun, strains, motions = first(topology, geometry, bare, tolerance)
    sag = jnp.linalg.norm(begun.joints.p[-1] - begun.joints.p[-2], axis=-1).mean()
    if last:
        frames = (released, gravity, bare, begun, strains)
        released, gravity, bare, begun, strains = jax.tree.map(lambda x: x[-1:], frames)
    corrections = jax.tree.map(
        lambda x: jnp.broadcast_to(x, (len(released), *x.shape)), plain(len(ratio))
    )
    ended, again = begun, motions
    if network is not None:

        def correct(
            state: BeamState, twist: Array, s: Array, gravity: Array
        ) -> corrector.Corrections:
            features = corrector.features_of(topology, geometry, ratio, state, twist, s, gravity, p)
            return corrector.corrections(network, topology, features)

        corrections = jax.vmap(correct)(begun, strains, released, gravity)
        ended, again = corrected_equilibria(
            topology, corrected(bare, corrections), begun, tolerance
        )

    def corners(state: BeamState, s: Array, face: Array, middle: Array) -> tuple[Array, Array]:
        return placed(
            topology,
            geometry,
            state,
            *local_corners(section_model, topology, geometry, s, face, middle),
        )

    joints, sections = jax.vmap(corners)(ended, released, corrections.face, corrections.middle)
    strained = None
    if stress is not None:
        printed = stresses.printed(p, geometry, ratio)

        def strain(half_beams: HalfBeams, state: BeamState, s: Array, gravity: Array) -> Array:
            own = (1 - s) * printed + elastic(
                stress, topology, geometry, ratio, half_beams, state, s, gravity, p
            )
            return stresses.in_space(topology, geometry, state, own)

        strained = jax.vmap(strain)(bare, ended, released, gravity)
    return Prediction(
        joints,
        sections,
        strained,
        jnp.maximum(motions.max(), again.max()),
        jnp.linalg.norm(ended.joints.p[-1] - begun.joints.p[-1], axis=-1).mean(),
        sag,
        jnp.sqrt((strains[-1, ..., 3:] ** 2).sum(-1).mean()),
    )


def elastic(
    network: NetworkWeights,
    topology: Topology,
    geometry: FlatGeometry,
    ratio: Array,
    bare: HalfBeams,
    state: BeamState,
    s: Array,
    gravity: Array,
    p: Properties,
) -> Array:
    """Return the elastic stress (2, B, 2, 4, 6) that the network predicts in the halves' axes, MPa.

    Args:
        network: the one for stresses.
        topology: how the grid hangs together.
        geometry: the flat grid.
        ratio: (B,) signed actuator ratios.
        bare: halves by the section_model alone.
        state: the poses.
        s: released fraction.
        gravity: multiple of gravity.
        p: numbers of the material.
    """
    features = corrector.features_of(
        topology, geometry, ratio, state, twists(topology, bare, state), s, gravity, p
    )
    stiff = p.stiffness / REFERENCE_STIFFNESS
    return stiff * corrector.stresses(network, topology, features)

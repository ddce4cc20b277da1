"""Beam mechanics, corrected by a small network, in equilibrium again: frames from a design.

The fitted section alone gives a first shape of every frame. The network looks at it and tells how
rest, stiffness and sections differ; with that the grid is brought into equilibrium once more, all
frames at a time. Nothing can come apart, and frame 0 is the design.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp

from simulearn.learn import local, stresses
from simulearn.material import Material
from simulearn.mechanics.corners import local_corners, placed
from simulearn.mechanics.equilibrium import settle
from simulearn.mechanics.forces import Elements, State, each, twists
from simulearn.mechanics.poses import Array, Pose, exp_se3
from simulearn.mechanics.rollout import RELEASED, Loads, every_frame, rollout
from simulearn.mechanics.section import Law
from simulearn.mechanics.skeleton import Flat, Skeleton

TOLERANCE = 0.05  # mm, of the last motion; what is left after it is far less
MOST = 25  # iterations
STOPS = (4, 9, 10)  # of frames 1 to 11, on the way to the last alone


class Parameters(NamedTuple):
    """All that is fitted: the section, the network that corrects it, and the one for stresses."""

    law: Law
    network: local.Weights | None = None
    stress: local.Weights | None = None


class Shapes(NamedTuple):
    """Frames 1 to 11, or the last alone, stacked.

    Attributes:
        joints: (11, J, 8, 3) corners, mm.
        sections: (11, B, 3, 4, 3) corners, mm.
        stress: (11, B, 4, 4, 6) MPa, or None if there is no network for it.
        way: () the last motion of an iteration, mm; large if there is no equilibrium.
        apart: () mean distance between the joints of the first shape and the last, last frame, mm.
        sag: () mean way of the joints in creep, first shape, mm.
        strain: () root of the mean square turn of the halves from rest, last frame, rad.
    """

    joints: Array
    sections: Array
    stress: Array | None
    way: Array
    apart: Array
    sag: Array
    strain: Array


def plain(beams: int) -> local.Answer:
    """Return the answer of a network that has nothing to add."""
    zero = lambda *shape: jnp.zeros((2, beams, *shape))  # noqa: E731
    return local.Answer(zero(6), zero(6), zero(4, 3), zero(4, 3))


def corrected(el: Elements, told: local.Answer) -> Elements:
    """Return elements with the network's corrections of rest and stiffness."""
    root = jnp.exp(told.stiff / 2)
    return el._replace(
        rest=el.rest @ exp_se3(told.rest),
        stiffness=root[..., :, None] * el.stiffness * root[..., None, :],
    )


def first(
    bones: Skeleton, plan: Flat, el: Elements, tolerance: float = TOLERANCE
) -> tuple[State, Array, Array]:
    """Return the shapes by mechanics alone (11), the halves' twists, and the last motions."""
    states, ways = rollout(bones, plan, el, tolerance)
    return states, jax.vmap(lambda e, state: twists(bones, e, state))(el, states), ways


def resettled(bones: Skeleton, el: Elements, begun: State, tolerance: float) -> tuple[State, Array]:
    """Return the equilibria of corrected elements in all frames (11), and the last motions.

    Each begins where the first shape is, moved on as the two frames before let expect.
    """

    def frame(
        moves: tuple[State, State], now: tuple[Elements, State]
    ) -> tuple[tuple[State, State], tuple[State, Array]]:
        here, first = now
        state, way = settle(bones, here, each(_expected, first, *moves), tolerance, MOST)
        return (moves[1], each(_move, first, state)), (state, way)

    start = jax.tree.map(lambda x: x[0], begun)
    none = each(_move, start, start)
    return jax.lax.scan(frame, (none, none), (el, begun))[1]


def _move(a: Pose, b: Pose) -> Pose:
    """Return how poses turn and move from a to b."""
    return Pose(b.R @ jnp.swapaxes(a.R, -1, -2), b.p - a.p)


def _expected(pose: Pose, before: Pose, last: Pose) -> Pose:
    """Return a pose after the move that would follow two."""
    turn = last.R @ jnp.swapaxes(before.R, -1, -2) @ last.R
    return Pose(turn @ pose.R, pose.p + 2 * last.p - before.p)


def shapes(
    parameters: Parameters,
    bones: Skeleton,
    plan: Flat,
    ratio: Array,
    load: Loads,
    material: Material,
    tolerance: float = TOLERANCE,
    last: bool = False,
) -> Shapes:
    """Return frames 1 to 11 of a design.

    Args:
        parameters: fitted.
        bones: how the grid hangs together.
        plan: the flat grid.
        ratio: (B,) signed actuator ratios.
        load: weights.
        material: for the printed-in stress.
        tolerance: of the last motion of an iteration, mm.
        last: whether only the last frame is asked for, which costs half.
    """
    law, network, stress = parameters
    released, gravity = jnp.array(RELEASED), load.gravity
    bare = every_frame(law, bones, plan, ratio, load)
    if last:
        way = lambda x: x[jnp.array(STOPS)]  # noqa: E731
        bare, released, gravity = jax.tree.map(way, (bare, released, gravity))
    begun, strains, ways = first(bones, plan, bare, tolerance)
    sag = jnp.linalg.norm(begun.joints.p[-1] - begun.joints.p[-2], axis=-1).mean()
    if last:
        kept = (released, gravity, bare, begun, strains)
        released, gravity, bare, begun, strains = jax.tree.map(lambda x: x[-1:], kept)
    told = jax.tree.map(lambda x: jnp.broadcast_to(x, (len(released), *x.shape)), plain(len(ratio)))
    ended, again = begun, ways
    if network is not None:

        def tell(state: State, twist: Array, s: Array, gravity: Array) -> local.Answer:
            seen = local.look(bones, plan, ratio, state, twist, s, gravity)
            return local.answer(network, bones, seen)

        told = jax.vmap(tell)(begun, strains, released, gravity)
        ended, again = resettled(bones, corrected(bare, told), begun, tolerance)

    def corners(state: State, s: Array, face: Array, middle: Array) -> tuple[Array, Array]:
        return placed(bones, plan, state, *local_corners(law, bones, plan, s, face, middle))

    joints, sections = jax.vmap(corners)(ended, released, told.face, told.middle)
    strained = None
    if stress is not None:
        printed = stresses.printed(material, plan, ratio)

        def strain(el: Elements, state: State, s: Array, gravity: Array) -> Array:
            own = (1 - s) * printed + elastic(stress, bones, plan, ratio, el, state, s, gravity)
            return stresses.in_space(bones, plan, state, own)

        strained = jax.vmap(strain)(bare, ended, released, gravity)
    return Shapes(
        joints,
        sections,
        strained,
        jnp.maximum(ways.max(), again.max()),
        jnp.linalg.norm(ended.joints.p[-1] - begun.joints.p[-1], axis=-1).mean(),
        sag,
        jnp.sqrt((strains[-1, ..., 3:] ** 2).sum(-1).mean()),
    )


def elastic(
    network: local.Weights,
    bones: Skeleton,
    plan: Flat,
    ratio: Array,
    bare: Elements,
    state: State,
    s: Array,
    gravity: Array,
) -> Array:
    """Return the elastic stress (2, B, 2, 4, 6) that the network tells in the halves' axes, MPa.

    Args:
        network: the one for stresses.
        bones: how the grid hangs together.
        plan: the flat grid.
        ratio: (B,) signed actuator ratios.
        bare: halves by the law alone.
        state: the poses.
        s: released fraction.
        gravity: multiple of gravity.
    """
    seen = local.look(bones, plan, ratio, state, twists(bones, bare, state), s, gravity)
    return local.stresses(network, bones, seen)

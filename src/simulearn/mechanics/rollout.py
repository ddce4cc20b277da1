"""The twelve frames of a grid by beam mechanics, each found from the ones before."""

from typing import NamedTuple

import jax
import jax.numpy as jnp

from simulearn.material import Material
from simulearn.mechanics.equilibrium import Elements, State, inverse_of_blocks, settle
from simulearn.mechanics.poses import Array, Pose
from simulearn.mechanics.section import Law, in_s, rest
from simulearn.mechanics.skeleton import Flat, Skeleton

STEPS = 10
RELEASED = (*(k / STEPS for k in range(1, STEPS + 1)), 1.0)  # frames 1 to 11


class Loads(NamedTuple):
    """Weight of what is printed.

    Attributes:
        body: () N/mm3.
        section: () mm2.
        thickness: () mm.
        gravity: (11,) multiples of it in frames 1 to 11.
    """

    body: Array
    section: Array
    thickness: Array
    gravity: Array


def loads(material: Material) -> Loads:
    """Return the loads of a material system; creep is gravity times 1 + phi."""
    section = material.section
    return Loads(
        jnp.array(material.gravity.body_force),
        jnp.array(section.width * section.thickness),
        jnp.array(section.thickness),
        jnp.array([1.0] * STEPS + [1 + material.creep.amplitude]),
    )


def elements(
    law: Law, bones: Skeleton, plan: Flat, ratio: Array, load: Loads, s: Array, gravity: Array
) -> Elements:
    """Return the halves of a grid at a released fraction s and a multiple of gravity."""
    length = jnp.stack([plan.length] * 2)
    held = (bones.ends == bones.fixed).astype(length.dtype)
    free, compliance = rest(law, length, jnp.stack([ratio] * 2), held, s)
    body = load.body * gravity
    return Elements(
        rest=free,
        stiffness=inverse_of_blocks(compliance),
        face=plan.face * (1 + in_s(law.plane, s)),
        frame=plan.frame,
        length=plan.length / 2,
        line=body * load.section,
        weight=body * load.thickness * plan.area,
    )


def every_frame(law: Law, bones: Skeleton, plan: Flat, ratio: Array, load: Loads) -> Elements:
    """Return the halves of a grid in frames 1 to 11, stacked."""
    one = lambda s, gravity: elements(law, bones, plan, ratio, load, s, gravity)  # noqa: E731
    return jax.vmap(one)(jnp.array(RELEASED), load.gravity)


def start(plan: Flat) -> State:
    """Return the flat state."""
    eye = jnp.broadcast_to(jnp.eye(3), (len(plan.centre), 3, 3))
    return State(Pose(eye, plan.centre), Pose(plan.frame[0], plan.middle))


def rollout(
    bones: Skeleton, plan: Flat, el: Elements, tolerance: float = 0.02, most: int = 60
) -> tuple[State, Array]:
    """Return the states of frames 1 to 11, stacked, and the last motion in each (11,) mm.

    Args:
        bones: how the grid hangs together.
        plan: the flat grid.
        el: halves in frames 1 to 11, or fewer: equal steps of release, then creep.
        tolerance: of the last motion of an iteration, mm.
        most: iterations in a frame. The first, when a large grid hangs down, takes the most.
    """

    def frame(
        carry: tuple[State, State], now: tuple[Elements, Array]
    ) -> tuple[tuple[State, State], tuple[State, Array]]:
        before, last = carry
        here, fresh = now
        new, way = settle(bones, here, _onward(before, last, 1 - fresh), tolerance, most)
        return (last, new), (new, way)

    begin = start(plan)
    # No extrapolation over a jump in gravity.
    fresh = jnp.array([1.0, 1.0] + [0.0] * (len(el.weight) - 3) + [1.0])
    _, (states, ways) = jax.lax.scan(frame, (begin, begin), (el, fresh))
    return states, ways


def _onward(before: State, last: State, share: Array) -> State:
    """Return a state as far beyond the last as that is from the one before, or a share of it."""

    def go(a: Pose, b: Pose) -> Pose:
        turn = b.R @ (jnp.swapaxes(a.R, -1, -2) @ b.R)
        return Pose(jnp.where(share > 0, turn, b.R), b.p + share * (b.p - a.p))

    return State(go(before.joints, last.joints), go(before.middles, last.middles))

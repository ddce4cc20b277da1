"""The twelve frames of a grid by beam mechanics, each found from the ones before."""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from simulearn.material import Material
from simulearn.mechanics.equilibrium import settle
from simulearn.mechanics.forces import Elements, State, each
from simulearn.mechanics.poses import Array, Pose
from simulearn.mechanics.section import Law, in_s, rest, tilted
from simulearn.mechanics.skeleton import Flat, Skeleton
from simulearn.mechanics.stiffness import inverse_of_blocks

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
    held = (bones.ends == bones.fixed).astype(plan.length.dtype)
    free, compliance = rest(law, plan.length, ratio, s)
    body = load.body * gravity
    return Elements(
        rest=tilted(law, held, s) @ free,
        stiffness=jnp.stack([inverse_of_blocks(compliance)] * 2),
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
        path: tuple[State, State, State], now: tuple[Elements, Array]
    ) -> tuple[tuple[State, State, State], tuple[State, Array]]:
        here, order = now
        new, way = settle(bones, here, _onward(*path, order), tolerance, most)
        return (*path[1:], new), (new, way)

    begin = start(plan)
    # No extrapolation over a jump in gravity.
    order = np.clip(np.arange(len(el.weight)) - 1, 0, 2)
    order[-1] = 0
    _, (states, ways) = jax.lax.scan(frame, (begin, begin, begin), (el, jnp.array(order)))
    return states, ways


def _onward(first: State, second: State, third: State, order: Array) -> State:
    """Return the state after three, by a polynomial of order 0 to 2."""

    def go(a: Pose, b: Pose, c: Pose) -> Pose:
        before, last = jnp.swapaxes(a.R, -1, -2) @ b.R, jnp.swapaxes(b.R, -1, -2) @ c.R
        line = c.R @ last
        curve = line @ last @ jnp.swapaxes(before, -1, -2)
        turned = jnp.where(order > 1, curve, jnp.where(order > 0, line, c.R))
        way = jnp.minimum(order, 1) * (c.p - b.p) + (order > 1) * (c.p - 2 * b.p + a.p)
        return Pose(turned, c.p + way)

    return each(go, first, second, third)

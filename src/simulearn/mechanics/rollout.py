"""The twelve frames of a grid by beam mechanics, each found from the ones before."""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from simulearn.mechanics.equilibrium import solve_equilibrium
from simulearn.mechanics.forces import BeamState, HalfBeams, each
from simulearn.mechanics.model import SectionModel
from simulearn.mechanics.poses import Array, Pose
from simulearn.mechanics.properties import Properties
from simulearn.mechanics.section import in_s, rest, tilted
from simulearn.mechanics.stiffness import inverse_of_blocks
from simulearn.mechanics.topology import FlatGeometry, Topology
from simulearn.schedule import SCHEDULE

RELEASED = SCHEDULE.released[1:]  # frames 1 to 11


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


def loads(p: Properties) -> Loads:
    """Return the loads of a material; creep is gravity times 1 + phi."""
    gravity = [jnp.asarray(g) + 0.0 * p.creep for g in SCHEDULE.gravity(p.creep)[1:]]
    return Loads(
        jnp.asarray(p.body), jnp.asarray(p.width * p.thickness), jnp.asarray(p.thickness),
        jnp.stack(gravity),
    )  # fmt: skip


def half_beams_at(
    section_model: SectionModel,
    topology: Topology,
    geometry: FlatGeometry,
    ratio: Array,
    load: Loads,
    s: Array,
    gravity: Array,
) -> HalfBeams:
    """Return the halves of a grid at a released fraction s and a multiple of gravity."""
    held = (topology.ends == topology.fixed).astype(geometry.length.dtype)
    free, compliance = rest(section_model, geometry.length, ratio, s)
    body = load.body * gravity
    return HalfBeams(
        rest=tilted(section_model, held, geometry.reach, s) @ free,
        stiffness=jnp.stack([inverse_of_blocks(compliance)] * 2),
        face=geometry.face * (1 + in_s(section_model.plane, s)),
        frame=geometry.frame,
        length=geometry.length / 2,
        line=body * load.section,
        weight=body * load.thickness * geometry.area,
    )


def every_frame(
    section_model: SectionModel,
    topology: Topology,
    geometry: FlatGeometry,
    ratio: Array,
    load: Loads,
) -> HalfBeams:
    """Return the halves of a grid in frames 1 to 11, stacked."""

    def frame(s: Array, gravity: Array) -> HalfBeams:
        return half_beams_at(section_model, topology, geometry, ratio, load, s, gravity)

    return jax.vmap(frame)(jnp.array(RELEASED), load.gravity)


def start(geometry: FlatGeometry) -> BeamState:
    """Return the flat state."""
    eye = jnp.broadcast_to(jnp.eye(3), (len(geometry.centre), 3, 3))
    return BeamState(Pose(eye, geometry.centre), Pose(geometry.frame[0], geometry.middle))


def rollout(
    topology: Topology,
    geometry: FlatGeometry,
    half_beams: HalfBeams,
    tolerance: float = 0.02,
    most: int = 60,
) -> tuple[BeamState, Array]:
    """Return the states of frames 1 to 11, stacked, and the last motion in each (11,) mm.

    Args:
        topology: how the grid hangs together.
        geometry: the flat grid.
        half_beams: halves in frames 1 to 11, or fewer: equal steps of release, then creep.
        tolerance: of the last motion of an iteration, mm.
        most: iterations in a frame. The first, when a large grid hangs down, takes the most.
    """

    def frame(
        path: tuple[BeamState, BeamState, BeamState], now: tuple[HalfBeams, Array]
    ) -> tuple[tuple[BeamState, BeamState, BeamState], tuple[BeamState, Array]]:
        here, order = now
        new, motion = solve_equilibrium(topology, here, _onward(*path, order), tolerance, most)
        return (*path[1:], new), (new, motion)

    begin = start(geometry)
    # No extrapolation over a jump in gravity.
    order = np.clip(np.arange(len(half_beams.weight)) - 1, 0, 2)
    order[-1] = 0
    _, (states, motions) = jax.lax.scan(
        frame, (begin, begin, begin), (half_beams, jnp.array(order))
    )
    return states, motions


def _onward(first: BeamState, second: BeamState, third: BeamState, order: Array) -> BeamState:
    """Return the state after three, by a polynomial of order 0 to 2."""

    def go(a: Pose, b: Pose, c: Pose) -> Pose:
        before, last = jnp.swapaxes(a.R, -1, -2) @ b.R, jnp.swapaxes(b.R, -1, -2) @ c.R
        line = c.R @ last
        curve = line @ last @ jnp.swapaxes(before, -1, -2)
        turned = jnp.where(order > 1, curve, jnp.where(order > 0, line, c.R))
        moved = jnp.minimum(order, 1) * (c.p - b.p) + (order > 1) * (c.p - 2 * b.p + a.p)
        return Pose(turned, c.p + moved)

    return each(go, first, second, third)

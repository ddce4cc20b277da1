"""Forces of half-beams between joints, at any poses.

Each half stores d.K.d / 2, d being the twist by which its middle has left its place at rest:
exact for any rotation, and for the constant strains of the rest itself.

All wrenches and motions are about the origin and in the axes of space (force or translation, then
moment or rotation), whatever they act on. So the two ends of a half feel the same wrench, with
opposite signs, and what moves both alike changes nothing.
"""

from collections.abc import Callable
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np

from simulearn.mechanics.poses import Array, Pose, exp_se3, inverse_right, log_se3
from simulearn.mechanics.topology import Topology

UP = np.array([0.0, 0.0, 1.0])
# The axes of a beam's middle as its two halves see them.
FLIP = np.stack([np.eye(3), np.diag([-1.0, -1.0, 1.0])])


class BeamState(NamedTuple):
    """Poses in space; joints (J), middles of beams in the axes of half 0 (B)."""

    joints: Pose
    middles: Pose


class HalfBeams(NamedTuple):
    """Halves of beams and loads at one released fraction.

    Attributes:
        rest: (2, B) place of the middle as seen from the face, free of loads.
        stiffness: (2, B, 6, 6) N, mm.
        face: (2, B, 3) from the joint's centre to the face, in the joint's axes, mm.
        frame: (2, B, 3, 3) axes of the half in the joint's.
        length: (B,) of the halves' mean, for the weight, mm.
        line: () weight of beams, N/mm.
        weight: (J,) of joints, N.
    """

    rest: Pose
    stiffness: Array
    face: Array
    frame: Array
    length: Array
    line: Array
    weight: Array


class Halves(NamedTuple):
    """Poses gathered for each half (2, B): of its joint, and of its middle in its own axes."""

    joint: Pose
    middle: Pose


class Forces(NamedTuple):
    """Wrenches out of balance, on joints (J, 6) and middles (B, 6)."""

    joints: Array
    middles: Array


class EndForces(NamedTuple):
    """What the halves (2, B) do to their ends.

    Attributes:
        wrench: (2, B, 6) elastic, on middles; joints feel the opposite.
        change: (2, B, 6, 6) how twists change as middles move.
        lever: (2, B, 3) first moment of the weight that joints carry, N mm.
    """

    wrench: Array
    change: Array
    lever: Array


class CarriedWeight(NamedTuple):
    """Weight that bodies carry: its sum (...) N, and its first moment (..., 3) N mm."""

    weight: Array
    lever: Array

    @property
    def wrench(self) -> Array:
        """(..., 6) slope of its energy."""
        lift = self.weight[..., None] * UP
        return jnp.concatenate([lift, jnp.cross(self.lever, UP)], -1)


def each(function: Callable[..., Pose], *states: BeamState) -> BeamState:
    """Return a function of the poses of joints, and of middles."""
    return BeamState(*(function(*poses) for poses in zip(*states, strict=True)))


def halves(topology: Topology, state: BeamState) -> Halves:
    """Return the poses that each half joins."""
    joint = Pose(state.joints.R[topology.ends], state.joints.p[topology.ends])
    return Halves(joint, Pose(state.middles.R @ FLIP[:, None], jnp.stack([state.middles.p] * 2)))


def moved(state: BeamState, joints: Array, middles: Array) -> BeamState:
    """Return a state after motions of joints (J, 6) and middles (B, 6)."""
    return BeamState(exp_se3(joints) @ state.joints, exp_se3(middles) @ state.middles)


def twists(topology: Topology, elements: HalfBeams, state: BeamState) -> Array:
    """Return how far the halves' middles have left their places at rest: (2, B, 6)."""
    return _twists(elements, halves(topology, state))


def _twists(half_beams: HalfBeams, at: Halves) -> Array:
    relative = (at.joint @ Pose(half_beams.frame, half_beams.face)).inverse @ at.middle
    return log_se3(half_beams.rest.inverse @ relative)


def _change(d: Array, at: Halves) -> Array:
    """Return how twists change as middles move: (2, B, 6, 6)."""
    back = jnp.swapaxes(at.middle.R, -1, -2)
    turn, along = inverse_right(d)
    turn, along = turn @ back, along @ back
    along += jnp.cross(at.middle.p[..., None, :], turn)
    return block(turn, along, jnp.zeros_like(turn), turn)


def block(a: Array, b: Array, c: Array, d: Array) -> Array:
    """Return matrices (..., 6, 6) of four blocks."""
    return jnp.concatenate([jnp.concatenate([a, b], -1), jnp.concatenate([c, d], -1)], -2)


def end_forces(half_beams: HalfBeams, at: Halves) -> EndForces:
    """Return what halves do to their ends."""
    d = _twists(half_beams, at)
    change = _change(d, at)
    wrench = jnp.einsum(
        "hbji,hbj->hbi", change, jnp.einsum("hbij,hbj->hbi", half_beams.stiffness, d)
    )
    # Weight, as a cubic deflection shares it between the ends; couples on middles cancel.
    share = (half_beams.length * half_beams.line / 2)[:, None]
    couple = (half_beams.length**2 * half_beams.line / 12)[:, None]
    local = share * half_beams.face + couple * half_beams.frame[..., 0]
    lever = share * at.joint.p + jnp.einsum("hbij,hbj->hbi", at.joint.R, local)
    return EndForces(wrench, change, lever)


def carried_weight(
    topology: Topology, half_beams: HalfBeams, state: BeamState, levers: Array
) -> tuple[CarriedWeight, CarriedWeight]:
    """Return the weight that joints (J) and middles (B) carry, with the levers of `EndForces`."""
    line = half_beams.length * half_beams.line
    weight = half_beams.weight.at[topology.ends].add(line / 2)
    lever = (half_beams.weight[:, None] * state.joints.p).at[topology.ends].add(levers)
    return CarriedWeight(weight, lever), CarriedWeight(line, line[:, None] * state.middles.p)


def gathered(
    topology: Topology, ends: EndForces, loads: tuple[CarriedWeight, CarriedWeight]
) -> Forces:
    """Return the wrenches on joints and middles, given what halves do and what hangs on them."""
    joints, middles = (load.wrench for load in loads)
    return Forces(joints.at[topology.ends].add(-ends.wrench), middles + ends.wrench.sum(0))


def forces(topology: Topology, half_beams: HalfBeams, state: BeamState) -> Forces:
    """Return the wrenches out of balance in a state: the slope of its energy."""
    ends = end_forces(half_beams, halves(topology, state))
    return gathered(topology, ends, carried_weight(topology, half_beams, state, ends.lever))

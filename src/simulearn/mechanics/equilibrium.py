"""Equilibrium of a grid of halves of beams between joints, by Gauss-Newton with elimination.

Each half stores d.K.d / 2, d being the twist by which its middle has left its place at rest:
exact for any rotation, and for the constant strains of the rest itself. Middles of beams are
eliminated in 6 x 6 blocks; only joints remain. The stiffness of second order in d is left out:
the iteration then always goes downhill, and needs two or three steps from a good start.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp

from simulearn.mechanics.poses import (
    Array,
    Pose,
    adjoint,
    exp_so3,
    hat,
    inverse_right,
    log_se3,
)
from simulearn.mechanics.skeleton import Skeleton

UP = jnp.array([0.0, 0.0, 1.0])
# The axes of a beam's middle as its two halves see them.
FLIP = jnp.stack([jnp.eye(3), jnp.diag(jnp.array([-1.0, -1.0, 1.0]))])
LONGEST = 15.0  # mm, that a joint may move in one step


class State(NamedTuple):
    """Poses in space; joints (J), middles of beams in the axes of half 0 (B)."""

    joints: Pose
    middles: Pose


class Elements(NamedTuple):
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


def twists(bones: Skeleton, elements: Elements, state: State) -> Array:
    """Return how far the halves' middles have left their places at rest: (2, B, 6)."""
    return _seen(bones, elements, state)[0]


def _seen(bones: Skeleton, el: Elements, state: State) -> tuple[Array, Pose, Pose, Array]:
    """Return twists, the middles as seen from faces, the middles in space, the joints' axes."""
    turn = state.joints.R[bones.ends]
    face = Pose(
        turn @ el.frame,
        state.joints.p[bones.ends] + jnp.einsum("hbij,hbj->hbi", turn, el.face),
    )
    flip = FLIP[:, None]
    middle = Pose(state.middles.R[None] @ flip, jnp.stack([state.middles.p] * 2))
    seen = face.inverse @ middle
    return log_se3(el.rest.inverse @ seen), seen, middle, turn


class Balance(NamedTuple):
    """Forces that are out of balance, and stiffness, in (translation in space, rotation in body).

    Attributes:
        joints: (J, 6) N, N mm.
        middles: (B, 6).
        blocks: (2, B, 12, 12) of each half's joint and middle.
    """

    joints: Array
    middles: Array
    blocks: Array


def balance(bones: Skeleton, el: Elements, state: State) -> Balance:
    """Return the forces out of balance in a state, and its Gauss-Newton stiffness."""
    d, seen, middle, turn = _seen(bones, el, state)
    zero = jnp.zeros_like(turn)
    block = lambda a, b, c, e: jnp.concatenate(  # noqa: E731
        [jnp.concatenate([a, b], -1), jnp.concatenate([c, e], -1)], -2
    )
    back = jnp.swapaxes(el.frame, -1, -2)
    at_face = block(jnp.swapaxes(turn @ el.frame, -1, -2), -back @ hat(el.face), zero, back)
    flip = jnp.broadcast_to(FLIP[:, None], zero.shape)
    at_middle = block(jnp.swapaxes(middle.R, -1, -2), zero, zero, flip)
    change = inverse_right(d)
    both = jnp.concatenate(
        [-change @ adjoint(seen.inverse) @ at_face, change @ at_middle], -1
    )  # (2, B, 6, 12)
    pull = jnp.einsum("hbij,hbj->hbi", el.stiffness, d)
    force = jnp.einsum("hbji,hbj->hbi", both, pull) + _weights(el, turn, middle)
    blocks = jnp.swapaxes(both, -1, -2) @ el.stiffness @ both
    joints = jnp.zeros((len(el.weight), 6)).at[:, 2].add(el.weight)
    joints = joints.at[bones.ends].add(force[..., :6])
    return Balance(joints, force[..., 6:].sum(0), blocks)


def _weights(el: Elements, turn: Array, middle: Pose) -> Array:
    """Return the forces of the halves' weight, as a cubic deflection shares it: (2, B, 12)."""
    half = el.length * el.line / 2
    moment = el.length**2 * el.line / 12
    seen = turn[..., 2, :]  # up, as the joint sees it
    tangent = el.frame[..., 0]
    at_joint = half[:, None] * jnp.cross(el.face, seen) + moment[:, None] * jnp.cross(tangent, seen)
    along = jnp.broadcast_to(FLIP[:, None, :, 0], seen.shape)  # the tangent in the middle's axes
    above = jnp.einsum("hij,hbj->hbi", FLIP, middle.R[..., 2, :])
    at_middle = -moment[:, None] * jnp.cross(along, above)
    up = half[:, None] * UP
    lift = jnp.broadcast_to(up, seen.shape)
    return jnp.concatenate([lift, at_joint, lift, at_middle], -1)


def solve(bones: Skeleton, at: Balance) -> tuple[Array, Array]:
    """Return the step (J, 6), (B, 6) that would balance a linear grid; the fixed joint stays."""
    a, b = at.blocks
    coupling = jnp.concatenate([a[:, :6, 6:], b[:, :6, 6:]], 1)  # (B, 12, 6)
    inner = a[:, 6:, 6:] + b[:, 6:, 6:]
    right = jnp.concatenate([jnp.swapaxes(coupling, 1, 2), at.middles[..., None]], -1)
    solved = jnp.linalg.solve(inner, right)  # (B, 6, 13)
    outer = -coupling @ solved
    schur = outer[..., :12].at[:, :6, :6].add(a[:, :6, :6]).at[:, 6:, 6:].add(b[:, :6, :6])
    count = at.joints.shape[0]
    index = (6 * bones.ends[..., None] + jnp.arange(6)).transpose(1, 0, 2).reshape(-1, 12)
    matrix = jnp.zeros((6 * count, 6 * count))
    matrix = matrix.at[index[:, :, None], index[:, None, :]].add(schur)
    force = at.joints.ravel().at[index].add(outer[..., 12])
    held = 6 * bones.fixed + jnp.arange(6)
    matrix = matrix.at[held, :].set(0.0).at[:, held].set(0.0).at[held, held].set(1.0)
    force = force.at[held].set(0.0)
    joints = -jnp.linalg.solve(matrix, force)
    middles = -solved[..., 12] - jnp.einsum("bij,bj->bi", solved[..., :12], joints[index])
    return joints.reshape(-1, 6), middles


def moved(state: State, joints: Array, middles: Array) -> State:
    """Return a state after a step (J, 6), (B, 6): translation in space, rotation in the body."""
    step = lambda pose, x: Pose(pose.R @ exp_so3(x[..., 3:]), pose.p + x[..., :3])  # noqa: E731
    return State(step(state.joints, joints), step(state.middles, middles))


def iterate(
    bones: Skeleton, el: Elements, state: State, tolerance: float, most: int
) -> tuple[State, Array]:
    """Iterate until nothing moves by more than a tolerance (mm); return the last motion, too."""

    def once(carry: tuple[State, Array, Array]) -> tuple[State, Array, Array]:
        state, _, count = carry
        joints, middles = solve(bones, balance(bones, el, state))
        way = jnp.maximum(jnp.abs(joints[:, :3]).max(), jnp.abs(middles[:, :3]).max())
        less = jnp.minimum(1.0, LONGEST / jnp.maximum(way, 1e-9))
        return moved(state, less * joints, less * middles), way, count + 1

    def going(carry: tuple[State, Array, Array]) -> Array:
        return (carry[1] > tolerance) & (carry[2] < most)

    state, way, _ = jax.lax.while_loop(going, once, (state, jnp.array(jnp.inf), jnp.array(0)))
    return state, way

"""Equilibrium of a grid of halves of beams between joints, by Gauss-Newton with elimination.

Each half stores d.K.d / 2, d being the twist by which its middle has left its place at rest:
exact for any rotation, and for the constant strains of the rest itself. Middles of beams are
eliminated in 6 x 6 blocks; only joints remain. The stiffness of second order in d is left out:
the iteration then always goes downhill, and needs two or three steps from a good start.
"""

from functools import partial
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


class Halves(NamedTuple):
    """Poses gathered for each half (2, B): of its joint, and of its middle in its own axes."""

    joint: Pose
    middle: Pose


def halves(bones: Skeleton, state: State) -> Halves:
    """Return the poses that each half joins."""
    joint = Pose(state.joints.R[bones.ends], state.joints.p[bones.ends])
    return Halves(joint, Pose(state.middles.R @ FLIP[:, None], jnp.stack([state.middles.p] * 2)))


def twists(bones: Skeleton, elements: Elements, state: State) -> Array:
    """Return how far the halves' middles have left their places at rest: (2, B, 6)."""
    return _seen(elements, halves(bones, state))[0]


def _seen(el: Elements, at: Halves) -> tuple[Array, Pose]:
    """Return the twists, and the middles as seen from the faces."""
    seen = (at.joint @ Pose(el.frame, el.face)).inverse @ at.middle
    return log_se3(el.rest.inverse @ seen), seen


def _forces(el: Elements, at: Halves) -> tuple[Array, Array]:
    """Return the forces of each half on its joint and middle (2, B, 12), and twists by motions.

    Motions are translation in space and rotation in the body, of joint and middle.
    """
    d, seen = _seen(el, at)
    turn = at.joint.R
    zero = jnp.zeros_like(turn)
    back = jnp.swapaxes(el.frame, -1, -2)
    at_face = _block(jnp.swapaxes(turn @ el.frame, -1, -2), -back @ hat(el.face), zero, back)
    flip = jnp.broadcast_to(FLIP[:, None], zero.shape)
    at_middle = _block(jnp.swapaxes(at.middle.R, -1, -2), zero, zero, flip)
    change = inverse_right(d)
    motion = jnp.concatenate(
        [-change @ adjoint(seen.inverse) @ at_face, change @ at_middle], -1
    )  # (2, B, 6, 12)
    pull = jnp.einsum("hbij,hbj->hbi", el.stiffness, d)
    return jnp.einsum("hbji,hbj->hbi", motion, pull) + _weights(el, at), motion


def _block(a: Array, b: Array, c: Array, d: Array) -> Array:
    return jnp.concatenate([jnp.concatenate([a, b], -1), jnp.concatenate([c, d], -1)], -2)


def _weights(el: Elements, at: Halves) -> Array:
    """Return the forces of the halves' weight, as a cubic deflection shares it: (2, B, 12)."""
    half = el.length * el.line / 2
    moment = el.length**2 * el.line / 12
    seen = at.joint.R[..., 2, :]  # up, as the joint sees it
    tangent = el.frame[..., 0]
    at_joint = half[:, None] * jnp.cross(el.face, seen) + moment[:, None] * jnp.cross(tangent, seen)
    along = jnp.broadcast_to(FLIP[:, None, :, 0], seen.shape)  # the tangent in the middle's axes
    above = jnp.einsum("hij,hbj->hbi", FLIP, at.middle.R[..., 2, :])
    at_middle = -moment[:, None] * jnp.cross(along, above)
    lift = jnp.broadcast_to(half[:, None] * UP, seen.shape)
    return jnp.concatenate([lift, at_joint, lift, at_middle], -1)


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
    force, motion = _forces(el, halves(bones, state))
    blocks = jnp.swapaxes(motion, -1, -2) @ el.stiffness @ motion
    return Balance(*_gathered(bones, el, force), blocks)


def _gathered(bones: Skeleton, el: Elements, force: Array) -> tuple[Array, Array]:
    joints = jnp.zeros((len(el.weight), 6)).at[:, 2].add(el.weight)
    return joints.at[bones.ends].add(force[..., :6]), force[..., 6:].sum(0)


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


def exact_stiffness(bones: Skeleton, el: Elements, state: State) -> Array:
    """Return the whole stiffness (6 J + 6 B, ...), the fixed joint's rows and columns being unity.

    With the terms that Gauss-Newton leaves out: by it equilibria change with what they depend on.
    """
    here = halves(bones, state)

    def shifted(x: Array) -> Array:
        # A half's middle turns about its own axes, which the second half sees upside down.
        turn = jnp.einsum("hij,hbj->hbi", FLIP, x[..., 9:])
        joint = Pose(here.joint.R @ exp_so3(x[..., 3:6]), here.joint.p + x[..., :3])
        middle = Pose(here.middle.R @ exp_so3(turn), here.middle.p + x[..., 6:9])
        return _forces(el, Halves(joint, middle))[0]

    zero = jnp.zeros((*bones.ends.shape, 12))
    push = lambda e: jax.jvp(shifted, (zero,), (jnp.broadcast_to(e, zero.shape),))[1]  # noqa: E731
    blocks = jnp.moveaxis(jax.vmap(push)(jnp.eye(12)), 0, -1)  # (2, B, 12, 12)
    joints, beams = len(el.weight), bones.ends.shape[1]
    six = jnp.arange(6)
    index = jnp.concatenate(
        [
            6 * bones.ends[..., None] + six,
            jnp.broadcast_to(
                6 * (joints + jnp.arange(beams))[None, :, None] + six, zero[..., :6].shape
            ),
        ],
        -1,
    )
    size = 6 * (joints + beams)
    whole = jnp.zeros((size, size)).at[index[..., :, None], index[..., None, :]].add(blocks)
    held = 6 * bones.fixed + six
    return whole.at[held, :].set(0.0).at[:, held].set(0.0).at[held, held].set(1.0)


@partial(jax.custom_vjp, nondiff_argnums=(3, 4))
def settle(
    bones: Skeleton, el: Elements, state: State, tolerance: float, most: int
) -> tuple[State, Array]:
    """Return the equilibrium nearest to a state, and the last motion (mm), as `iterate` does.

    Its derivatives are those of the equilibrium, by the theorem of implicit functions.
    """
    return iterate(bones, el, state, tolerance, most)


def _settle(
    bones: Skeleton, el: Elements, state: State, tolerance: float, most: int
) -> tuple[tuple[State, Array], tuple[Skeleton, Elements, State]]:
    state, way = iterate(bones, el, state, tolerance, most)
    return (state, way), (bones, el, state)


def _settled(
    tolerance: float,
    most: int,
    kept: tuple[Skeleton, Elements, State],
    bar: tuple[State, Array],
) -> tuple[None, Elements, State]:
    bones, el, state = kept
    count, beams = len(el.weight), bones.ends.shape[1]
    zero = jnp.zeros((count, 6)), jnp.zeros((beams, 6))
    pulled = jax.vjp(lambda a, b: moved(state, a, b), *zero)[1](bar[0])
    right = jnp.concatenate([pulled[0].at[bones.fixed].set(0.0).ravel(), pulled[1].ravel()])
    weight = jnp.linalg.solve(exact_stiffness(bones, el, state).T, right)
    split = weight[: 6 * count].reshape(-1, 6), weight[6 * count :].reshape(-1, 6)

    def forces(el: Elements, held: Pose) -> tuple[Array, Array]:
        set_held = lambda x, y: x.at[bones.fixed].set(y)  # noqa: E731
        at = State(jax.tree.map(set_held, state.joints, held), state.middles)
        return _gathered(bones, el, _forces(el, halves(bones, at))[0])

    # The fixed joint stays where it was put: what depends on it depends on where it began.
    held = jax.tree.map(lambda x: x[bones.fixed], state.joints)
    bar_el, bar_held = jax.vjp(forces, el, held)[1]((-split[0], -split[1]))
    begun = jax.tree.map(jnp.zeros_like, state)
    joints = jax.tree.map(
        lambda zero, b, own: zero.at[bones.fixed].set(b + own[bones.fixed]),
        begun.joints,
        bar_held,
        bar[0].joints,
    )
    return None, bar_el, State(joints, begun.middles)


settle.defvjp(_settle, _settled)


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

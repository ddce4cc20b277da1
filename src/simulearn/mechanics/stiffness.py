"""Stiffness of a grid of halves of beams, by elimination of the beams' middles.

Middles are eliminated in 6 x 6 blocks; only joints remain. The stiffness is Gauss-Newton's, with
which every step goes downhill, or has that of forces that turn added, up to terms of second order
in the halves' twists. Motions and wrenches are about the origin, as in `forces`.
"""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax.scipy.linalg import cho_solve

from simulearn.mechanics.forces import (
    UP,
    BeamState,
    CarriedWeight,
    Forces,
    HalfBeams,
    Halves,
    block,
    carried_weight,
    end_forces,
    gathered,
    halves,
)
from simulearn.mechanics.poses import Array, exp_se3, hat
from simulearn.mechanics.topology import Topology


class Factors(NamedTuple):
    """What a step needs besides the forces.

    Attributes:
        matrix: (6 J, 6 J) the joints' stiffness.
        root: (6 J, 6 J) its Cholesky factor, a constant where it is differentiated.
        soft: (B, 6, 6) inverse of the stiffness that holds a middle.
        follow: (2, B, 6, 6) how a middle follows its joints.
    """

    matrix: Array
    root: Array
    soft: Array
    follow: Array


def balance(
    topology: Topology, half_beams: HalfBeams, state: BeamState, full: Array | float = 0.0
) -> tuple[Forces, Factors]:
    """Return the forces out of balance in a state, and the factors of its stiffness.

    Args:
        topology: how the grid hangs together.
        half_beams: halves and loads.
        state: the poses.
        full: 1 to add the stiffness of forces that turn to Gauss-Newton's, which is that of 0.
    """
    ends = end_forces(half_beams, halves(topology, state))
    loads = carried_weight(topology, half_beams, state, ends.lever)
    spring = jnp.swapaxes(ends.change, -1, -2) @ (half_beams.stiffness @ ends.change)
    # exp(-a) exp(b) = exp(b - a - [a, b] / 2 ...), so a wrench W adds -W.[a, b] / 2 to the energy.
    force, moment = hat(ends.wrench[..., :3]), hat(ends.wrench[..., 3:])
    turned = block(jnp.zeros_like(force), force, force, moment)
    coupled = full / 2 * turned - spring  # of joints and middles
    of_joints, of_middles = (full * _swinging(load) for load in loads)
    soft = inverse_of_blocks(spring[0] + spring[1] + of_middles)
    follow = -soft @ jnp.swapaxes(coupled, -1, -2)
    own, across = spring + coupled @ follow, coupled[0] @ follow[1]
    a, b = 6 * topology.ends[..., None] + jnp.arange(6)
    rows, columns = jnp.stack([a, b, a, b])[..., None], jnp.stack([a, b, b, a])[..., None, :]
    blocks = jnp.stack([own[0], own[1], across, jnp.swapaxes(across, -1, -2)])
    size = 6 * len(half_beams.weight)
    six = 6 * jnp.arange(len(half_beams.weight))[:, None] + jnp.arange(6)
    matrix = jnp.zeros((size, size)).at[rows, columns].add(blocks)
    matrix = matrix.at[six[..., None], six[:, None, :]].add(of_joints)
    matrix = _with_held(matrix, topology)
    root = cholesky(jax.lax.stop_gradient(matrix))
    return gathered(topology, ends, loads), Factors(matrix, root, soft, follow)


def cholesky(matrix: Array) -> Array:
    """Return the Cholesky factor; of many, one after the other.

    JAX 0.10 would share many among threads, and two such calls at once wait for each other for
    ever.
    """
    return jax.custom_batching.sequential_vmap(jnp.linalg.cholesky)(matrix)


def solve(topology: Topology, forces: Forces, by: Factors) -> tuple[Array, Array]:
    """Return the motions that would balance a linear grid: of joints (J, 6) and middles (B, 6)."""
    free = jnp.einsum("bij,bj->bi", by.soft, forces.middles)  # of a middle between held joints
    taken = jnp.einsum("hbji,bj->hbi", by.follow, forces.middles)  # by its joints
    right = forces.joints.at[topology.ends].add(taken).at[topology.fixed].set(0.0)

    def with_factors(_: Any, force: Array) -> Array:
        return cho_solve((by.root, True), force)

    # Differentiated by one more solution with the same factors, instead of through the factors.
    motion = jax.lax.custom_linear_solve(
        lambda x: by.matrix @ x, right.ravel(), with_factors, symmetric=True
    )
    joints = -motion.reshape(right.shape)
    return joints, jnp.einsum("hbij,hbj->bi", by.follow, joints[topology.ends]) - free


def exact_stiffness(topology: Topology, half_beams: HalfBeams, state: BeamState) -> Array:
    """Return how forces change with motions: (6 J + 6 B, ...), 1 for the fixed joint itself.

    With the terms that Gauss-Newton leaves out: by it equilibria change with what they depend on.
    """
    here = halves(topology, state)
    zero = jnp.zeros((*topology.ends.shape, 12))

    def shifted(x: Array) -> Array:
        at = Halves(exp_se3(x[..., :6]) @ here.joint, exp_se3(x[..., 6:]) @ here.middle)
        ends = end_forces(half_beams, at)
        line = jnp.broadcast_to(half_beams.length * half_beams.line / 2, ends.lever.shape[:-1])
        joint = CarriedWeight(line, ends.lever).wrench - ends.wrench
        middle = CarriedWeight(line, line[..., None] * at.middle.p).wrench + ends.wrench
        return jnp.concatenate([joint, middle], -1)

    def push(e: Array) -> Array:
        return jax.jvp(shifted, (zero,), (jnp.broadcast_to(e, zero.shape),))[1]

    blocks = jnp.moveaxis(jax.vmap(push)(jnp.eye(12)), 0, -1)  # (2, B, 12, 12)
    joints, beams = len(half_beams.weight), topology.ends.shape[1]
    six = jnp.arange(6)
    middle = 6 * (joints + jnp.arange(beams))[None, :, None] + six
    index = jnp.concatenate(
        [6 * topology.ends[..., None] + six, jnp.broadcast_to(middle, zero[..., :6].shape)], -1
    )
    size = 6 * (joints + beams)
    matrix = jnp.zeros((size, size)).at[index[..., :, None], index[..., None, :]].add(blocks)
    # A joint's own weight: its moment changes as it moves.
    lift, lever = half_beams.weight[:, None, None] * hat(jnp.array(UP)), hat(state.joints.p)
    none = jnp.zeros_like(lift)
    at = 6 * jnp.arange(joints)[:, None] + six
    matrix = matrix.at[at[..., None], at[:, None, :]].add(block(none, none, -lift, lift @ lever))
    return _with_held(matrix, topology)


def _with_held(matrix: Array, topology: Topology) -> Array:
    """Return the stiffness of a grid whose fixed joint is held."""
    held = 6 * topology.fixed + jnp.arange(6)
    return matrix.at[held, :].set(0.0).at[:, held].set(0.0).at[held, held].set(1.0)


def _swinging(load: CarriedWeight) -> Array:
    """Return the stiffness (..., 6, 6) of weight that hangs on bodies."""
    leant = load.lever[..., None] * UP
    turn = (leant + jnp.swapaxes(leant, -1, -2)) / 2
    turn -= load.lever[..., 2, None, None] * jnp.eye(3)
    lift = load.weight[..., None, None] / 2 * hat(jnp.array(UP))
    return block(jnp.zeros_like(turn), lift, -lift, turn)


def inverse_of_blocks(matrix: Array) -> Array:
    """Return the inverse of symmetric positive (..., 6, 6), by blocks of three."""
    a, b, d = matrix[..., :3, :3], matrix[..., :3, 3:], matrix[..., 3:, 3:]
    across = jnp.swapaxes(b, -1, -2)
    soft = _inverse_of_three(a)
    carried = soft @ b
    rest = _inverse_of_three(d - across @ carried)
    out = -carried @ rest
    return block(soft - out @ jnp.swapaxes(carried, -1, -2), out, jnp.swapaxes(out, -1, -2), rest)


def _inverse_of_three(m: Array) -> Array:
    """Return the inverse of (..., 3, 3), whose columns are cross products of rows."""
    x, y, z = m[..., 0, :], m[..., 1, :], m[..., 2, :]
    first = jnp.cross(y, z)
    return (
        jnp.stack([first, jnp.cross(z, x), jnp.cross(x, y)], -1)
        / (x * first).sum(-1)[..., None, None]
    )

"""Equilibrium of a grid of halves of beams between joints, by Gauss-Newton with elimination.

Each half stores d.K.d / 2, d being the twist by which its middle has left its place at rest:
exact for any rotation, and for the constant strains of the rest itself. Middles of beams are
eliminated in 6 x 6 blocks; only joints remain.

Far from equilibrium the stiffness is Gauss-Newton's, with which every step goes downhill; near it
the stiffness of forces that turn is added, up to terms of second order in d, without which slender
grids converge slowly. Old factors are used again where they do.
"""

from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax.scipy.linalg import cho_solve

from simulearn.mechanics.poses import Array, Pose, exp_so3, hat, inverse_right, log_se3
from simulearn.mechanics.skeleton import Skeleton

UP = np.array([0.0, 0.0, 1.0])
# The axes of a beam's middle as its two halves see them.
FLIP = np.stack([np.eye(3), np.diag([-1.0, -1.0, 1.0])])
LONGEST = 15.0  # mm, that anything may move in one step
NEAR = 3.0  # mm, the motion below which the stiffness of forces is added
CLOSE = 1.0  # mm, the motion below which old factors are tried
AGAIN = 4  # steps with the same factors, at most
FREE = 8  # steps that may lead uphill: bending at first stretches
SLOW = 0.3  # of the step before; where a step is longer, new factors are needed


class State(NamedTuple):
    """Poses in space; joints (J), middles of beams in the axes of half 0 (B)."""

    joints: Pose
    middles: Pose


Motion = tuple[Array, Array]  # of joints (J, 6) and middles (B, 6): translation, rotation in space


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


class Forces(NamedTuple):
    """Wrenches out of balance: force and moment in the axes of space, about the body itself.

    Attributes:
        joints: (J, 6), or those of each half (2, B, 6).
        middles: (B, 6), or (2, B, 6).
    """

    joints: Array
    middles: Array


def halves(bones: Skeleton, state: State) -> Halves:
    """Return the poses that each half joins."""
    joint = Pose(state.joints.R[bones.ends], state.joints.p[bones.ends])
    return Halves(joint, Pose(state.middles.R @ FLIP[:, None], jnp.stack([state.middles.p] * 2)))


def twists(bones: Skeleton, elements: Elements, state: State) -> Array:
    """Return how far the halves' middles have left their places at rest: (2, B, 6)."""
    return _twists(elements, halves(bones, state))


def _twists(el: Elements, at: Halves) -> Array:
    seen = (at.joint @ Pose(el.frame, el.face)).inverse @ at.middle
    return log_se3(el.rest.inverse @ seen)


def _change(d: Array, at: Halves) -> Array:
    """Return how twists change as middles move, in the axes of space: (2, B, 6, 6)."""
    back = jnp.swapaxes(at.middle.R, -1, -2)
    turn, along = inverse_right(d)
    turn, along = turn @ back, along @ back
    return _block(turn, along, jnp.zeros_like(turn), turn)


def _block(a: Array, b: Array, c: Array, d: Array) -> Array:
    return jnp.concatenate([jnp.concatenate([a, b], -1), jnp.concatenate([c, d], -1)], -2)


class Pulls(NamedTuple):
    """What the halves (2, B) do to their ends.

    Attributes:
        forces: on joints and middles, weight included.
        change: (2, B, 6, 6) how twists change as middles move, in the axes of space.
        wrench: (2, B, 6) elastic, on middles.
        lever: (2, B, 3) first moment of the weight that joints carry, from their centres, N mm.
    """

    forces: Forces
    change: Array
    wrench: Array
    lever: Array


def _pulls(el: Elements, at: Halves) -> Pulls:
    """Return the forces of halves and what their stiffness follows from."""
    d = _twists(el, at)
    change = _change(d, at)
    pull = jnp.einsum("hbji,hbjk,hbk->hbi", change, el.stiffness, d)
    # Weight, as a cubic deflection shares it between the ends.
    share = (el.length * el.line / 2)[:, None]
    couple = (el.length**2 * el.line / 12)[:, None]
    face = jnp.einsum("hbij,hbj->hbi", at.joint.R, el.face)
    tangent = jnp.einsum("hbij,hbj->hbi", at.joint.R, el.frame[..., 0])
    force, moment = pull[..., :3], pull[..., 3:]
    lever, lift = share * face + couple * tangent, share * UP
    on_joint = jnp.cross(lever, UP) - moment - jnp.cross(at.middle.p - at.joint.p, force)
    on_middle = moment - couple * jnp.cross(at.middle.R[..., 0], UP)
    both = (lift - force, on_joint), (lift + force, on_middle)
    return Pulls(Forces(*(jnp.concatenate(pair, -1) for pair in both)), change, pull, lever)


def _gathered(bones: Skeleton, el: Elements, each: Forces) -> Forces:
    """Return the wrenches on joints and middles, given those of halves."""
    own = jnp.zeros((len(el.weight), 6)).at[:, 2].add(el.weight)
    return Forces(own.at[bones.ends].add(each.joints), each.middles.sum(0))


class Factors(NamedTuple):
    """What a step needs besides the forces.

    Attributes:
        root: (6 J, 6 J) Cholesky factor of the joints' stiffness, about the origin.
        soft: (B, 6, 6) inverse of the stiffness that holds a middle.
        follow: (2, B, 6, 6) how a middle follows its joints.
        joints: (J, 3) where they were.
        middles: (B, 3).
    """

    root: Array
    soft: Array
    follow: Array
    joints: Array
    middles: Array


def balance(
    bones: Skeleton, el: Elements, state: State, whole: Array | float = 0.0
) -> tuple[Forces, Factors]:
    """Return the forces out of balance in a state, and the factors of its stiffness.

    Args:
        bones: how the grid hangs together.
        el: halves and loads.
        state: the poses.
        whole: 1 to add the stiffness of forces that turn to Gauss-Newton's, which is that of 0.
    """
    pulls = _pulls(el, halves(bones, state))
    spring = jnp.swapaxes(pulls.change, -1, -2) @ el.stiffness @ pulls.change
    # exp(-a) exp(b) = exp(b - a - [a, b] / 2 ...), so a wrench W adds -W.[a, b] / 2 to the energy.
    force, moment = hat(pulls.wrench[..., :3]), hat(pulls.wrench[..., 3:])
    zero = jnp.zeros_like(force)
    coupled = whole / 2 * _block(zero, force, force, moment) - spring  # of joints and middles
    lift = whole / 2 * (el.length * el.line)[:, None, None] * hat(jnp.array(UP))
    none = jnp.zeros_like(lift)
    soft = inverse_of_blocks(spring[0] + spring[1] + _block(none, lift, -lift, none))
    follow = -soft @ jnp.swapaxes(coupled, -1, -2)
    here = _from_origin(state.middles.p)
    there = jnp.swapaxes(here, -1, -2)
    own = there @ (spring + coupled @ follow) @ here
    across = there @ coupled[0] @ follow[1] @ here
    a, b = 6 * bones.ends[..., None] + jnp.arange(6)
    rows, columns = jnp.stack([a, b, a, b])[..., None], jnp.stack([a, b, b, a])[..., None, :]
    blocks = jnp.stack([own[0], own[1], across, jnp.swapaxes(across, -1, -2)])
    size = 6 * len(el.weight)
    matrix = jnp.zeros((size, size)).at[rows, columns].add(blocks)
    six = 6 * jnp.arange(len(el.weight))[:, None] + jnp.arange(6)
    carried = whole * _carried(bones, el, state, pulls)
    matrix = matrix.at[six[..., None], six[:, None, :]].add(carried)
    held = 6 * bones.fixed + jnp.arange(6)
    matrix = matrix.at[held, :].set(0.0).at[:, held].set(0.0).at[held, held].set(1.0)
    factors = Factors(jnp.linalg.cholesky(matrix), soft, follow, state.joints.p, state.middles.p)
    return _gathered(bones, el, pulls.forces), factors


def _carried(bones: Skeleton, el: Elements, state: State, pulls: Pulls) -> Array:
    """Return the stiffness (J, 6, 6), about the origin, of the weight that joints carry."""
    total = el.weight.at[bones.ends].add(el.length * el.line / 2)
    lever = (total[:, None] * state.joints.p).at[bones.ends].add(pulls.lever)
    leant = lever[..., None] * UP
    turn = (leant + jnp.swapaxes(leant, -1, -2)) / 2
    turn -= lever[:, 2, None, None] * jnp.eye(3)
    lift = total[:, None, None] / 2 * hat(jnp.array(UP))
    return _block(jnp.zeros_like(turn), lift, -lift, turn)


def _from_origin(p: Array) -> Array:
    """Return (..., 6, 6): what a motion about the origin is at points (..., 3)."""
    eye = jnp.broadcast_to(jnp.eye(3), (*p.shape, 3))
    return _block(eye, -hat(p), jnp.zeros_like(eye), eye)


def inverse_of_blocks(matrix: Array) -> Array:
    """Return the inverse of symmetric positive (..., 6, 6), by blocks of three."""
    a, b, d = matrix[..., :3, :3], matrix[..., :3, 3:], matrix[..., 3:, 3:]
    across = jnp.swapaxes(b, -1, -2)
    soft = _inverse_of_three(a)
    carried = soft @ b
    rest = _inverse_of_three(d - across @ carried)
    out = -carried @ rest
    return _block(soft - out @ jnp.swapaxes(carried, -1, -2), out, jnp.swapaxes(out, -1, -2), rest)


def _inverse_of_three(m: Array) -> Array:
    """Return the inverse of (..., 3, 3), whose columns are cross products of rows."""
    x, y, z = m[..., 0, :], m[..., 1, :], m[..., 2, :]
    first = jnp.cross(y, z)
    return (
        jnp.stack([first, jnp.cross(z, x), jnp.cross(x, y)], -1)
        / (x * first).sum(-1)[..., None, None]
    )


def solve(bones: Skeleton, forces: Forces, by: Factors) -> tuple[Array, Array]:
    """Return the step that would balance a linear grid: (J, 6), (B, 6); the fixed joint stays.

    A motion is a translation and a rotation in the axes of space, of a body about itself.
    """
    free = jnp.einsum("bij,bj->bi", by.soft, forces.middles)  # of a middle between held joints
    taken = jnp.einsum("hbji,bj->hbi", by.follow, forces.middles)  # by its joints
    right = _about_origin(by.joints, forces.joints)
    right = right.at[bones.ends].add(_about_origin(by.middles, taken)).at[bones.fixed].set(0.0)
    motion = -cho_solve((by.root, True), right.ravel()).reshape(right.shape)
    carried = jnp.einsum("hbij,hbj->bi", by.follow, _at(by.middles, motion[bones.ends]))
    return _at(by.joints, motion), carried - free


def _about_origin(p: Array, wrench: Array) -> Array:
    """Return wrenches (..., 6) about points (..., 3) as they are about the origin."""
    force = wrench[..., :3]
    return jnp.concatenate([force, wrench[..., 3:] + jnp.cross(p, force)], -1)


def _at(p: Array, motion: Array) -> Array:
    """Return motions (..., 6) about the origin as they are at points (..., 3)."""
    turn = motion[..., 3:]
    return jnp.concatenate([motion[..., :3] + jnp.cross(turn, p), turn], -1)


def moved(state: State, joints: Array, middles: Array) -> State:
    """Return a state after motions of joints (J, 6) and middles (B, 6), as `solve` tells them."""
    return State(_after(state.joints, joints), _after(state.middles, middles))


def _after(pose: Pose, motion: Array) -> Pose:
    return Pose(exp_so3(motion[..., 3:]) @ pose.R, pose.p + motion[..., :3])


def exact_stiffness(bones: Skeleton, el: Elements, state: State) -> Array:
    """Return how forces change with motions: (6 J + 6 B, ...), 1 for the fixed joint itself.

    With the terms that Gauss-Newton leaves out: by it equilibria change with what they depend on.
    """
    here = halves(bones, state)

    def shifted(x: Array) -> Array:
        at = Halves(_after(here.joint, x[..., :6]), _after(here.middle, x[..., 6:]))
        return jnp.concatenate(_pulls(el, at).forces, -1)

    zero = jnp.zeros((*bones.ends.shape, 12))
    push = lambda e: jax.jvp(shifted, (zero,), (jnp.broadcast_to(e, zero.shape),))[1]  # noqa: E731
    blocks = jnp.moveaxis(jax.vmap(push)(jnp.eye(12)), 0, -1)  # (2, B, 12, 12)
    joints, beams = len(el.weight), bones.ends.shape[1]
    six = jnp.arange(6)
    middle = 6 * (joints + jnp.arange(beams))[None, :, None] + six
    index = jnp.concatenate(
        [6 * bones.ends[..., None] + six, jnp.broadcast_to(middle, zero[..., :6].shape)], -1
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

    def forces(el: Elements, held: Pose) -> Forces:
        set_held = lambda x, y: x.at[bones.fixed].set(y)  # noqa: E731
        at = State(jax.tree.map(set_held, state.joints, held), state.middles)
        return _gathered(bones, el, _pulls(el, halves(bones, at)).forces)

    # The fixed joint stays where it was put: what depends on it depends on where it began.
    held = jax.tree.map(lambda x: x[bones.fixed], state.joints)
    bar_el, bar_held = jax.vjp(forces, el, held)[1](Forces(-split[0], -split[1]))
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

    def forces_in(state: State) -> Forces:
        return _gathered(bones, el, _pulls(el, halves(bones, state)).forces)

    def asked(forces: Forces, by: Factors) -> tuple[Motion, Array]:
        joints, middles = solve(bones, forces, by)
        way = jnp.maximum(jnp.abs(joints[:, :3]).max(), jnp.abs(middles[:, :3]).max())
        stable = jnp.isfinite(way)  # else the stiffness has no factor: stay
        less = jnp.minimum(1.0, LONGEST / jnp.maximum(way, 1e-9))
        step = jnp.where(stable, less * joints, 0.0), jnp.where(stable, less * middles, 0.0)
        return step, jnp.where(stable, way, jnp.inf)

    def once(carry: tuple[State, Array, Array]) -> tuple[State, Array, Array]:
        state, before, count = carry
        forces, by = balance(bones, el, state, jnp.where(before < NEAR, 1.0, 0.0))
        step, way = asked(forces, by)

        # Where a step leads beyond the lowest point along it, back to where that may lie. A loop of
        # one round at most: of a condition, vmap would compute both branches every time.
        def shorter(carry: tuple[Array, Array]) -> tuple[Array, Array]:
            slope, beyond = _power(forces, step), _power(forces_in(moved(state, *step)), step)
            share = jnp.where(beyond > -slope / 4, slope / (slope - beyond), 1.0)
            return share, jnp.array(0.0)

        far = jnp.isfinite(way) & (count >= FREE)
        begin = (jnp.array(1.0), jnp.where(far, way, 0.0))
        share, _ = jax.lax.while_loop(lambda carry: carry[1] > CLOSE, shorter, begin)
        state = moved(state, share * step[0], share * step[1])

        def again(carry: tuple[State, Array, Array, Array]) -> tuple[State, Array, Array, Array]:
            state, before, _, k = carry
            step, way = asked(forces_in(state), by)
            return moved(state, *step), way, way > SLOW * before, k + 1

        def going(carry: tuple[State, Array, Array, Array]) -> Array:
            _, way, slow, k = carry
            return (way > tolerance) & ~slow & (k < AGAIN)

        begun = (state, way, way > CLOSE, jnp.array(0))
        state, way, _, _ = jax.lax.while_loop(going, again, begun)
        return state, way, count + 1

    def going(carry: tuple[State, Array, Array]) -> Array:
        return (carry[1] > tolerance) & (carry[2] < most)

    begin = (state, jnp.array(jnp.inf), jnp.array(0))
    state, way, _ = jax.lax.while_loop(going, once, begin)
    return state, way


def _power(forces: Forces, step: Motion) -> Array:
    """Return how the energy changes along a step, to first order."""
    return (forces.joints * step[0]).sum() + (forces.middles * step[1]).sum()

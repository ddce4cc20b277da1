"""Equilibrium of a grid of halves of beams between joints, and how it changes with them.

Far from equilibrium steps are Gauss-Newton's, which go downhill; near it the stiffness of forces
that turn is added, without which slender grids converge slowly. Old factors are used again where
they do.
"""

from functools import partial

import jax
import jax.numpy as jnp

from simulearn.mechanics.forces import Elements, Forces, State, forces, moved
from simulearn.mechanics.poses import Array, Pose
from simulearn.mechanics.skeleton import Skeleton
from simulearn.mechanics.stiffness import Factors, balance, exact_stiffness, solve

LONGEST = 15.0  # mm, that anything may move in one step
NEAR = 3.0  # mm, the motion below which the stiffness of forces is added
CLOSE = 1.0  # mm, the motion below which old factors are tried
AGAIN = 4  # steps with the same factors, at most
FREE = 8  # steps that may lead uphill: bending at first stretches
SLOW = 0.3  # of the step before; where a step is longer, new factors are needed

Motion = tuple[Array, Array]  # of joints (J, 6) and middles (B, 6), about the origin


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

    def with_held(el: Elements, held: Pose) -> Forces:
        set_held = lambda x, y: x.at[bones.fixed].set(y)  # noqa: E731
        at = State(jax.tree.map(set_held, state.joints, held), state.middles)
        return forces(bones, el, at)

    # The fixed joint stays where it was put: what depends on it depends on where it began.
    held = jax.tree.map(lambda x: x[bones.fixed], state.joints)
    bar_el, bar_held = jax.vjp(with_held, el, held)[1](Forces(-split[0], -split[1]))
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

    def asked(state: State, out: Forces, by: Factors) -> tuple[Motion, Array]:
        joints, middles = solve(bones, out, by)
        way = jnp.maximum(_way(state.joints, joints), _way(state.middles, middles))
        stable = jnp.isfinite(way)  # else the stiffness has no factor: stay
        less = jnp.minimum(1.0, LONGEST / jnp.maximum(way, 1e-9))
        step = jnp.where(stable, less * joints, 0.0), jnp.where(stable, less * middles, 0.0)
        return step, jnp.where(stable, way, jnp.inf)

    def once(carry: tuple[State, Array, Array]) -> tuple[State, Array, Array]:
        state, before, count = carry
        out, by = balance(bones, el, state, jnp.where(before < NEAR, 1.0, 0.0))
        step, way = asked(state, out, by)

        # Where a step leads beyond the lowest point along it, back to where that may lie. A loop of
        # one round at most: of a condition, vmap would compute both branches every time.
        def shorter(carry: tuple[Array, Array]) -> tuple[Array, Array]:
            slope = _power(out, step)
            beyond = _power(forces(bones, el, moved(state, *step)), step)
            share = jnp.where(beyond > -slope / 4, slope / (slope - beyond), 1.0)
            return share, jnp.array(0.0)

        far = jnp.isfinite(way) & (count >= FREE)
        begin = (jnp.array(1.0), jnp.where(far, way, 0.0))
        share, _ = jax.lax.while_loop(lambda carry: carry[1] > CLOSE, shorter, begin)
        state = moved(state, share * step[0], share * step[1])

        def again(carry: tuple[State, Array, Array, Array]) -> tuple[State, Array, Array, Array]:
            state, before, _, k = carry
            step, way = asked(state, forces(bones, el, state), by)
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


def _way(pose: Pose, motion: Array) -> Array:
    """Return how far a motion leads, to first order, along an axis at most, mm."""
    return jnp.abs(motion[..., :3] + jnp.cross(motion[..., 3:], pose.p)).max()


def _power(forces: Forces, step: Motion) -> Array:
    """Return how the energy changes along a step, to first order."""
    return (forces.joints * step[0]).sum() + (forces.middles * step[1]).sum()

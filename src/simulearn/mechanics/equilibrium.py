"""Equilibrium of a grid of halves of beams between joints, and how it changes with them.

Far from equilibrium steps are Gauss-Newton's, which go downhill; near it the stiffness of forces
that turn is added, without which slender grids converge slowly. Old factors are used again where
they do.
"""

from functools import partial

import jax
import jax.numpy as jnp

from simulearn.mechanics.forces import BeamState, Forces, HalfBeams, forces, moved
from simulearn.mechanics.poses import Array, Pose
from simulearn.mechanics.stiffness import Factors, balance, exact_stiffness, solve
from simulearn.mechanics.topology import Topology

LONGEST = 15.0  # mm, that anything may move in one step
NEAR = 3.0  # mm, the motion below which the stiffness of forces is added
CLOSE = 1.0  # mm, the motion below which old factors are tried
AGAIN = 4  # steps with the same factors, at most
FREE = 8  # steps that may lead uphill: bending at first stretches
SLOW = 0.3  # of the step before; where a step is longer, new factors are needed

Motion = tuple[Array, Array]  # of joints (J, 6) and middles (B, 6), about the origin


@partial(jax.custom_vjp, nondiff_argnums=(3, 4))
def solve_equilibrium(
    topology: Topology, half_beams: HalfBeams, state: BeamState, tolerance: float, most: int
) -> tuple[BeamState, Array]:
    """Return the equilibrium nearest to a state, and the last motion (mm), as `iterate` does.

    Its derivatives are those of the equilibrium, by the theorem of implicit functions.
    """
    return iterate(topology, half_beams, state, tolerance, most)


def _solve_forward(
    topology: Topology, half_beams: HalfBeams, state: BeamState, tolerance: float, most: int
) -> tuple[tuple[BeamState, Array], tuple[Topology, HalfBeams, BeamState]]:
    state, motion = iterate(topology, half_beams, state, tolerance, most)
    return (state, motion), (topology, half_beams, state)


def _solve_backward(
    tolerance: float,
    most: int,
    solved: tuple[Topology, HalfBeams, BeamState],
    bar: tuple[BeamState, Array],
) -> tuple[None, HalfBeams, BeamState]:
    topology, half_beams, state = solved
    count, beams = len(half_beams.weight), topology.ends.shape[1]
    zero = jnp.zeros((count, 6)), jnp.zeros((beams, 6))
    pulled = jax.vjp(lambda a, b: moved(state, a, b), *zero)[1](bar[0])
    right = jnp.concatenate([pulled[0].at[topology.fixed].set(0.0).ravel(), pulled[1].ravel()])
    weight = jnp.linalg.solve(exact_stiffness(topology, half_beams, state).T, right)
    split = weight[: 6 * count].reshape(-1, 6), weight[6 * count :].reshape(-1, 6)

    def with_held(half_beams: HalfBeams, held: Pose) -> Forces:
        def with_fixed(x: Array, y: Array) -> Array:
            return x.at[topology.fixed].set(y)

        at = BeamState(jax.tree.map(with_fixed, state.joints, held), state.middles)
        return forces(topology, half_beams, at)

    # The fixed joint stays where it was put: what depends on it depends on where it began.
    held = jax.tree.map(lambda x: x[topology.fixed], state.joints)
    bar_el, bar_held = jax.vjp(with_held, half_beams, held)[1](Forces(-split[0], -split[1]))
    begun = jax.tree.map(jnp.zeros_like, state)
    joints = jax.tree.map(
        lambda zero, b, own: zero.at[topology.fixed].set(b + own[topology.fixed]),
        begun.joints,
        bar_held,
        bar[0].joints,
    )
    return None, bar_el, BeamState(joints, begun.middles)


solve_equilibrium.defvjp(_solve_forward, _solve_backward)


def iterate(
    topology: Topology, half_beams: HalfBeams, state: BeamState, tolerance: float, most: int
) -> tuple[BeamState, Array]:
    """Iterate until nothing moves by more than a tolerance (mm); return the last motion, too."""

    def newton_step(state: BeamState, out: Forces, by: Factors) -> tuple[Motion, Array]:
        joints, middles = solve(topology, out, by)
        motion = jnp.maximum(_motion(state.joints, joints), _motion(state.middles, middles))
        stable = jnp.isfinite(motion)  # else the stiffness has no factor: stay
        less = jnp.minimum(1.0, LONGEST / jnp.maximum(motion, 1e-9))
        step = jnp.where(stable, less * joints, 0.0), jnp.where(stable, less * middles, 0.0)
        return step, jnp.where(stable, motion, jnp.inf)

    def once(carry: tuple[BeamState, Array, Array]) -> tuple[BeamState, Array, Array]:
        state, before, count = carry
        out, by = balance(topology, half_beams, state, jnp.where(before < NEAR, 1.0, 0.0))
        step, motion = newton_step(state, out, by)

        # Where a step leads beyond the lowest point along it, back to where that may lie. A loop of
        # one round at most: of a condition, vmap would compute both branches every time.
        def shorter(carry: tuple[Array, Array]) -> tuple[Array, Array]:
            slope = _power(out, step)
            beyond = _power(forces(topology, half_beams, moved(state, *step)), step)
            share = jnp.where(beyond > -slope / 4, slope / (slope - beyond), 1.0)
            return share, jnp.array(0.0)

        far = jnp.isfinite(motion) & (count >= FREE)
        begin = (jnp.array(1.0), jnp.where(far, motion, 0.0))
        share, _ = jax.lax.while_loop(lambda carry: carry[1] > CLOSE, shorter, begin)
        state = moved(state, share * step[0], share * step[1])

        def again(
            carry: tuple[BeamState, Array, Array, Array],
        ) -> tuple[BeamState, Array, Array, Array]:
            state, before, _, k = carry
            step, motion = newton_step(state, forces(topology, half_beams, state), by)
            return moved(state, *step), motion, motion > SLOW * before, k + 1

        def going(carry: tuple[BeamState, Array, Array, Array]) -> Array:
            _, motion, slow, k = carry
            return (motion > tolerance) & ~slow & (k < AGAIN)

        begun = (state, motion, motion > CLOSE, jnp.array(0))
        state, motion, _, _ = jax.lax.while_loop(going, again, begun)
        return state, motion, count + 1

    def going(carry: tuple[BeamState, Array, Array]) -> Array:
        return (carry[1] > tolerance) & (carry[2] < most)

    begin = (state, jnp.array(jnp.inf), jnp.array(0))
    state, motion, _ = jax.lax.while_loop(going, once, begin)
    return state, motion


def _motion(pose: Pose, step: Array) -> Array:
    """Return how far a motion moves a pose, to first order, along an axis at most, mm."""
    return jnp.abs(step[..., :3] + jnp.cross(step[..., 3:], pose.p)).max()


def _power(forces: Forces, step: Motion) -> Array:
    """Return how the energy changes along a step, to first order."""
    return (forces.joints * step[0]).sum() + (forces.middles * step[1]).sum()

"""The law of a printed beam: how a half of it would lie free of loads, and how stiff it is.

A half is passive from its joint's face on, then active up to the middle. Each part has a constant
rest strain, so that it lies on an arc; its compliance is that of the arc, part by part. Rest
strains and stiffnesses are polynomials in the released fraction s with fitted coefficients.
"""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from simulearn.mechanics.poses import Array, Pose, adjoint, exp_se3

GAUSS = (0.5 - 0.5 / np.sqrt(3), 0.5 + 0.5 / np.sqrt(3))


class Law(NamedTuple):
    """Fitted properties; polynomials are coefficients of s, s2.

    Attributes:
        active, passive: (2,) rest stretch of active and passive parts.
        curvature: (2,) of active parts, rad/mm.
        short: () more of it per s where the actuator is short, times one less its ratio.
        tilt: (2,) rad, of the fixed joint's faces, whose lower half is held.
        plane, thickness: (2,) stretch of joints.
        waist: (2, 2) stretch across, and through the thickness, of a beam's middle.
        stiffness: (3, 6) log of axial (N), two shear (N), torsional and two bending (N mm2)
            stiffnesses of passive parts: at s = 0, per s, per s2.
        stiffened: (2, 6) the same of active parts relative to passive: at s = 0, per s.
    """

    active: Array
    passive: Array
    curvature: Array
    short: Array
    tilt: Array
    plane: Array
    thickness: Array
    waist: Array
    stiffness: Array
    stiffened: Array


def first_guess() -> Law:
    """Return the law of a uniform section of hot PLA, from which fitting begins."""
    array = lambda *x: jnp.array(x)  # noqa: E731
    modulus, area = 2.2, 28.8
    bending = [modulus * 7.2 * 4.0**3 / 12, modulus * 4.0 * 7.2**3 / 12]
    stiffness = [modulus * area, 0.3 * modulus * area, 0.3 * modulus * area, 50.0, *bending]
    return Law(
        active=array(-0.035, 0.0),
        passive=array(-0.005, 0.0),
        curvature=array(0.034, 0.0),
        short=jnp.array(0.0),
        tilt=array(-0.02, 0.0),
        plane=array(-0.031, 0.0),
        thickness=array(0.039, 0.0),
        waist=jnp.array([[-0.005, 0.0], [0.023, 0.0]]),
        stiffness=jnp.stack([jnp.log(jnp.array(stiffness)), jnp.zeros(6), jnp.zeros(6)]),
        stiffened=jnp.zeros((2, 6)),
    )


def in_s(coefficients: Array, s: Any) -> Array:
    """Return a quadratic without constant at s."""
    return coefficients[0] * s + coefficients[1] * s * s


def tilted(law: Law, held: Array, s: Any) -> Pose:
    """Return how faces lie as seen from where they would if they were not held.

    Args:
        law: of the section.
        held: (...) 1 where the half leaves the fixed joint, else 0.
        s: released fraction.
    """
    zero = jnp.zeros_like(held)
    return exp_se3(jnp.stack([zero, zero, zero, zero, held * in_s(law.tilt, s), zero], -1))


def rest(law: Law, length: Array, ratio: Array, s: Any) -> tuple[Pose, Array]:
    """Return how halves lie free of loads, and their compliances there.

    Args:
        law: of the section.
        length: (...) net length of the whole beams, mm.
        ratio: (...) signed actuator ratios.
        s: released fraction.

    Returns:
        Pose of the middle as seen from the face, where that is not held; compliance (..., 6, 6):
        how far the middle moves (a twist there) under a wrench there, (mm, rad) per (N, N mm).
    """
    size, sign = jnp.abs(ratio), jnp.sign(ratio)
    passive, active = (1 - size) / 2 * length, size / 2 * length
    zero = jnp.zeros_like(length)
    bend = in_s(law.curvature, s) + law.short * s * (1 - size)
    first = jnp.stack([passive * (1 + in_s(law.passive, s)), *[zero] * 5], -1)
    # The active half shrinks: a beam curls towards it, which is about -y where it is on top.
    second = jnp.stack(
        [active * (1 + in_s(law.active, s)), zero, zero, zero, -sign * bend * active, zero], -1
    )
    stiff = law.stiffness[0] + law.stiffness[1] * s + law.stiffness[2] * s * s
    soft = jnp.exp(-jnp.stack([stiff, stiff + law.stiffened[0] + law.stiffened[1] * s]))
    # Both parts, and both Gauss points of each, at once: (2, 2, ..., 6).
    strains = jnp.stack([first, second])
    back = 1 - jnp.array(GAUSS).reshape(2, *[1] * first.ndim)
    inner = exp_se3(strains[:, None] * back)
    placed, arc = exp_se3(first), exp_se3(second)
    beyond = jax.tree.map(lambda x: jnp.stack([x, jnp.broadcast_to(_none(x), x.shape)]), arc)
    onward = inner @ jax.tree.map(lambda x: x[:, None], beyond)
    turn = adjoint(onward.inverse)
    weight = jnp.stack([passive, active])[..., None] / 2 * soft.reshape(2, *[1] * zero.ndim, 6)
    compliance = jnp.einsum("pg...ij,p...j,pg...kj->...ik", turn, weight, turn)
    return placed @ arc, compliance


def _none(x: Array) -> Array:
    """Return the rotation or the way of no motion."""
    return jnp.eye(3) if x.shape[-2:] == (3, 3) else jnp.zeros(3)

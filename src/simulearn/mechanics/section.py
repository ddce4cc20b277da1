"""The section model of a printed beam: the rest shape of a half-beam, and its stiffness.

A half is passive from its joint's face on, then active up to the middle. Each part has a constant
rest strain, so that it lies on an arc; its compliance is that of the arc, part by part. Rest
strains and stiffnesses are polynomials in the released fraction s with fitted coefficients.
"""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from simulearn.mechanics.model import SectionModel
from simulearn.mechanics.poses import Array, Pose, adjoint, exp_se3

GAUSS = (0.5 - 0.5 / np.sqrt(3), 0.5 + 0.5 / np.sqrt(3))


def in_s(coefficients: Array, s: Any) -> Array:
    """Return a quadratic without constant at s."""
    return coefficients[0] * s + coefficients[1] * s * s


def tilted(section_model: SectionModel, held: Array, reach: Array, s: Any) -> Pose:
    """Return the poses of faces relative to where they would lie on a joint that stays flat.

    Args:
        section_model: of the section.
        held: (...) 1 where the half leaves the fixed joint, whose lower half is held, else 0.
        reach: (...) from the joint's centre to the face, mm.
        s: released fraction.
    """
    zero = jnp.zeros_like(held)
    turn = held * in_s(section_model.tilt, s) - reach * in_s(section_model.lean, s)
    return exp_se3(jnp.stack([zero, zero, zero, zero, turn, zero], -1))


def rest(section_model: SectionModel, length: Array, ratio: Array, s: Any) -> tuple[Pose, Array]:
    """Return how halves lie free of loads, and their compliances there.

    Args:
        section_model: of the section.
        length: (...) net length of the beams, mm.
        ratio: (...) signed actuator ratios.
        s: released fraction.

    Returns:
        Pose of the middle relative to the face, where that is not held; compliance (..., 6, 6):
        how far the middle moves (a twist there) under a wrench there, (mm, rad) per (N, N mm).
    """
    size, sign = jnp.abs(ratio), jnp.sign(ratio)
    passive, active = (1 - size) / 2 * length, size / 2 * length
    zero = jnp.zeros_like(length)
    bend = in_s(section_model.curvature, s) + section_model.short * s * (1 - size)
    own = [in_s(x, s) for x in section_model.own]
    stretched = passive * (1 + in_s(section_model.passive, s))
    first = jnp.stack([stretched, zero, zero, zero, -own[0] * passive, zero], -1)
    # The active half shrinks: a beam curls towards it, which is about -y where it is on top.
    second = jnp.stack(
        [
            active * (1 + in_s(section_model.active, s)),
            zero,
            zero,
            zero,
            -(sign * bend + own[1]) * active,
            zero,
        ],
        -1,
    )
    stiff = (
        section_model.stiffness[0]
        + section_model.stiffness[1] * s
        + section_model.stiffness[2] * s * s
    )
    soft = jnp.exp(
        -jnp.stack([stiff, stiff + section_model.stiffened[0] + section_model.stiffened[1] * s])
    )
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
    """Return the rotation or translation of no motion."""
    return jnp.eye(3) if x.shape[-2:] == (3, 3) else jnp.zeros(3)

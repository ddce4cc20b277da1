"""The section model of a printed beam: the rest shape of a half-beam, and its stiffness.

A half is passive from its joint's face on, then active up to the middle. Each part has a constant
rest strain, so that it lies on an arc; its compliance is that of the arc, part by part. Rest
strains and stiffnesses are polynomials in the released fraction s with fitted coefficients.
"""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from simulearn.material import Material
from simulearn.mechanics.model import SectionModel
from simulearn.mechanics.poses import Array, Pose, adjoint, exp_se3

SHEAR = 0.3  # shear stiffness over E A, before fitting
TORSION = 50.0 / (2.2 * 7.2 * 4.0**3)  # torsional stiffness over E w t3, before fitting
PLA_STRAIN, PLA_THICKNESS = 0.09261, 4.0  # mm; of the section that the first guess was read off

GAUSS = (0.5 - 0.5 / np.sqrt(3), 0.5 + 0.5 / np.sqrt(3))


def first_guess(material: Material) -> SectionModel:
    """Return the model of a uniform section, from which fitting begins."""
    width, thick = material.section.width, material.section.thickness
    modulus, area = material.law.stiffness, width * thick
    shear = SHEAR * modulus * area
    torsion = TORSION * modulus * width * thick**3
    bending = [modulus * width * thick**3 / 12, modulus * thick * width**3 / 12]
    stiffness = [modulus * area, shear, shear, torsion, *bending]
    # Rest strains of PLA's section, in its released strain; curvature in strain over thickness.
    e = material.shrinkage.active / PLA_STRAIN
    return SectionModel(
        active=jnp.array([-0.035 * e, 0.0]),
        passive=jnp.array([-0.005 * e, 0.0]),
        curvature=jnp.array([0.034 * e * PLA_THICKNESS / thick, 0.0]),
        short=jnp.array(0.0),
        tilt=jnp.array([-0.02 * e, 0.0]),
        plane=jnp.array([-0.031 * e, 0.0]),
        thickness=jnp.array([0.039 * e, 0.0]),
        waist=e * jnp.array([[-0.005, 0.0], [0.023, 0.0]]),
        stiffness=jnp.stack([jnp.log(jnp.array(stiffness)), jnp.zeros(6), jnp.zeros(6)]),
        stiffened=jnp.zeros((2, 6)),
    )


def in_s(coefficients: Array, s: Any) -> Array:
    """Return a quadratic without constant at s."""
    return coefficients[0] * s + coefficients[1] * s * s


def tilted(section_model: SectionModel, held: Array, s: Any) -> Pose:
    """Return the poses of faces relative to where they would lie if they were not held.

    Args:
        section_model: of the section.
        held: (...) 1 where the half leaves the fixed joint, else 0.
        s: released fraction.
    """
    zero = jnp.zeros_like(held)
    return exp_se3(
        jnp.stack([zero, zero, zero, zero, held * in_s(section_model.tilt, s), zero], -1)
    )


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
    first = jnp.stack([passive * (1 + in_s(section_model.passive, s)), *[zero] * 5], -1)
    # The active half shrinks: a beam curls towards it, which is about -y where it is on top.
    second = jnp.stack(
        [
            active * (1 + in_s(section_model.active, s)),
            zero,
            zero,
            zero,
            -sign * bend * active,
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

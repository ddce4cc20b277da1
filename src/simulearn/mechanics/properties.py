"""A material as mechanics sees it: plain numbers, one set for each design or many stacked."""

from typing import Any, NamedTuple

import numpy as np

from simulearn.material import Material, member_of

# PLA in water of 80 C: numbers are counted from it.
REFERENCE_STRAIN, REFERENCE_RATIO = 0.09261, 0.118 / 0.158
REFERENCE_SLENDER, REFERENCE_RIM = 1.8, 0.125
REFERENCE_WEIGHT, REFERENCE_STIFFNESS = 4.959e-6, 2.2


class Properties(NamedTuple):
    """Numbers of a material, each () or stacked.

    Attributes:
        width, thickness: of the section, mm.
        stiffness: modulus, MPa.
        body: weight, N/mm3.
        creep: creep strain over elastic strain.
        strain: released strain of the active half over that of the reference.
        passive, joint, shell: released strains over that of the active half.
        curl: what the top shrinks more than the bottom, over the same.
        rim: width of a shell over that of the section.
        along, across: printed-in stress of active and of passive halves, MPa.
        mesh: 0 for the default mesh, 1 for the fine one, whose answer is wanted.
    """

    width: Any
    thickness: Any
    stiffness: Any
    body: Any
    creep: Any
    strain: Any
    passive: Any
    joint: Any
    shell: Any
    curl: Any
    rim: Any
    along: Any
    across: Any
    mesh: Any


def properties_of(material: Material, mesh: float = 1.0) -> Properties:
    """Return the numbers of a material.

    Args:
        material: the material system.
        mesh: 0 for the default mesh, 1 for the fine one.
    """
    member, section = member_of(material), material.section
    return Properties(
        width=section.width,
        thickness=section.thickness,
        stiffness=material.law.stiffness,
        body=material.gravity.body_force,
        creep=material.creep.amplitude,
        strain=member.strain / REFERENCE_STRAIN,
        passive=member.passive,
        joint=member.joint,
        shell=member.shell,
        curl=member.curl,
        rim=member.rim,
        along=material.shrinkage.stress_active,
        across=material.shrinkage.stress_passive,
        mesh=mesh,
    )


def stacked(properties: list[Properties]) -> Properties:
    """Return the numbers of several materials as arrays."""
    return Properties(*(np.array(x, np.float64) for x in zip(*properties, strict=True)))


DEVIATIONS = 6  # ratios, rim, width over thickness, mesh


def deviations(p: Properties, xp: Any) -> Any:
    """Return how a material deviates from the reference in what curls: (DEVIATIONS, ...).

    Args:
        p: numbers.
        xp: NumPy or jax.numpy.
    """
    slender = xp.log(p.width / p.thickness / REFERENCE_SLENDER) / 0.4
    return xp.stack(
        [
            (p.passive - REFERENCE_RATIO) / 0.2,
            (p.joint - REFERENCE_RATIO) / 0.2,
            (p.shell - 1) / 0.2,
            (p.rim - REFERENCE_RIM) / 0.05,
            slender,
            p.mesh + 0.0 * slender,
        ]
    )


def signs_of(p: Properties, xp: Any) -> Any:
    """Return what a network sees of a material: (DEVIATIONS + 2, ...).

    How it deviates in what curls, then its own curl, which is upwards, and its weight.
    """
    weight = p.body * p.thickness / p.stiffness / REFERENCE_WEIGHT - 1
    rest = xp.stack([p.curl / 0.3 + 0.0 * weight, weight])
    return xp.concatenate([deviations(p, xp), rest])

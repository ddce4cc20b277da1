"""The properties of a printed section: as functions of the material, and of one material.

What a beam does at rest follows from its section as that of a layered beam does; what the solid
does besides is fitted: each coefficient is that of the layered beam plus a linear function of how
the material deviates from the reference. Growth is I + s diag(g), so that coefficients of s grow
as the strain, those of s2 as its square. Lengths count in thicknesses, so that a section of half
the size needs nothing new.
"""

from typing import Any, NamedTuple

import numpy as np

from simulearn.mechanics.properties import DEVIATIONS, REFERENCE_STRAIN, Properties, deviations

REFERENCE_WIDTH = 7.2  # mm; lengths count in sections of this width

SHEAR = 0.3  # shear stiffness over E A, before fitting
TORSION = 0.0493  # torsional stiffness over E w t3 of the reference section, before fitting
POISSON = 0.406


class SectionModel(NamedTuple):
    """Properties of a printed section; polynomials are coefficients of s, s2.

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
        own: (2, 2) curvature of its own, upwards, of passive and of active parts, rad/mm.
        lean: (2,) the same of joints: by so much their faces lean for each mm from the centre.
    """

    active: Any
    passive: Any
    curvature: Any
    short: Any
    tilt: Any
    plane: Any
    thickness: Any
    waist: Any
    stiffness: Any
    stiffened: Any
    own: Any
    lean: Any


SECTION_SHAPES = SectionModel(
    (2,), (2,), (2,), (), (2,), (2,), (2,), (2, 2), (3, 6), (2, 6), (2, 2), (2,)
)
TERMS = 2 + DEVIATIONS  # one, the deviations, and the square of the own curl


class SectionLaw(SectionModel):
    """Fitted coefficients of each property of a section, (TERMS, ...) each: see `section_of`."""


def unfitted() -> SectionLaw:
    """Return the law of layered beams, from which fitting begins."""
    return SectionLaw(*(np.zeros((TERMS, *shape)) for shape in SECTION_SHAPES))


def section_of(law: SectionLaw, p: Properties, xp: Any = np) -> SectionModel:
    """Return the properties of a material's section.

    Args:
        law: fitted.
        p: numbers of the material, each (); or (T,) for many, whose axis is then the last one.
        xp: NumPy or jax.numpy.
    """
    curved = (p.curl / 0.3) ** 2
    terms = xp.concatenate([xp.stack([1.0 + 0.0 * curved]), deviations(p, xp), xp.stack([curved])])
    fitted = SectionLaw(*(xp.tensordot(x, terms, axes=(0, 0)) for x in law))
    k, t = p.strain, p.thickness
    rise = xp.stack([k * 1.0, k * k])  # coefficients of s and s2 grow so
    core, shells = 1 - 2 * p.rim, 2 * p.rim
    e, across = REFERENCE_STRAIN, POISSON * p.passive
    shells = shells * p.shell

    def first(value: Any) -> Any:
        """Return a coefficient of s, and none of s2."""
        return xp.stack([value, 0.0 * value])

    passive = e * (core * across - shells)
    active = e * (core * (across - 1) / 2 - shells)
    curvature = 1.5 * core * e * (1 + across)  # of two halves, in thicknesses
    joint = e * p.joint
    none = 0.0 * joint
    waist = xp.stack(
        [first(-0.06 * joint + none), first(0.33 * joint + none)]
    )  # across, and through the thickness
    curl = e * p.curl
    area, slender = p.width * t, p.width / t
    shear = SHEAR * area
    torsion = TORSION * _torsion(slender, xp) / _torsion(REFERENCE_WIDTH / 4, xp)
    axes = [
        area, shear, shear, torsion * p.width * t**3,
        p.width * t**3 / 12, t * p.width**3 / 12,
    ]  # fmt: skip
    log = xp.log(p.stiffness * xp.stack([1.0 * x for x in axes]))
    return SectionModel(
        active=rise * (first(active) + fitted.active),
        passive=rise * (first(passive) + fitted.passive),
        curvature=rise * (first(curvature) + fitted.curvature) / t,
        short=k * fitted.short / t,
        tilt=rise * (first(-0.29 * joint) + fitted.tilt),
        plane=rise * (first((POISSON - 1) * joint) + fitted.plane),
        thickness=rise * (first(2 * POISSON * joint) + fitted.thickness),
        waist=rise * (waist + fitted.waist),
        stiffness=xp.stack(
            [log + fitted.stiffness[0], k * fitted.stiffness[1], k * k * fitted.stiffness[2]]
        ),
        stiffened=xp.stack([fitted.stiffened[0], k * fitted.stiffened[1]]),
        # Odd in the own curl: so is what is fitted.
        own=rise * curl * (xp.stack([first(1.0 + none), first(1.0 + none)]) + fitted.own) / t,
        lean=rise * curl * (first(1.0 + none) + fitted.lean) / t,
    )


def _torsion(slender: Any, xp: Any) -> Any:
    """Return the torsional constant of a rectangle over w t3 (Timoshenko, Goodier 1970)."""
    thin = xp.minimum(slender, 1 / slender)
    value = (1 - 0.63 * thin * (1 - thin**4 / 12)) / 3
    return xp.where(slender < 1, value * slender**2, value)

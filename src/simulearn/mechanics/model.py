"""The fitted properties of a printed section, as plain arrays."""

from typing import Any, NamedTuple

REFERENCE_WIDTH = 7.2  # mm; lengths count in sections of this width


class SectionModel(NamedTuple):
    """Fitted properties of a printed beam; polynomials are coefficients of s, s2.

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

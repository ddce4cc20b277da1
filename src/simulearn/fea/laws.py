"""Constitutive laws from what a material system says.

Marlow law: the energy is whatever function of the first invariant a uniaxial test demands.
At nominal strain e and stress T of the test, with stretch l = 1 + e, the lateral faces are free, so
the Kirchhoff stress is l T along the test and zero across. Its mean is K J (J - 1), which gives
J(J - 1) = l T / 3K, the lateral stretch^2 m = J / l, and from the deviator
dw/dI1 = l T J^(2/3) / 2(l^2 - m): one point (I1, dw/dI1) from each point of the table, exactly.

Between the points f'(x) = 2 x dw/dI1 is interpolated over x = sqrt(I1 - 3), in which it is nearly
the stress-strain curve itself, by monotone cubics; beyond the table it goes on with its last slope.
"""

import numpy as np
from scipy.interpolate import PchipInterpolator

from simulearn.fea.kernels.law import (
    MARLOW,
    NEO_HOOKEAN,
    ST_VENANT_KIRCHHOFF,
    ConstitutiveLaw,
)
from simulearn.material import ElasticData, MarlowData


def law_of(data: MarlowData | ElasticData) -> ConstitutiveLaw:
    """Return the law that a material system's data describe."""
    if isinstance(data, MarlowData):
        return marlow(data)
    shear = data.stiffness / (2 * (1 + data.poisson))
    bulk = data.stiffness / (3 * (1 - 2 * data.poisson))
    if data.kind == "neo-hookean":
        return neo_hookean(shear, bulk)
    return st_venant_kirchhoff(bulk - 2 / 3 * shear, shear)


def marlow(data: MarlowData) -> ConstitutiveLaw:
    """Return the Marlow law that reproduces a uniaxial test."""
    bulk = data.stiffness / (3 * (1 - 2 * data.poisson))
    strain, stress = np.array(data.table).T
    stress *= data.scale
    stretch = 1 + strain
    J = (1 + np.sqrt(1 + 4 * stretch * stress / (3 * bulk))) / 2
    lateral = J / stretch
    x = np.sqrt(J ** (-2 / 3) * (stretch**2 + 2 * lateral) - 3)
    slope = stretch * stress * J ** (2 / 3) / (stretch**2 - lateral) * x
    curve = PchipInterpolator(np.r_[0, x], np.r_[0, slope])
    beyond = [0, 0, max(float(curve(x[-1], 1)), 0.0), slope[-1]]
    pieces = np.column_stack([curve.c, beyond])
    area = np.vstack([pieces / np.array([4, 3, 2, 1])[:, None], np.zeros(len(x) + 1)])
    steps = np.diff(np.r_[0, x])
    for k, step in enumerate(steps):
        area[4, k + 1] = np.polyval(area[:, k], step)
    return ConstitutiveLaw(MARLOW, float(bulk), 0.0, np.r_[0, x], np.ascontiguousarray(area))


def neo_hookean(shear: float, bulk: float) -> ConstitutiveLaw:
    """Return W = shear/2 (I1 - 3) + bulk/2 (J - 1)^2; MPa. For verification; CalculiX has it."""
    return ConstitutiveLaw(NEO_HOOKEAN, float(bulk), float(shear), np.zeros(1), np.zeros((5, 1)))


def st_venant_kirchhoff(lame: float, shear: float) -> ConstitutiveLaw:
    """Return W = lame/2 tr(E)^2 + shear E:E with E = (F^T F - I)/2; MPa.

    For verification: published tables of large bending use it, and so does CalculiX for a linear
    elastic material in a geometrically nonlinear step.
    """
    return ConstitutiveLaw(
        ST_VENANT_KIRCHHOFF, float(lame), float(shear), np.zeros(1), np.zeros((5, 1))
    )

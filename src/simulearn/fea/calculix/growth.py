"""Growth in the words that CalculiX has for it.

Its thermal expansion would not do: in a geometrically nonlinear step version 2.20 subtracts the
thermal strain from the displacement gradient, so that a body which grew freely and then merely
turned is stressed. Initial strains are exact: S = D : (E - E0).

Growth F_g = diag(g) in the printing frame gives the elastic strain F_g^-1 (E - E0) F_g^-1 with
E0 = (F_g^2 - I)/2. The St Venant-Kirchhoff law of the grown volume is then, per reference volume,

    S_ij = det F_g D_ijkl / (g_i g_j g_k g_l) (E - E0)_kl

which is an orthotropic linear law in the printing frame: CalculiX computes F_e = F F_g^-1 exactly.
See docs/calculix.md for the measurements.
"""

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.fea.solid import Solid
from simulearn.material import ElasticData

Array = NDArray[np.float64]


def uniform(solid: Solid) -> Array:
    """Return the growth (E, 3) of bricks that have one each.

    Raises:
        InputError: growth varies inside a brick.
    """
    first = solid.growth[:, 0]
    varies = np.flatnonzero((solid.growth != first[:, None]).any(axis=(1, 2)))
    if varies.size:
        raise InputError(
            f"brick {varies[0]} has several growths; CalculiX takes one in each brick: "
            "mesh shells and core as bricks of their own"
        )
    return first


def initial_strain(angle: Array, growth: Array, release: float) -> Array:
    """Return the Lagrange strain of growth (E, 6), order 11 22 33 12 13 23, in global axes.

    Args:
        angle: (E,) direction of the printing frame's first axis from +x, radians.
        growth: (E, 3) released strains in the printing frame.
        release: released fraction s.
    """
    along, across, up = (release * growth + (release * growth) ** 2 / 2).T
    c, s = np.cos(angle), np.sin(angle)
    zero = np.zeros_like(c)
    return np.column_stack(
        [
            c * c * along + s * s * across,
            s * s * along + c * c * across,
            up,
            c * s * (along - across),
            zero,
            zero,
        ]
    )


def orthotropic(law: ElasticData, growth: Array, release: float) -> Array:
    """Return the nine constants of the grown St Venant-Kirchhoff law in the printing frame, MPa.

    Args:
        law: Young's modulus and Poisson ratio.
        growth: (3,) released strains in the printing frame.
        release: released fraction s.

    Returns:
        D1111, D1122, D2222, D1133, D2233, D3333, D1212, D1313, D2323.
    """
    shear = law.stiffness / (2 * (1 + law.poisson))
    lame = law.stiffness * law.poisson / ((1 + law.poisson) * (1 - 2 * law.poisson))
    g = 1 + release * growth
    D = (lame + 2 * shear * np.eye(3)) * g.prod() / np.outer(g, g) ** 2
    G = shear * g.prod() / np.outer(g, g) ** 2
    return np.array(
        [D[0, 0], D[0, 1], D[1, 1], D[0, 2], D[1, 2], D[2, 2], G[0, 1], G[0, 2], G[1, 2]]
    )

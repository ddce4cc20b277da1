"""Stress and moduli of any law in the Lagrange strain of the flat grid, with growth.

Per volume of the flat grid the energy is det F_g w(F F_g^-1). Written in the strain E its
derivatives are the second Piola-Kirchhoff stress and its moduli, by automatic differentiation of
the law's energy alone: nothing of the solver's own stresses and tangents is used.
"""

from collections.abc import Callable

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from simulearn.compiled import double_precision
from simulearn.fea.calculix.energy import energy as density
from simulearn.fea.kernels.law import ConstitutiveLaw

# The order of CalculiX: 11 22 33 12 13 23.
ROW, COLUMN = np.array([[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]]).T


def moduli_of(law: ConstitutiveLaw) -> Callable[..., tuple[Array, Array]]:
    """Return the function that gives S (M, 6) and dS/dE (M, 6, 6) of a law, MPa.

    Its arguments are the strains (M, 6) with engineering shears, the axes of the printing frames as
    rows (M, 3, 3), and the stretches of growth along them (M, 3).
    """

    def energy(strain: Array, frame: Array, stretch: Array) -> Array:
        half = jnp.zeros((3, 3)).at[ROW, COLUMN].set(strain / 2)
        C = jnp.eye(3) + 2 * (half + half.T)
        inverse = frame.T @ jnp.diag(1 / stretch) @ frame
        # An isotropic law cannot tell F_e from any other root of C_e.
        F = _root(inverse @ C @ inverse)
        return stretch.prod() * density(law, F)

    def both(strain: Array, frame: Array, stretch: Array) -> tuple[Array, Array]:
        point = strain, frame, stretch
        return jax.grad(energy)(*point), jax.hessian(energy)(*point)

    return double_precision(jax.jit(jax.vmap(both)))


def _root(C: Array) -> Array:
    """Return the upper triangular F (3, 3) with F^T F = C."""
    # Written out: the library's routine works matrix by matrix and cannot be fused.
    a = jnp.sqrt(C[0, 0])
    b, c = C[0, 1] / a, C[0, 2] / a
    d = jnp.sqrt(C[1, 1] - b**2)
    e = (C[1, 2] - b * c) / d
    f = jnp.sqrt(C[2, 2] - c**2 - e**2)
    zero = jnp.zeros(())
    return jnp.array([[a, b, c], [zero, d, e], [zero, zero, f]])

"""Energy densities of the constitutive laws, for automatic differentiation.

Call it in double precision (`compiled.double_precision`). The solver has stress and moduli in
closed form (`fea.kernels.law`). What is derived from these energies is independent of them: the
tests compare both, and CalculiX is given only what is here.
"""

import jax
import jax.numpy as jnp
from jax import Array

from simulearn.fea.kernels.law import MARLOW, SMALL, ST_VENANT_KIRCHHOFF, ConstitutiveLaw


def energy(law: ConstitutiveLaw, F: Array) -> Array:
    """Return the energy density at an elastic deformation gradient F (3, 3), MPa."""
    C = F.T @ F
    if law.kind == ST_VENANT_KIRCHHOFF:
        E = (C - jnp.eye(3)) / 2
        return law.first / 2 * jnp.trace(E) ** 2 + law.shear * (E * E).sum()
    # Written out: the library's determinant factors the matrix, and cannot be fused.
    J = jnp.dot(F[0], jnp.cross(F[1], F[2]))
    I1 = J ** (-2 / 3) * jnp.trace(C)
    volume = law.first / 2 * (J - 1) ** 2
    if law.kind == MARLOW:
        return _table(law, I1) + volume
    return law.shear / 2 * (I1 - 3) + volume


def _table(law: ConstitutiveLaw, I1: Array) -> Array:
    """Return the energy of Marlow's table at the isochoric first invariant."""
    x = jnp.sqrt(jnp.maximum(I1 - 3, 0) + SMALL)
    k = jnp.searchsorted(jnp.asarray(law.breaks), jax.lax.stop_gradient(x), side="right") - 1
    t = x - jnp.asarray(law.breaks)[k]
    a, b, c, d, e = jnp.asarray(law.pieces)[:, k]
    return (((a * t + b) * t + c) * t + d) * t + e

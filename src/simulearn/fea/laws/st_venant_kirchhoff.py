"""St Venant-Kirchhoff law: linear between Green-Lagrange strain and second Piola-Kirchhoff stress.

For verification: published tables of large bending use it, and so does CalculiX for a linear
elastic material in a geometrically nonlinear step.
"""

from dataclasses import dataclass

import jax
import jax.numpy as jnp
from jax import Array

from simulearn.fea.laws.law import Law


@jax.tree_util.register_dataclass
@dataclass(frozen=True)
class StVenantKirchhoff(Law):
    """W = lame/2 tr(E)^2 + shear E:E with E = (F^T F - I)/2; moduli in MPa."""

    lame: float
    shear: float

    def energy(self, F: Array) -> Array:
        """Return the energy density (M,)."""
        E = self._strain(F)
        return self.lame / 2 * jnp.einsum("iim->m", E) ** 2 + self.shear * (E * E).sum(axis=(0, 1))

    def response(self, F: Array) -> tuple[Array, Array]:
        """Return P = dW/dF (3, 3, M) and A = dP/dF (3, 3, 3, 3, M)."""
        E = self._strain(F)
        eye = jnp.eye(3)
        S = self.lame * jnp.einsum("iim->m", E) * eye[:, :, None] + 2 * self.shear * E
        P = jnp.einsum("kjm,jim->kim", F, S)
        FF = jnp.einsum("kim,ljm->kiljm", F, F)
        A = (
            jnp.einsum("kl,ijm->kiljm", eye, S)
            + self.lame * FF
            + self.shear * FF.transpose(0, 3, 2, 1, 4)
            + self.shear * jnp.einsum("knm,lnm,ij->kiljm", F, F, eye)
        )
        return P, A

    @staticmethod
    def _strain(F: Array) -> Array:
        return (jnp.einsum("kim,kjm->ijm", F, F) - jnp.eye(3)[:, :, None]) / 2

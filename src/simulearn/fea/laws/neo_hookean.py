"""Neo-Hookean law: w = mu/2 (I1 - 3). For verification; CalculiX has the same."""

from dataclasses import dataclass

import jax
import jax.numpy as jnp
from jax import Array

from simulearn.fea.laws.invariant import InvariantLaw


@jax.tree_util.register_dataclass
@dataclass(frozen=True)
class NeoHookean(InvariantLaw):
    """Neo-Hookean law with shear modulus `shear` and bulk modulus `bulk`, MPa."""

    shear: float
    bulk: float

    def isochoric(self, I1: Array) -> tuple[Array, Array, Array]:
        """Return w, dw/dI1 and d2w/dI1^2 (M,)."""
        half = self.shear / 2 * jnp.ones_like(I1)
        return half * (I1 - 3), half, jnp.zeros_like(I1)

"""What a constitutive law must offer, for many material points at once.

A law is an energy density of the elastic deformation gradient. Its stress and moduli follow by
differentiation; the laws give them in closed form, because they are what a solver spends its time
on, and the tests compare them with the automatic derivatives of the energy.

Points are the last axis of every array, so that compiled loops run over contiguous memory.
"""

from abc import ABC, abstractmethod

import jax.numpy as jnp
from jax import Array


class Law(ABC):
    """An energy density W(F), MPa; with F the elastic deformation gradient (3, 3, M)."""

    @abstractmethod
    def energy(self, F: Array) -> Array:
        """Return the energy density (M,)."""

    @abstractmethod
    def response(self, F: Array) -> tuple[Array, Array]:
        """Return P = dW/dF (3, 3, M) and A = dP/dF (3, 3, 3, 3, M), with A[k, i, l, j]."""


def inverse_transpose(F: Array) -> tuple[Array, Array]:
    """Return F^-T (3, 3, M) and det F (M,) by cofactors."""
    cofactors = jnp.stack([jnp.cross(F[(k + 1) % 3], F[(k + 2) % 3], axis=0) for k in range(3)])
    J = (F[0] * cofactors[0]).sum(axis=0)
    return cofactors / J, J

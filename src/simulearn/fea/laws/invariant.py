"""Laws in the first invariant: W = w(I1) + K/2 (J - 1)^2 with I1 = J^(-2/3) tr(F^T F).

Stress and moduli need only the first two derivatives of w, so a law of this family is its w.
"""

from abc import abstractmethod

import jax.numpy as jnp
from jax import Array

from simulearn.fea.laws.law import Law, inverse_transpose


class InvariantLaw(Law):
    """A law in the isochoric first invariant and the volume, with bulk modulus K in MPa."""

    bulk: float

    @abstractmethod
    def isochoric(self, I1: Array) -> tuple[Array, Array, Array]:
        """Return w, dw/dI1 and d2w/dI1^2 at the isochoric first invariant (M,)."""

    def energy(self, F: Array) -> Array:
        """Return the energy density (M,)."""
        _, J = inverse_transpose(F)
        I1 = J ** (-2 / 3) * (F * F).sum(axis=(0, 1))
        return self.isochoric(I1)[0] + self.bulk / 2 * (J - 1) ** 2

    def response(self, F: Array) -> tuple[Array, Array]:
        """Return P = dW/dF (3, 3, M) and A = dP/dF (3, 3, 3, 3, M)."""
        H, J = inverse_transpose(F)
        c = 2 * J ** (-2 / 3)
        trace = (F * F).sum(axis=(0, 1))
        _, w1, w2 = self.isochoric(c / 2 * trace)
        G = c * (F - trace / 3 * H)  # dI1/dF
        K = self.bulk
        P = w1 * G + K * (J - 1) * J * H

        # With dJ/dF = J H and dH[k, i]/dF[l, j] = -H[k, j] H[l, i]:
        outer = lambda a, b: a[:, :, None, None] * b[None, None]  # noqa: E731
        FH = outer(F, H)
        HH = outer(H, H)
        swapped = HH.transpose(0, 3, 2, 1, 4)  # H[k, j] H[l, i]
        eye = jnp.einsum("kl,ij->kilj", jnp.eye(3), jnp.eye(3))[..., None]
        A = (
            w2 * outer(G, G)
            + w1 * c * (eye - 2 / 3 * (FH + FH.transpose(2, 3, 0, 1, 4)))
            + (w1 * c * trace * 2 / 9 + K * (2 * J - 1) * J) * HH
            + (w1 * c * trace / 3 - K * (J - 1) * J) * swapped
        )
        return P, A

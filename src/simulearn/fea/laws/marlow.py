"""Marlow law: the energy is whatever function of the first invariant a uniaxial test demands.

At nominal strain e and stress T of the test, with stretch l = 1 + e, the lateral faces are free, so
the Kirchhoff stress is l T along the test and zero across. Its mean is K J (J - 1), which gives
J(J - 1) = l T / 3K, the lateral stretch^2 m = J / l, and from the deviator
dw/dI1 = l T J^(2/3) / 2(l^2 - m): one point (I1, dw/dI1) from each point of the table, exactly.

Between the points f'(x) = 2 x dw/dI1 is interpolated over x = sqrt(I1 - 3), in which it is nearly
the stress-strain curve itself, by monotone cubics; beyond the table it goes on with its last slope.
"""

from dataclasses import dataclass

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from scipy.interpolate import PchipInterpolator

from simulearn.fea.laws.invariant import InvariantLaw
from simulearn.material import MarlowData

# I1 - 3 is quadratic in the strain: below this (a strain of 6e-5) the law is linear.
SMALL = 1e-8


@jax.tree_util.register_dataclass
@dataclass(frozen=True)
class Marlow(InvariantLaw):
    """A law from a uniaxial test.

    Attributes:
        bulk: bulk modulus K, MPa.
        breaks: (n,) places x of the table, beginning with 0.
        pieces: (5, n) coefficients of f between breaks, highest power of (x - break) first.
    """

    bulk: float
    breaks: Array
    pieces: Array

    @classmethod
    def fit(cls, data: MarlowData) -> "Marlow":
        """Return the law that reproduces a uniaxial test."""
        bulk = data.modulus / (3 * (1 - 2 * data.poisson))
        strain, stress = np.array(data.table).T
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
        return cls(bulk, jnp.asarray(np.r_[0, x]), jnp.asarray(area))

    def isochoric(self, I1: Array) -> tuple[Array, Array, Array]:
        """Return w, dw/dI1 and d2w/dI1^2 (M,)."""
        x = jnp.sqrt(jnp.maximum(I1 - 3, 0) + SMALL)
        k = jnp.searchsorted(self.breaks, x, side="right", method="compare_all") - 1
        t = x - self.breaks[k]
        a, b, c, d, e = self.pieces[:, k]
        f = (((a * t + b) * t + c) * t + d) * t + e
        f1 = ((4 * a * t + 3 * b) * t + 2 * c) * t + d
        f2 = (12 * a * t + 6 * b) * t + 2 * c
        return f, f1 / (2 * x), (f2 - f1 / x) / (4 * x**2)

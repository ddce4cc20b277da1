"""The stress that a trial reports at its sampling points.

It is what is still locked in, (1 - s) times the printed-in stress, turned with the material, plus
the Cauchy stress of the elastic deformation: frame 0 shows the design, the last what is left.
"""

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from numpy.typing import NDArray

from simulearn.fea.kernel import Points, deformation
from simulearn.fea.laws import Law
from simulearn.fea.solid import Solid

COMPONENTS = (0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2)  # 11 22 33 12 13 23


def sampled_stress(
    solid: Solid,
    points: Points,
    u: NDArray[np.float64],
    released: float,
    cauchy: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Return the stress (B, 4, 4, 6) MPa at the sampling points.

    Args:
        solid: the solid.
        points: its material points.
        u: (N, 3) mm, displacements of the nodes.
        released: fraction of the residual stress that is released.
        cauchy: (M, 3, 3) MPa, elastic stress at the points.
    """
    many = len(solid.weights)
    # The bricks of beams follow those of joints.
    at = solid.samples + many * int((solid.parts[:, 0] < 0).sum())
    elastic = np.einsum("bsci,bscikl->bsckl", solid.shares, cauchy[at])
    F = np.asarray(_gradient(points, u[solid.bricks], released))[at]
    left, _, right = np.linalg.svd(np.einsum("bsci,bscikl->bsckl", solid.shares, F))
    frame = np.asarray(points.frame)[at[..., 0] // many]
    axes = np.einsum("bsckm,bscmi,bscai->bscak", left, right, frame)  # turned printing axes
    printed = solid.stress.reshape(-1, 3)[at[..., 0]]
    locked = (1 - released) * np.einsum("bsca,bscai,bscaj->bscij", printed, axes, axes)
    return np.asarray((elastic + locked)[..., *COMPONENTS])


@jax.jit
def cauchy_stress(law: Law, points: Points, u: Array, s: Array | float) -> Array:
    """Return the elastic Cauchy stress (M, 3, 3) MPa at all points; see `kernel.respond`."""
    F, _, _ = deformation(points, u, s)
    P, _ = law.response(F)
    return jnp.einsum("kim,lim->mkl", P, F) / jnp.linalg.det(F.transpose(2, 0, 1))[:, None, None]


@jax.jit
def _gradient(points: Points, u: Array, s: Array | float) -> Array:
    """Return the whole deformation gradient F_e F_g (M, 3, 3) at all points."""
    F, _, _ = deformation(points, u, s)
    grown = jnp.einsum("eai,eqa,eaj->eqij", points.frame, 1 + s * points.growth, points.frame)
    return jnp.einsum("kim,mij->mkj", F, grown.reshape(-1, 3, 3))

"""The stress that a trial reports at its sampling points.

It is what is still locked in, (1 - s) times the printed-in stress, turned with the material, plus
the Cauchy stress of the elastic deformation: frame 0 shows the design, the last what is left.
"""

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from numpy.typing import NDArray

from simulearn.fea.equilibrium import Equilibrium, State
from simulearn.fea.kernel import Points, deformation
from simulearn.fea.laws import Law

COMPONENTS = (0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2)  # 11 22 33 12 13 23


def sampled_stress(
    problem: Equilibrium, state: State, softening: float = 1.0
) -> NDArray[np.float64]:
    """Return the stress (B, 4, 4, 6) MPa at the sampling points of a solid in equilibrium.

    Args:
        problem: whose solid it is.
        state: its equilibrium.
        softening: by which creep has divided the elastic moduli.
    """
    solid = problem.solid
    first = solid.growth.shape[1] * problem.structure.joint_bricks
    cauchy, F = _fields(problem.law, problem.points, state.u[solid.bricks], state.released)
    # The points of beams follow those of joints.
    at = first + solid.samples
    elastic = np.einsum("bsci,bscikl->bsckl", solid.shares, np.asarray(cauchy)[at]) / softening
    F = np.einsum("bsci,bscikl->bsckl", solid.shares, np.asarray(F)[at])
    left, _, right = np.linalg.svd(F)
    frame = np.asarray(problem.points.frame)[at[..., 0] // solid.growth.shape[1]]
    axes = np.einsum("bsckm,bscmi,bscai->bscak", left, right, frame)  # turned printing axes
    printed = solid.stress.reshape(-1, 3)[at[..., 0]]
    locked = (1 - state.released) * np.einsum("bsca,bscai,bscaj->bscij", printed, axes, axes)
    return (elastic + locked)[..., *COMPONENTS]


@jax.jit
def _fields(law: Law, points: Points, u: Array, s: float) -> tuple[Array, Array]:
    """Return Cauchy stress and deformation gradient at all points, (M, 3, 3)."""
    F, _, _ = deformation(points, u, s)
    P, _ = law.response(F)
    J = jnp.linalg.det(F.transpose(2, 0, 1))
    cauchy = jnp.einsum("kim,lim->mkl", P, F) / J[:, None, None]
    grown = jnp.einsum(
        "eai,eqa,eaj->eqij", points.frame, 1 + s * points.growth, points.frame
    ).reshape(-1, 3, 3)
    return cauchy, jnp.einsum("kim,mij->mkj", F, grown)

"""Corners of joints and sections from the poses of beam mechanics, and poses from corners."""

import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray

from simulearn.mechanics.forces import FLIP, State
from simulearn.mechanics.poses import Array
from simulearn.mechanics.section import Law, in_s
from simulearn.mechanics.skeleton import Flat, Skeleton

Numbers = NDArray[np.float64]


def local_corners(
    law: Law, bones: Skeleton, plan: Flat, s: Array, face: Array, middle: Array
) -> tuple[Array, Array]:
    """Return the corners of joints (J, 8, 3) and of middle sections (B, 4, 3) in their own axes.

    Args:
        law: of the section; its stretches hold where nothing warps.
        bones: how the grid hangs together.
        plan: the flat grid.
        s: released fraction.
        face: (2, B, 4, 3) warping of the corners at the halves' joints, in the halves' axes, mm.
        middle: (2, B, 4, 3) the same of the middle sections, as either half tells it.
    """
    plane, thick = in_s(law.plane, s), in_s(law.thickness, s)
    joints = plan.corners * (1 + jnp.stack([plane, plane, thick]))
    told = jnp.einsum("hbij,hbcj->hbci", plan.frame, face)
    right, left = bones.side, (bones.side + 1) % 4
    corner = jnp.stack([right, left, 4 + right, 4 + left], -1)  # (2, B, 4)
    where = (bones.ends[..., None], corner)
    total = jnp.zeros_like(joints).at[where].add(told)
    count = jnp.zeros(joints.shape[:2]).at[where].add(1.0)
    joints += total / jnp.maximum(count, 1.0)[..., None]
    across, up = in_s(law.waist[0], s), in_s(law.waist[1], s)
    sections = plan.section * (1 + jnp.stack([jnp.zeros_like(across), across, up]))
    other = jnp.einsum("ij,bcj->bci", FLIP[1], middle[1][:, jnp.array([1, 0, 3, 2])])
    return joints, sections + (middle[0] + other) / 2


def placed(
    bones: Skeleton, plan: Flat, state: State, joints: Array, sections: Array
) -> tuple[Array, Array]:
    """Return corners in space: of joints (J, 8, 3), of sections (B, 3, 4, 3).

    The ends of a beam are the faces of its joints. The lower half of the fixed joint stays.
    """
    at = jnp.einsum("jik,jck->jci", state.joints.R, joints) + state.joints.p[:, None]
    flat = (plan.centre[:, None] + plan.corners)[bones.fixed, :4]
    at = at.at[bones.fixed, :4].set(flat)
    right, left = bones.side, (bones.side + 1) % 4
    corner = jnp.stack([right, left, 4 + right, 4 + left], -1)
    faces = at[bones.ends[..., None], corner]  # (2, B, 4, 3), as seen from either joint
    middle = jnp.einsum("bik,bck->bci", state.middles.R, sections) + state.middles.p[:, None]
    end = faces[1][:, jnp.array([1, 0, 3, 2])]
    return at, jnp.stack([faces[0], middle, end], 1)


def poses_of(corners: Numbers, local: Numbers) -> tuple[Numbers, Numbers]:
    """Return the rotations (..., 3, 3) and places (..., 3) that bring corners nearest.

    Args:
        corners: (..., C, 3) in space.
        local: (..., C, 3) in the body, about its centre.

    Source: W. Kabsch, Acta Cryst. A32, 922 (1976).
    """
    centre = corners.mean(axis=-2)
    product = np.swapaxes(corners - centre[..., None, :], -1, -2) @ local
    u, _, v = np.linalg.svd(product)
    sign = np.ones(product.shape[:-1])
    sign[..., 2] = np.sign(np.linalg.det(u @ v))
    return (u * sign[..., None, :]) @ v, centre

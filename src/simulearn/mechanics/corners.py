"""Corners of joints and sections from the poses of beam mechanics, and poses from corners."""

import jax.numpy as jnp

from simulearn.mechanics.forces import FLIP, BeamState
from simulearn.mechanics.model import SectionModel
from simulearn.mechanics.poses import Array
from simulearn.mechanics.section import in_s
from simulearn.mechanics.topology import FlatGeometry, Topology


def local_corners(
    section_model: SectionModel,
    topology: Topology,
    geometry: FlatGeometry,
    s: Array,
    face: Array,
    middle: Array,
) -> tuple[Array, Array]:
    """Return the corners of joints (J, 8, 3) and of middle sections (B, 4, 3) in their own axes.

    Args:
        section_model: of the section; its stretches hold where nothing warps.
        topology: how the grid hangs together.
        geometry: the flat grid.
        s: released fraction.
        face: (2, B, 4, 3) warping of the corners at the halves' joints, in the halves' axes, mm.
        middle: (2, B, 4, 3) the same of the middle sections, as either half predicts it.
    """
    plane, thick = in_s(section_model.plane, s), in_s(section_model.thickness, s)
    joints = geometry.corners * (1 + jnp.stack([plane, plane, thick]))
    real = topology.real[:, None]  # what only fills up touches no corner
    warped = jnp.einsum("hbij,hbcj->hbci", geometry.frame, face) * real[..., None]
    right, left = topology.side, (topology.side + 1) % 4
    corner = jnp.stack([right, left, 4 + right, 4 + left], -1)  # (2, B, 4)
    where = (topology.ends[..., None], corner)
    total = jnp.zeros_like(joints).at[where].add(warped)
    count = jnp.zeros(joints.shape[:2]).at[where].add(jnp.broadcast_to(real, corner.shape))
    joints += total / jnp.maximum(count, 1.0)[..., None]
    across, up = in_s(section_model.waist[0], s), in_s(section_model.waist[1], s)
    sections = geometry.section * (1 + jnp.stack([jnp.zeros_like(across), across, up]))
    other = jnp.einsum("ij,bcj->bci", FLIP[1], middle[1][:, jnp.array([1, 0, 3, 2])])
    return joints, sections + (middle[0] + other) / 2


def placed(
    topology: Topology, geometry: FlatGeometry, state: BeamState, joints: Array, sections: Array
) -> tuple[Array, Array]:
    """Return corners in space: of joints (J, 8, 3), of sections (B, 3, 4, 3).

    The ends of a beam are the faces of its joints. The lower half of the fixed joint stays.
    """
    at = jnp.einsum("jik,jck->jci", state.joints.R, joints) + state.joints.p[:, None]
    flat = (geometry.centre[:, None] + geometry.corners)[topology.fixed, :4]
    at = at.at[topology.fixed, :4].set(flat)
    right, left = topology.side, (topology.side + 1) % 4
    corner = jnp.stack([right, left, 4 + right, 4 + left], -1)
    faces = at[topology.ends[..., None], corner]  # (2, B, 4, 3), as seen from either joint
    middle = jnp.einsum("bik,bck->bci", state.middles.R, sections) + state.middles.p[:, None]
    end = faces[1][:, jnp.array([1, 0, 3, 2])]
    return at, jnp.stack([faces[0], middle, end], 1)

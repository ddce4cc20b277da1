"""The flat grid in beam mechanics: faces of joints, and half-beams between them.

A beam is two halves, each from the face of its joint to the middle. In the axes of its joint every
half is alike: x into the beam, y to its left, z up. `grid.outline` says which corner lies between
which beams; where it lies is computed here, differentiably in the joints' places.
"""

from typing import Any, NamedTuple, Protocol

import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray

from simulearn.grid.outline import corner_topology
from simulearn.mechanics.model import REFERENCE_WIDTH
from simulearn.mechanics.poses import Array

Indices = NDArray[np.int64]


class Topology(NamedTuple):
    """How a grid hangs together; half h = end * B + beam.

    Attributes:
        ends: (2, B) joint of each half.
        fixed: () index of the fixed joint.
        before: (J, 4) half before each corner of a joint, counter-clockwise.
        after: (J, 4) half after it.
        parts: (J, 4) into how many parts the gap between them is divided.
        part: (J, 4) which of them the corner bisects.
        side: (2, B) side of its joint that each half leaves; from corner `side` to the next.
        real: (B,) 1 where a beam counts, 0 where it only fills up.
    """

    ends: Indices
    fixed: NDArray[np.int64]
    before: Indices
    after: Indices
    parts: Indices
    part: Indices
    side: Indices
    real: Any


class Breadth(Protocol):
    """What has the width and thickness of a section, mm."""

    @property
    def width(self) -> Any:
        """Of the section, mm."""
        ...

    @property
    def thickness(self) -> Any:
        """Of the section, mm."""
        ...


class FlatGeometry(NamedTuple):
    """The flat grid in numbers, mm.

    Attributes:
        centre: (J, 3) mean of each joint's corners.
        corners: (J, 8, 3) from the centre: bottom, then top.
        area: (J,) mm2.
        face: (2, B, 3) middle of each half's face, from its joint's centre.
        frame: (2, B, 3, 3) axes of each half, in columns.
        reach: (2, B) from where the axes meet to the face.
        skew: (2, B) how far the face's left corner is ahead of its right one.
        length: (B,) between the faces.
        middle: (B, 3) of each beam.
        section: (B, 4, 3) corners of the middle section in the axes of half 0, from its middle.
        scale: () width of the section over that of the first material, 7.2 mm.
    """

    centre: Any
    corners: Any
    area: Any
    face: Any
    frame: Any
    reach: Any
    skew: Any
    length: Any
    middle: Any
    section: Any
    scale: Any


def topologies(beams: Indices, fixed: int, joints: NDArray[np.float64]) -> Topology:
    """Return the topologies of valid designs of one topology, stacked along T.

    Args:
        beams: (B, 2) joint indices.
        fixed: index of the fixed joint.
        joints: (T, J, 2) mm.
    """
    ends = np.broadcast_to(beams.T, (len(joints), 2, len(beams)))
    real = np.ones((len(joints), len(beams)))
    return Topology(ends, np.full(len(joints), fixed), *corner_topology(beams, joints), real)


def flat_geometry(topology: Topology, joints: Array, section: Breadth) -> FlatGeometry:
    """Return the flat grid whose axes meet at joints (J, 2)."""
    width, up = section.width / 2, section.thickness / 2
    start, end = joints[topology.ends[0]], joints[topology.ends[1]]
    vector = jnp.stack([end - start, start - end])
    along = vector / jnp.linalg.norm(vector, axis=-1, keepdims=True)  # (2, B, 2)
    angle = jnp.arctan2(vector[..., 1], vector[..., 0]).ravel()

    first = angle[topology.before]
    gap = jnp.mod(angle[topology.after] - first, 2 * jnp.pi)
    gap = jnp.where(topology.before == topology.after, 2 * jnp.pi, gap) / topology.parts
    bisector = first + gap * (topology.part + 0.5)
    out = width / jnp.sin(gap / 2)
    corner = out[..., None] * jnp.stack([jnp.cos(bisector), jnp.sin(bisector)], -1)  # (J, 4, 2)
    middle = corner.mean(1)

    joint, side = topology.ends, topology.side
    right, left = corner[joint, side], corner[joint, (side + 1) % 4]
    reach = ((right + left) / 2 * along).sum(-1)
    skew = ((left - right) * along).sum(-1)
    across = jnp.stack([-along[..., 1], along[..., 0]], -1)
    upward = jnp.broadcast_to(jnp.array([0.0, 0.0, 1.0]), (*along.shape[:-1], 3))
    frame = jnp.stack([_lifted(along), _lifted(across), upward], -1)
    place = joints[joint] + reach[..., None] * along
    local = corner - middle[:, None]
    x = (skew[0] + skew[1]) / 4  # half the middle section's own skew
    o = jnp.ones_like(x)
    rows = [(-x, -1, -1), (x, 1, -1), (-x, -1, 1), (x, 1, 1)]
    mid_section = jnp.stack(
        [jnp.stack([a, b * width * o, c * up * o], -1) for a, b, c in rows], axis=1
    )
    return FlatGeometry(
        centre=_lifted(joints + middle),
        corners=jnp.concatenate([_lifted(local, -up), _lifted(local, up)], 1),
        area=jnp.abs(_cross(local[:, 2] - local[:, 0], local[:, 3] - local[:, 1])) / 2,
        face=_lifted(place - (joints + middle)[joint]),
        frame=frame,
        reach=reach,
        skew=skew,
        length=jnp.linalg.norm(vector[0], axis=-1) - reach.sum(0),
        middle=_lifted(place.mean(0)),
        section=mid_section,
        scale=jnp.asarray(section.width / REFERENCE_WIDTH),
    )


def _lifted(xy: Array, z: Any = 0.0) -> Array:
    """Return points of the plane in space."""
    return jnp.concatenate([xy, z + jnp.zeros_like(xy[..., :1])], -1)


def _cross(a: Array, b: Array) -> Array:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]

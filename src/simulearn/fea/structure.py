"""How a grid's nodes lie in slabs and joints.

Joints come first among a solid's bricks, then the slabs of beam after beam; all joints are alike,
and so are all slabs.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from skfem import ElementHexS2

from simulearn.fea.solid import Solid

Indices = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Structure:
    """Which nodes lie where.

    Attributes:
        faces: (B, slabs + 1, f) nodes on the faces between slabs; the first and last in joints.
        insides: (B, slabs, i) nodes within the slabs.
        blocks: (J, n) nodes of the joints.
        ends: (B, 2) start and end joint of the beams.
    """

    faces: Indices
    insides: Indices
    blocks: Indices
    ends: Indices


def structure_of(solid: Solid) -> Structure:
    """Return where the nodes of a solid lie."""
    in_beam = solid.parts[:, 0] >= 0
    joints = int(solid.parts[~in_beam, 1].max()) + 1
    beams = int(solid.parts[in_beam, 0].max()) + 1
    blocks, _ = _merge(solid.bricks[~in_beam].reshape(joints, -1))
    nodes, in_slab = _merge(solid.bricks[in_beam].reshape(beams * solid.slabs, -1))
    nodes = nodes.reshape(beams, solid.slabs, -1)

    x = np.zeros(nodes.shape[-1])
    x[in_slab] = np.tile(np.asarray(ElementHexS2.doflocs)[:, 0], in_slab.size // 20)
    left, right, inside = (np.flatnonzero(x == place) for place in (0.0, 1.0, 0.5))
    # The right face in the order in which the next slab meets the same nodes on its left.
    place = {node: k for k, node in enumerate(nodes[0, 0])}
    right = np.array([place[node] for node in nodes[0, 1, left]])
    faces = np.concatenate([nodes[:, :, left], nodes[:, -1:, right]], axis=1)

    owner = np.empty(len(solid.nodes), dtype=np.int64)
    owner[blocks] = np.arange(joints)[:, None]
    return Structure(faces, nodes[:, :, inside], blocks, owner[faces[:, [0, -1], 0]])


def _merge(bricks: Indices) -> tuple[Indices, Indices]:
    """Return distinct nodes (P, n) of alike parts (P, b 20), and where the bricks put them."""
    _, first, inverse = np.unique(bricks[0], return_index=True, return_inverse=True)
    return bricks[:, first], inverse

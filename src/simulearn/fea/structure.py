"""How a grid's nodes lie in slabs and joints: what block elimination needs to know once.

Joints come first among a solid's bricks, then the slabs of beam after beam; all joints are alike,
and so are all slabs, so that one table serves for all of them.
"""

from dataclasses import dataclass, field
from itertools import combinations_with_replacement

import jax
import numpy as np
from numpy.typing import NDArray
from skfem import ElementHexS2

from simulearn.fea.solid import Solid

Indices = NDArray[np.int64]

PAIRS = list(combinations_with_replacement(range(3), 2))  # of displacement components, k <= l


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class Structure:
    """Which nodes lie where.

    Attributes:
        faces: (B, slabs + 1, f) nodes on the faces between slabs; the first and last in joints.
        insides: (B, slabs, i) nodes within the slabs.
        blocks: (J, n) nodes of the joints.
        slab: (r, m, m) where the entries of a slab's matrix, on [left face, right face, inside],
            come from among those of its bricks; up to r bricks add to one.
        joint: (r, m, m) the same for a joint.
        joint_bricks: number of bricks in joints; they come first.
    """

    faces: Indices
    insides: Indices
    blocks: Indices
    slab: Indices
    joint: Indices
    joint_bricks: int = field(metadata={"static": True})


@dataclass(frozen=True, eq=False)
class Skeleton:
    """How joints and beams are connected.

    Attributes:
        ends: (B, 2) start and end joint.
        seats: (B, 2, 3 f) degrees of freedom of a beam's end faces among those of their joints.
        fixed: the fixed joint.
        held: its degrees of freedom that are held.
        order: joints, those with the fewest neighbours left first.
    """

    ends: list[tuple[int, int]]
    seats: Indices
    fixed: int
    held: Indices
    order: list[int]


def structure_of(solid: Solid) -> tuple[Structure, Skeleton]:
    """Return the structure of a solid and its skeleton."""
    in_beam = solid.parts[:, 0] >= 0
    joints = int(solid.parts[~in_beam, 1].max()) + 1
    beams = int(solid.parts[in_beam, 0].max()) + 1
    blocks, in_joint = _merge(solid.bricks[~in_beam].reshape(joints, -1))
    nodes, in_slab = _merge(solid.bricks[in_beam].reshape(beams * solid.slabs, -1))
    nodes = nodes.reshape(beams, solid.slabs, -1)

    x = np.zeros(nodes.shape[-1])
    x[in_slab] = np.tile(np.asarray(ElementHexS2.doflocs)[:, 0], in_slab.size // 20)
    left, right, inside = (np.flatnonzero(x == place) for place in (0.0, 1.0, 0.5))
    # The right face in the order in which the next slab meets the same nodes on its left.
    place = {node: k for k, node in enumerate(nodes[0, 0])}
    right = np.array([place[node] for node in nodes[0, 1, left]])
    seat = np.empty(len(x), dtype=np.int64)
    seat[np.concatenate([left, right, inside])] = np.arange(len(x))
    faces = np.concatenate([nodes[:, :, left], nodes[:, -1:, right]], axis=1)

    owner = np.empty(len(solid.nodes), dtype=np.int64)
    owner[blocks] = np.arange(joints)[:, None]
    spot = np.empty(len(solid.nodes), dtype=np.int64)
    spot[blocks] = np.arange(blocks.shape[1])
    ends = [tuple(pair) for pair in owner[faces[:, [0, -1], 0]].tolist()]
    return Structure(
        faces=faces,
        insides=nodes[:, :, inside],
        blocks=blocks,
        slab=_sources(seat[in_slab].reshape(-1, 20)),
        joint=_sources(in_joint.reshape(-1, 20)),
        joint_bricks=int((~in_beam).sum()),
    ), Skeleton(
        ends=ends,
        seats=_dofs(spot[faces[:, [0, -1]]]),
        fixed=int(owner[solid.fixed[0]]),
        held=_dofs(spot[solid.fixed]),
        order=_minimum_degree(ends, joints),
    )


def _merge(bricks: Indices) -> tuple[Indices, Indices]:
    """Return distinct nodes (P, n) of alike parts (P, b 20), and where the bricks put them."""
    _, first, inverse = np.unique(bricks[0], return_index=True, return_inverse=True)
    return bricks[:, first], inverse


def _dofs(places: Indices) -> Indices:
    """Return the three displacement components of nodes, along the last axis."""
    return (3 * places[..., None] + np.arange(3)).reshape(*places.shape[:-1], -1)


def _sources(places: Indices) -> Indices:
    """Return the table (r, m, m) for parts whose bricks put their nodes at places (b, 20).

    A brick has 6 x 20 x 20 entries, for PAIRS (k, l) and nodes a, b; one past the last is zero.
    """
    entry = np.empty((20, 3, 20, 3), dtype=np.int64)
    grid = np.arange(400).reshape(20, 20)
    for pair, (k, l) in enumerate(PAIRS):  # noqa: E741
        entry[:, k, :, l] = 400 * pair + grid
        entry[:, l, :, k] = 400 * pair + grid.T
    size = 400 * len(PAIRS)
    dofs = _dofs(places)
    rows = 3 * (int(places.max()) + 1)
    target = (rows * dofs[:, :, None] + dofs[:, None, :]).reshape(-1)
    source = (size * np.arange(len(places))[:, None, None] + entry.reshape(60, 60)).reshape(-1)
    by_target = np.argsort(target, kind="stable")
    target, source = target[by_target], source[by_target]
    rank = np.arange(len(target)) - np.searchsorted(target, target)
    table = np.full((int(rank.max()) + 1, rows**2), size * len(places))
    table[rank, target] = source
    return table.reshape(-1, rows, rows).astype(np.int32)


def _minimum_degree(ends: list[tuple[int, int]], joints: int) -> list[int]:
    near: dict[int, set[int]] = {j: set() for j in range(joints)}
    for a, b in ends:
        near[a].add(b)
        near[b].add(a)
    order = []
    while near:
        joint = min(near, key=lambda j: (len(near[j]), j))
        others = near.pop(joint)
        for other in others:
            near[other] |= others - {other}
            near[other].discard(joint)
        order.append(joint)
    return order

"""Solving the linear system of a grid by block elimination along its own structure.

Inside a beam only neighbouring slabs know each other, so all slabs of all beams are eliminated
together, level by level: first the nodes inside each slab, then every second face, until a beam is
one dense block between its two joints. What is left couples joints along the beams; they are
eliminated one by one, those with the fewest neighbours first. Everything is small dense algebra in
batches: no sparse solver, and no symbolic analysis to keep.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from skfem import ElementHexS2

from simulearn.fea.solid import Solid

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Structure:
    """Which nodes lie where, and the order in which joints are eliminated.

    Attributes:
        faces: (B, slabs + 1, f) nodes on the faces between slabs; the first and last in joints.
        insides: (B, slabs, i) nodes within the slabs.
        blocks: (J, n) nodes of the joints.
        slab: (b, 20) where a slab's bricks put their nodes, in [left face, right face, inside].
        joint: (b, 20) where a joint's bricks put their nodes.
        ends: (B, 2) start and end joint.
        seats: (B, 2, f) places of a beam's first and last face among their joints' nodes.
        held: (h,) places of the held nodes in the fixed joint.
        order: joints in the order of elimination.
        fixed: the fixed joint.
    """

    faces: Indices
    insides: Indices
    blocks: Indices
    slab: Indices
    joint: Indices
    ends: Indices
    seats: Indices
    held: Indices
    order: list[int]
    fixed: int

    @classmethod
    def of(cls, solid: Solid) -> "Structure":
        """Return the structure of a solid."""
        in_beam = solid.parts[:, 0] >= 0
        joints = solid.parts[~in_beam, 1].max() + 1
        blocks, joint = _merge(solid.bricks[~in_beam].reshape(joints, -1))
        beams = solid.parts[in_beam, 0].max() + 1
        nodes, slab = _merge(solid.bricks[in_beam].reshape(beams * solid.slabs, -1))

        x = np.zeros(nodes.shape[1])
        x[slab] = np.tile(np.asarray(ElementHexS2.doflocs)[:, 0], slab.size // 20)
        left, right, inside = (np.flatnonzero(x == place) for place in (0.0, 1.0, 0.5))
        # The same order on both faces of a slab: that in which the next slab meets them.
        first, second = nodes.reshape(beams, solid.slabs, -1)[0, :2]
        right = np.array([int(np.flatnonzero(first == node)[0]) for node in second[left]])
        place = np.empty(len(x), dtype=np.int64)
        place[np.concatenate([left, right, inside])] = np.arange(len(x))
        nodes = nodes.reshape(beams, solid.slabs, -1)
        faces = np.concatenate([nodes[:, :, left], nodes[:, -1:, right]], axis=1)

        owner = np.full(len(solid.nodes), -1)
        owner[blocks] = np.arange(joints)[:, None]
        ends = owner[faces[:, [0, -1], 0]]
        seat = np.empty(len(solid.nodes), dtype=np.int64)
        seat[blocks] = np.arange(blocks.shape[1])
        fixed = int(owner[solid.fixed[0]])
        return cls(
            faces=faces,
            insides=nodes[:, :, inside],
            blocks=blocks,
            slab=place[slab].reshape(-1, 20),
            joint=joint.reshape(-1, 20),
            ends=ends,
            seats=seat[faces[:, [0, -1]]],
            held=seat[solid.fixed],
            order=_minimum_degree(ends, int(joints)),
            fixed=fixed,
        )


def _merge(bricks: Indices) -> tuple[Indices, Indices]:
    """Return distinct nodes (P, n) of alike parts (P, b 20), and where the bricks put them."""
    _, first, inverse = np.unique(bricks[0], return_index=True, return_inverse=True)
    return bricks[:, first], inverse


def _minimum_degree(ends: Indices, joints: int) -> list[int]:
    near: dict[int, set[int]] = {j: set() for j in range(joints)}
    for a, b in ends.tolist():
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


def _dofs(places: Indices) -> Indices:
    """Return the three displacement components of nodes, along the last axis."""
    return (3 * places[..., None] + np.arange(3)).reshape(*places.shape[:-1], -1)


def _gather(stiffness: Array, places: Indices, parts: int) -> Array:
    """Add the bricks (E, 60, 60) of alike parts up to matrices (parts, m, m)."""
    size = 3 * (int(places.max()) + 1)
    total = np.zeros((parts, size, size))
    bricks = stiffness.reshape(parts, len(places), 60, 60)
    for brick, place in enumerate(_dofs(places)):
        total[:, place[:, None], place] += bricks[:, brick]
    return total


def solve(structure: Structure, stiffness: Array, load: Array) -> Array:
    """Return the displacements under a load, the held nodes staying.

    Args:
        structure: of the solid.
        stiffness: (E, 60, 60) of the bricks, joints first, N/mm.
        load: (N, 3) N.

    Returns:
        (N, 3) mm.
    """
    s = structure
    joints, beams = len(s.blocks), len(s.faces)
    count = joints * len(s.joint)
    face = 3 * s.faces.shape[2]
    slabs = _gather(stiffness[count:], s.slab, s.insides.shape[0] * s.insides.shape[1])
    slabs = slabs.reshape(beams, -1, *slabs.shape[1:])

    # Inside the slabs.
    outer, inner = slice(0, 2 * face), slice(2 * face, None)
    f = load[s.insides].reshape(beams, s.insides.shape[1], -1)
    inside = _condense(slabs[..., inner, inner], slabs[..., inner, outer], f)
    K = slabs[..., outer, outer] - slabs[..., outer, inner] @ inside[0]
    r = -np.einsum("bsij,bsj->bsi", slabs[..., outer, inner], inside[1])

    # Every second face, until one block a beam is left.
    levels = []
    faces = np.arange(s.faces.shape[1])
    left, right = slice(0, face), slice(face, None)
    while K.shape[1] > 1:
        pairs = K.shape[1] // 2
        a, b = K[:, : 2 * pairs : 2], K[:, 1 : 2 * pairs : 2]
        ra, rb = r[:, : 2 * pairs : 2], r[:, 1 : 2 * pairs : 2]
        middle = faces[1 : 2 * pairs : 2]
        f = load[s.faces[:, middle]].reshape(beams, pairs, face) + ra[..., right] + rb[..., left]
        coupling = np.concatenate([a[..., right, left], b[..., left, right]], axis=-1)
        X, x = _condense(a[..., right, right] + b[..., left, left], coupling, f)
        merged = -coupling.swapaxes(-1, -2) @ X
        merged[..., left, left] += a[..., left, left]
        merged[..., right, right] += b[..., right, right]
        rest = np.concatenate([ra[..., left], rb[..., right]], axis=-1)
        rest -= np.einsum("bpij,bpi->bpj", coupling, x)
        outer_faces = np.stack([faces[: 2 * pairs : 2], faces[2 : 2 * pairs + 1 : 2]], axis=1)
        levels.append((middle, outer_faces, X, x))
        K = np.concatenate([merged, K[:, 2 * pairs :]], axis=1)
        r = np.concatenate([rest, r[:, 2 * pairs :]], axis=1)
        faces = np.concatenate([faces[: 2 * pairs + 1 : 2], faces[2 * pairs + 1 :]])

    u = np.zeros_like(load)
    blocks = _gather(stiffness[:count], s.joint, joints)
    u[s.blocks] = _solve_joints(s, blocks, K[:, 0], load[s.blocks].reshape(joints, -1), r[:, 0])
    for middle, outer_faces, X, x in reversed(levels):
        ends = u[s.faces[:, outer_faces]].reshape(beams, len(middle), -1)
        u[s.faces[:, middle]] = (x - np.einsum("bpij,bpj->bpi", X, ends)).reshape(
            beams, len(middle), -1, 3
        )
    ends = np.concatenate([u[s.faces[:, :-1]], u[s.faces[:, 1:]]], axis=2)
    ends = ends.reshape(beams, s.insides.shape[1], -1)
    u[s.insides] = (inside[1] - np.einsum("bsij,bsj->bsi", inside[0], ends)).reshape(
        *s.insides.shape, 3
    )
    return u


def _condense(K: Array, coupling: Array, f: Array) -> tuple[Array, Array]:
    """Return K^-1 coupling and K^-1 f."""
    both = np.linalg.solve(K, np.concatenate([coupling, f[..., None]], axis=-1))
    return both[..., :-1], both[..., -1]


def _solve_joints(s: Structure, blocks: Array, beams: Array, load: Array, rest: Array) -> Array:
    """Return the displacements (J, n, 3) of the joints' nodes.

    Args:
        s: the structure.
        blocks: (J, 3 n, 3 n) stiffness of the joints alone.
        beams: (B, 2 f, 2 f) stiffness of the beams, condensed to their ends.
        load: (J, 3 n) forces on the joints' nodes.
        rest: (B, 2 f) forces of the beams on their ends.
    """
    size = blocks.shape[1]
    face = beams.shape[1] // 2
    seats = _dofs(s.seats)
    between: dict[tuple[int, int], Array] = {}
    load = load.copy()
    for b, (i, j) in enumerate(s.ends.tolist()):
        p, q = seats[b]
        blocks[i][np.ix_(p, p)] += beams[b, :face, :face]
        blocks[j][np.ix_(q, q)] += beams[b, face:, face:]
        load[i, p] += rest[b, :face]
        load[j, q] += rest[b, face:]
        coupling = np.zeros((size, size))
        coupling[np.ix_(p, q)] = beams[b, :face, face:]
        between[i, j] = between.get((i, j), 0) + coupling
        between[j, i] = between[i, j].T
    held = _dofs(s.held)
    blocks[s.fixed][held] = 0
    blocks[s.fixed][:, held] = 0
    blocks[s.fixed][held, held] = 1
    load[s.fixed, held] = 0
    for (i, j), coupling in between.items():
        if i == s.fixed:
            coupling[held] = 0
        if j == s.fixed:
            coupling[:, held] = 0

    passed = []
    left = set(range(len(blocks)))
    for i in s.order:
        left.discard(i)
        near = sorted(j for j in left if (i, j) in between)
        wide = np.concatenate([between[i, j] for j in near] + [load[i][:, None]], axis=1)
        X = np.linalg.solve(blocks[i], wide)
        passed.append((i, near, X))
        if not near:
            continue
        change = wide[:, :-1].T @ X
        for a, j in enumerate(near):
            rows = slice(a * size, (a + 1) * size)
            load[j] -= change[rows, -1]
            blocks[j] -= change[rows, rows]
            for c, k in enumerate(near):
                if j != k:
                    part = change[rows, c * size : (c + 1) * size]
                    between[j, k] = between[j, k] - part if (j, k) in between else -part
    u = np.zeros((len(blocks), size))
    for i, near, X in reversed(passed):
        u[i] = X[:, -1] - (X[:, :-1] @ u[near].reshape(-1) if near else 0)
    return u.reshape(len(blocks), -1, 3)

"""The order in which a grid's unknowns are eliminated, from its own structure.

Inside a beam only neighbouring slabs know each other: first the nodes inside each slab are
eliminated, then the faces between, halving by halving, until a beam is one dense front between its
two joints. What is left couples joints along the beams; they are eliminated one by one, those with
the fewest neighbours first, and in each one the nodes first that no beam meets.
"""

from collections import defaultdict
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.fea.kernels.front import Fronts
from simulearn.fea.solid import Solid
from simulearn.fea.structure import Structure, structure_of

Indices = NDArray[np.int64]


def fronts_of(solid: Solid) -> Fronts:
    """Return the fronts of a solid, in the order of their elimination."""
    structure = structure_of(solid)
    order = joint_order(structure)
    beam = _beam_fronts(structure, solid)
    fronts: list[_Front] = []
    for joint, parent in order.walk:
        if joint < 0:
            fronts += beam[~joint]
        else:
            fronts += _joint_fronts(structure, solid, order, joint, parent)
    return _packed(fronts, solid)


@dataclass(frozen=True, eq=False)
class _Front:
    """One front: nodes that it eliminates, nodes that these are coupled to, bricks, children."""

    own: Indices
    rest: Indices
    bricks: Indices
    children: int


@dataclass(frozen=True, eq=False)
class JointOrder:
    """How the graph of joints and beams is eliminated.

    Attributes:
        faces: for each joint, the end faces (beam, 0 or 1) at later joints that it is coupled to.
        walk: what is eliminated one after the other, children before parents: (joint, number of
            children), or (~beam, 0).
    """

    faces: list[list[tuple[int, int]]]
    walk: list[tuple[int, int]]


def joint_order(structure: Structure) -> JointOrder:
    """Return the elimination of the joints, those with the fewest neighbours left first."""
    ends = structure.ends.tolist()
    joints = len(structure.blocks)
    # near[i][j]: end faces at joint j that joint i is coupled to.
    near: list[dict[int, set[tuple[int, int]]]] = [defaultdict(set) for _ in range(joints)]
    for b, (i, j) in enumerate(ends):
        near[i][j].add((b, 1))
        near[j][i].add((b, 0))
    faces: list[list[tuple[int, int]]] = [[] for _ in range(joints)]
    parent = [-1] * joints
    rank = [0] * joints
    left = set(range(joints))
    neighbours: list[list[int]] = [[] for _ in range(joints)]
    for place in range(joints):
        joint = min(left, key=lambda j: (len(near[j]), j))
        left.remove(joint)
        rank[joint] = place
        neighbours[joint] = sorted(near[joint])
        faces[joint] = sorted(set().union(*near[joint].values()))
        for other in neighbours[joint]:
            near[other].pop(joint, None)
            for third in neighbours[joint]:
                if third != other:
                    near[other][third] |= near[joint][third]
    below: list[list[int]] = [[] for _ in range(joints)]
    for joint in sorted(range(joints), key=rank.__getitem__):
        if neighbours[joint]:
            parent[joint] = min(neighbours[joint], key=rank.__getitem__)
            below[parent[joint]].append(joint)
    beams: list[list[int]] = [[] for _ in range(joints)]
    for b, pair in enumerate(ends):
        beams[min(pair, key=rank.__getitem__)].append(b)

    walk: list[tuple[int, int]] = []
    for root in (joint for joint in range(joints) if parent[joint] < 0):
        waiting = [(root, False)]
        while waiting:
            joint, entered = waiting.pop()
            if entered:
                walk += [(~b, 0) for b in beams[joint]]
                walk.append((joint, len(below[joint]) + len(beams[joint])))
            else:
                waiting.append((joint, True))
                waiting += [(child, False) for child in reversed(below[joint])]
    return JointOrder(faces, walk)


def _beam_fronts(structure: Structure, solid: Solid) -> list[list[_Front]]:
    """Return the fronts of each beam, children before parents."""
    slabs = solid.slabs
    first = int((solid.parts[:, 0] < 0).sum())
    each = (len(solid.bricks) - first) // (len(structure.faces) * slabs)
    pieces: list[tuple[int, int, int]] = []  # faces: eliminated (-1: inside), before, after

    def halve(before: int, after: int) -> None:
        middle = (before + after) // 2
        if middle == before:
            pieces.append((-1, before, after))
            return
        halve(before, middle)
        halve(middle, after)
        pieces.append((middle, before, after))

    halve(0, slabs)
    none = np.zeros(0, dtype=np.int64)
    beams = []
    for b, faces in enumerate(structure.faces):
        fronts = []
        for middle, before, after in pieces:
            rest = np.concatenate([faces[before], faces[after]])
            if middle < 0:
                bricks = first + (b * slabs + before) * each + np.arange(each)
                fronts.append(_Front(structure.insides[b, before], rest, bricks, 0))
            else:
                fronts.append(_Front(faces[middle], rest, none, 2))
        beams.append(fronts)
    return beams


def _joint_fronts(
    structure: Structure, solid: Solid, order: JointOrder, joint: int, children: int
) -> list[_Front]:
    """Return the fronts of a joint: first what no beam meets, then what beams do."""
    each = int((solid.parts[:, 0] < 0).sum()) // len(structure.blocks)
    faces = [structure.faces[b, -end] for b, end in order.faces[joint]]
    rest = np.unique(np.concatenate(faces)) if faces else np.zeros(0, dtype=np.int64)
    bricks = joint * each + np.arange(each)
    block = structure.blocks[joint]
    met = np.isin(block, structure.faces[:, [0, -1]][structure.ends == joint])
    if met.all():
        return [_Front(block, rest, bricks, children)]
    none = np.zeros(0, dtype=np.int64)
    return [
        _Front(block[~met], block[met], bricks, 0),
        _Front(block[met], rest, none, children + 1),
    ]


def _packed(fronts: list[_Front], solid: Solid) -> Fronts:
    """Return the fronts as arrays, without the nodes that are fixed."""
    held = np.zeros(len(solid.nodes), dtype=bool)
    held[solid.fixed] = True
    parts = [part for front in fronts for part in (front.own, front.rest)]
    free = [part[~held[part]] for part in parts]
    counts = np.array([len(part) for part in free], dtype=np.int64).reshape(-1, 2)
    children = np.array([front.children for front in fronts], dtype=np.int64)
    own, rest = 3 * counts.T
    waits = rest * (rest + 1)
    top = most = 0
    stack: list[int] = []
    for wait, many in zip(waits.tolist(), children.tolist(), strict=True):
        for _ in range(many):
            top -= stack.pop()
        stack.append(wait)
        top += wait
        most = max(most, top)
    rows = own + rest
    bricks = [front.bricks for front in fronts]
    return Fronts(
        nodes=np.concatenate(free).astype(np.int64),
        start=_starts(counts.sum(axis=1)),
        own=np.ascontiguousarray(counts[:, 0]),
        bricks=np.concatenate(bricks).astype(np.int64),
        first_brick=_starts(np.array([len(b) for b in bricks])),
        children=children,
        factors=_starts(own * (rows + 1)),
        pivots=_starts(own),
        space=np.array([(rows * (rows + 1)).max(), most + 1], dtype=np.int64),
    )


def _starts(lengths: Indices) -> Indices:
    """Return where parts of given lengths begin, and where the last one ends."""
    return np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)

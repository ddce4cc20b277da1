"""The order in which the joints of a grid are eliminated, and where their blocks lie."""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from simulearn.mechanics.kernels.assembly import Layout

Indices = NDArray[np.int64]


def layout_of(beams: Indices, fixed: int, joints: int) -> Layout:
    """Return the layout of a topology.

    Args:
        beams: (B, 2) joint indices.
        fixed: index of the fixed joint.
        joints: how many there are.
    """
    beams = np.ascontiguousarray(beams, np.int64)
    return _layout(beams.tobytes(), len(beams), int(fixed), joints)


@lru_cache(maxsize=1024)
def _layout(beams: bytes, count: int, fixed: int, joints: int) -> Layout:
    pairs = np.frombuffer(beams, np.int64).reshape(count, 2)
    near: dict[int, set[int]] = {j: set() for j in range(joints) if j != fixed}
    for a, b in pairs.tolist():
        if a in near and b in near:
            near[a].add(b)
            near[b].add(a)
    order: list[int] = []
    below: list[list[int]] = []
    while near:  # the joint with the fewest neighbours next; those become each other's
        joint = min(near, key=lambda j: (len(near[j]), j))
        others = near.pop(joint)
        for other in others:
            near[other] |= others
            near[other] -= {other, joint}
        order.append(joint)
        below.append(list(others))
    place = np.full(joints, -1, np.int64)
    place[order] = np.arange(len(order))
    rows = [sorted(int(place[j]) for j in column) for column in below]
    columns = np.cumsum([0, *map(len, rows)])
    index = {(k, k): k for k in range(len(order))}
    for k, column in enumerate(rows):
        index |= {(row, k): len(order) + int(columns[k]) + i for i, row in enumerate(column)}
    targets = [
        index[row, c] for column in rows for i, row in enumerate(column) for c in column[: i + 1]
    ]
    slot = [
        index[max(a, b), min(a, b)] if min(a, b) >= 0 else -1
        for a, b in zip(place[pairs[:, 0]].tolist(), place[pairs[:, 1]].tolist(), strict=True)
    ]
    flat = [row for column in rows for row in column]
    return Layout(
        np.array(pairs.T, order="C"),  # a copy, which is not read-only, also of one beam
        fixed,
        place,
        columns.astype(np.int64),
        np.array(flat, np.int64),
        np.array(targets, np.int64),
        np.array(slot, np.int64),
        len(order) + len(flat),
        max(map(len, rows), default=0),
    )

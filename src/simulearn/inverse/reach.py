"""Targets that nothing can come near: beyond the length of the beams, or in another unit."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import Message
from simulearn.grid import Grid
from simulearn.inverse.goals import Goals

SLACK = 1.1  # of the beams' length, which a target may be away; joints may move outwards
LEAST = 0.3  # of the dimension; targets in the right unit hardly lie all nearer
UNITS = {"metres": 1000.0, "inches": 25.4, "centimetres": 10.0}
# Of the dimension: a design that stays so far from its targets does not come near them, where
# something speaks for it beforehand and where nothing does.
FAR, VERY_FAR = 0.1, 0.5
TINY = 0.05  # of the dimension; if all targets are nearer, they are perhaps in metres


def out_of_reach(grid: Grid, goals: Goals) -> list[Message]:
    """Return a warning for targets that the vertices of a grid can hardly come to.

    Args:
        grid: the design to begin with, its fixed joint at the origin.
        goals: what is wanted.
    """
    away = np.linalg.norm(goals.targets, axis=1)
    flat = [np.linalg.norm(_place(grid, vertex.part, vertex.index)) for vertex in goals.vertices]
    if away.max() < TINY * grid.dimension and max(flat) > TINY * grid.dimension:
        text = (
            f"all targets lie within {away.max():.3g} mm of the fixed joint, and the grid reaches "
            f"{grid.dimension:.0f} mm; targets are in mm, seen from the fixed joint"
        )
        likely = [
            (name, factor)
            for name, factor in UNITS.items()
            if LEAST * grid.dimension < factor * away.max() < SLACK * grid.dimension
        ]
        if likely:
            text += "; if they are in {}, multiply them by {:g}".format(*likely[0])
        return [Message("targets-tiny", "goals", text)]
    path = _paths(grid)
    messages = []
    for k, vertex in enumerate(goals.vertices):
        joints = [vertex.index] if vertex.part == "joint" else grid.beams[vertex.index].tolist()
        longest = max(path[j] for j in joints)
        if away[k] > SLACK * longest + 10:
            text = (
                f"the target of goal {k} ({vertex}) lies {away[k]:.0f} mm from the fixed joint; "
                f"the beams that lead there are {longest:.0f} mm long"
            )
            messages.append(Message("target-far", f"goals[{k}]", text))
    return messages


def not_near(grid: Grid, error: float, reach: Sequence[Message]) -> list[Message]:
    """Return a warning where the best design does not come near its targets, and the likely reason.

    Args:
        grid: the design to begin with.
        error: of the best design, mm.
        reach: what `out_of_reach` says of the targets.
    """
    reasons = {
        "targets-tiny": "they are probably in another unit",
        "target-far": "they lie farther away than the beams reach",
    }
    why = [reasons[message.code] for message in reach if message.code in reasons]
    if error < (FAR if why else VERY_FAR) * grid.dimension:
        return []
    reason = why[0] if why else "actuators and joints that may change do not lead there"
    text = f"no design comes near the targets ({error:.0f} mm are left): {reason}"
    return [Message("nothing-near", "goals", text)]


def _place(grid: Grid, part: str, index: int) -> NDArray[np.float64]:
    if part == "joint":
        return grid.joints[index]
    middle: NDArray[np.float64] = grid.joints[grid.beams[index]].mean(axis=0)
    return middle


def _paths(grid: Grid) -> NDArray[np.float64]:
    """Return the length (J,) mm of the shortest path of beams from the fixed joint to each joint.

    Source: Bellman, On a routing problem, 1958.
    """
    start, end = grid.beams.T
    length = np.linalg.norm(grid.joints[end] - grid.joints[start], axis=1)
    path = np.full(len(grid.joints), np.inf)
    path[grid.fixed] = 0.0
    for _ in range(len(path)):
        before = path.copy()
        np.minimum.at(path, end, path[start] + length)
        np.minimum.at(path, start, path[end] + length)
        if (path == before).all():
            break
    return path

"""What must hold before a grid has a shape at all: numbers that are numbers, indices that exist.

The file reader and validation both ask here; the messages name the file's keys, for a grid in
memory has the same ones.
"""

import numpy as np

from simulearn.errors import Message
from simulearn.grid.grid import Grid

# Far beyond any printer; keeps squares and products of coordinates from overflowing (mm).
FARTHEST = 1e5


def structure_errors(grid: Grid) -> list[Message]:
    """Return what is wrong with the numbers and indices of a grid, the first first."""
    found = []

    def add(code: str, where: str, message: str) -> None:
        found.append(Message(code, where, message))

    joints, beams, actuators = len(grid.joints), len(grid.beams), len(grid.actuators)
    if actuators != beams:
        add(
            "actuator-count",
            "grid",
            f"actuators has {actuators} ratios for {beams} beams; there is one for each beam",
        )
    for k, place in enumerate(grid.joints.tolist()):
        if not all(abs(x) <= FARTHEST for x in place):  # NaN compares false
            add(
                "joint-place",
                f"joint {k}",
                f"joints[{k}] is {place}; coordinates lie within {FARTHEST:g} mm of the origin",
            )
    seen: dict[frozenset[int], int] = {}
    for k, (i, j) in enumerate(grid.beams.tolist()):
        name, where = f"beams[{k}] is [{i}, {j}]", f"beam {k}"
        if not (0 <= i < joints and 0 <= j < joints):
            add("beam-index", where, f"{name}; joints are numbered 0 to {joints - 1}")
        elif i == j:
            add("beam-to-itself", where, f"{name}; a beam joins two different joints")
        elif (first := seen.setdefault(frozenset((i, j)), k)) != k:
            add("beam-duplicate", where, f"{name}; beam {first} joins the same two joints")
    for k in np.flatnonzero(~(abs(grid.actuators) <= 1)).tolist():
        add(
            "actuator-ratio",
            f"beam {k}",
            f"actuators[{k}] is {grid.actuators[k]:g}; a ratio lies in [-1, 1]",
        )
    if not 0 <= grid.fixed < joints:
        add("fixed-index", "grid", f"fixed is {grid.fixed}; joints are numbered 0 to {joints - 1}")
    return found

"""Targets that nothing can come near: beyond the length of the beams, or in another unit."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import Message
from simulearn.grid import Grid
from simulearn.inverse.goals import Goals
from simulearn.inverse.kinds import AtPoints, OnSet, Set
from simulearn.inverse.vertex import Vertex
from simulearn.surfaces import Curve, Surface
from simulearn.units import in_mm

SLACK = 1.1  # of the beams' length, which a target may be away; joints may move outwards
LEAST = 0.3  # of the dimension; targets in the right unit hardly lie all nearer
UNITS = in_mm("m", "in", "cm")
# Of the dimension: a design that stays so far from its targets does not come near them, where
# something speaks for it beforehand and where nothing does.
FAR, VERY_FAR = 0.1, 0.5
TINY = 0.05  # of the dimension; if all targets are nearer, they are perhaps in metres
SMALL, LARGE = 0.1, 5.0  # likewise, below which a surface is perhaps in another unit; and likely


def out_of_reach(grid: Grid, goals: Goals) -> list[Message]:
    """Return a warning for targets that the vertices of a grid can hardly come to.

    Args:
        grid: the design to begin with, its fixed joint at the origin.
        goals: what is wanted.
    """
    if goals.pose is not None:
        return _tiny_sets(grid, goals)
    return _far_points(grid, goals) + _tiny_sets(grid, goals) + _far_sets(grid, goals)


def _far_points(grid: Grid, goals: Goals) -> list[Message]:
    """Return a warning for targets that are points."""
    numbers = np.flatnonzero([kind == "point" for kind in goals.kinds])
    parts = [part for part in goals.parts if isinstance(part.wanted, AtPoints)]
    vertices = [vertex for part in parts for vertex in part.vertices]
    if not vertices:
        return []
    away = np.linalg.norm(goals.targets, axis=1)
    flat = [np.linalg.norm(_place(grid, vertex.part, vertex.index)) for vertex in vertices]
    if away.max() < TINY * grid.dimension and max(flat) > TINY * grid.dimension:
        text = (
            f"all targets lie within {away.max():.3g} mm of the fixed joint, and the grid reaches "
            f"{grid.dimension:.0f} mm; targets are in mm, seen from the fixed joint"
        )
        likely = _likely(away.max(), grid)
        if likely:
            text += "; if they are in {}, multiply them by {:g}".format(*likely[0])
        return [Message("targets-tiny", "goals", text)]
    path = _paths(grid)
    messages = []
    for k, vertex, distance in zip(numbers, vertices, away, strict=True):
        longest = _reach(grid, path, vertex)
        if distance > SLACK * longest + 10:
            text = (
                f"the target of goal {k} ({vertex}) lies {distance:.0f} mm from the fixed joint; "
                f"the beams that lead there are {longest:.0f} mm long"
            )
            messages.append(Message("target-far", f"goals[{k}]", text))
    return messages


def _tiny_sets(grid: Grid, goals: Goals) -> list[Message]:
    """Return a warning for surfaces and curves that are hardly in mm."""
    messages = []
    for kind, shape in _sets(goals):
        if isinstance(shape, Surface | Curve) and shape.size < SMALL * grid.dimension:
            text = (
                f"the {kind} is {shape.size:.3g} mm across, and the grid reaches "
                f"{grid.dimension:.0f} mm"
            )
            likely = _likely(shape.size, grid, LARGE)
            if likely:
                text += f"; if its file is in {likely[0][0]}, say so by its key unit"
            messages.append(Message("targets-tiny", "goals", text))
    return messages


def _far_sets(grid: Grid, goals: Goals) -> list[Message]:
    """Return a warning for surfaces, curves and planes that are out of reach."""
    longest = float(_paths(grid).max())
    messages = []
    for kind, shape in _sets(goals):
        away = float(np.linalg.norm(shape.closest(np.zeros((1, 3)))[0]))
        if away > SLACK * longest + 10:
            text = (
                f"the {kind} lies {away:.0f} mm from the fixed joint; the beams reach "
                f"{longest:.0f} mm"
            )
            messages.append(Message("target-far", "goals", text))
    return messages


def _sets(goals: Goals) -> list[tuple[str, Set]]:
    """Return the surfaces, curves and planes of goals, each once."""
    wanted = [part.wanted for part in goals.parts]
    each = {id(one.set): (one.kind, one.set) for one in wanted if isinstance(one, OnSet)}
    return list(each.values())


def _likely(length: float, grid: Grid, most: float = SLACK) -> list[tuple[str, float]]:
    """Return the units in which a length would be .3 to so many times as long as a grid is."""
    return [
        (name, factor)
        for name, factor in UNITS.items()
        if LEAST * grid.dimension < factor * length < most * grid.dimension
    ]


def _reach(grid: Grid, path: NDArray[np.float64], vertex: Vertex) -> float:
    joints = [vertex.index] if vertex.part == "joint" else grid.beams[vertex.index].tolist()
    return float(max(path[j] for j in joints))


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

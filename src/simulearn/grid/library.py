"""Grids that morph into shapes with a name, for any number of cells.

A design is a rule from where a beam lies to its actuator's ratio. A beam whose top half is
active (+) lifts its ends, one whose bottom half is (-) drops them.

Flat, cone, saddle and developable are the ones of the paper's authors; the rest are ours.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from simulearn.errors import InputError
from simulearn.grid.grid import Grid
from simulearn.grid.lattice import lattice


@dataclass(frozen=True)
class Place:
    """Where a beam lies in a grid.

    Attributes:
        along_x: whether it runs along x, else along y.
        rim: whether it lies on the outer edge of the grid.
        x: middle of the beam from -1 (left edge) over 0 (centre) to 1 (right edge).
        y: the same from the lower to the upper edge.
        cell: number of the beam in its line, from 0.
    """

    along_x: bool
    rim: bool
    x: float
    y: float
    cell: int


@dataclass(frozen=True)
class Design:
    """A named design: what it becomes, and the ratio of each beam."""

    description: str
    ratio: Callable[[Place], float]


def _sign(x: float) -> float:
    return float(np.sign(x))


DESIGNS = {
    "flat": Design("no actuators: stays flat but for gravity", lambda b: 0.0),
    "cone": Design("beams inside the rim curl down", lambda b: 0.0 if b.rim else -0.5),
    "saddle": Design("curls up along x and down along y", lambda b: 0.25 if b.along_x else -1.0),
    "developable": Design(
        "curls down along x only: a piece of a cylinder", lambda b: -1.0 if b.along_x else 0.0
    ),
    "dome": Design("every beam curls down", lambda b: -1.0),
    "bowl": Design("every beam curls up", lambda b: 1.0),
    "twist": Design(
        "opposite corners rise and fall, like a propeller",
        lambda b: _sign(b.x * b.y) if b.rim else 0.0,
    ),
    "wave": Design(
        "curls up and down in turn along x",
        lambda b: (-1.0) ** b.cell if b.along_x else 0.0,
    ),
    "hammock": Design("the rim curls up: corners rise", lambda b: 1.0 if b.rim else 0.0),
    "scroll": Design(
        "curls up along x, tighter to the right",
        # Quarters, from one at the left edge to four at the right.
        lambda b: float(np.clip(np.ceil(2 * (b.x + 1)), 1, 4)) / 4 if b.along_x else 0.0,
    ),
}


def library() -> dict[str, str]:
    """Return the names of the designs and what each becomes."""
    return {name: design.description for name, design in DESIGNS.items()}


def make(
    name: str,
    cells: tuple[int, int] = (2, 2),
    length: float = 65.0,
    material: str = "pla-hot-water",
) -> Grid:
    """Return a design of the library.

    Args:
        name: one of `library()`.
        cells: number of cells along x and y.
        length: length of a beam from joint to joint, mm.
        material: name of the material system.

    Raises:
        InputError: there is no such design, or cells or length are wrong.
    """
    if name not in DESIGNS:
        raise InputError(f'design "{name}" is not known; known are {", ".join(DESIGNS)}')
    grid = lattice(cells, length, material)
    ratios = [DESIGNS[name].ratio(place) for place in _places(cells)]
    return Grid(grid.joints, grid.beams, ratios, grid.fixed, material)


def _places(cells: tuple[int, int]) -> list[Place]:
    """Return where each beam of a lattice lies."""
    grid = lattice(cells, 1.0)
    corner = grid.joints.min(axis=0)
    start, end = grid.joints[grid.beams.T] - corner
    middle = (start + end) / np.array(cells) - 1
    return [
        Place(
            along_x=bool(along_x),
            rim=bool(abs(y if along_x else x) == 1),
            x=float(x),
            y=float(y),
            cell=int(first[0] if along_x else first[1]),
        )
        for (x, y), first, along_x in zip(middle, start, end[:, 0] > start[:, 0], strict=True)
    ]

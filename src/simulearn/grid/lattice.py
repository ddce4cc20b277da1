"""The plain grid of square cells that the library and the random designs start from.

Joints are numbered in rows from the lower left; beams in the order of their joints, at each
joint the beam along +x before the one along +y.
"""

from collections.abc import Collection
from math import isfinite

import numpy as np

from simulearn.errors import InputError
from simulearn.grid.grid import Grid

MOST_CELLS = 100


def lattice(
    cells: tuple[int, int] = (2, 2), length: float = 65.0, material: str = "pla-hot-water"
) -> Grid:
    """Return a grid of square cells without actuators, its fixed joint at the origin.

    Args:
        cells: number of cells along x and y.
        length: length of a beam from joint to joint, mm.
        material: name of the material system.

    Returns:
        The grid; fixed is the joint nearest to the middle, the first of several.

    Raises:
        InputError: a count is not in 1 to 100, or the length is not positive.
    """
    if len(cells) != 2 or not all(1 <= n <= MOST_CELLS and n == int(n) for n in cells):
        raise InputError(f"cells is {tuple(cells)}; a grid has 1 to {MOST_CELLS} along each axis")
    if not (isfinite(length) and length > 0):
        raise InputError(f"length is {length:g}; a beam is longer than 0 mm")
    nx, ny = (int(n) for n in cells)
    place = np.array([(i, j) for j in range(ny + 1) for i in range(nx + 1)])
    beams = [
        (k, k + step)
        for k, (i, j) in enumerate(place.tolist())
        for step, inside in ((1, i < nx), (nx + 1, j < ny))
        if inside
    ]
    # In integers, so that ties are ties.
    fixed = int(np.argmin(((2 * place - (nx, ny)) ** 2).sum(axis=1)))
    joints = (place - place[fixed]) * float(length)
    return Grid(joints, beams, np.zeros(len(beams)), fixed, material)


def drop_beams(grid: Grid, beams: Collection[int]) -> Grid:
    """Return a grid without some of its beams; the others keep their order, all joints stay.

    Raises:
        InputError: there is no beam of that number.
    """
    for beam in beams:
        if not 0 <= beam < len(grid.beams):
            raise InputError(f"beam {beam} is not there; beams are 0 to {len(grid.beams) - 1}")
    stay = ~np.isin(np.arange(len(grid.beams)), list(beams))
    return Grid(grid.joints, grid.beams[stay], grid.actuators[stay], grid.fixed, grid.material)

"""Where grids lie on the bed: side by side in rows, amid the bed, or a reason why not."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.fabricate.printer import Bed, Printer
from simulearn.grid import Grid, outline
from simulearn.material import Section

Array = NDArray[np.float64]
GAP = 10.0  # mm between two grids
EDGE = 1.0  # mm of the bed's edge that stay free
ROUNDING = 1e-6


def place(grids: Sequence[Grid], section: Section, printer: Printer) -> list[Grid]:
    """Return the grids moved to where they are printed, a quarter turn where that helps.

    Args:
        grids: valid designs.
        section: of their beams.
        printer: whose bed they are to lie on.

    Raises:
        InputError: a grid is larger than the bed, or there are too many.
    """
    bed = printer.bed
    room = np.array([bed.width, bed.depth]) - 2 * EDGE
    boxes = [_box(grid, section) for grid in grids]
    sizes = np.array([high - low for low, high in boxes])
    for k, size in enumerate(sizes):
        if (np.sort(size) > np.sort(room) + ROUNDING).any():
            which = f"grid {k} " if len(grids) > 1 else "the grid "
            raise InputError(
                f"{which}is {_by(size)} mm, larger than what the bed of {printer.name} takes "
                f"({_by(room)} mm, {EDGE:g} mm of its edge being kept free)"
            )
    for turned in _turns(sizes, room):
        now = np.where(turned[:, None], sizes[:, ::-1], sizes)
        for order in (np.arange(len(grids)), np.argsort(-now[:, 1], kind="stable")):
            corners = _rows(now[order], room)
            if corners is not None:
                corners[order] = corners.copy()
                return _moved(grids, boxes, turned, corners, now, bed)
    raise InputError(
        f"the {len(grids)} grids do not fit beside one another on the bed of {printer.name} "
        f"({_by(room)} mm, with {GAP:g} mm between them); print fewer at once"
    )


def _box(grid: Grid, section: Section) -> tuple[Array, Array]:
    corners = outline(grid, section).joints.reshape(-1, 2)
    return corners.min(axis=0), corners.max(axis=0)


def _turns(sizes: Array, room: Array) -> list[NDArray[np.bool_]]:
    """Return which grids to turn, tried one after the other: none that need not be, wide, tall."""
    must: NDArray[np.bool_] = np.asarray((sizes > room + ROUNDING).any(axis=1))
    may = (sizes[:, ::-1] <= room + ROUNDING).all(axis=1)
    wide, tall = sizes[:, 0] > sizes[:, 1], sizes[:, 0] < sizes[:, 1]
    return [must, must | (may & tall), must | (may & wide)]


def _rows(sizes: Array, room: Array) -> Array | None:
    """Return the lower left corners (n, 2) of boxes set in rows, or None if they do not fit."""
    corners = np.zeros_like(sizes)
    x = y = height = 0.0
    for k, (width, depth) in enumerate(sizes):
        if x and x + width > room[0] + ROUNDING:
            x, y, height = 0.0, y + height + GAP, 0.0
        corners[k] = x, y
        x, height = x + width + GAP, max(height, float(depth))
    return corners if y + height <= room[1] + ROUNDING else None


def _moved(
    grids: Sequence[Grid],
    boxes: list[tuple[Array, Array]],
    turned: NDArray[np.bool_],
    corners: Array,
    sizes: Array,
    bed: Bed,
) -> list[Grid]:
    """Return the grids with their boxes at the corners, all of them amid the bed."""
    middle = (np.array(bed.low) + bed.high) / 2
    shift = middle - ((corners + sizes).max(axis=0) + corners.min(axis=0)) / 2
    placed = []
    for grid, (low, high), turn, corner in zip(grids, boxes, turned, corners, strict=True):
        joints = grid.joints - low
        if turn:  # counter-clockwise: the upper left corner becomes the lower left one
            joints = np.stack([high[1] - low[1] - joints[:, 1], joints[:, 0]], axis=1)
        joints = joints + corner + shift
        placed.append(Grid(joints, grid.beams, grid.actuators, grid.fixed, grid.material))
    return placed


def _by(size: Array) -> str:
    return f"{size[0]:.1f} x {size[1]:.1f}"

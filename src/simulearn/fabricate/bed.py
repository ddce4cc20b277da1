"""Where grids lie on the bed: apart from one another, amid the bed, or a reason why not."""

from collections.abc import Sequence
from itertools import product
from operator import itemgetter

import numpy as np
import rectpack
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.fabricate.printer import Bed, Printer
from simulearn.grid import Grid, outline
from simulearn.material import Section

Array = NDArray[np.float64]
GAP = 10.0  # mm between two grids
EDGE = 1.0  # mm of the bed's edge that stay free
ROUNDING = 1e-6
UNIT = 1e-3  # mm, in which boxes are packed
# Tried one after the other until all grids fit; the first keeps to rows.
PACKINGS = (rectpack.MaxRectsBl, rectpack.MaxRectsBssf, rectpack.GuillotineBssfSas)
SORTINGS = (rectpack.SORT_NONE, rectpack.SORT_AREA, rectpack.SORT_SSIDE)


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
    if (packed := _packed(sizes, room)) is not None:
        corners, turned = packed
        return _moved(grids, boxes, turned, corners, bed)
    raise InputError(
        f"the {len(grids)} grids do not fit beside one another on the bed of {printer.name} "
        f"({_by(room)} mm, with {GAP:g} mm between them); print fewer at once"
    )


def _box(grid: Grid, section: Section) -> tuple[Array, Array]:
    corners = outline(grid, section).joints.reshape(-1, 2)
    return corners.min(axis=0), corners.max(axis=0)


def _packed(sizes: Array, room: Array) -> tuple[Array, NDArray[np.bool_]] | None:
    """Return the lower left corners (n, 2) of boxes and which are turned, or None if none fits.

    Boxes are turned where they must be; others only where all would not fit otherwise.

    Args:
        sizes: (n, 2) mm.
        room: (2,) mm.
    """
    must: NDArray[np.bool_] = np.asarray((sizes > room + ROUNDING).any(axis=1))
    upright = np.where(must[:, None], sizes[:, ::-1], sizes)
    # A gap goes with each box, and one with the room; the packer counts in integers.
    boxes = np.ceil((upright + GAP - ROUNDING) / UNIT).astype(int).tolist()
    space = np.floor((room + GAP + ROUNDING) / UNIT).astype(int).tolist()
    if sum(w * h for w, h in boxes) > space[0] * space[1]:
        return None
    for rotation, packing, sorting in product((False, True), PACKINGS, SORTINGS):
        packer = rectpack.newPacker(pack_algo=packing, sort_algo=sorting, rotation=rotation)
        for k, box in enumerate(boxes):
            packer.add_rect(*box, rid=k)
        packer.add_bin(*space)
        packer.pack()
        placed = sorted(packer.rect_list(), key=itemgetter(5))
        if len(placed) == len(boxes):
            corners = np.array([(x, y) for _, x, y, _, _, _ in placed]) * UNIT
            turned = np.array([[w, h] for _, _, _, w, h, _ in placed]) != boxes
            return corners, must ^ turned.any(axis=1)
    return None


def _moved(
    grids: Sequence[Grid],
    boxes: list[tuple[Array, Array]],
    turned: NDArray[np.bool_],
    corners: Array,
    bed: Bed,
) -> list[Grid]:
    """Return the grids with their boxes at the corners, all of them amid the bed."""
    sizes = np.array([high - low for low, high in boxes])
    sizes = np.where(turned[:, None], sizes[:, ::-1], sizes)
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

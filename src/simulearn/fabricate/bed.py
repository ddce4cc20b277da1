"""Where grids lie on the bed: apart from one another, amid the bed, or a reason why not."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations, product
from operator import itemgetter

import numpy as np
import rectpack
import shapely
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.fabricate.printer import Bed, Printer
from simulearn.fabricate.regions import footprint
from simulearn.fabricate.zones import farthest, grown, printable, zones
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


def place(
    grids: Sequence[Grid],
    section: Section,
    printer: Printer,
    brim: float = 0.0,
    margins: Sequence[float] = (),
) -> list[Grid]:
    """Return the grids moved to where they are printed, a quarter turn where that helps.

    Args:
        grids: valid designs.
        section: of their beams.
        printer: whose bed they are to lie on.
        brim: width of a brim around each, mm, for which there is room if possible.
        margins: of the bed that stay free if possible, mm, tried one after the other.

    Raises:
        InputError: a grid is larger than the bed, or there are too many, or whether the bed is
            round matters and is not known.
    """
    bed = printer.bed
    boxes = [_box(grid, section) for grid in grids]
    sizes = np.array([high - low for low, high in boxes])
    free = shapely.buffer(printable(bed, EDGE), ROUNDING)
    found = []
    for low, high in _rooms(bed, margins):
        if (packed := _packed(sizes, high - low)) is None:
            continue
        placed = _moved(grids, boxes, packed, (low + high) / 2)
        if bed.round:  # amid the bed by the circle around them, not by their box
            circle = shapely.minimum_bounding_circle(_shapes(placed, section))
            shift = shapely.get_coordinates(shapely.centroid(circle))[0] - bed.middle
            placed = [replace(grid, joints=grid.joints - shift) for grid in placed]
        shapes = _shapes(placed, section)
        if bed.shape_unclear and farthest(shapes, bed) > bed.width / 2 - EDGE:
            raise InputError(f"the grid is wider than a round bed; {bed.ask_shape()}")
        if shapely.contains(free, shapely.buffer(shapes, brim)):
            return placed
        if shapely.contains(free, shapes):
            found.append(placed)
    if found:
        return found[0]
    raise InputError(_too_large(sizes, printer))


def _shapes(grids: Sequence[Grid], section: Section) -> shapely.Geometry:
    return shapely.union_all([footprint(outline(grid, section)) for grid in grids])


def _rooms(bed: Bed, margins: Sequence[float] = ()) -> Iterator[tuple[Array, Array]]:
    """Yield rectangles (low, high; mm) into which grids are packed, one after the other.

    The first is the bed itself within its margins, where they lie amid it. Grids that would there
    leave a round bed or meet an excluded zone are packed into what lies inside of it, or beside the
    zones.
    """
    low, high = np.array(bed.low), np.array(bed.high)
    for margin in (*margins, 0.0):
        yield low + EDGE + margin, high - EDGE - margin
    if bed.round:
        for degrees in (45.0, 35.0, 55.0, 25.0, 65.0):
            angle = np.radians(degrees)
            half = (bed.width / 2 - EDGE) * np.array([np.cos(angle), np.sin(angle)])
            yield np.array(bed.middle) - half, np.array(bed.middle) + half
    yield from _beside_zones(bed)


def _beside_zones(bed: Bed) -> Iterator[tuple[Array, Array]]:
    """Yield the rectangles that lie beside all zones and can grow no further, the largest first."""
    taken = [grown(zone, EDGE) for zone in zones(bed)]
    if not taken:
        return
    low, high = np.add(bed.low, EDGE), np.subtract(bed.high, EDGE)
    bounds = np.reshape(shapely.bounds(taken), (-1, 2))
    xs, ys = (np.unique(np.clip([low[k], high[k], *bounds[:, k]], low[k], high[k])) for k in (0, 1))
    found = [
        shapely.box(x0, y0, x1, y1)
        for x0, x1 in combinations(xs.tolist(), 2)
        for y0, y1 in combinations(ys.tolist(), 2)
    ]
    # They touch zones, but share no area with them.
    clear = [room for room in found if not shapely.area(shapely.intersection(room, taken)).any()]
    largest = [
        room
        for room in clear
        if not any(shapely.contains(other, room) for other in clear if other is not room)
    ]
    for room in sorted(largest, key=lambda room: -shapely.area(room)):
        bounds = shapely.bounds(room)
        yield bounds[:2], bounds[2:]


def _too_large(sizes: Array, printer: Printer) -> str:
    """Return why grids of some sizes, (n, 2) mm with their brims, find no place."""
    bed = printer.bed
    room = np.array([bed.width, bed.depth]) - 2 * EDGE
    takes = f"{_by(room)} mm, {EDGE:g} mm of its edge being kept free"
    if bed.round:
        takes = f"a circle of {room[0]:.1f} mm, {EDGE:g} mm of its edge being kept free"
    zone = "; nothing is printed in its excluded zones" if bed.excluded else ""
    for k, size in enumerate(sizes):
        if len(sizes) == 1 or (np.sort(size) > np.sort(room) + ROUNDING).any():
            which = f"grid {k} " if len(sizes) > 1 else "the grid "
            return (
                f"{which}is {_by(size)} mm, larger than what the bed of {printer.name} takes "
                f"({takes}){zone}"
            )
    return (
        f"the {len(sizes)} grids do not fit beside one another on the bed of {printer.name} "
        f"({takes}, with {GAP:g} mm between them){zone}; print fewer at once"
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
    packed: tuple[Array, NDArray[np.bool_]],
    middle: Array,
) -> list[Grid]:
    """Return the grids with their boxes at the corners, all of them around a middle."""
    corners, turned = packed
    sizes = np.array([high - low for low, high in boxes])
    sizes = np.where(turned[:, None], sizes[:, ::-1], sizes)
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

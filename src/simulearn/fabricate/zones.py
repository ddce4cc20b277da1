"""Where on a bed may be printed: rectangle or disc, without the zones that are excluded."""

import numpy as np
import shapely
from numpy.typing import NDArray

from simulearn.fabricate.printer import Bed

Array = NDArray[np.float64]
QUARTER = 64  # sides of a quarter of a round bed; they lie within 0.1 per mille of its radius
ROUNDING = 1e-6


def printable(bed: Bed, edge: float = 0.0) -> shapely.Geometry:
    """Return the area in which may be printed.

    Args:
        bed: its shape and zones.
        edge: how much of its edge, and around the zones, stays free, mm.
    """
    if bed.round:
        area = shapely.buffer(shapely.points(bed.middle), bed.width / 2 - edge, quad_segs=QUARTER)
    else:
        area = shapely.box(*np.add(bed.low, edge), *np.subtract(bed.high, edge))
    return shapely.difference(area, shapely.union_all([grown(zone, edge) for zone in zones(bed)]))


def zones(bed: Bed) -> list[shapely.Geometry]:
    """Return the rectangles in which nothing is printed."""
    corners = [np.sort(np.array(zone), axis=0) for zone in bed.excluded]
    return [shapely.box(*low, *high) for low, high in corners]


def grown(zone: shapely.Geometry, by: float) -> shapely.Geometry:
    """Return a rectangle that reaches further on all sides, mm."""
    low_x, low_y, high_x, high_y = shapely.bounds(zone)
    return shapely.box(low_x - by, low_y - by, high_x + by, high_y + by)


def room(geometry: shapely.Geometry, bed: Bed) -> float:
    """Return how far what is printed may reach beyond a geometry, mm; 0 where it is not on the bed.

    Args:
        geometry: on the bed, without holes.
        bed: its shape and zones.
    """
    area = printable(bed)
    if not shapely.contains_properly(shapely.buffer(area, ROUNDING), geometry):
        return 0.0
    return float(shapely.distance(geometry, shapely.boundary(area)))


def farthest(geometry: shapely.Geometry, bed: Bed) -> float:
    """Return the greatest distance of a geometry from the middle of the bed, mm."""
    points = shapely.get_coordinates(geometry) - bed.middle
    return float(np.hypot(points[:, 0], points[:, 1]).max())


def off_bed(begins: Array, ends: Array, bed: Bed) -> NDArray[np.bool_]:
    """Return which lines leave a round bed or meet an excluded zone.

    Args:
        begins: (n, 2) mm, of lines that are printed.
        ends: (n, 2) mm.
        bed: its shape and zones.
    """
    off = np.zeros(len(ends), dtype=bool)
    if bed.round:
        away = np.hypot(*(ends - bed.middle).T)
        off |= (away > bed.width / 2 + ROUNDING) | (
            np.hypot(*(begins - bed.middle).T) > bed.width / 2 + ROUNDING
        )
    if bed.excluded:
        lines = shapely.linestrings(np.stack([begins, ends], axis=1))
        for zone in zones(bed):
            off |= np.asarray(shapely.intersects(grown(zone, -ROUNDING), lines))
    return off

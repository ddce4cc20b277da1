"""What is printed beside the grids on the first layer: a skirt that primes, a brim that holds.

The skirt runs around everything at a distance. The brim is a few rows along the outside of each
grid, on the bed alone; a narrow gap keeps it from bonding firmly, since it is cut off before the
bath. Where two grids are near, their brims merge.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import floor

import numpy as np
import shapely
from numpy.typing import NDArray

from simulearn.fabricate.printer import Bed
from simulearn.fabricate.regions import Plan
from simulearn.fabricate.settings import Settings
from simulearn.fabricate.zones import room
from simulearn.grid import Message

Array = NDArray[np.float64]
SKIRT_LEAST = 3.0  # mm; a skirt nearer to the grid is left out
APART = 1.0  # mm; also one nearer to the brim
QUARTER = 12  # segments of a quarter circle where a row turns about a corner
GAP = 0.1  # mm between brim and grid, as makers of printers have it


@dataclass(frozen=True, eq=False)
class Ring:
    """A closed row.

    Attributes:
        grid: the grid around which it runs, -1 for several.
        points: (n, 2) mm, the last being the first.
    """

    grid: int
    points: Array


@dataclass(frozen=True)
class Beside:
    """What is printed beside the grids.

    Attributes:
        skirt: one ring or none.
        brim: its rows, the outermost first.
        messages: what is narrower than it should be, or missing.
    """

    skirt: list[Ring]
    brim: list[Ring]
    messages: list[Message]


def beside(plans: Sequence[Plan], settings: Settings, bed: Bed) -> Beside:
    """Return skirt and brim, as wide and as far out as the bed allows.

    Args:
        plans: the grids on the bed.
        settings: width of the brim and of a row, distance of the skirt.
        bed: what they must stay on.
    """
    line = settings.line
    grids = [_filled(plan.union) for plan in plans]
    everything = shapely.union_all(grids)
    free = room(everything, bed)
    messages = []

    wanted = max(1, round(settings.brim / line)) if settings.brim else 0
    rows = min(wanted, max(0, floor((free - GAP) / line + 1e-6)))
    if rows < wanted:
        text = f"the brim is {rows * line:.1f} mm wide instead of {settings.brim:g}"
        text = text if rows else "there is no room for a brim"
        messages.append(Message("brim", "bed", f"{text}: the bed ends there"))
    brim = _brim(grids, rows, line)

    least_away = min(SKIRT_LEAST, settings.skirt_distance)
    if rows:
        least_away = GAP + rows * line + APART
    wished = max(settings.skirt_distance, least_away)
    hull = shapely.convex_hull(everything)
    away = min(wished, room(hull, bed) - line)
    if away < least_away:
        primes = "the brim primes the nozzle" if rows else "prime the nozzle by hand"
        text = f"there is no room for a skirt on the bed; {primes}"
        return Beside([], brim, [*messages, Message("skirt", "bed", text)])
    if abs(away - settings.skirt_distance) > 1e-6:
        text = f"the skirt is {away:.1f} mm out instead of {settings.skirt_distance:g}: "
        text += "the bed ends there" if away < wished else "the brim is in between"
        messages.append(Message("skirt", "bed", text))
    ring = shapely.get_coordinates(shapely.buffer(hull, away + line / 2, quad_segs=QUARTER))
    return Beside([Ring(-1, ring)], brim, messages)


def _brim(grids: list[shapely.Geometry], rows: int, line: float) -> list[Ring]:
    """Return the rows around each grid, the outermost first, those of a grid in one go."""
    rings = []
    everything = shapely.union_all(grids)
    for row in reversed(range(rows)):
        # Closed by half a row: two rows that would lie closer than that become one area.
        out = shapely.buffer(everything, GAP + (row + 1) * line, quad_segs=QUARTER)
        out = shapely.buffer(out, -line / 2, quad_segs=QUARTER)
        for area in shapely.get_parts(out):
            inside = np.flatnonzero(shapely.intersects(area, grids))
            g = int(inside[0]) if len(inside) == 1 else -1
            rings += [Ring(g, shapely.get_coordinates(r)) for r in shapely.get_rings(area)]
    return sorted(rings, key=lambda ring: ring.grid)


def _filled(union: shapely.Geometry) -> shapely.Geometry:
    """Return an outline without its cells."""
    parts = shapely.get_parts(union)
    return shapely.union_all([shapely.polygons(shapely.get_exterior_ring(p)) for p in parts])

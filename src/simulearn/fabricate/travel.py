"""How the nozzle gets from bead to bead: in place, lifted, or lifted with filament drawn back.

A nozzle that travels inside the part may ooze: what it loses stays in the part. So filament is
drawn back only on travels that leave the part. The nozzle is lifted on those, and on travels that
cross a bead of the same layer, which would be scratched and pushed where it does not hold well.
"""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from simulearn.fabricate.toolpath import BRIM, Bead, Toolpath

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
NEAR = 2.0  # lines; from one row of the brim to the next, which lies outside of the part
ROUNDING = 2e-3  # mm; coordinates of beads have three digits


@dataclass(frozen=True, eq=False)
class Travels:
    """The travel to each bead.

    Attributes:
        drawn: (n,) whether filament is drawn back.
        lifted: (n,) whether the nozzle is lifted.
    """

    drawn: Flags
    lifted: Flags


def travels(path: Toolpath, part: shapely.Geometry, line: float) -> Travels:
    """Return how the nozzle travels to each bead; the first one is reached from above.

    Args:
        path: the beads.
        part: the outline of all that is printed, with the cells as holes.
        line: width of a row, mm.
    """
    beads = [bead for layer in path.layers for bead in layer.beads]
    layer = np.repeat(np.arange(len(path.layers)), [len(q.beads) for q in path.layers])
    begins = np.array([bead.points[0] for bead in beads])
    ends = np.array([bead.points[-1] for bead in beads])
    pairs = np.stack([ends[:-1], begins[1:]], axis=1)
    lines = shapely.linestrings(pairs)
    length = np.linalg.norm(pairs[:, 1] - pairs[:, 0], axis=1)

    area = shapely.buffer(part, ROUNDING)
    shapely.prepare(area)
    stays = shapely.covers(area, lines)
    brim = np.array([bead.role == BRIM for bead in beads])
    stays |= brim[1:] & brim[:-1] & (length <= NEAR * line)

    # A travel does not cross what it leaves: it is cut short by a row there.
    share = (line / np.maximum(length, line))[:, None]
    pairs[:, 0] += share * (pairs[:, 1] - pairs[:, 0])
    lines = shapely.linestrings(pairs)
    tested = np.flatnonzero(stays & (length > NEAR * line) & (layer[1:] == layer[:-1])) + 1
    crosses = np.zeros(len(beads), dtype=bool)
    for k in range(len(path.layers)):
        first = int(np.searchsorted(layer, k))
        these = tested[layer[tested] == k]
        crosses[these] = _crosses(lines[these - 1], these - first, path.layers[k].beads)
    drawn = np.append(True, ~stays)
    return Travels(drawn, drawn | crosses)


def _crosses(
    lines: NDArray[np.object_], numbers: NDArray[np.int64], beads: tuple[Bead, ...]
) -> Flags:
    """Return whether travels cross beads that are printed before them.

    Args:
        lines: of the travels.
        numbers: of the beads to which they lead.
        beads: of the layer.
    """
    tree = shapely.STRtree([shapely.linestrings(bead.points) for bead in beads])
    which, crossed = tree.query(lines, predicate="intersects")
    result = np.zeros(len(lines), dtype=bool)
    result[which[crossed < numbers[which]]] = True
    return result

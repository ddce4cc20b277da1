"""A toolpath as the machine runs it: every move in one list, with the travels between the beads.

Where a travel leaves the part the filament is drawn back, so that it does not ooze; see travel.py.
At the first bead it is not drawn back, whatever the printer did before.
"""

from dataclasses import dataclass
from math import floor

import numpy as np
import shapely
from numpy.typing import NDArray

from simulearn.fabricate.settings import Settings
from simulearn.fabricate.toolpath import Toolpath
from simulearn.fabricate.travel import travels

Array = NDArray[np.float64]

PRINT, TRAVEL, LIFT, RETRACT, RESTORE = range(5)
APPROACH = 5.0  # mm above the bed on the travel to the first bead
AWAY = 10.0  # mm above the print at its end
DIGITS = 5  # of filament, mm


@dataclass(frozen=True, eq=False)
class Moves:
    """Moves in the order in which they are run; move k leads from place k - 1 to place k.

    Attributes:
        kind: (m,) PRINT, TRAVEL, LIFT, RETRACT or RESTORE.
        places: (m, 3) x, y, z where a move ends, mm.
        filament: (m,) fed during a move, mm; negative where it is drawn back.
        speeds: (m,) mm/min, of the filament where only that moves.
        bead: (m,) which of all beads a move belongs to; a travel belongs to the bead it leads to,
            the moves after the last bead to none (the number of beads).
        start: (3,) where the first move is taken to begin, mm.
    """

    kind: NDArray[np.int64]
    places: Array
    filament: Array
    speeds: Array
    bead: NDArray[np.int64]
    start: Array


def moves_of(
    path: Toolpath, part: shapely.Geometry, settings: Settings, start: Array, highest: float
) -> Moves:
    """Return the moves that print a toolpath.

    Args:
        path: what to print.
        part: the outline of all grids, within which travels need no retraction.
        settings: speeds, retraction and filament.
        start: (2,) where the nozzle is taken to be at first, mm.
        highest: the nozzle goes no higher, mm.
    """
    s = settings
    highest = floor(highest * 1000) / 1000  # a file has three digits of a place
    blocks: list[Array] = []
    to = travels(path, part, s.line)
    x, y = start.tolist()
    z, number = 0.0, 0
    for layer in path.layers:
        height = round(layer.z, 6)
        for bead in layer.beads:
            u, v = bead.points[0].tolist()
            lead = []
            if to.lifted[number]:
                above = min(highest, height + (s.lift if number else APPROACH))
                lead = [
                    [LIFT, x, y, above, 0.0, s.speed_z],
                    [TRAVEL, u, v, above, 0.0, s.travel],
                    [LIFT, u, v, height, 0.0, s.speed_z],
                ]
                if number and s.retraction and to.drawn[number]:
                    lead.insert(0, [RETRACT, x, y, z, -s.retraction, s.retraction_speed])
                    lead.append([RESTORE, u, v, height, s.retraction, s.retraction_speed])
            else:
                if height != z:
                    lead.append([LIFT, x, y, height, 0.0, s.speed_z])
                if (u, v) != (x, y):
                    lead.append([TRAVEL, u, v, height, 0.0, s.travel])
            z = height
            block = np.empty((len(lead) + len(bead.widths), 7))
            if lead:
                block[: len(lead), :6] = lead
            rest = block[len(lead) :]
            rest[:, 0] = PRINT
            rest[:, 1:3] = bead.points[1:]
            rest[:, 3] = z
            fed = bead.lengths * bead.section * (layer.height / s.filament_area)
            rest[:, 4] = fed.round(DIGITS)
            rest[:, 5] = bead.speed
            block[:, 6] = number
            blocks.append(block)
            x, y = bead.points[-1].tolist()
            number += 1
    tail = [[LIFT, x, y, min(highest, z + AWAY), 0.0, s.speed_z, number]]
    if s.retraction:
        tail.insert(0, [RETRACT, x, y, z, -s.retraction, s.retraction_speed, number])
    table = np.concatenate([*blocks, np.array(tail)])
    return Moves(
        table[:, 0].astype(np.int64),
        table[:, 1:4],
        table[:, 4],
        table[:, 5],
        table[:, 6].astype(np.int64),
        np.array([*start, 0.0]),
    )

"""From grids on the bed to a toolpath: shells first, then what they enclose, layer by layer.

The strokes of a region are the same on all layers of a half and a parity. Where each begins is not:
neither seams nor turns stack (see order.py).
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from simulearn.fabricate.order import printing_order
from simulearn.fabricate.printer import Bed
from simulearn.fabricate.raster import Strokes, fill
from simulearn.fabricate.regions import Plan, Region
from simulearn.fabricate.settings import Settings
from simulearn.fabricate.skirt import Ring, beside
from simulearn.fabricate.toolpath import BRIM, SHELL, SKIRT, Bead, Layer, Toolpath
from simulearn.grid import Grid, Message
from simulearn.material import Section

Array = NDArray[np.float64]
ROUND = 3  # digits of a coordinate, mm; the file's, so that E fits what is moved


def build(
    grids: Sequence[Grid], section: Section, settings: Settings, bed: Bed
) -> tuple[Toolpath, list[Message]]:
    """Return the toolpath of grids, and warnings about it.

    Args:
        grids: valid designs without dangling beams, where they lie on the bed.
        section: of their beams.
        settings: how they are printed.
        bed: where skirt and brim must stay.
    """
    plans = [Plan(grid, section, settings.line, settings.shells) for grid in grids]
    extra = beside(plans, settings, bed)
    shells, fills = _Shells(plans, settings), _Fills(plans, settings)
    here = np.array(bed.low)
    layers = []
    tops = np.cumsum(settings.heights).round(6).tolist()
    for k, (z, height) in enumerate(zip(tops, settings.heights, strict=True)):
        beads: list[Bead] = []
        if k == 0:
            for role, rings in ((SKIRT, extra.skirt), (BRIM, extra.brim)):
                for ring in rings:
                    beads.append(_ring_bead(settings, role, ring, here))
                    here = beads[-1].points[-1]
        beads += shells.beads(here, k == 0)
        beads += fills.beads(k >= settings.layers // 2, k % 2 == 1, beads[-1].points[-1], k == 0)
        here = beads[-1].points[-1]
        layers.append(Layer(z, height, tuple(beads)))
    return Toolpath(tuple(layers)), extra.messages


class _Shells:
    """The closed beads along the outlines, and where they have begun on the layers so far."""

    def __init__(self, plans: list[Plan], settings: Settings) -> None:
        self.settings = settings
        self.rings = [(g, ring[:-1]) for g, plan in enumerate(plans) for ring in plan.rings()]
        self.seams = [_corners(points, settings.line) for _, points in self.rings]
        self.places = [points[k] for (_, points), k in zip(self.rings, self.seams, strict=True)]
        self.used = [np.zeros(len(k), dtype=np.int64) for k in self.seams]

    def beads(self, here: Array, first: bool) -> list[Bead]:
        """Return the beads of the next layer, in order from where the nozzle is."""
        beads = []
        for k, seam in printing_order(self.places, self.places, here, self.used):
            g, points = self.rings[k]
            points = np.roll(points, -self.seams[k][seam], axis=0)
            points = np.concatenate([points, points[:1]])
            line = self.settings.line
            beads.append(_bead(self.settings, SHELL, "outline", g, points, line, first))
        return beads


class _Fills:
    """The strokes of all regions of all grids, and where they have begun on the layers so far."""

    def __init__(self, plans: list[Plan], settings: Settings) -> None:
        self.settings = settings
        self.joints = {
            (top, odd): [
                piece
                for g, plan in enumerate(plans)
                for j in range(len(plan.grid.joints))
                for piece in self._fill(g, [plan.joint(j, top, odd)])
            ]
            for top in (False, True)
            for odd in (False, True)
        }
        self.beams: dict[bool, list[_Piece]] = {False: [], True: []}
        for g, plan in enumerate(plans):
            for b, ratio in enumerate(plan.grid.actuators.tolist()):
                passive = self._fill(g, plan.beam(b, False))
                active = self._fill(g, plan.beam(b, True)) if ratio else passive
                for top in (False, True):
                    self.beams[top] += active if ratio and (ratio > 0) == top else passive

    def beads(self, top: bool, odd: bool, here: Array, first: bool) -> Iterator[Bead]:
        """Yield what fills the next layer, in order from where the nozzle is."""
        pieces = [*self.joints[top, odd], *self.beams[top]]
        tips = [piece.strokes.tips() for piece in pieces]
        order = printing_order(
            [a for a, _ in tips], [b for _, b in tips], here, [piece.used for piece in pieces]
        )
        for k, variant in order:
            yield pieces[k].bead(variant, self.settings, first)

    def _fill(self, g: int, regions: list[Region]) -> list["_Piece"]:
        s = self.settings
        return [
            _Piece(g, region, strokes)
            for region in regions
            for strokes in fill(region, s.line, s.overlap, s.shells * s.line, s.infill)
        ]


class _Piece:
    """Strokes of a region, and how often each of their variants has been printed."""

    def __init__(self, grid: int, region: Region, strokes: Strokes) -> None:
        self.grid, self.region, self.strokes = grid, region, strokes
        self.used = np.zeros(4, dtype=np.int64)
        self._beads: dict[tuple[int, bool], Bead] = {}

    def bead(self, variant: int, settings: Settings, first: bool) -> Bead:
        """Return the bead of a variant, the same object whenever it is printed again."""
        if (variant, first) not in self._beads:
            points, widths = self.strokes.path(variant)
            role, part = self.region.role, self.region.part
            bead = _bead(settings, role, part, self.grid, points, widths, first)
            self._beads[variant, first] = bead
        return self._beads[variant, first]


def _bead(
    settings: Settings,
    role: str,
    part: str,
    g: int,
    points: Array,
    widths: Array | float,
    first: bool,
) -> Bead:
    points = np.round(points, ROUND) + 0.0  # no -0
    widths = np.broadcast_to(np.round(widths, 4), len(points) - 1)
    stays = np.append(True, (np.diff(points, axis=0) != 0).any(axis=1))
    speed, flow = settings.speed[role], settings.flow[role]
    if first:
        speed, flow = min(speed, settings.first_layer_speed), flow * settings.first_layer_flow
    return Bead(role, part, g, points[stays], widths[stays[1:]], speed, flow)


def _ring_bead(settings: Settings, role: str, ring: Ring, here: Array) -> Bead:
    """Return a row of skirt or brim, from its corner nearest to where the nozzle is."""
    points = ring.points[:-1]
    first = int(np.argmin(np.sum((points - here) ** 2, axis=1).round(6)))
    points = np.roll(points, -first, axis=0)
    points = np.concatenate([points, points[:1]])
    return _bead(settings, role, role, ring.grid, points, settings.line, True)


def _corners(points: Array, line: float) -> NDArray[np.int64]:
    """Return the points (n, 2) of a ring at which it may begin: of those within a row, one."""
    steps = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    ends = np.flatnonzero(steps >= line)  # a corner's last points
    if not len(ends):
        return np.zeros(1, dtype=np.int64)
    begins = np.append(ends[-1] - len(points), ends) + 1
    return np.array([((a + b - 1) // 2) % len(points) for a, b in pairwise(begins)])

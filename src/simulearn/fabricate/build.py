"""From grids on the bed to a toolpath: shells first, then what they enclose, layer by layer.

There are only four kinds of layer, two halves of two parities. Each is computed once and printed as
often as the thickness of the beam requires.
"""

from collections.abc import Iterator, Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

from simulearn.fabricate.order import nearest_first
from simulearn.fabricate.printer import Bed
from simulearn.fabricate.raster import Strokes, fill
from simulearn.fabricate.regions import Plan, Region
from simulearn.fabricate.settings import Settings
from simulearn.fabricate.toolpath import SHELL, SKIRT, Bead, Layer, Toolpath
from simulearn.grid import Grid, Message
from simulearn.material import Section

Array = NDArray[np.float64]
ROUND = 3  # digits of a coordinate, mm; the file's, so that E fits what is moved
SKIRT_LEAST = 3.0  # mm; a skirt nearer to the grid is left out


def build(
    grids: Sequence[Grid], section: Section, settings: Settings, bed: Bed
) -> tuple[Toolpath, list[Message]]:
    """Return the toolpath of grids, and warnings about it.

    Args:
        grids: valid designs without dangling beams, where they lie on the bed.
        section: of their beams.
        settings: how they are printed.
        bed: where the skirt must stay.
    """
    plans = [Plan(grid, section, settings.line, settings.shells) for grid in grids]
    skirt, messages = _skirt(plans, settings, bed)
    filled = _Filled(plans, settings)
    rings = [(g, ring) for g, plan in enumerate(plans) for ring in plan.rings()]
    here = skirt[-1].points[-1] if skirt else np.array(bed.low)
    kinds: dict[tuple[bool, bool], tuple[Bead, ...]] = {}
    layers = []
    for k in range(settings.layers):
        kind = (k >= settings.layers // 2, k % 2 == 1)
        if kind not in kinds:
            shells = list(_shells(rings, settings, here))
            fills = list(filled.beads(*kind, shells[-1].points[-1]))
            kinds[kind] = (*shells, *fills)
            here = fills[-1].points[-1]
        beads = kinds[kind] if k else (*skirt, *kinds[kind])
        layers.append(Layer((k + 1) * settings.layer, settings.layer, beads))
    return Toolpath(tuple(layers)), messages


class _Filled:
    """The strokes of all regions of all grids, each computed once."""

    def __init__(self, plans: list[Plan], settings: Settings) -> None:
        self.settings = settings
        self.joints = {
            odd: [
                self._fill(g, [plan.joint(j, odd)])
                for g, plan in enumerate(plans)
                for j in range(len(plan.grid.joints))
            ]
            for odd in (False, True)
        }
        self.beams = {}
        for g, plan in enumerate(plans):
            for b, ratio in enumerate(plan.grid.actuators.tolist()):
                passive = self._fill(g, plan.beam(b, False))
                active = self._fill(g, plan.beam(b, True)) if ratio else passive
                self.beams[g, b] = {
                    top: active if ratio and (ratio > 0) == top else passive
                    for top in (False, True)
                }

    def beads(self, top: bool, odd: bool, here: Array) -> Iterator[Bead]:
        """Yield what fills a layer of a half and a parity, in order from where the nozzle is."""
        pieces = [
            piece
            for part in [*self.joints[odd], *(halves[top] for halves in self.beams.values())]
            for piece in part
        ]
        tips = [strokes.tips() for *_, strokes in pieces]
        order = nearest_first([a for a, _ in tips], [b for _, b in tips], here)
        for k, variant in order:
            g, region, strokes = pieces[k]
            points, widths = strokes.path(variant)
            yield _bead(self.settings, region.role, region.part, g, points, widths)

    def _fill(self, g: int, regions: list[Region]) -> list[tuple[int, Region, Strokes]]:
        s = self.settings
        return [
            (g, region, strokes)
            for region in regions
            for strokes in fill(region, s.line, s.overlap, s.shells * s.line, s.infill)
        ]


def _bead(
    settings: Settings, role: str, part: str, g: int, points: Array, widths: Array | float
) -> Bead:
    points = np.round(points, ROUND) + 0.0  # no -0
    widths = np.broadcast_to(np.round(widths, 4), len(points) - 1)
    stays = np.append(True, (np.diff(points, axis=0) != 0).any(axis=1))
    return Bead(
        role, part, g, points[stays], widths[stays[1:]], settings.speed[role], settings.flow[role]
    )


def _shells(rings: list[tuple[int, Array]], settings: Settings, here: Array) -> Iterator[Bead]:
    """Yield the closed beads along the outlines, in order from where the nozzle is."""
    corners = [ring[:-1] for _, ring in rings]
    for k, first in nearest_first(corners, corners, here):
        g, ring = rings[k]
        points = np.roll(ring[:-1], -first, axis=0)
        points = np.concatenate([points, points[:1]])
        yield _bead(settings, SHELL, "outline", g, points, settings.line)


def _skirt(plans: list[Plan], settings: Settings, bed: Bed) -> tuple[list[Bead], list[Message]]:
    """Return the bead that runs around everything before the first layer, as far out as fits."""
    hull = shapely.convex_hull(shapely.union_all([plan.union for plan in plans]))
    least, most = np.reshape(shapely.bounds(hull), (2, 2))
    room = min((least - bed.low).min(), (bed.high - most).min()) - settings.line
    away = min(settings.skirt_distance, float(room))
    if away < min(SKIRT_LEAST, settings.skirt_distance):
        text = "there is no room for a skirt on the bed; prime the nozzle by hand"
        return [], [Message("skirt", "bed", text)]
    ring = shapely.get_coordinates(shapely.buffer(hull, away + settings.line / 2, quad_segs=8))
    messages = []
    if away < settings.skirt_distance - 1e-6:
        text = f"the skirt is {away:.1f} mm out instead of {settings.skirt_distance:g}: "
        messages = [Message("skirt", "bed", text + "the bed ends there")]
    return [_bead(settings, SKIRT, "skirt", -1, ring, settings.line)], messages

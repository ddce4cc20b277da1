"""Travels: drawn back where they leave the part, lifted where they would scratch it."""

import numpy as np
import pytest
import shapely

from simulearn.fabricate import load_printer, prepare
from simulearn.fabricate.moves import PRINT
from simulearn.fabricate.regions import footprint
from simulearn.fabricate.travel import travels
from simulearn.grid import Rules, draw_valid, make, outline

LINE = 0.6
DESIGNS = [[make("twist")], [draw_valid(Rules(), 150, 3)[0]], [make("dome", (1, 1), 40.0)] * 2]


@pytest.mark.parametrize("grids", DESIGNS, ids=["twist", "random", "two"])
def test_travels_against_a_check_by_points(grids):
    job = prepare(grids, load_printer("stacker-s4"))
    part = shapely.union_all([footprint(outline(g, job.material.section)) for g in job.grids])
    found = travels(job.path, part, LINE)
    near, core = shapely.buffer(part, 5e-3), shapely.buffer(part, -0.05)
    shapely.prepare(near)
    shapely.prepare(core)
    number = inside = 0
    end = None
    for layer in job.path.layers:
        printed = []  # pieces of beads of this layer so far
        for bead in layer.beads:
            if end is not None:
                length = np.linalg.norm(bead.points[0] - end)
                t = np.linspace(0, 1, 2 + int(length / 0.2))[:, None]
                points = end * (1 - t) + bead.points[0] * t
                brim = bead.role == "brim" and length < 2 * LINE
                if not found.drawn[number]:
                    assert brim or shapely.contains_xy(near, points).all()
                else:  # it leaves the part, or touches its outline
                    assert not shapely.contains_xy(core, points).all()
                assert found.lifted[number] or not found.drawn[number]
                if length > 2 * LINE and not found.lifted[number] and printed:
                    inside += 1
                    line = shapely.linestrings(points[t[:, 0] * length >= LINE])
                    assert not shapely.intersects(shapely.multilinestrings(printed), line)
            pieces = np.stack([bead.points[:-1], bead.points[1:]], axis=1)
            printed += [shapely.linestrings(piece) for piece in pieces]
            end = bead.points[-1]
            number += 1
        end = bead.points[-1]
    assert inside > 30


def test_filament_is_not_drawn_back_at_the_first_bead():
    job = prepare([make("twist", (1, 1), 40.0)], load_printer("ender-3"))
    fed = job.moves.filament
    first = int(np.argmax(fed != 0))
    assert fed[first] > 0
    assert fed[first] < job.settings.retraction  # a bead, no restoring
    drawn = np.cumsum(np.where(job.moves.kind == PRINT, 0.0, fed))
    assert drawn.max() == pytest.approx(0.0, abs=1e-9)
    assert drawn[-1] == pytest.approx(-job.settings.retraction)

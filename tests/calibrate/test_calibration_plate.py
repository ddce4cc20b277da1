"""The plate: strips that dangle are printed whole, apart, on the bed; a grid's own are not."""

import numpy as np
import pytest
from matplotlib.patches import Ellipse

from simulearn.calibrate import make_plate
from simulearn.errors import InputError
from simulearn.fabricate import load_printer, prepare
from simulearn.fabricate.regions import footprint
from simulearn.grid import outline
from simulearn.show.plate import plate_map

PRINTER = load_printer("ender-3")


def small(width):
    return PRINTER.model_copy(
        update={"bed": PRINTER.bed.model_copy(update={"width": width, "depth": width})}
    )


@pytest.fixture(scope="module")
def plate():
    return make_plate(small(180.0))


def test_all_strips_are_printed_apart(plate):
    job = plate.job
    assert len(job.grids) == len(set(job.names)) == 18
    section = job.material.section
    shapes = [footprint(outline(grid, section)) for grid in job.grids]
    for k, one in enumerate(shapes):
        for other in shapes[:k]:
            assert one.distance(other) >= 10 - 1e-6
    low, high = job.path.bounds
    assert (low >= 0).all()
    assert (high <= 180).all()


def test_halves_are_printed_as_designed(plate):
    roles = {
        (bead.grid, top): bead
        for k, layer in enumerate(plate.job.path.layers)
        for bead in layer.beads
        if bead.role == "active"
        for top in [k >= len(plate.job.path.layers) // 2]
    }
    halves = {plate.job.names[g][0] + "+-"[not top] for g, top in roles}
    assert halves == {"T+", "H+", "B-"}


def test_lengths_tell_strips_apart(plate):
    lengths = sorted(plate.length.values())
    assert np.diff(lengths).min() > 9
    record = plate.form.strips["joints"]
    assert plate.length["joints"] == pytest.approx(sum(record.beams) + 7.2)


def test_the_map_shows_the_bed_as_it_is():
    bed = PRINTER.bed.model_copy(update={"width": 280.0, "depth": 280.0, "shape": "round"})
    for one in (bed, bed.model_copy(update={"shape": "rectangle"})):
        ax, *_ = plate_map(make_plate(PRINTER.model_copy(update={"bed": one}), repeats=1)).axes
        assert any(isinstance(patch, Ellipse) for patch in ax.patches) == one.round


def test_too_small_a_bed():
    with pytest.raises(InputError, match="try 2") as caught:
        make_plate(small(168.0))
    assert caught.value.code == "calibration-bed"
    with pytest.raises(InputError, match=r"the longest strip is 163\.2 mm"):
        make_plate(small(150.0))


def test_a_grid_of_a_user_still_loses_what_dangles(plate):
    with pytest.raises(InputError, match="dangle"):
        prepare([plate.form.strips["top"].grid()], PRINTER)

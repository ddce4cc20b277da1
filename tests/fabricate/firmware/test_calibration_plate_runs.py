"""Plates of strips for a calibration, run on the machine that each printer is: no danger."""

import pytest
from test_prints_run import limits_of
from virtual_printer import simulate

from simulearn.calibrate import make_plate
from simulearn.fabricate import load_printer


@pytest.mark.parametrize("name", ["bambu-x1", "ender-3", "makerbot-2x"])
def test_a_plate_does_no_harm(name):
    job = make_plate(load_printer(name), repeats=2).job
    trace = simulate(job.gcode, limits_of(job.printer))
    assert [str(danger) for danger in trace.dangers] == []
    assert trace.beads[:, 5].sum() == pytest.approx(job.estimate.filament_mm, rel=1e-6)

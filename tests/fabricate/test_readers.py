"""What the programs of print servers say of our files, on all printers.

They are in an environment of their own (make readers): Moonraker reads for Mainsail and Fluidd,
OctoPrint for itself, gcode-metadata for PrusaLink and PrusaConnect, bambox checks for Bambu Lab.
"""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
from reading import read
from several import FIRMWARE, GRIDS, job_of

from requiring import required
from simulearn import __version__
from simulearn.fabricate import write_gcode, write_package
from simulearn.fabricate.header import clock

ROOT = Path(__file__).parents[2]
PYTHON = ROOT / ".venv-readers" / "bin" / "python"
SCRIPT = Path(__file__).parent / "readers" / "read_files.py"
SMALL = [[32, 32], [48, 48], [300, 300]]


@pytest.mark.parametrize("name", FIRMWARE)
def test_programs_of_print_servers_understand_all_files(name, tmp_path):
    required("print-readers", PYTHON.exists())
    jobs = {f"{name}-{grids}.gcode": job_of(name, grids) for grids in GRIDS}
    for file, job in jobs.items():
        write_gcode(job.gcode, tmp_path / file)
        if FIRMWARE[name] == "bambu":
            write_package(job, tmp_path / file.replace(".gcode", ".own.gcode.3mf"))
    command = [str(PYTHON), str(SCRIPT), str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stderr
    answers = json.loads(done.stdout)
    for file, job in jobs.items():
        says = answers[file]
        check_moonraker(says["moonraker"], job)
        check_octoprint(says["octoprint"], job)
        check_prusa(says["prusa"], job)
        pictures = [] if FIRMWARE[name] == "bambu" else SMALL
        assert [size for size in says["thumbnails"] if size in SMALL] == pictures
        if FIRMWARE[name] == "bambu":
            assert says["bambox_pack"] == {"valid": True, "errors": [], "warnings": []}
            own = answers[file.replace(".gcode", ".own.gcode.3mf")]["bambox"]
            assert own == {"valid": True, "errors": [], "warnings": []}


def check_moonraker(says, job):
    assert says["slicer_version"].endswith(f"(SimuLearn {__version__})")
    assert says["estimated_time"] == pytest.approx(job.estimate.seconds, abs=1)
    assert says["filament_total"] == pytest.approx(job.estimate.filament_mm, abs=0.01)
    assert says["filament_weight_total"] == pytest.approx(job.estimate.filament_g, abs=0.01)
    assert says["layer_count"] == len(job.path.layers)
    assert says["object_height"] == pytest.approx(job.path.layers[-1].z)
    assert says["layer_height"] == job.settings.layer
    assert says["first_layer_height"] == pytest.approx(job.path.layers[0].z)
    assert says["nozzle_diameter"] == job.settings.nozzle
    assert says["first_layer_extr_temp"] == 205  # not what a nozzle has while it probes
    assert says["filament_type"] == "PLA"
    assert says["filament_name"] == "pla-hot-water"
    sizes = {(picture["width"], picture["height"]) for picture in says.get("thumbnails", [])}
    if job.printer.firmware == "bambu":
        assert sizes == set()
    elif job.printer.firmware == "prusa":
        assert sizes == {(32, 32), (48, 48), (300, 300), (16, 16), (313, 173), (440, 240)}
    else:
        assert sizes == {(32, 32), (48, 48), (300, 300)}


def check_octoprint(says, job):
    # It knows no accelerations, so its time is a lower limit.
    assert 0.4 * job.estimate.seconds < 60 * says["total_time"] < 1.02 * job.estimate.seconds
    # It counts what the start code feeds and where, too.
    start = read(job.gcode.partition(";LAYER_COUNT")[0])
    (length,) = says["extrusion_length"]
    assert length == pytest.approx(job.estimate.filament_mm + start.fed.sum(), abs=0.05)
    purge = np.flatnonzero(start.prints)
    purged = start.places[np.union1d(purge - 1, purge)]
    places = np.concatenate([purged[:, :2], job.path.bounds])
    area, low, high = says["printing_area"], np.nanmin(places, axis=0), np.nanmax(places, axis=0)
    assert [area["minX"], area["minY"]] == pytest.approx(low.tolist(), abs=0.001)
    assert [area["maxX"], area["maxY"]] == pytest.approx(high.tolist(), abs=0.001)
    heights = [*purged[:, 2], job.path.layers[-1].z]
    assert area["maxZ"] == pytest.approx(np.nanmax(heights))


def check_prusa(says, job):
    needs = job.estimate
    assert says["estimated printing time (normal mode)"] == clock(needs.seconds)
    if job.printer.firmware != "reprap":
        assert says["filament used [mm]"] == pytest.approx(needs.filament_mm, abs=0.01)
    assert says["filament used [cm3]"] == pytest.approx(needs.filament_cm3, abs=0.01)
    assert says["filament used [g]"] == pytest.approx(needs.filament_g, abs=0.01)
    assert says["filament_type"] == "PLA"
    assert says["temperature"] == 205
    assert says["bed_temperature"] == 0
    assert says["nozzle_diameter"] == job.settings.nozzle
    assert says["layer_height"] == job.settings.layer
    assert says["max_layer_z"] == pytest.approx(job.path.layers[-1].z)
    assert says["fill_density"] == "100%"
    assert says["brim_width"] == round(job.settings.brim)
    assert says["layer_info_present"]
    assert says["normal_percent_present"]
    assert says["normal_left_present"]
    assert says["printer_model"] == job.printer.title.removeprefix("Original Prusa ")
    if job.printer.firmware == "prusa":
        assert says["printer_model"] == "MK4"
        qoi = ["16x16_QOI", "313x173_QOI", "440x240_QOI"]
        assert set(says["thumbnails"]) == {"32x32_PNG", "48x48_PNG", "300x300_PNG", *qoi}

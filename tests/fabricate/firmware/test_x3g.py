"""What GPX makes of a print for a Replicator 2X, where it is installed; the reader of its files."""

import shutil
import struct
import subprocess

import numpy as np
import pytest
from x3g import DEFINE, HOME_HIGH, HOME_LOW, MOVE, PLACE, RECALL, check_film, read_x3g

from requiring import required
from simulearn.fabricate import load_printer, prepare, write_gcode
from simulearn.grid import make

MOVED = struct.pack("<B5iIBfH", MOVE, 8889, -8889, 400, -963, 0, 2000, 24, 141.42, 1600)
HOMED = struct.pack("<BBIH", HOME_HIGH, 3, 382, 20) + struct.pack("<BBIH", HOME_LOW, 4, 136, 20)


def test_commands_are_distinguished():
    place = struct.pack("<B5iI", PLACE, 0, 0, 4000, 0, 0, 166)
    define = struct.pack("<B5i", DEFINE, 0, 0, 4000, 0, 0)
    heat = bytes([136, 0, 3, 2, 205, 0])
    named = bytes([153]) + struct.pack("<I", 0) + b"twist\0"
    film = read_x3g(HOMED + bytes([RECALL, 31]) + place + define + heat + named + MOVED)
    assert film.commands == [HOME_HIGH, HOME_LOW, RECALL, PLACE, DEFINE, 136, 153]
    assert film.axes == [("high", "XY"), ("low", "Z")]
    assert film.defined == [(0.0, 0.0, 10.0)]
    np.testing.assert_allclose(film.places, [(0, 0, 10), (100, -100, 1)], atol=0.01)
    assert film.fed == pytest.approx(10, abs=0.01)
    assert film.seconds == pytest.approx(141.42 / 25, rel=1e-6)


@pytest.mark.parametrize("data", [HOMED[:-1], b"\x01", MOVED + bytes([136, 0])])
def test_a_broken_file_is_refused(data):
    with pytest.raises((ValueError, IndexError)):
        read_x3g(data)


def test_gpx_takes_the_print_without_a_warning(tmp_path):
    gpx = shutil.which("gpx")
    required("gpx", gpx is not None)
    printer = load_printer("makerbot-2x")
    job = prepare([make("twist")], printer)
    source, target = tmp_path / "twist.gcode", tmp_path / "twist.x3g"
    write_gcode(job.gcode, source)
    done = subprocess.run(
        [gpx, "-r", "-m", "r2x", source, target], capture_output=True, text=True, check=True
    )
    assert done.stdout + done.stderr == ""
    check_film(read_x3g(target.read_bytes()), job)

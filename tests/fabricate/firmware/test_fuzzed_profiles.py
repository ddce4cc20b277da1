"""A profile is refused with one error that says where, or its file is no danger to the machine."""

import os

import pytest
from fuzzed_profiles import FIRMWARES, STARTS, profiles
from hypothesis import HealthCheck, given, settings
from pydantic import ValidationError
from virtual_limits import of_profile
from virtual_printer import simulate

from simulearn.errors import InputError
from simulearn.fabricate import Printer, prepare
from simulearn.grid import make

SMALL = make("twist", (1, 1), 30.0)
# More examples, other ones each time: SIMULEARN_FUZZ=5000 pytest tests/fabricate/firmware
EXAMPLES = int(os.environ.get("SIMULEARN_FUZZ", "0"))
# What is a warning rather than an error, and a word of its warning.
WARNED = {"oozes": "oozes"}


def result(data):
    """Return the trace of a profile's print, or the error by which it is refused."""
    try:
        printer = Printer.model_validate(data)
    except ValidationError as error:
        return error
    try:
        job = prepare([SMALL], printer)
        text = job.gcode
    except InputError as error:
        return error
    trace = simulate(text, of_profile(printer))
    again = simulate(text, of_profile(printer), trace.last)
    trace.dangers += [danger for danger in again.dangers if danger.what not in trace.kinds]
    warned = " ".join(warning.message for warning in job.warnings)
    trace.dangers = [d for d in trace.dangers if WARNED.get(d.what, "no warning") not in warned]
    return trace


@given(profiles())
@settings(
    max_examples=EXAMPLES or 300,
    deadline=None,
    derandomize=not EXAMPLES,
    suppress_health_check=[HealthCheck.too_slow],
)
def test_a_fuzzed_profile_is_refused_or_no_danger(data):
    found = result(data)
    if isinstance(found, ValidationError):
        assert all(error["loc"] for error in found.errors())
    elif isinstance(found, InputError):
        assert "fuzzed" in str(found) or "skirt" in str(found) or found.where, str(found)
        assert "\n" not in str(found)
    else:
        assert [str(danger) for danger in found.dangers] == []


@pytest.mark.parametrize("firmware", FIRMWARES)
def test_the_code_into_which_odd_lines_are_put_is_printed(firmware):
    for extrusion in ("absolute", "relative"):
        found = result(sound(firmware, extrusion))
        assert not isinstance(found, Exception), str(found)
        assert found.dangers == []
        assert len(found.beads) > 1000


def sound(firmware, extrusion):
    """Return a profile with nothing odd in it."""
    bed = {"width": 220.0, "depth": 220.0, "height": 250.0, "shape": "rectangle"}
    bed["origin"] = "centre" if firmware == "sailfish" else "corner"
    motion = {"speed": 6000.0, "speed_z": 600.0}
    motion |= {"acceleration": 500.0, "acceleration_travel": 500.0}
    return {
        "name": "sound",
        "title": "Sound",
        "firmware": firmware,
        "bed": bed,
        "extruder": {"extrusion": extrusion},
        "temperature": {"nozzle_most": 260.0},
        "motion": motion,
        "print": {"nozzle": 0.6, "layer": 0.5},
        "code": {"start": "\n".join(STARTS[firmware]), "end": "M84"},
    }

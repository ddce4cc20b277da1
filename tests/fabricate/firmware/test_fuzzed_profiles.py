"""A profile is refused with one error that says where, or its file is no danger to the machine."""

import os

from fuzzed_profiles import profiles
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
# What is told rather than refused, and a word of its warning.
WARNED = {"oozes": "oozes"}
counts = {"refused": 0, "printed": 0}


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


def check(data):
    found = result(data)
    if isinstance(found, Exception):
        counts["refused"] += 1
        assert "\n" not in str(found) or isinstance(found, ValidationError)
        assert str(found)
        return
    counts["printed"] += 1
    assert [str(danger) for danger in found.dangers] == []


@given(profiles())
@settings(
    max_examples=EXAMPLES or 300,
    deadline=None,
    derandomize=not EXAMPLES,
    suppress_health_check=[HealthCheck.too_slow],
)
def test_a_fuzzed_profile_is_refused_or_no_danger(data):
    check(data)

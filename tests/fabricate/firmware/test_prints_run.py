"""Whole prints of all printers, run on the machine that each is: no danger, true figures."""

import re
from dataclasses import replace
from functools import cache
from math import pi

import numpy as np
import pytest
from virtual_limits import of_profile
from virtual_printer import simulate

from simulearn.fabricate import load_printer, prepare, printers
from simulearn.grid import make

# What each machine runs, whatever its profile says.
FIRMWARE = {
    "bambu-x1": "bambu",
    "ender-3": "marlin",
    "makerbot-2x": "sailfish",
    "modix-big60": "reprap",
    "prusa-mk4": "prusa",
    "stacker-s4": "marlin",
    "voron": "klipper",
}
# Where the MK4's nozzle goes: X_MIN_POS to Z_MAX_POS in its firmware's Configuration_MK4.h.
MK4 = ((-1.0, 251.0), (-4.0, 211.0), (0.0, 221.0))
LONGEST = 280.0  # mm; longer beams do not carry their own weight in the bath
GRIDS = {
    "twist": lambda: [make("twist")],
    "cone": lambda: [make("cone")],
    "wave": lambda: [make("wave", (2, 3), 45.0)],
    "small": lambda: [make("twist", (1, 1), 30.0)],
    "two": lambda: [make("dome", (1, 1), 40.0), make("twist", (1, 1), 40.0)],
}


def limits_of(printer):
    limits = replace(of_profile(printer), firmware=FIRMWARE[printer.name])
    return replace(limits, reach=MK4) if printer.name == "prusa-mk4" else limits


@cache
def printed(name, which):
    printer = load_printer(name)
    grids = GRIDS[which]() if which in GRIDS else [large(printer)]
    return prepare(grids, printer)


def large(printer):
    """Return a flat grid of one cell that nearly fills the bed."""
    bed = printer.bed
    taken = [0.0, *(abs(corner[1] - bed.low[1]) for box in bed.excluded for corner in box)]
    side = min(bed.width, bed.depth - max(taken))
    side = side / np.sqrt(2) if bed.shape == "round" else side
    return make("flat", (1, 1), float(round(min(side - 25, LONGEST))))


@pytest.mark.parametrize("which", [*GRIDS, "large"])
@pytest.mark.parametrize("name", printers())
def test_no_printer_comes_to_harm(name, which):
    job = printed(name, which)
    trace = simulate(job.gcode, limits_of(job.printer))
    assert [str(danger) for danger in trace.dangers] == []

    # What the header says is what the machine does.
    said = dict(re.findall(r"^;(\w+(?: \w+)?):(\S+)$", job.gcode, re.MULTILINE))
    fed = trace.beads[:, 5].sum()
    assert fed == pytest.approx(job.estimate.filament_mm, rel=1e-6)
    stated = re.search(r"filament used \[mm\] = ([\d.]+)", job.gcode)
    assert stated is None or float(stated[1]) == pytest.approx(fed, abs=0.006)
    area = pi * job.settings.filament**2 / 4
    beads = [(layer, bead) for layer in job.path.layers for bead in layer.beads]
    volume = sum(float(b.lengths @ np.asarray(b.section)) * q.height for q, b in beads)
    assert fed * area == pytest.approx(volume, rel=1e-4)
    along = np.concatenate([trace.beads[:, [0, 1]], trace.beads[:, [2, 3]]])
    for axis, letter in enumerate("XY"):
        low, high = float(said[f"MIN{letter}"]), float(said[f"MAX{letter}"])
        assert along[:, axis].min() == pytest.approx(low, abs=job.settings.line)
        assert along[:, axis].max() == pytest.approx(high, abs=job.settings.line)
    assert len(np.unique(trace.beads[:, 4])) == int(said["LAYER_COUNT"])
    assert trace.progress == sorted(trace.progress)

    # The state in which the first bead is laid.
    first = trace.first
    assert first["flow"] in (100, "hidden")
    assert first["coldest"] == job.settings.temperature
    assert first["bed"] in (job.settings.bed, "hidden")
    assert trace.hidden == 0


@pytest.mark.parametrize("name", printers())
def test_the_next_print_begins_as_this_one_ends(name):
    job = printed(name, "small")
    limits = limits_of(job.printer)
    first = simulate(job.gcode, limits)
    assert [str(danger) for danger in simulate(job.gcode, limits, first.last).dangers] == []


MISSING = {
    "G28": {"not-homed", "origin"},
    "M109 S205": {"cold"},
    "M104 S0": {"heaters-on"},
    "M22[01] S100": {"factors"},
    r"G0 Z(5|10)\b": {"heats-on-bed", "low-travel", "origin"},
    "M132": {"not-homed", "origin"},
    "G29 A": {"not-levelled"},
}


ALWAYS = {"G28", "M109 S205", "M104 S0", "M22[01] S100"}
# What a firmware makes good: GPX begins each file with factors of 100; a Prusa and a Bambu end
# their levelling above the bed; a Bambu levels after G29.2 S1.
BETTER = {"M22[01] S100": ["sailfish"], r"G0 Z(5|10)\b": ["prusa", "bambu"]}
BETTER |= {"G29 A": ["bambu"]}


@pytest.mark.parametrize("name", printers())
def test_a_file_that_lacks_what_matters_is_a_danger(name):
    job = printed(name, "small")
    text = job.gcode
    # What macros do is not in the file: here they are written out.
    text = re.sub(r"^PRINT_START.*$", "G28\nG0 Z10 F600", text, flags=re.MULTILINE)
    text = re.sub(r"^PRINT_END.*$", "M84", text, flags=re.MULTILINE)
    limits, lines = limits_of(job.printer), text.split("\n")
    assert simulate(text, limits).dangers == []
    begin = next(k for k, line in enumerate(lines) if line.startswith(";LAYER:0"))
    for pattern, kinds in MISSING.items():
        if FIRMWARE[name] in BETTER.get(pattern, ()):
            continue
        kept = [
            line
            for k, line in enumerate(lines)
            if not (re.match(pattern, line) and (k < begin or "S0" in pattern))
        ]
        if pattern in ALWAYS or len(kept) < len(lines):
            found = simulate("\n".join(kept), limits)
            assert found.kinds & kinds, (pattern, found.kinds)


def test_other_modes_than_the_files_are_a_danger():
    for name, mode in (("ender-3", "M83"), ("voron", "M82"), ("modix-big60", "G91")):
        job = printed(name, "small")
        text = re.sub(r"^;LAYER:0$", f"{mode}\n;LAYER:0", job.gcode, count=1, flags=re.MULTILINE)
        found = simulate(text, limits_of(job.printer))
        assert found.kinds & {"e-jump", "unload", "reach", "relative"}, (name, found.kinds)

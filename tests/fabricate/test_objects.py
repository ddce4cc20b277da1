"""Several grids on a bed: one can be left out while the others are printed, by each firmware."""

import json
import re

import pytest
from several import FIRMWARE, job_of

from simulearn.fabricate import load_printer, prepare
from simulearn.fabricate.markers import object_names
from simulearn.grid import make

SKIPPING = [name for name, kind in FIRMWARE.items() if kind not in ("bambu", "sailfish")]


def test_names_are_plain_and_no_two_alike():
    names = ["dome", "Dome", "two words; M112", "ä/ö", "ä.ö", "", "x" * 99, 'a"b']
    safe = object_names(names)
    assert all(re.fullmatch(r"[A-Za-z0-9_]{1,70}", name) for name in safe)
    assert len({name.upper() for name in safe}) == len(names)
    assert safe[0] == "dome"


def run(text, left_out, counts):
    """Return what is extruded by object, mm, if one is left out.

    Args:
        text: of the file.
        left_out: the object, or None.
        counts: whether the firmware counts absolute E while it leaves an object out.
    """
    now, e, absolute, drawn, fed = -1, 0.0, True, 0.0, {}
    names = re.findall(r"^EXCLUDE_OBJECT_DEFINE NAME=(\S+)", text, re.M)
    for line in text.splitlines():
        code = line.partition(";")[0].strip()
        if code in ("M82", "M83"):
            absolute = code == "M82"
        elif code == "G92 E0":
            e = 0.0
        elif found := re.fullmatch(r'M486 S(-?\d+)(?: A".+")?', code):
            now = int(found[1])
        elif found := re.fullmatch(r"EXCLUDE_OBJECT_(START|END) NAME=(\S+)", code):
            number = names.index(found[2])
            assert now == (-1 if found[1] == "START" else number)
            now = number if found[1] == "START" else -1
        elif found := re.match(r"G1.*E(-?[\d.]+)", code):
            value = float(found[1])
            step = value - e if absolute else value
            skipped = now == left_out and now >= 0
            if absolute and (counts or not skipped):
                e = value
            if not skipped:
                drawn = min(drawn + step, 0.0) if step < 0 or drawn < 0 else 0.0
                assert drawn > -8.0  # never drawn back twice
                fed[now] = fed.get(now, 0.0) + step
    return fed


@pytest.mark.parametrize("counts", [True, False])
@pytest.mark.parametrize("name", SKIPPING)
def test_what_is_left_is_printed_as_if_nothing_had_been_left_out(name, counts):
    job = job_of(name, "two")
    whole = run(job.gcode, None, counts)
    assert set(whole) == {-1, 0, 1}
    for k in (0, 1):
        beads = [(q.height, b) for q in job.path.layers for b in q.beads if b.grid == k]
        volume = sum(height * float(b.lengths @ b.section) for height, b in beads)
        assert whole[k] == pytest.approx(volume / job.settings.filament_area, rel=0.01)
    for k in (0, 1):
        rest = run(job.gcode, k, counts)
        assert k not in rest
        assert rest == pytest.approx({key: fed for key, fed in whole.items() if key != k}, abs=0.01)


def test_klipper_knows_where_objects_lie():
    job = job_of("voron", "two")
    found = re.findall(
        r"^EXCLUDE_OBJECT_DEFINE NAME=(\w+) CENTER=(\S+),(\S+) POLYGON=(\S+)$", job.gcode, re.M
    )
    assert [name for name, *_ in found] == ["a_dome_1", "A_dome_1_2"]
    for (_, x, y, polygon), grid in zip(found, job.grids, strict=True):
        middle = (grid.joints.min(axis=0) + grid.joints.max(axis=0)) / 2
        assert [float(x), float(y)] == pytest.approx(middle.tolist(), abs=0.01)
        places = json.loads(polygon)
        assert len(places) >= 4
        assert all(abs(u - float(x)) < 20 and abs(v - float(y)) < 20 for u, v in places)
    assert job.gcode.index("EXCLUDE_OBJECT_DEFINE") < job.gcode.index("PRINT_START")


def test_names_stand_where_a_firmware_looks_for_them():
    assert (
        "\nM486 S0\nM486 Aa_dome_1\nM486 S1\nM486 AA_dome_1_2\nM486 S-1\n"
        in job_of("prusa-mk4", "two").gcode
    )
    assert (
        '\nM486 S0 A"a_dome_1"\nM486 S1 A"A_dome_1_2"\nM486 S-1\n'
        in job_of("modix-big60", "two").gcode
    )
    marlin = job_of("ender-3", "two").gcode
    assert "\nM486 T2\nM486 S-1\n" in marlin
    assert not re.search(r"^M486.*[AC]", marlin, re.M)  # C would cancel what is printed


@pytest.mark.parametrize("name", FIRMWARE)
def test_one_grid_is_no_object(name):
    text = job_of(name, "cone").gcode
    assert "M486" not in text
    assert "EXCLUDE_OBJECT" not in text


def test_the_same_grids_give_the_same_bytes():
    grids = [make("dome", (1, 1), 30.0)] * 2
    for name in ("voron", "prusa-mk4", "bambu-x1"):
        texts = {prepare(grids, load_printer(name), ["a", "b"]).gcode for _ in range(2)}
        assert len(texts) == 1

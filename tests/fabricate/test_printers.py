"""Printer profiles: those that come along, one's own, what is refused, and fuzzed ones."""

import math
import re
import tomllib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError
from reading import read

from simulearn.errors import InputError
from simulearn.fabricate import Printer, load_printer, prepare, printers, profile_text
from simulearn.grid import Grid, make

SMALL = make("twist", (1, 1), 30.0)
DECK = {
    "stacker-s4": ((510, 360), "absolute"),
    "makerbot-2x": ((246, 152), "relative"),
    "modix-big60": ((610, 610), "absolute"),
}


def profile(tmp_path, text):
    path = tmp_path / "mine.toml"
    path.write_text(text)
    return path


def changed(name, **tables):
    """Return a printer with some of its tables changed."""
    data = tomllib.loads(profile_text(name))
    for table, values in tables.items():
        data[table] = data.get(table, {}) | values
    return Printer.model_validate(data)


def test_the_printers_that_were_promised():
    promised = {"stacker-s4", "makerbot-2x", "modix-big60", "prusa-mk4", "ender-3"}
    assert set(printers()) == promised | {"bambu-x1", "voron"}
    for name, (bed, extrusion) in DECK.items():
        printer = load_printer(name)
        assert (printer.bed.width, printer.bed.depth) == bed
        assert printer.extruder.extrusion == extrusion
        assert printer.print["nozzle"] == 0.6


@pytest.mark.parametrize("name", printers())
def test_every_printer_prints(name):
    job = prepare([SMALL], load_printer(name))
    file = read(job.gcode)
    assert file.prints.any()
    # Those of the deck have its nozzle; the others say that theirs is another.
    overridden = [w.where for w in job.warnings if w.code == "override"]
    assert overridden == ([] if name in DECK else ["print.nozzle"])


def test_a_profile_may_begin_from_another(tmp_path):
    text = 'base = "ender-3"\ntitle = "Mine"\n[print]\nnozzle = 0.6\n[bed]\nwidth = 300.0\n'
    printer = load_printer(profile(tmp_path, text))
    assert (printer.title, printer.bed.width, printer.bed.depth) == ("Mine", 300.0, 220.0)
    assert printer.print == {"nozzle": 0.6, "retraction": 5.0, "retraction_speed": 2700.0}
    assert [w.code for w in prepare([SMALL], printer).warnings] == ["untried", "short-strokes"]


def test_a_profile_may_begin_from_a_file_beside_it(tmp_path):
    (tmp_path / "shop.toml").write_text('base = "voron"\n[bed]\nwidth = 350.0\n')
    assert load_printer(profile(tmp_path, 'base = "shop.toml"\n')).bed.width == 350.0


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('base = "enders-3"', 'printer "enders-3" is not known'),
        ('base = "mine.toml"', "begin from one another"),
        ("base = 3", "base: is not the name of a printer"),
        ("name = ", "is not valid TOML"),
        ('name = "a"', "title: is missing"),
        ('base = "voron"\ncolour = "red"', "colour: is not a key of a printer profile"),
        ('base = "voron"\n[bed]\nwidth = nan', "bed.width: is nan"),
        ('base = "voron"\n[bed]\nwidth = -3', "bed.width: is -3; input should be greater than 0"),
        ('base = "voron"\n[bed]\norigin = "left"', "bed.origin: is 'left'"),
        ('base = "voron"\n[print]\nspeed = 3', "print: speed is not a print setting"),
        ('base = "voron"\n[print]\nlayer = inf', "print: layer: "),
        ('base = "voron"\n[print]\nfan = "yes"', "print: fan: "),
        ('base = "voron"\n[extruder]\nfilament = 1.0', "extruder.filament: is 1.0"),
        ('base = "voron"\nbed = 3', "bed: is 3"),
        ('base = "voron"\n[reach]\nx = [9.0, 0.0]', "reach.x: goes from 9 to 0; the smaller"),
        ('base = "voron"\n[bed]\nwidth = "300"', "bed.width: is '300'"),
        ('base = "voron"\n[print]\nfan = 0', "print: fan: "),
        ('base = "voron"\n[print]\nnozzle = true', "print: nozzle: "),
        ('base = "voron"\n[print]\nlayer = ' + "9" * 400, "print: layer: "),
    ],
)
def test_a_wrong_profile_is_refused_by_key(tmp_path, text, words):
    with pytest.raises(InputError) as refused:
        load_printer(profile(tmp_path, text))
    assert words in str(refused.value)
    assert "mine.toml" in str(refused.value) or 'printer "' in str(refused.value)


def test_an_override_of_what_the_curl_depends_on_has_a_warning():
    overrides = {"nozzle": 0.6, "bed": 55.0, "speed_fill": 1800.0, "fan": False}
    printer = changed("prusa-mk4", print=overrides)
    job = prepare([SMALL], printer)
    overridden = {w.where for w in job.warnings if w.code == "override"}
    assert overridden == {"print.bed", "print.speed_fill", "print.fan"}
    assert "bed 55 C instead of 0; the curl was measured with the latter" in job.gcode
    file = read(job.gcode)
    assert (file.s[file.command == "M190"] == 55).all()
    assert not (file.command == "M106").any()
    harmless = {"nozzle": 0.6, "speed_travel": 9000.0, "retraction": 0.0, "skirt_distance": 6.0}
    job = prepare([SMALL], changed("prusa-mk4", print=harmless))
    assert [w.code for w in job.warnings] == ["untried"]
    assert (read(job.gcode).fed >= 0).all()


def test_a_slow_machine_has_a_warning():
    slow = changed("modix-big60", motion={"speed": 1200.0})
    messages = [w.message for w in prepare([SMALL], slow).warnings]
    assert any("moves at most 1200 mm/min" in line for line in messages)


@pytest.mark.parametrize(
    ("tables", "words"),
    [
        ({"print": {"temperature": 300.0}}, "prints at 170 to 290 C"),
        ({"temperature": {"nozzle_most": 200.0}}, "the material's temperature is 205 C"),
        ({"print": {"temperature": 150.0}}, "print.temperature is 150 C"),
        ({"print": {"bed": 130.0}}, "reaches at most 120 C"),
        ({"print": {"nozzle": 0.8}}, "wider than a shell row of 0.6 mm"),
        ({"print": {"nozzle": 0.25}}, "too narrow for a line of 0.6 mm"),
        ({"print": {"layer": 0.3}}, "do not fill half a beam of 2 mm; 0.2857 mm would"),
        ({"print": {"layer": 0.5, "nozzle": 0.4}}, "is thicker than the nozzle"),
        ({"print": {"line_width": 2.5, "nozzle": 1.5}}, "needs 4 rows or more"),
        ({"print": {"flow_active": 30.0}}, "flow_active is 30; it lies between 0.2 and 3"),
        ({"bed": {"height": 3.0}}, "the print is 4 mm high"),
        ({"bed": {"width": 30.0}}, "larger than what the bed of prusa-mk4 takes"),
    ],
)
def test_what_a_printer_cannot_do_is_refused(tables, words):
    with pytest.raises(InputError, match=words):
        prepare([SMALL], changed("prusa-mk4", **tables))


def test_an_unknown_material_is_refused():
    grid = Grid(SMALL.joints, SMALL.beams, SMALL.actuators, 0, "wood")
    with pytest.raises(InputError, match='material "wood" is not known'):
        prepare([grid], load_printer("voron"))


def test_a_grid_that_is_not_valid_is_refused():
    grid = Grid(SMALL.joints, SMALL.beams, SMALL.actuators * 0 + 0.2, 0)
    with pytest.raises(InputError, match=r"the actuator of beam 0 is .* \(and 3 more"):
        prepare([grid], load_printer("voron"))


@pytest.mark.parametrize(
    ("code", "words"),
    [
        ("G0 X300", "leads to X 300 mm; prusa-mk4 reaches -1 to 251"),
        ("G28\nG1 Y-5", "line 2: leads to Y -5 mm"),
        ("g1 z-0.1", "leads to Z -0.1 mm"),
        ("G01 X{bed_max_x} Y999", "leads to Y 999"),
        ("G91\nG0 X5", "relative to a place that is not known"),
        ("G28\nG0 X10 Y10 Z5\nG91\nG0 X5\nG0 X240", "line 5: leads to X 255 mm"),
        ("G91\nG0 Z-5", "relative to a place that is not known"),
        ("G0 Xnan", "is not a number"),
        ("G0 X1e99", "put a space before E"),
        ("G0 X9999999", "not a number a printer can use"),
        ("G2 X10 Y30 I5 J5", "an arc"),
        ("M104 S{hot}", "{hot} is not known; words are temperature"),
        ("G92 X0", "moves the origin"),
        ("G92X0", "moves the origin"),
        ("G92.1", "moves the origin"),
        ("G10 L2 P1 X5", "G10 L2 moves the origin"),
        ("G10 P0 Z-1", "G10 Z-1 moves the origin"),
        ("G54", "moves the origin"),
        ("G59.1", "moves the origin"),
        ("M851 Z-2", "moves the probe"),
        ("SET_GCODE_OFFSET Z=-1", "moves the origin"),
        ("set_gcode_offset Z=-1", "moves the origin"),
        ("G91\nG90\nG91\nG0 Y1", "relative to a place that is not known"),
        ("G20", "inches"),
        ("G020", "inches"),
        ("N10 G1 X999", "leads to X 999"),
        ("G53 G1 X999", "G53 and G1 stand on one line, of which Prusa's firmware does only the"),
        ("G1X999Y5", "leads to X 999"),
        ("M206 X50", "moves the origin"),
        ("G1 X{1+5}", "{1+5} is a slicer's expression"),
        ("M117 grüß", "line 1, column 8: ü is nothing that printers read; use plain ASCII"),
    ],
)
def test_code_that_leaves_the_bed_is_refused(code, words):
    job = prepare([SMALL], changed("prusa-mk4", code={"start": code}))
    with pytest.raises(InputError) as refused:
        job.gcode  # noqa: B018
    assert words in str(refused.value)
    assert "code.start" in str(refused.value)


def test_units_modes_and_factors_stand_before_the_start_code_and_after_it():
    job = prepare([SMALL], changed("prusa-mk4", code={"start": "G28\nG91\nG0 Z3"}))
    lines = job.gcode.splitlines()
    start, first = lines.index("G28"), lines.index(";LAYER:0")
    modes = ["G21", "G90", "M83", "M220 S100", "M221 S100", "G92 E0"]
    assert [line for line in lines[:start] if not line.startswith(";")] == modes
    assert lines[start + 3 : first][1:7] == modes
    # A machine that comes in relative mode is thus where the check takes it to be.
    assert "G91" not in lines[start + 3 :]


@pytest.mark.parametrize(("axis", "high"), [("X", 251.0), ("Y", 211.0), ("Z", 220.0)])
def test_the_end_code_begins_where_the_nozzle_is(axis, high):
    k = "XYZ".index(axis)
    last = prepare([SMALL], changed("prusa-mk4")).moves.places[-1, k]

    def file(step):
        end = f"G91\nG0 {axis}{step:.3f}"
        return prepare([SMALL], changed("prusa-mk4", code={"end": end})).gcode

    assert f"G0 {axis}{high - last:.3f}" in file(high - last)
    with pytest.raises(InputError, match=f"code.end, line 2: leads to {axis} {high:g}.01 mm"):
        file(high - last + 0.01)


def test_words_in_braces_are_filled_in():
    start = (
        "A S{temperature} B{bed} N{nozzle} F{filament} L{layer}\nBOX {min_x} {max_x}\nG91\nG0 Z3"
    )
    end = "G0 Z{top} X{bed_max_x}\nG91\nG0 Z10\nG90\nPARK"
    printer = changed("voron", code={"start": start, "end": end}, print={"nozzle": 0.6})
    job = prepare([SMALL], printer)
    text = job.gcode
    assert "A S205 B0 N0.6 F1.75 L0.25" in text
    low, high = job.path.bounds
    assert f"BOX {low[0]:g} {high[0]:g}" in text
    assert "G0 Z14 X250" in text
    # Absolute again whatever the profile's code left, and heaters off whatever its end does.
    assert text.index("G0 Z3") < text.index("\nG90", text.index("G0 Z3")) < text.index(";LAYER:0")
    assert text.rindex("M104 S0") < text.rindex("PARK")


numbers = st.floats(allow_nan=True, allow_infinity=True) | st.sampled_from([0.0, -1.0, 1e300, 1e-9])
lengths = st.floats(20.0, 400.0) | numbers
codes = st.lists(
    st.sampled_from(
        ["G28", "G0 X10 Y10", "G1 Z5 F300", "G91", "G90", "G0 X-5", "G0 X{bed_max_x}", "PRINT", ""]
    ),
    max_size=4,
).map("\n".join)
tables = st.fixed_dictionaries(
    {
        "bed": st.fixed_dictionaries(
            {
                "width": lengths,
                "depth": lengths,
                "height": lengths,
                "origin": st.sampled_from(["corner", "centre"]),
            }
        ),
        "extruder": st.fixed_dictionaries(
            {
                "filament": st.sampled_from([1.75, 2.85]) | numbers,
                "extrusion": st.sampled_from(["absolute", "relative"]),
                "lift": st.floats(0.0, 30.0) | numbers,
            }
        ),
        "motion": st.fixed_dictionaries(
            {
                "speed": st.floats(10.0, 30000.0) | numbers,
                "speed_z": st.floats(10.0, 3000.0) | numbers,
                "acceleration": st.floats(1.0, 20000.0) | numbers,
                "acceleration_travel": st.floats(1.0, 20000.0) | numbers,
            }
        ),
        "print": st.dictionaries(
            st.sampled_from(
                [
                    "layer",
                    "line_width",
                    "nozzle",
                    "temperature",
                    "speed_fill",
                    "flow_joint",
                    "shell_overlap",
                    "infill",
                    "skirt_distance",
                    "retraction",
                    "retraction_speed",
                ]
            ),
            st.floats(0.1, 2.0) | numbers,
            max_size=2,
        ),
        "code": st.fixed_dictionaries({"start": codes, "end": codes}),
    }
)
usual = {"name": "fuzzed", "title": "Fuzzed", "temperature": {"nozzle_most": 260.0}}


def printed(data):
    """Return the file of a fuzzed profile, or None where it is refused."""
    try:
        printer = Printer.model_validate(usual | data)
        job = prepare([SMALL], printer)
        return printer, job.gcode, job.estimate
    except (InputError, ValidationError):
        return None


def check_fuzzed(data):
    if (answer := printed(data)) is None:
        return False
    printer, text, needs = answer
    numbers = re.sub(r"^; \S+$", "", text, flags=re.MULTILINE).lower()  # without pictures
    assert "nan" not in numbers.replace("nano", "")
    assert "inf" not in numbers.replace("infill", "")
    file = read(text)
    move = np.isin(file.command, ["G0", "G1"])
    body = np.arange(len(move)) > np.nonzero(file.command == "M109")[0][-1]
    low, high = np.array([*printer.bed.low, 0.0]), np.array([*printer.bed.high, printer.bed.height])
    inside = file.places[move & body]
    inside = inside[~np.isnan(inside).any(axis=1)]
    assert len(inside) > 100
    assert (inside >= low - 1e-6).all()
    assert (inside <= high + 1e-6).all()
    assert (file.speed[file.prints] > 0).all()
    assert all(math.isfinite(x) and x > 0 for x in (needs.seconds, needs.filament_mm))
    return True


@given(tables)
@settings(max_examples=60, deadline=None)
def test_fuzzed_profiles_give_a_sound_file_or_none(data):
    check_fuzzed(data)


sound = st.fixed_dictionaries(
    {
        "bed": st.fixed_dictionaries(
            {
                "width": st.floats(45.0, 400.0),
                "depth": st.floats(45.0, 400.0),
                "height": st.floats(4.0, 300.0),
                "origin": st.sampled_from(["corner", "centre"]),
            }
        ),
        "extruder": st.fixed_dictionaries(
            {
                "filament": st.sampled_from([1.75, 2.85]),
                "extrusion": st.sampled_from(["absolute", "relative"]),
                "lift": st.floats(0.1, 20.0),
            }
        ),
        "motion": st.fixed_dictionaries(
            {
                "speed": st.floats(10.0, 30000.0),
                "speed_z": st.floats(10.0, 3000.0),
                "acceleration": st.floats(1.0, 20000.0),
                "acceleration_travel": st.floats(1.0, 20000.0),
            }
        ),
        "print": st.fixed_dictionaries(
            {
                "nozzle": st.floats(0.3, 0.6),
                "layer": st.sampled_from([0.2, 0.25]),
                "skirt_distance": st.floats(0.0, 50.0),
                "infill": st.floats(0.3, 1.0),
                "retraction": st.floats(0.0, 8.0),
            }
        ),
        "code": st.just({"start": "G28", "end": ""}),
    }
)


@given(sound)
@settings(max_examples=25, deadline=None)
def test_fuzzed_profiles_that_are_sound_always_give_a_file(data):
    assert check_fuzzed(data)

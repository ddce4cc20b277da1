"""Start and end code, followed as state in the dialect of each firmware."""

import tomllib

import pytest

from simulearn.errors import InputError
from simulearn.fabricate import Printer, load_printer, prepare, printers, profile_text
from simulearn.grid import make

SMALL = make("twist", (1, 1), 30.0)
READY = "G28\nM109 S{temperature}\n"  # a lift is written between them


def changed(name, **tables):
    """Return a printer with some of its tables or keys changed."""
    data = tomllib.loads(profile_text(name))
    for key, value in tables.items():
        data[key] = data.get(key, {}) | value if isinstance(value, dict) else value
    return Printer.model_validate(data)


def job_of(name, start=None, end=None, **tables):
    code = {key: text for key, text in (("start", start), ("end", end)) if text is not None}
    return prepare([SMALL], changed(name, code=code, **tables))


def lines_of(job):
    """Return the lines of a file from the first command on."""
    lines = job.gcode.splitlines()
    return lines[lines.index("G21") :]


def refusal(name, start=None, end=None, **tables):
    with pytest.raises(InputError) as refused:
        job_of(name, start, end, **tables).gcode  # noqa: B018
    return str(refused.value)


def codes(job):
    return {(w.code, w.where.partition(": ")[2]) for w in job.warnings if "code." in w.where}


# Placeholders


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("M140 S[first_layer_bed_temperature]", "placeholder; write {bed}"),
        ("M104 S{first_layer_temperature[0]}", "placeholder; write {temperature}"),
        ("M104 S[nozzle_temperature_initial_layer]", "placeholder; write {temperature}"),
        ("M104 S{material_print_temperature, 0}", "placeholder; write {temperature}"),
        ("G0 X{first_layer_print_min[0]}", "placeholder; write {min_x}"),
        ("G0 Y[first_layer_print_max[1]]", "placeholder; write {max_y}"),
        ("M190 S[bed0_temperature]", "placeholder; write {bed}"),
        ("T[initial_tool]", "[initial_tool] is not known; words are temperature"),
        ("T{initial_tool[0]}", "for which there is no word here; words are temperature"),
        ("G0 Z{max_layer_z + 2}", "a number, or {top} for max_layer_z"),
        ("{if layer_z > 3}", "a number, or {top} for layer_z"),
        ("{endif}", "{endif} is not known"),
    ],
)
def test_placeholders_of_slicers_are_refused_with_our_word(line, words):
    message = refusal("ender-3", f"G28\n{line}\nG0 Z5 F300")
    assert message.startswith("ender-3: code.start, line 2: ")
    assert words in message


def test_brackets_in_comments_are_no_placeholders():
    start = READY + "G0 Z5 F300 ; [first_layer_temperature] {hot} {temperature} [x]"
    assert "; [first_layer_temperature] {hot} 205 [x]" in job_of("ender-3", start).gcode


def test_comments_are_made_plain_and_code_is_refused():
    text = job_of("ender-3", READY + "G0 Z5 ; 205 \N{DEGREE SIGN}C für Düse\tzwei").gcode
    assert "G0 Z5 ; 205 C fur Duse zwei\n" in text
    message = refusal("ender-3", "G28\nG0 Z\N{EN DASH}5")
    assert "line 2, column 5: \N{EN DASH} is nothing" in message


# Homing, place and modes


def test_code_that_does_not_home_is_refused():
    assert "does not home X; write G28" in refusal("ender-3", "M104 S{temperature}")
    assert "does not home Y; write G28" in refusal("ender-3", "G28 X Z\nG0 Z5")
    assert "X moves before the machine knows where it is" in refusal("ender-3", "G0 X5\nG28")
    assert "does not home Z" in refusal("ender-3", "G28\nG0 Z5\nM84 Z")
    assert "moves before" in refusal("ender-3", end="M84\nG0 X5")
    assert job_of("ender-3", "G91\nG0 Z5\nG90\nG28\nG0 Z5").gcode  # up is safe from anywhere
    assert "Z moves before" in refusal("voron", "G91\nG0 Z5\nG90\nG28")  # not so for Klipper


def test_a_macro_leaves_nothing_known():
    assert "not known after a macro" in refusal("voron", "PRINT_START\nG0 X5")
    assert "relative to a place that is not known" in refusal("voron", "PRINT_START\nG91\nG0 X5")
    assert "not known after PRINT_START" in refusal("voron", "PRINT_START\nG90\nG1 E5")
    start = "PRINT_START\nG90\nM83\nG0 X5 Y5 Z5\nG10\nG11\nG92 E0\nG1 E2\nG91\nG0 X-5"
    assert "G0 X-5" in job_of("voron", start).gcode


def test_only_klipper_has_macros():
    message = refusal("prusa-mk4", "PRINT_START\nG28")
    assert "PRINT_START is no command of Prusa's firmware" in message
    assert 'firmware = "klipper"' in message
    assert "PRINT_START" in job_of("ender-3", "PRINT_START", firmware="klipper").gcode


@pytest.mark.parametrize(
    ("name", "firmware", "absolute", "fed"),
    [
        ("ender-3", "marlin", None, None),  # by version
        ("ender-3", "prusa", True, None),
        ("ender-3", "reprap", False, 3.0),
        ("ender-3", "klipper", False, 3.0),
    ],
)
def test_whether_g90_sets_e_depends_on_the_firmware(name, firmware, absolute, fed):
    """M83, then G90: relative in Klipper and RepRapFirmware, absolute in Marlin 2."""
    start = READY + "M83\nG92 E30\nG90\nG1 E3"
    if absolute is None:
        assert "not known after G90 or G91" in refusal(name, start, firmware=firmware)
    elif absolute:
        assert "draws back 32 mm" in refusal(name, start, firmware=firmware)
    else:
        text = job_of(name, start, firmware=firmware).gcode
        assert f"G1 E{5 - fed:g} F2700" in text  # what is still to be pushed back


def test_absolute_e_needs_a_beginning():
    assert "where E stands is not known; write G92 E0" in refusal(
        "makerbot-2x",
        "G28\nM132 X Y Z A B\nG0 X0 Y0 Z10\nM109 S{temperature}\nM82\nG1 E5",
    )


def test_one_command_a_line_in_capitals():
    assert "G90 and G0 stand on one line" in refusal("ender-3", "G28\nG90 G0 Z5")
    assert job_of("modix-big60", "G28\nG90 G0 Z5").gcode
    assert "write G28" in refusal("ender-3", "g28")
    assert job_of("voron", "g28\ng0 z5").gcode
    assert "reads 95" in refusal("ender-3", "G28\nM118 " + "x" * 95)


def test_the_end_code_keeps_off_the_print():
    assert "G28 leads down to the bed, on which the print stands; write G28 X Y" in refusal(
        "ender-3", end="G28"
    )
    assert "G28" in job_of("ender-3", end="G28 X Y").gcode
    delta = {"width": 220.0, "depth": 220.0, "origin": "centre", "shape": "round"}
    assert job_of("ender-3", end="G28", bed=delta).gcode  # homes upwards
    assert "G29 leads down to the bed" in refusal("ender-3", end="G29")
    assert "leads down to Z 1 mm where the print stands" in refusal("ender-3", end="G0 Z1")
    assert "which is 4 mm high" in refusal("ender-3", end="G91\nG0 Z-12")
    assert job_of("ender-3", end="G0 X0 Y0\nG0 Z1").gcode  # beside it
    assert "leads down" in refusal("ender-3", end="G0 X0 Y0\nG0 Z1\nG0 X220 Y220")


def test_what_is_probed_is_used():
    assert "write G29 A after both" in refusal("prusa-mk4", "G28\nG29 P1\nG0 Z5")
    assert "write M420 S1 after both" in refusal("ender-3", "G29\nG28\nG0 Z5")
    assert job_of("ender-3", "G29\nG28\nM420 S1\nG0 Z5").gcode
    assert job_of("ender-3", "G28\nG29\nG0 Z5").gcode


def test_heaters_are_off_at_the_end():
    lines = lines_of(job_of("ender-3", end="M104 S60\nM84"))
    assert lines[-2:] == ["M104 S0", "M140 S0"]
    assert lines_of(job_of("ender-3", end="M84"))[-1] == "M84"
    assert lines_of(job_of("ender-3", end="M109 R50\nM104 S0"))[-1] == "M104 S0"


def test_the_nozzle_does_not_rub_on_the_bed():
    assert "moves across the bed with the nozzle on it" in refusal("ender-3", "G28\nG0 X5\nG0 Z5")
    assert "line 3" in refusal("ender-3", "G28\nG0 Z0.1\nG0 Y5")
    assert job_of("ender-3", "G28\nG0 X5 Z5\nG0 Y5").gcode
    assert job_of("ender-3", "G28\nG91\nG0 Z5\nG90\nG0 Y5").gcode


# Filament


def test_e_in_the_end_code_is_relative_and_nothing_is_unloaded():
    text = job_of("ender-3", end="G1 E-2 F2700\nM84").gcode
    before = text[: text.index("G1 E-2 F2700")].splitlines()
    assert before[-3:] == ["G90", "M83", "G92 E0"]
    # What lies drawn back at the end is pushed back before the next print.
    assert "G1 E7 F2700" in text
    assert "draws back 23 mm of filament in all" in refusal("ender-3", end="G1 E-9\nG1 E-9")
    assert "does not push it back (G11)" in refusal("ender-3", end="G10")
    assert "does not push it back (G11)" in refusal("ender-3", READY + "G10")
    assert "unloads the filament" in refusal("prusa-mk4", end="M702")
    assert "unloads the filament" in refusal("bambu-x1", end="M620 S255")
    assert "unloads the filament" in refusal("bambu-x1", end="T255")


def test_what_the_start_code_pushes_is_not_pushed_again():
    assert "G1 E2 F2700" in job_of("ender-3", READY + "G92 E0\nG1 E3 F300").gcode
    lines = lines_of(job_of("prusa-mk4"))  # it purges
    assert not any(line.startswith("G1 E0.8") for line in lines[: lines.index(";LAYER:0")])
    lines = lines_of(job_of("voron"))  # nothing is known of its macro
    assert "G1 E0.75 F1800" in lines[: lines.index(";LAYER:0")]


def test_cold_filament_is_not_moved():
    assert "before the nozzle is hot" in refusal("ender-3", "G28\nM104 S{temperature}\nG1 E5")
    cools = READY + "M104 S0\nG28\nG1 E5"
    assert "before the nozzle is hot" in refusal("ender-3", cools)
    assert "M302 allows cold" in refusal("ender-3", "M302 P1\nG28")
    assert job_of("ender-3", "M302 S155\nG28\nM109 S160\nG1 E5").gcode
    assert "code.end, line 2" in refusal("ender-3", end="M109 R40\nG1 E-2")
    # A nozzle that has just printed is hot, though it is told to cool.
    assert job_of("ender-3", end="M104 S0\nG1 E-2").gcode


def test_too_much_filament_is_not_fed():
    assert "in one place" in refusal("ender-3", READY + "G1 E60")
    purge = READY + "G0 X0 Y0 Z0.2\nM83\nG1 X10 E7"
    assert "Klipper takes at most 2.66 mm" in refusal("voron", purge)
    assert job_of("prusa-mk4", purge).gcode


# Heat


def test_targets_beyond_the_limits_are_refused():
    assert "heats the nozzle to 300 C" in refusal("ender-3", "G28\nM104 S300")
    assert "heats the bed to 120 C" in refusal("ender-3", "G28\nM190 S120")
    assert "heats the nozzle to 300 C" in refusal("modix-big60", "G10 P0 S300\nG28")
    heater = "SET_HEATER_TEMPERATURE HEATER=extruder TARGET=400"
    assert "heats the nozzle to 400 C" in refusal("voron", f"G28\n{heater}")


def test_a_nozzle_that_heats_is_lifted_off_the_bed():
    # The start code leaves it on the bed: the lift comes after it, before the wait.
    lines = lines_of(job_of("ender-3", "G28"))
    lift = next(k for k, line in enumerate(lines) if line.startswith("G0 Z10 F300"))
    assert lines.index("G28") < lift < lines.index("M109 S205")
    # It waits itself: the lift comes before that, in the mode that holds there.
    for start in ("G28\nM109 S200\nG0 Z5", "G28\nM104 S200\nM190 S60\nG0 Z5"):
        lines = lines_of(job_of("ender-3", start, print={"bed": 60.0}))
        assert lines[lines.index("G28") + (1 if "M109" in start else 2)].startswith("G0 Z10 F300 ;")
    assert job_of("ender-3", "G28\nG91\nM109 S200").gcode.count("G0 Z10 F300 ;") == 1
    # It is off the bed: no lift of ours.
    assert "G0 Z10 F300" not in job_of("ender-3", "G28\nG0 Z5\nM109 S200").gcode
    # A low ceiling is kept.
    low = job_of("ender-3", "G28", bed={"height": 6.0})
    assert "G0 Z6 F300 ; off the bed" in low.gcode
    # GPX does not know where the axes are after homing.
    assert "write a move off the bed" in refusal("makerbot-2x", "G28\nM109 S205\nM132 X Y Z A B")


def test_heat_at_a_height_that_is_not_known_has_a_warning():
    assert ("oozes", "code.start, line 1") in codes(job_of("ender-3", "M109 S205\nG28"))
    assert ("oozes", "code.start, line 2") in codes(job_of("voron", "PRINT_START\nM109 S205"))
    assert not codes(job_of("ender-3", "M104 S205\nG28"))  # it does not wait


def test_a_nozzle_that_touches_the_bed_hot_has_a_warning():
    assert ("oozes", "code.start, line 2") in codes(job_of("prusa-mk4", "M104 S205\nG28\nG0 Z5"))
    assert not codes(job_of("prusa-mk4", "M104 S170\nG28\nG0 Z5"))
    assert ("oozes", "code.start, line 2") in codes(job_of("bambu-x1", "M104 S205\nG28"))


# Factors, limits, and what ends a print


def test_factors_have_a_warning_and_are_set_back():
    job = job_of("ender-3", "G28\nM221 S95\nM220 S80\nM220 S100\nG0 Z5")
    assert codes(job) == {("override", f"code.start, line {k}") for k in (2, 3)}
    lines = lines_of(job)
    first = lines.index("M221 S95")
    assert "M221 S100" in lines[:first]
    assert "M221 S100" in lines[first : lines.index(";LAYER:0")]
    assert "M220 S100" in lines[first + 3 : lines.index(";LAYER:0")]


def test_volumetric_e_may_be_switched_off():
    assert "M200 D0" in job_of("ender-3", "M200 D0\nG28").gcode
    assert "M200 changes how E is counted" in refusal("ender-3", "M200 D1.75\nG28")


@pytest.mark.parametrize("line", ["M112", "M81", "M502", "SAVE_CONFIG", "M23 other.gco", "M999"])
def test_what_stops_the_print_is_refused(line):
    assert "leave it out" in refusal("voron", f"G28\n{line}")


def test_each_firmware_gets_the_accelerations_in_its_own_words():
    limits = {
        "ender-3": ["M204 P500 R1000 T500", "M205 X8 Y8 J0.053"],
        "prusa-mk4": ["M201 X2000 Y2000 Z200 E1200", "M204 P1000 R1200 T2000", "M205 X8 Y8"],
        "modix-big60": ["M204 P1000 T1000", "M566 X480 Y480"],
        "bambu-x1": ["M201 X9000 Y9000 Z500 E5000", "M204 P1000 R5000 T9000", "M205 X8 Y8"],
        "voron": ["SET_VELOCITY_LIMIT ACCEL=1000 SQUARE_CORNER_VELOCITY=5 MINIMUM_CRUISE_RATIO=0"],
        "makerbot-2x": [],
        "stacker-s4": [],
    }
    assert set(limits) == set(printers())
    words = ("M201", "M204", "M205", "M566", "SET_VELOCITY_LIMIT")
    for name, expected in limits.items():
        lines = lines_of(job_of(name))
        # After the start code, which may have set others.
        start = load_printer(name).code.start.split()[0]
        begin = next(k for k, line in enumerate(lines) if line.startswith(start))
        assert [line for line in lines[begin:] if line.startswith(words)] == expected
        assert any("acceleration and corner speed" in line for line in lines)
    assert load_printer("voron").one_acceleration


# Profiles


@pytest.mark.parametrize("name", printers())
def test_profiles_name_their_sources_and_that_nobody_has_tried_them(name):
    printer, job = load_printer(name), job_of(name)
    assert printer.sources
    assert printer.bed.shape == "rectangle"
    assert [w.code for w in job.warnings].count("untried") == 1
    assert "; warning: nobody has run the profile" in job.gcode
    tried = job_of(name, tried="printed twice, 2026-03-01")
    assert "untried" not in [w.code for w in tried.warnings]


def test_a_replicator_learns_where_its_axes_are():
    lines = lines_of(job_of("makerbot-2x"))
    homed = lines.index("G28")
    assert not any(line.startswith("G92") for line in lines[:homed])
    assert lines[homed + 1].startswith("M132 X Y Z A B")
    assert lines[homed + 2].startswith("G0 X0 Y0 Z10")
    assert "where the axes are is not known to GPX" in refusal("makerbot-2x", "G28\nM132 X Y Z")
    assert "G92 sets all axes" in refusal("makerbot-2x", "G28\nG92 E0")


def test_the_maker_s_purge_beside_the_bed_is_allowed_by_the_reach():
    start = "M109 R170\nG28\nM109 S{temperature}\nG1 Z0.2 F720\nG1 Y-3 F1000\nM83\nG1 X60 E9\n"
    assert "G1 Y-3 F1000" in job_of("prusa-mk4", start).gcode
    assert "reaches 0 to 210" in refusal("prusa-mk4", start, reach={"y": [0.0, 210.0]})

"""Profiles as people bring them along: placeholders, purges, factors, round beds, retractions.

Each is run by the command, and each file that it writes on the machine of these tests.
"""

import json

import pytest
from virtual_limits import of_profile
from virtual_printer import simulate

import simulearn.cli.fabricate  # noqa: F401  (adds its commands)
from simulearn.fabricate import load_printer
from simulearn.grid import grid_to_dict, make

SOUND = "M104 S150\nG28\nG0 Z5 F300"


@pytest.fixture
def gcode(run, tmp_path):
    """Return a function that prints a grid with a profile: messages, trace of the file, file."""

    def gcode(profile, grid="flat", encoding="utf-8", newline=None):
        path, out = tmp_path / "mine.toml", tmp_path / "out.gcode"
        out.unlink(missing_ok=True)
        path.write_text(profile, encoding=encoding, newline=newline)
        design = tmp_path / "design.json"
        cell = make("flat", (1, 1), 30.0) if grid == "flat" else grid
        design.write_text(json.dumps(grid_to_dict(cell)))
        code, shown, wrong = run("gcode", design, "--printer", path, "-o", out)
        text = " ".join((shown + wrong).split())
        assert "Traceback" not in text
        if code:
            assert code == 1
            assert not out.exists()
            return text, None, ""
        file = out.read_text(encoding="ascii")
        return text, simulate(file, of_profile(load_printer(path))), file

    return gcode


def profile(start=SOUND, end="M84", base="ender-3", more=""):
    return (
        f'base = "{base}"\n{more}\n[print]\nnozzle = 0.6\n'
        f'[code]\nstart = """\n{start}\n"""\nend = """\n{end}\n"""\n'
    )


@pytest.mark.parametrize(
    ("line", "word", "ours"),
    [
        # PrusaSlicer and SuperSlicer, old and new
        ("M104 S[first_layer_temperature]", "[first_layer_temperature]", "{temperature}"),
        ("M140 S[first_layer_bed_temperature]", "[first_layer_bed_temperature]", "{bed}"),
        ("M104 S{first_layer_temperature[0]}", "first_layer_temperature[0]", "{temperature}"),
        ("M190 S{first_layer_bed_temperature[0]}", "first_layer_bed_temperature", "{bed}"),
        ("G0 X{first_layer_print_min[0]}", "first_layer_print_min[0]", "{min_x}"),
        ("G0 Y{first_layer_print_max[1]}", "first_layer_print_max[1]", "{max_y}"),
        # Orca and Bambu Studio
        ("M104 S[nozzle_temperature_initial_layer]", "initial_layer]", "{temperature}"),
        ("M109 S{nozzle_temperature_initial_layer[0]}", "initial_layer[0]", "{temperature}"),
        ("M190 S[bed_temperature_initial_layer_single]", "single]", "{bed}"),
        # Cura
        ("M104 S{material_print_temperature_layer_0}", "material_print", "{temperature}"),
        ("M190 S{material_bed_temperature_layer_0}", "material_bed", "{bed}"),
    ],
)
@pytest.mark.parametrize("base", ["ender-3", "voron"])
def test_a_slicers_placeholder_is_refused_with_our_word_for_it(gcode, line, word, ours, base):
    text, trace, _ = gcode(profile(f"{SOUND}\n{line}", base=base))
    assert trace is None
    assert "code.start, line 4" in text
    assert word in text
    assert ours in text


@pytest.mark.parametrize(
    "line",
    [
        "START_PRINT EXTRUDER_TEMP=[nozzle_temperature_initial_layer]",
        "START_PRINT T={first_layer_temperature[initial_extruder] + 5}",
        "START_PRINT SIZE={first_layer_print_min[0]}_{first_layer_print_max[1]}",
        "{if has_wipe_tower}G0 X5{endif}",
        "G0 X{print_bed_max[0] - 20}",
        "G0 Z{max_layer_z + 5}",
    ],
)
def test_a_slicers_expression_is_refused_in_any_macro(gcode, line):
    for base in ("voron", "ender-3"):
        text, trace, _ = gcode(profile(f"{SOUND}\n{line}", base=base))
        assert trace is None
        assert "code.start, line 4" in text


PURGE = """G28
G0 Z5 F300
M109 S{temperature}
M83
G92 E0
G0 X0 Y-3 F3000
G0 Z0.2 F300
G1 X60 E9 F1000
G1 X100 E12.5 F1000
G92 E0
G0 Z2 F300
"""


def test_a_purge_beside_the_bed_needs_a_profile_that_says_the_nozzle_gets_there(gcode):
    text, trace, _ = gcode(profile(PURGE))
    assert trace is None
    assert "code.start, line 6" in text
    assert "Y -3" in text
    _, trace, file = gcode(profile(PURGE, more="[reach]\ny = [-4.0, 220.0]"))
    assert "Y-3" in file
    assert trace.dangers == []
    # The reach is for the code: nothing is printed there.
    assert trace.beads[:, [1, 3]].min() >= 0
    text, trace, _ = gcode(profile(PURGE, more="[reach]\ny = [-2.0, 220.0]"))
    assert trace is None


@pytest.mark.parametrize(("line", "share"), [("M221 S95", 95), ("M220 S80", 80), ("M221 S0", 0)])
def test_a_factor_in_start_code_is_set_back_and_reported(gcode, line, share):
    for base in ("ender-3", "makerbot-2x"):
        start = SOUND
        if base == "makerbot-2x":
            start = "G28\nM132 X Y Z A B\nG0 X0 Y0 Z10 F900"
        text, trace, _ = gcode(profile(f"{start}\n{line}", base=base))
        if trace is None:
            assert share == 0  # no factor at all
            continue
        assert line.split()[0] in text
        assert str(share) in text
        assert trace.dangers == []
        assert trace.first["flow"] == trace.first["speed"] == 100


DELTA = """base = "voron"
name = "delta"
title = "Delta"
[bed]
width = {size}
depth = {size}
height = 300.0
origin = "centre"
{shape}
[print]
nozzle = 0.6
"""


def test_a_round_bed(gcode):
    wide = make("flat", (1, 1), 150.0)  # 157 mm: its corners lie 111 mm out
    for shape in ("", 'shape = "round"'):
        text, trace, _ = gcode(DELTA.format(size="200.0", shape=shape), wide)
        assert trace is None
        assert "round" in text or "circle" in text
    _, trace, _ = gcode(DELTA.format(size="300.0", shape='shape = "round"'), wide)
    assert trace.dangers == []
    places = trace.beads[:, [0, 1, 2, 3]].reshape(-1, 2)
    assert (places**2).sum(axis=1).max() <= 150**2
    # As a square bed it takes it.
    _, trace, _ = gcode(DELTA.format(size="200.0", shape='shape = "rectangle"'), wide)
    assert trace.dangers == []


@pytest.mark.parametrize(
    "end",
    ["G1 E-2 F2700", "G91\nG1 E-2 F2700\nG1 Z10 F300\nG90", "M83\nG1 E-2 F2700", "G92 E0\nG1 E-2"],
)
@pytest.mark.parametrize("base", ["ender-3", "modix-big60", "prusa-mk4", "voron"])
def test_a_retraction_in_end_code_is_two_millimetres_in_every_mode(gcode, end, base):
    start = "G28\nG0 Z5 F300" if base == "voron" else SOUND
    _, trace, _ = gcode(profile(start, f"{end}\nG90\nG0 X0 Y200 F3000\nM84", base=base))
    if trace is None:
        return
    assert trace.dangers == []
    printed = trace.beads[:, 5].sum()
    assert 0 < printed - trace.fed + PRIMED[base] < 10


# Filament that is drawn back after a print, and given again before the next one, mm.
PRIMED = {"ender-3": 5.0, "modix-big60": 1.0, "prusa-mk4": 0.8, "voron": 0.75}


def test_a_retraction_that_unloads_the_filament_is_refused(gcode):
    for end in (
        "G91\nG1 E-100",
        "M83\nG1 E-15\nG1 E-15",
        "G92 E0\nG1 E-40",
        "M82\nG92 E500\nG1 E0",
    ):
        text, trace, _ = gcode(profile(end=end))
        assert trace is None
        assert "code.end" in text
        assert "mm of filament" in text


def test_volumetric_extrusion_may_be_switched_off_but_not_on(gcode):
    for line in ("M200 D0", "M200 S0", "M200 S0 D1.75"):
        text, trace, _ = gcode(profile(f"{line}\n{SOUND}"))
        if trace is None:
            assert line != "M200 D0", text
            continue
        assert trace.dangers == []
    for line in ("M200 D1.75", "M200 S1 D1.75"):
        text, trace, _ = gcode(profile(f"{line}\n{SOUND}"))
        assert trace is None
        assert "code.start, line 1" in text


def test_other_letters_in_comments_are_made_plain(gcode):
    comment = profile(SOUND.replace("S150", "S150 ; Düse auf 205 °C, größer — 日本"))
    for encoding in ("utf-8", "utf-8-sig", "utf-16"):
        text, trace, file = gcode(comment, encoding=encoding)
        assert trace is not None, text
        assert file.isascii()
        assert trace.dangers == []
    _, trace, file = gcode(comment, newline="\r\n")
    assert "\r" not in file
    assert trace.dangers == []
    text, trace, _ = gcode(comment.replace("base =", 'title = "Drucker Küche"\nbase ='))
    assert trace.dangers == []
    assert "Küche" in text


@pytest.mark.parametrize("line", ["M117 Düse", "G0 X5\u00a0Y5", "G0 X5\u22125", "G0 Z５"])
def test_other_letters_in_code_are_refused_with_their_place(gcode, line):
    text, trace, _ = gcode(profile(f"{SOUND}\n{line}"))
    assert trace is None
    assert "code.start, line 4" in text


@pytest.mark.parametrize(
    ("base", "start", "words"),
    [
        ("voron", "G28\nG01 Z5", "write G1"),
        ("voron", "G028\nG0 Z5", "write G28"),
        ("ender-3", "G28\nG0 Z0.05 F300\nG0 X90 Y90", "on it"),
    ],
)
def test_what_a_firmware_passes_over_or_rubs_on_is_refused(gcode, base, start, words):
    text, trace, _ = gcode(profile(start, base=base))
    assert trace is None
    assert words in text


@pytest.mark.parametrize("pause", ["M0", "M1", "M25", "M226", "M116", "G4 S30"])
def test_a_hot_nozzle_is_lifted_before_any_pause(gcode, pause):
    _, trace, file = gcode(profile(f"M104 S{{temperature}}\nG28\n{pause}\nG0 Z5"))
    assert trace.dangers == []
    assert file.index("before the nozzle waits hot") < file.index(f"\n{pause}\n")


def test_filament_is_not_laid_across_the_print_by_end_code(gcode):
    text, trace, _ = gcode(profile(end="G1 X100 Y100 E50"))
    assert trace is None
    assert "code.end, line 1" in text


def test_motors_that_are_off_move_nothing_after_the_print(gcode):
    for end in ("M84\nG0 X0", "M84\nG91\nG0 Z1\nG90", "M18 Z\nG91\nG0 Z1"):
        text, trace, _ = gcode(profile(end=end))
        assert trace is None
        assert "code.end" in text
    _, trace, _ = gcode(profile(end="M84 E\nG91\nG0 Z1\nG90\nG0 X0 Y200\nM84"))
    assert trace.dangers == []

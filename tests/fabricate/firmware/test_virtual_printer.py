"""The machine of these tests notices what is wrong: one fault put into a good file at a time."""

import numpy as np
import pytest
from command_words import commands
from virtual_limits import Limits
from virtual_printer import simulate

START = {
    "marlin": "M104 S205\nG28\nM420 S1\nG0 Z5 F300",
    "prusa": "M104 S170\nM109 R170\nG28\nG29 P1\nG29 P3.2\nG29 A\nG0 Z5 F300",
    "klipper": "G28\nG0 Z5 F300",
    "reprap": "G28\nG29 S1\nG0 Z5 F300",
    "bambu": "M104 S140\nM109 S140\nG28\nG29.2 S1\nG0 Z5 F300",
    "sailfish": "G28\nM132 X Y Z A B\nG0 X0 Y0 Z10 F900",
}
HOT = "G21\nG90\nM82\nM220 S100\nM221 S100\nG92 E0\nM109 S205\nM107"
BODY = (
    ";LAYER:0\nG92 E0\nG0 Z5.25 F300\nG0 X20 Y20 F3000\nG0 Z0.25 F300\n"
    "G1 X60 E2.4 F1500\nG1 Y60 E4.8\nG1 E3.8 F1800\nG0 Z0.75 F300\nG0 X20 Y20 F3000\n"
    ";LAYER:1\nG92 E0\nG0 Z0.5 F300\nG1 E1 F1800\nG1 X60 E3.4 F1500\nG1 Y60 E5.8\nG1 E4.8\n"
    "G0 Z10.5 F300"
)
END = "M107\nM104 S0\nM140 S0"
PARK = "G0 X0 Y200 F3000\nM84"
FIRMWARES = sorted(START)


def limits(firmware, **others):
    reach = ((0.0, 220.0), (0.0, 220.0), (0.0, 250.0))
    return Limits(firmware, reach, ((0.0, 0.0), (220.0, 220.0)), **others)


def good(firmware):
    head = "G21\nG90\nM82"
    return "\n".join([head, START[firmware], HOT, BODY, END, PARK]) + "\n"


def kinds(firmware, text, **others):
    return simulate(text, limits(firmware, **others)).kinds


def after(text, line, more):
    """Return a file with more lines after the first one that is this line."""
    lines = text.split("\n")
    at = lines.index(line) + 1
    return "\n".join([*lines[:at], *more.split("\n"), *lines[at:]])


def without(text, *dropped):
    lines = text.split("\n")
    assert set(dropped) <= set(lines)
    return "\n".join(line for line in lines if line not in dropped)


@pytest.mark.parametrize("firmware", FIRMWARES)
def test_a_good_file_is_no_danger_and_its_figures_are_read(firmware):
    trace = simulate(good(firmware), limits(firmware))
    assert trace.dangers == []
    assert trace.hidden == 0
    # The second layer's restoration is no bead; each layer has two.
    np.testing.assert_allclose(trace.beads[:, 4], [0.25, 0.25, 0.5, 0.5])
    np.testing.assert_allclose(trace.beads[:, 5].sum(), 9.6)
    assert trace.fed == pytest.approx(9.6 - 1.0)
    assert trace.first["flow"] == trace.first["speed"] == 100
    assert trace.first["levelled"] is not False
    assert trace.last.back == pytest.approx(1.0)


FAULTS = [
    # what is put in after which line, and the danger
    ("reach", "G0 X20 Y20 F3000", "G0 X221"),
    ("reach", "G0 X20 Y20 F3000", "G0 Y-0.1"),
    ("reach", "G0 X20 Y20 F3000", "G0 Z251"),
    ("reach", "G0 X20 Y20 F3000", "G91\nG0 X-21\nG90"),
    ("reach", "G28", "G91\nG0 X-5\nG90"),
    ("reach", "G28", "G91\nG0 Z-1\nG90\nM82"),
    ("reach", PARK.split("\n")[0], "G0 X230"),
    ("low-travel", "G28", "G0 X50 Y50 F3000"),
    ("low-travel", "G28", "G0 Z0.1\nG0 X50 Y50\nG0 X90 Y50"),
    ("unload", "M109 S205", "G1 E-30 F1800\nG1 E0"),
    ("unload", "M84", "M702"),
    ("e-jump", "M109 S205", "G1 E60 F100\nG1 E0"),
    ("e-jump", "G0 X20 Y20 F3000", "G92 E500\nG1 X30 E500.6\nM83\nG1 X40 E501.2\nM82"),
    ("unload", "G0 X20 Y20 F3000", "G92 E500\nG1 X30 E500.6\nG1 X40 E0.6"),
    ("not-homed", "M109 S205", "M84"),
    ("not-homed", "M84", "G0 X10"),
    ("heaters-on", "M84", "M104 S200"),
    ("heaters-on", "M84", "M140 S60"),
    ("factors", "M109 S205", "M221 S95"),
    ("factors", "M109 S205", "M220 S80"),
    ("relative", "G0 Z0.25 F300", "G91"),
    ("drawn-back", "M109 S205", "G1 E-5 F1800\nG92 E0"),
    ("drawn-back", "M109 S205", "G10"),
    ("hits-print", "G0 Z10.5 F300", "G0 Z0.4"),
    ("hits-print", "G0 Z10.5 F300", "G0 X0 Y0\nG0 Z0\nG0 X100 Y100"),
    ("hits-print", "M84", "G28"),
    ("hits-print", "G0 Z10.5 F300", "G28 Z"),
    ("too-hot", "M109 S205", "M104 S305\nM104 S205"),
    ("too-hot", "M109 S205", "M140 S130\nM140 S0"),
    ("origin", "M109 S205", "G92 X10"),
    ("origin", "M109 S205", "G92 Z1"),
    ("origin", "M109 S205", "M206 X3"),
    ("origin", "M109 S205", "G54"),
    ("scale", "M109 S205", "M92 E200"),
    ("scale", "M109 S205", "M200 D1.75"),
    ("stops", "M109 S205", "M112"),
    ("cold", "M109 S205", "M104 S100"),
    ("cold", "G0 X20 Y20 F3000", "M104 S0"),
    ("cold", "M109 S205", "M302 P1"),
]


@pytest.mark.parametrize(("what", "line", "more"), FAULTS)
def test_a_fault_in_a_good_file_is_noticed_by_every_firmware(what, line, more):
    for firmware in FIRMWARES:
        if line == "G28" and firmware == "sailfish":
            continue  # it has no place at all before M132
        if firmware == "klipper" and more.split()[0] in ("M206", "G54", "M92"):
            continue  # it does not know them
        assert what in kinds(firmware, after(good(firmware), line, more)), firmware


@pytest.mark.parametrize(
    ("what", "dropped"),
    [
        ("cold", ["M109 S205"]),
        ("not-homed", ["G28"]),
        ("heaters-on", ["M104 S0"]),
        ("factors", ["M220 S100"]),
        ("factors", ["M221 S100"]),
        ("rests", ["G0 Z10.5 F300", "G0 X0 Y200 F3000"]),
        ("nothing", [line for line in BODY.split("\n") if line.startswith("G1")]),
    ],
)
def test_a_line_that_is_missing_is_noticed(what, dropped):
    for firmware in FIRMWARES:
        text = good(firmware)
        if firmware == "sailfish" and dropped == ["G28"]:
            dropped = ["M132 X Y Z A B"]
        if firmware == "sailfish" and what == "factors":
            continue  # GPX begins each file with 100
        assert what in kinds(firmware, without(text, *dropped)), firmware


def test_a_nozzle_that_waits_hot_on_the_bed_is_noticed():
    for firmware in FIRMWARES:
        lift = "G0 X0 Y0 Z10 F900" if firmware == "sailfish" else "G0 Z5 F300"
        text = good(firmware).replace(lift, "G0 X0 Y0 Z0.5 F900")
        assert "heats-on-bed" in kinds(firmware, text), firmware
    low = good("marlin").replace("G0 Z5 F300", "G0 Z0.3 F300")
    assert "heats-on-bed" in kinds("marlin", low.replace("M104 S205\n", ""))
    assert "heats-on-bed" in kinds("marlin", after(low, "G0 Z0.3 F300", "G4 S30"))
    assert "heats-on-bed" not in kinds("marlin", after(good("marlin"), "G0 Z5 F300", "G4 S30"))


def test_an_oozing_nozzle_that_touches_the_bed_is_noticed():
    hot = good("prusa").replace("M104 S170\nM109 R170", "M104 S205")
    assert "oozes" in kinds("prusa", hot)
    late = after(good("prusa"), "G28", "M104 S205")
    assert "oozes" in kinds("prusa", late)  # G29 P1 touches too
    assert "oozes" in kinds("bambu", good("bambu").replace("S140", "S205"))
    assert "oozes" not in kinds("marlin", good("marlin"))  # a switch finds the bed


def test_levelling_that_is_off_is_noticed():
    text = good("prusa")
    assert "not-levelled" in kinds("prusa", without(text, "G29 A"))
    assert "not-levelled" in kinds("prusa", after(text, "G29 A", "G28 Z"))
    # Without letters G29 does nothing: neither a probe nor levelling.
    bare = simulate(text.replace("G29 P1\nG29 P3.2\nG29 A", "G29"), limits("prusa"))
    assert bare.first["levelled"] is False
    probed = good("marlin").replace("M420 S1", "G29")
    assert "not-levelled" not in kinds("marlin", probed)
    assert "not-levelled" in kinds("marlin", after(probed, "G29", "G28"))
    assert "not-levelled" not in kinds("reprap", after(good("reprap"), "G29 S1", "G28"))
    off = simulate(without(good("marlin"), "M420 S1"), limits("marlin"))
    assert off.first["levelled"] is False  # homing drops it


def test_the_modes_of_places_and_of_e_are_each_firmwares_own():
    # G91 makes E relative too, but for RepRapFirmware.
    twice = "G91\nG1 E2 F100\nG1 E2\nG90\nM82\nG92 E0"
    for firmware in FIRMWARES:
        trace = simulate(after(good(firmware), "G0 Z5.25 F300", twice), limits(firmware))
        assert trace.dangers == []
        assert trace.fed == pytest.approx(8.6 + (2 if firmware == "reprap" else 4))
    # G90 makes it absolute again in Marlin only: there M83 before it does not last.
    swapped = after(good("marlin"), "G0 Z5.25 F300", "M83\nG90\nG1 E2 F100\nG1 E2\nM82\nG92 E0")
    for firmware in FIRMWARES:
        marlin = firmware in ("marlin", "prusa", "bambu")
        text = swapped.replace(START["marlin"], START[firmware])
        fed = simulate(text, limits(firmware)).fed
        assert fed == pytest.approx(8.6 + (2 if marlin else 4))


def test_units_that_the_file_does_not_set_are_noticed():
    inches = after(good("marlin"), "M109 S205", "G20")
    assert {"inches", "reach"} <= kinds("marlin", inches)
    assert "inches" in kinds("klipper", after(good("klipper"), "M109 S205", "G20"))
    bare = good("marlin").replace("G21\nG90\nM82\n", "")
    assert {"inches", "mode", "e-mode"} <= kinds("marlin", bare)


def test_a_replicator_must_recall_where_its_axes_end():
    text = good("sailfish")
    assert "not-homed" in kinds("sailfish", without(text, "M132 X Y Z A B"))
    # Without a move to an absolute place G92 E0 makes nought of where the axes end.
    assert "origin" in kinds("sailfish", without(text, "G0 X0 Y0 Z10 F900"))


def test_a_bead_beside_the_bed_or_in_an_excluded_zone_is_noticed():
    text = good("marlin")
    small = Limits("marlin", limits("marlin").reach, ((0.0, 0.0), (50.0, 220.0)))
    assert simulate(text, small).kinds == {"bed"}
    around = Limits("marlin", limits("marlin").reach, ((0.0, 0.0), (60.0, 60.0)), round_bed=True)
    assert simulate(text, around).kinds == {"bed"}
    assert kinds("marlin", text, excluded=(((30.0, 0.0), (40.0, 28.0)),)) == {"excluded"}
    assert kinds("marlin", text, excluded=(((0.0, 0.0), (18.0, 28.0)),)) == set()


def test_what_a_macro_hides_is_no_danger_until_the_file_uses_it():
    text = good("klipper").replace(START["klipper"], "PRINT_START BED=0 EXTRUDER=205")
    trace = simulate(text, limits("klipper"))
    assert trace.dangers == []
    lost = without(text, "M220 S100", "G92 E0")
    assert simulate(lost, limits("klipper")).kinds == set()
    file = good("reprap").replace(START["reprap"], 'M98 P"start.g"')
    assert kinds("reprap", file) == set()
    # Elsewhere such a word is no command, and so the machine is not homed.
    for firmware in ("marlin", "prusa", "bambu", "reprap"):
        text = good(firmware).replace(START[firmware], "PRINT_START BED=0 EXTRUDER=205")
        assert "not-homed" in kinds(firmware, text), firmware


def test_waiting_for_a_nozzle_that_cools():
    # M109 S does not wait for it in Marlin, R does, and Klipper waits in any case.
    cold = "M104 S260\nM109 S260\nM109 S205"
    for firmware in ("marlin", "klipper"):
        trace = simulate(good(firmware).replace("M109 S205", cold), limits(firmware))
        assert trace.dangers == []
        assert [c for _, c in trace.waits][-2:] == [260, 205]
    assert "cold" in kinds("marlin", good("marlin").replace("M109 S205", "M109"))
    assert "cold" in kinds("klipper", good("klipper").replace("M109 S205", "M109"))


def test_a_second_print_begins_as_the_first_has_left_the_machine():
    for firmware in FIRMWARES:
        first = simulate(good(firmware), limits(firmware))
        assert "drawn-back" in simulate(good(firmware), limits(firmware), first.last).kinds
        taken = after(good(firmware), "M109 S205", "G1 E1 F1800\nG92 E0")
        first = simulate(taken, limits(firmware))
        assert simulate(taken, limits(firmware), first.last).dangers == []


def test_a_line_that_is_too_long_is_noticed():
    line = "G1 X20" + " " * 100 + "Y20"
    assert "long-line" in kinds("marlin", after(good("marlin"), "M109 S205", line))
    assert "long-line" not in kinds("klipper", after(good("klipper"), "M109 S205", line))
    comment = "G0 X20 ;" + "x" * 100
    assert "long-line" not in kinds("marlin", after(good("marlin"), "M109 S205", comment))


@pytest.mark.parametrize(
    ("line", "firmware", "names"),
    [
        ("g28 x0", "marlin", ["g28"]),
        ("g28 x0", "klipper", ["G28"]),
        ("g28 x0", "reprap", ["G28"]),
        ("G01 X5", "marlin", ["G1"]),
        ("G01 X5", "klipper", ["G01"]),
        ("G91 G0 X5", "marlin", ["G91"]),
        ("G91 G0 X5", "reprap", ["G91", "G0"]),
        ("G91 G0 X5", "klipper", ["G91"]),
        ("N10 G28*33", "marlin", ["G28"]),
        ("N7 G1 X5 E2", "klipper", ["G1"]),
        ("G 28", "marlin", ["G28"]),
        ("M117 G28 X999", "reprap", ["M117"]),
        ("G29.2 S1 ; on", "bambu", ["G29.2"]),
        ("(home) G28", "reprap", ["G28"]),
        ("; G28", "marlin", []),
        ("SET_VELOCITY_LIMIT ACCEL=500", "klipper", ["SET_VELOCITY_LIMIT"]),
    ],
)
def test_lines_are_read_as_each_firmware_reads_them(line, firmware, names):
    assert [command.name for command in commands(line, firmware)] == names


def test_parameters_are_numbers_or_there_without_one():
    (command,) = commands("G1X10.5 Y-3 E.25 F3000", "marlin")
    assert command.words == {"X": 10.5, "Y": -3.0, "E": 0.25, "F": 3000.0}
    (command,) = commands("G28 X Y", "prusa")
    assert command.words == {"X": None, "Y": None}
    (command,) = commands("SET_VELOCITY_LIMIT ACCEL=500 NAME=a", "klipper")
    assert command.words == {"ACCEL": 500.0, "NAME": None}

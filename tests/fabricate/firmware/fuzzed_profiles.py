"""Profiles as people might write them: sound ones with odd lines put in, and tables of any kind."""

from hypothesis import strategies as st

NUMBERS = st.sampled_from(
    [-500, -30, -5, -2, -0.5, 0, 0.1, 0.2, 0.3, 1, 2, 5, 9, 10, 30, 60, 110, 120, 250, 999]
) | st.floats(-50, 300).map(lambda value: round(value, 2))
WORDS = st.sampled_from(
    ["{bed_max_x}", "{bed_min_y}", "{min_x}", "{max_y}", "{top}", "{bed_max_z}", "{temperature}"]
)
VALUES = NUMBERS.map(lambda value: f"{value:g}") | WORDS
MOVE = st.builds(
    lambda head, words, gap: head + "".join(gap + axis + value for axis, value in words.items()),
    st.sampled_from(["G0", "G1", "G1", "G01", "g1", "G00", "N7 G1", "G 1"]),
    st.dictionaries(st.sampled_from("XYZEF"), VALUES, min_size=1, max_size=3),
    st.sampled_from([" ", " ", ""]),
)
DEGREES = st.sampled_from(["0", "60", "140", "170", "200", "205", "260", "400", "{temperature}"])
HEAT = st.builds(
    lambda head, letter, degrees: f"{head} {letter}{degrees}",
    st.sampled_from(["M104", "M109", "M140", "M190"]),
    st.sampled_from(["S", "S", "R", "T0 S", ""]),
    DEGREES,
)
FACTOR = st.builds(
    "{} S{}".format, st.sampled_from(["M220", "M221"]), st.sampled_from(["50", "95", "100", "0"])
)
SET = st.builds(
    "{} {}{}".format,
    st.sampled_from(["G92", "G92", "G10", "M206", "M92", "M84", "G28", "M132", "M204", "M205"]),
    st.sampled_from(["E", "X", "Z", "S", "P", "X Y Z", ""]),
    st.sampled_from(["", "0", "5", "-2", "100"]),
)
FIXED = st.sampled_from(
    """G90|G91|M82|M83|G20|G21|G90 G0 X5|G91 G90|G28|G28 X Y|G28 Z|g28|G28 W|G29|G29 P1|G29 A|G29 S1
G29 S2|G29.2 S1|G29.2 S0|M420 S1|M420 S0|M84|M18|M17|M84 S30|G4 P500|G4 S20|G10|G11|M132 X Y Z A B
M302 P1|M702|M701|M600|M0|M25|M112|M81|M2|M92 E400|M851 Z-1|G54|G53 G0 X5|M200 D0|M200 D1.75
M211 S0|T0|T1|G27|G12|G34|M400|M117 G28 X999|M118 hot|M73 P50 R3|M862.3 P "MK4"|M106 S255|M107
M115|M500|M502|M900 K0.05|M207 S1|M209 S1|M350 X16|M98 P"start.g"|M116|M999|M206 X5|G52 X3
PRINT_START|print_start BED=60|START_PRINT EXTRUDER={temperature}|PARK|QUAD_GANTRY_LEVEL
SET_GCODE_OFFSET Z=-1|SET_VELOCITY_LIMIT ACCEL=99999|SAVE_GCODE_STATE NAME=a|BED_MESH_CLEAR
RESTORE_GCODE_STATE NAME=a MOVE=1|M104 S[first_layer_temperature]|M109 S{first_layer_temperature[0]}
{if x}|G1 X{bed_max_x+5}|G1 Z|G1 E|G1 X1e2|G0 X1E5|G1 E-30|G1 E-2|G1 E-15 F1800|G1 Z0.2|G0 Z0
G0 Z5 F300|G0 Z10 F300|G2 X5 Y5 I1 J1|(home) G28|G28 ; Düse auf 205 °C|; a comment|M117 grüß
(G0 Z5)|G0 X10 (Y900) Y10|\tG0 Z5\t|G28*55|N3 G0 Z5*71|G1X5Y5Z5|G0 X--5|G0 X+5|G0 X.5|G0 Xnan|
""".replace("\n", "|").split("|")
)
LINES = st.one_of(MOVE, MOVE, MOVE, HEAT, FACTOR, SET, FIXED, FIXED)
STARTS = {
    "marlin": ["M104 S{temperature}", "G28", "G0 Z5 F300"],
    "prusa": ["M104 S170", "M109 S170", "G28", "G29 P1", "G29 A", "G0 Z5 F720"],
    "klipper": ["G28", "G0 Z5 F300"],
    "reprap": ["G28", "G0 Z5 F300"],
    "bambu": ["M104 S140", "M109 S140", "G28", "G0 Z5 F300"],
    "sailfish": ["G28", "M132 X Y Z A B", "G0 X0 Y0 Z10 F900"],
}
ENDS = [[], ["M84"], ["G0 X{bed_min_x} Y{bed_max_y} F3000", "M84"], ["G91", "G0 Z1", "G90"]]
FIRMWARES = sorted(STARTS)


@st.composite
def codes(draw, sound, most):
    """Code with odd lines put into sound code, or without some of its lines."""
    lines = list(sound)
    if lines and draw(st.integers(0, 5)) == 0:
        lines.pop(draw(st.integers(0, len(lines) - 1)))
    for _ in range(draw(st.integers(0, most))):
        lines.insert(draw(st.integers(0, len(lines))), draw(LINES))
    return "\n".join(lines)


PLACE = st.integers(-20, 100).map(float)
BOXES = st.tuples(st.tuples(PLACE, PLACE), st.tuples(PLACE, PLACE))
SPANS = st.tuples(st.integers(-60, 60), st.integers(0, 300)).map(lambda s: [float(v) for v in s])


@st.composite
def profiles(draw):
    """The tables of a profile, mostly sound, as plain data."""
    firmware = draw(st.sampled_from(FIRMWARES))
    centre = firmware == "sailfish" or draw(st.booleans())
    side = st.sampled_from([60.0, 120.0, 220.0])
    width = draw(side)
    shape = draw(st.sampled_from(["rectangle", "rectangle", "round"]))
    bed = {
        "width": width,
        "depth": width if shape == "round" else draw(side),
        "height": draw(st.sampled_from([5.0, 30.0, 250.0])),
        "origin": "centre" if centre else "corner",
        "shape": shape,
    }
    if draw(st.integers(0, 3)) == 0:
        boxes = draw(st.lists(BOXES, min_size=1, max_size=2))
        bed["excluded"] = [[list(corner) for corner in box] for box in boxes]
    reach = {}
    if draw(st.integers(0, 2)) == 0:
        reach = draw(st.dictionaries(st.sampled_from("xyz"), SPANS, max_size=2))
    settings = {
        "nozzle": 0.6,
        "layer": 0.5,
        "retraction": draw(st.sampled_from([0.0, 0.8, 5.0, 20.0])),
        "skirt_distance": draw(st.sampled_from([0.0, 5.0, 20.0])),
    }
    if draw(st.integers(0, 4)) == 0:
        settings["temperature"] = draw(st.sampled_from([180.0, 200.0, 230.0]))
    return {
        "name": "fuzzed",
        "title": "Fuzzed",
        "firmware": firmware,
        "bed": bed,
        "reach": reach,
        "extruder": {
            "extrusion": draw(st.sampled_from(["absolute", "relative"])),
            "filament": draw(st.sampled_from([1.75, 2.85])),
            "lift": draw(st.sampled_from([0.1, 0.5, 5.0])),
        },
        "temperature": {"nozzle_most": 260.0, "bed_most": draw(st.sampled_from([0.0, 100.0]))},
        "motion": {
            "speed": draw(st.sampled_from([3000.0, 12000.0])),
            "speed_z": draw(st.sampled_from([60.0, 600.0])),
            "acceleration": draw(st.sampled_from([500.0, 3000.0])),
            "acceleration_travel": 1000.0,
        },
        "print": settings,
        "code": {
            "start": draw(codes(STARTS[firmware], 4)),
            "end": draw(codes(draw(st.sampled_from(ENDS)), 3)),
            "progress": draw(st.booleans()),
        },
    }

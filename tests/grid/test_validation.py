"""Validation: each rule breaks for one grid made to break it, and says by how much."""

import re

import numpy as np
import pytest
from grids import MATERIAL, SECTION, drawn, moved, star
from hypothesis import given

from simulearn.errors import InputError
from simulearn.grid import (
    Grid,
    Rules,
    TrainingRange,
    check_designs,
    clean,
    draw,
    drop_beams,
    lattice,
    library,
    make,
    outline,
    validate,
)

FLAT = lattice()  # 2x2 cells, joint 4 fixed at the origin


def errors(grid, **options):
    return [(e.code, e.where, e.message) for e in validate(grid, MATERIAL, **options).errors]


def warnings(grid, **options):
    return [(w.code, w.where, w.message) for w in validate(grid, MATERIAL, **options).warnings]


def place(grid, joint, x, y):
    joints = grid.joints.copy()
    joints[joint] = x, y
    return moved(grid, joints=joints)


def only(messages):
    (message,) = messages
    return message


@pytest.mark.parametrize("cells", [(1, 1), (2, 2), (2, 3), (3, 3), (4, 1)])
@pytest.mark.parametrize("name", library())
def test_the_library_is_valid_without_a_warning(name, cells):
    result = validate(make(name, cells), MATERIAL)
    assert result.valid
    assert result.to_dict() == {"errors": [], "warnings": []}


@given(drawn())
def test_what_is_valid_can_be_outlined_when_clean(grid):
    result = validate(grid, MATERIAL)
    if result.valid:
        cleaned, removed = clean(grid)
        outline(cleaned, SECTION)
        again = validate(cleaned, MATERIAL)
        assert again.valid
        assert not [w for w in again.warnings if "removed" in w.message]
        assert set(removed) <= set(result.warnings)


# Numbers and indices


@pytest.mark.parametrize(
    ("grid", "code", "where", "message"),
    [
        (moved(FLAT, actuators=[0.0]), "actuator-count", "grid", "actuators has 1 ratios for 12"),
        (moved(FLAT, joints=[[1e9, 0]] + [[0, 0]] * 8), "joint-place", "joint 0", "[1000000000.0"),
        (moved(FLAT, beams=[[0, 9], *FLAT.beams[1:].tolist()]), "beam-index", "beam 0", "0 to 8"),
        (
            moved(FLAT, beams=[[3, 3], *FLAT.beams[1:].tolist()]),
            "beam-to-itself",
            "beam 0",
            "[3, 3]",
        ),
        (
            moved(FLAT, beams=[[3, 0], *FLAT.beams[1:].tolist()]),
            "beam-duplicate",
            "beam 1",
            "beam 0",
        ),
        (moved(FLAT, actuators=[1.5] + [0] * 11), "actuator-ratio", "beam 0", "is 1.5; a ratio"),
        (moved(FLAT, fixed=9), "fixed-index", "grid", "fixed is 9; joints are numbered 0 to 8"),
        (moved(FLAT, fixed=-1), "fixed-index", "grid", "fixed is -1"),
    ],
)
def test_numbers_and_indices(grid, code, where, message):
    result = only(errors(grid))
    assert result[:2] == (code, where)
    assert message in result[2]


# The grid as a whole


def test_a_grid_needs_beams():
    assert errors(Grid([[0, 0]], [], [], 0))[0][:2] == ("no-beams", "grid")


def test_a_tree_dangles_altogether():
    code, _, message = only(errors(star(0, 90, 180)))
    assert code == "no-beams"
    assert "none of the 3 beams closes a loop" in message


def test_two_joints_at_one_place():
    grid = place(FLAT, 8, *FLAT.joints[5])
    code, where, message = errors(grid)[0]
    assert (code, where) == ("joints-coincide", "joint 8")
    assert "joint 8 lies where joint 5 lies, 0 mm apart" in message
    assert "overlap" not in [e[0] for e in errors(grid)]


def test_a_grid_in_two_parts():
    square = lattice((1, 1))
    joints = np.r_[square.joints, square.joints + 200]
    two = Grid(joints, np.r_[square.beams, square.beams + 4], np.zeros(8), 0)
    assert only(errors(two)) == (
        "disconnected",
        "grid",
        "the grid is in 2 parts; no beam leads to joints 4, 5, 6, 7",
    )


def test_a_part_that_dangles_by_itself_is_a_part_too():
    square = lattice((1, 1))
    joints = np.r_[square.joints, [[300, 0], [360, 0]]]
    two = Grid(joints, [*square.beams.tolist(), [4, 5]], np.zeros(5), 0)
    assert only(errors(two))[0] == "disconnected"


# Joints


def test_a_joint_takes_four_beams():
    # The spokes of a wheel with five corners.
    rim = star(0, 72, 144, 216, 288)
    beams = [*rim.beams.tolist(), *([k + 1, (k + 1) % 5 + 1] for k in range(5))]
    wheel = Grid(rim.joints, beams, np.zeros(10), 0)
    assert only(errors(wheel)) == (
        "joint-valence",
        "joint 0",
        "joint 0 has 5 beams; a joint takes 2 to 4",
    )


def test_every_joint_without_an_outline_is_named():
    # Two corners pulled so far out that their beams leave at a few degrees.
    grid = place(place(FLAT, 0, -600, -600), 8, 600, 600)
    result = [e for e in errors(grid) if e[0] == "joint-outline"]
    assert [where for _, where, _ in result] == ["joint 0", "joint 8"]
    for _, where, message in result:
        assert message.startswith(where + " has a corner of ")
        assert message.endswith("each corner has 15 to 165")


def test_two_beams_in_one_direction():
    # Joint 1 on the line of beam 0-2 and on that of 0-3.
    grid = Grid([[0, 0], [60, 0], [120, 0], [60, 60]], [[0, 1], [0, 2], [1, 3], [2, 3]], [0] * 4, 0)
    result = errors(grid)
    assert ("joint-outline", "joint 0", "beams 0 and 1 leave joint 0 in one direction") in result


# Beams and actuators


def test_joints_too_close():
    small = lattice((2, 2), 8.0)
    result = errors(small)
    assert len(result) == 12
    assert result[0] == (
        "joints-too-close",
        "beam 0",
        "beam 0 is left an edge of 0.80 mm between joints 0 and 1; each edge needs at least 1 mm",
    )


@pytest.mark.parametrize(("net", "wrong"), [(39.9, True), (40.0, False), (41.0, False)])
def test_an_actuator_has_ten_millimetres(net, wrong):
    grid = lattice((2, 2), net + SECTION.width)
    grid = moved(grid, actuators=[0.0, -0.25] + [0.0] * 10)
    assert bool(errors(grid)) == wrong
    if wrong:
        assert only(errors(grid)) == (
            "actuator-short",
            "beam 1",
            "the actuator of beam 1 is 9.97 mm long (ratio 0.25 of 39.90 mm); "
            "an actuator is at least 10 mm, or 0",
        )


def test_ratios_need_not_be_quarters():
    assert not errors(moved(FLAT, actuators=np.linspace(0.3, 0.9, 12)))


def test_other_limits_than_the_materials():
    limits = MATERIAL.limits.model_copy(update={"actuator_length": 20.0})
    grid = moved(FLAT, actuators=[0.25] + [0.0] * 11)
    assert not errors(grid)
    assert only(errors(grid, limits=limits))[0] == "actuator-short"


def test_long_and_short_beams_are_warned_of():
    assert not validate(lattice((2, 2), 100.0), MATERIAL).warnings
    assert warnings(lattice((1, 1), 110.0))[3] == (
        "beam-long",
        "beam 3",
        "beam 3 is 110.00 mm long; the limit is 100 mm",
    )
    assert not validate(lattice((1, 1), 17.2), MATERIAL).warnings
    short = lattice((1, 1), 16.0)
    assert not errors(short)
    assert warnings(short)[0] == (
        "beam-short",
        "beam 0",
        "beam 0 is 8.80 mm long between its joints; at least 10 mm is usual",
    )


def test_the_training_range_replaces_the_limits():
    trained = TrainingRange(dimension=(60.0, 90.0), beam_length=(50.0, 64.0))
    result = warnings(FLAT, training=trained)
    assert [w[0] for w in result] == ["beam-long"] * 12 + ["grid-size"]
    assert result[-1][2] == (
        "the grid reaches 91.92 mm from its fixed joint; the model was trained from 60 to 90 mm"
    )
    assert [w[0] for w in warnings(lattice((2, 2), 45.0), training=trained)] == ["beam-short"] * 12
    assert not warnings(lattice((2, 2), 60.0), training=trained)


# Overlap


def test_beams_that_cross():
    # A square whose diagonals are beams without a joint where they cross.
    square = lattice((1, 1))
    beams = [*square.beams.tolist(), [0, 3], [1, 2]]
    crossed = Grid(square.joints, beams, np.zeros(6), 0)
    assert only(errors(crossed)) == (
        "joint-missing",
        "beam 5",
        "beam 4 and beam 5 cross at (32.5, 32.5) mm, where a joint is missing: "
        "add one and end both beams there",
    )


def test_a_joint_on_a_beam():
    # A square with a triangle hung on its upper corner; the triangle's tip touches beam 0.
    square = lattice((1, 1), 80.0)
    joints = np.r_[square.joints, [[40, 5]], [[40, 50]]]
    beams = [*square.beams.tolist(), [3, 4], [4, 5], [5, 3]]
    grid = Grid(joints, beams, np.zeros(7), 0)
    assert only(errors(grid)) == (
        "overlap",
        "beam 0",
        "joint 4 and beam 0 overlap; parts of a grid meet only end to end",
    )
    assert not errors(place(grid, 4, 40, 10))


@pytest.mark.parametrize("y", [0.0, 2.0, -2.0])
def test_beams_that_meet_in_a_t_without_a_joint(y):
    square = lattice((1, 1))
    joints = np.r_[square.joints, [[30, y], [30, 65 - y]]]
    grid = Grid(joints, [*square.beams.tolist(), [4, 5]], np.zeros(5), 0)
    first, second, third = errors(grid)
    assert first == (
        "joint-missing",
        "beam 0",
        f"joint 4 lies on beam 0 at (30, {y:g}) mm, which does not end there, so a joint is "
        "missing: divide the beam in two that end there",
    )
    assert (second[0], third[0]) == ("joint-missing", "disconnected")
    # A beam that only dangles for want of a joint keeps no grid from being simulated.
    hung = Grid(joints[:5], [*square.beams.tolist(), [4, 3]], np.zeros(5), 0)
    assert not errors(hung)
    assert [w[0] for w in warnings(hung)] == ["joint-missing", "dangling-beam"]


def test_beams_through_a_row_of_joints_lack_each_of_them():
    row = lattice((3, 1))
    beams = [(0, 4), (3, 7), (0, 3), (4, 7)]
    long = Grid(row.joints[:8], [*beams, (1, 5), (2, 6)], np.zeros(6), 0)
    where = [e for e in errors(long) if e[0] == "joint-missing"]
    assert len(where) == 4
    assert {e[1] for e in where} == {"beam 2", "beam 3"}


# Sizes


@pytest.mark.parametrize(
    ("scale", "words"),
    [
        (1e-3, "0.13 by 0.13 mm wide, .* read as metres, .* multiply all coordinates by 1000"),
        (1 / 25.4, r"5.12 by 5.12 mm wide, .* 2.56 mm long, .* inches, .* by 25\.4"),
        (0.1, "13 by 13 mm wide, .* not as long as it is wide .* centimetres"),
        (10.0, "1,300 by 1,300 mm wide, .* their own weight .* tenths of a millimetre"),
        (500.0, "65,000 by 65,000 mm wide, .* micrometres, .* by 0.001"),
    ],
)
def test_a_size_that_no_print_has_is_one_message_with_the_likely_unit(scale, words):
    grid = make("cone")
    scaled = moved(grid, joints=grid.joints * scale)
    code, where, message = only(errors(scaled))
    assert (code, where) == ("size", "grid")
    assert re.search(words, message), message
    assert not warnings(scaled)
    few = np.repeat(scaled.joints[None], 2, axis=0)
    ratios = np.repeat(grid.actuators[None], 2, axis=0)
    assert not check_designs(grid.beams, grid.fixed, few, ratios, MATERIAL).valid.any()


def test_far_away_joints_name_the_likely_unit():
    grid = make("cone")
    assert "micrometres" in errors(moved(grid, joints=grid.joints * 1600.0))[0][2]


@pytest.mark.parametrize("length", [12.0, 250.0])
def test_an_unusual_size_is_one_warning(length):
    grid = lattice((2, 2), length)
    assert not errors(grid)
    assert only(warnings(grid))[0] == "size"


def test_long_beams_and_slender_strips_are_no_matter_of_size():
    assert not errors(lattice((2, 2), 145.0))
    assert not errors(lattice((4, 1), 100.0))
    assert not errors(lattice((8, 1), 300.0))
    light = MATERIAL.gravity.model_copy(update={"acceleration": 0.0})
    weightless = MATERIAL.model_copy(update={"gravity": light})
    assert validate(lattice((2, 2), 650.0), weightless).valid


# Indices that count from 1


def test_indices_from_1_that_happen_to_exist_are_found_out():
    grid = lattice((2, 2))
    joints = np.r_[grid.joints, [[195.0, 195.0]]]
    shifted = Grid(joints, grid.beams + 1, grid.actuators, grid.fixed + 1)
    assert errors(shifted)[0][:2] == ("counted-from-one", "grid")
    assert "counted-from-one" not in [e[0] for e in errors(grid)]
    # Where joint 0 is unused and all else is well, nothing is to be said of the indices.
    spare = Grid(np.r_[[[-99.0, 0.0]], grid.joints], grid.beams + 1, grid.actuators, grid.fixed + 1)
    assert [w[0] for w in warnings(spare)] == ["unused-joint"]


# Dangling beams


def test_dangling_beams_are_removed_and_said_so():
    # Joint 0 loses one beam, so the other dangles; its joint goes without saying.
    grid = drop_beams(make("saddle"), {0})
    result = validate(grid, MATERIAL)
    assert result.valid
    assert [(w.code, w.where, w.message) for w in result.warnings] == [
        ("dangling-beam", "beam 0", "beam 0 dangles at one end and is removed")
    ]
    cleaned, removed = clean(grid)
    assert list(result.warnings) == removed
    assert (len(cleaned.joints), len(cleaned.beams), cleaned.fixed) == (8, 10, 3)
    np.testing.assert_array_equal(cleaned.joints, grid.joints[1:])
    np.testing.assert_array_equal(cleaned.actuators, grid.actuators[1:])
    np.testing.assert_array_equal(cleaned.joints[cleaned.beams], grid.joints[grid.beams[1:]])


def test_a_chain_of_dangling_beams_goes_altogether():
    square = lattice((1, 1))
    joints = np.r_[square.joints, square.joints[3] + [[50, 0], [100, 0], [400, 400]]]
    tail = Grid(joints, [*square.beams.tolist(), [3, 4], [4, 5]], np.zeros(6), 0)
    assert [w[:2] for w in warnings(tail)] == [
        ("dangling-beam", "beam 4"),
        ("dangling-beam", "beam 5"),
        ("unused-joint", "joint 6"),
    ]
    assert len(clean(tail)[0].joints) == 4


def test_a_fixed_joint_that_is_removed_is_an_error():
    grid = moved(drop_beams(FLAT, {0}), fixed=0)
    assert only(errors(grid))[:2] == ("fixed-removed", "joint 0")
    with pytest.raises(InputError, match="joint 0 is fixed but is removed"):
        clean(grid)


def test_messages_keep_the_numbers_of_the_design():
    grid = drop_beams(lattice((2, 2), 45.0), {0})  # removes joint 0, renumbering the rest
    grid = moved(grid, actuators=[0.0] * 10 + [0.25])
    assert only(errors(grid))[1] == "beam 10"


@pytest.mark.parametrize("k", range(200))
def test_few_random_designs_are_refused(k):
    result = validate(draw(Rules(), 7, k), MATERIAL)
    assert {e.code for e in result.errors} <= {"overlap", "joints-too-close", "joint-outline"}

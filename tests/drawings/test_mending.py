"""Messy drawings become the grid that was meant; clean ones are left as they are."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from messy import (
    NETS,
    doubled,
    drawing,
    ends_moved,
    l_grid,
    noisy,
    overlapped,
    same,
    shuffled,
    turned,
    with_crumbs,
    with_stubs,
)

from simulearn.drawings.importing import Options, grid_of
from simulearn.drawings.mending import MENDS
from simulearn.errors import InputError

STEPS = {
    "stubs": with_stubs,
    "ends": lambda lines, random: ends_moved(lines, random, 0.6),
    "doubled": doubled,
    "overlapped": overlapped,
    "crumbs": with_crumbs,
    "shuffled": shuffled,
    "noise": noisy,
}


def codes(result):
    return {mend.code: mend.count for mend in result.mends}


@pytest.mark.parametrize("net", NETS)
@given(
    seed=st.integers(0, 2**32 - 1),
    steps=st.sets(st.sampled_from(sorted(STEPS))),
    angle=st.floats(0, 6.3),
)
@settings(max_examples=25, deadline=None, derandomize=True)
def test_a_messy_drawing_becomes_the_grid_that_was_meant(net, seed, steps, angle):
    clean = turned(NETS[net](), angle)
    random = np.random.default_rng(seed)
    lines = clean
    for step in STEPS:  # in this order: stubs begin at joints
        if step in steps:
            lines = STEPS[step](lines, random)
    result = grid_of(drawing(lines))
    assert same(result.grid, clean), (codes(result), len(result.grid.beams))


@pytest.mark.parametrize("net", NETS)
def test_a_clean_drawing_is_not_mended(net):
    clean = NETS[net]()
    result = grid_of(drawing(clean))
    assert same(result.grid, clean, 1e-6)
    assert not result.mends


@pytest.mark.parametrize("net", NETS)
def test_the_order_of_lines_does_not_change_the_joints(net):
    clean = NETS[net]()
    first = grid_of(drawing(clean)).grid
    other = grid_of(drawing(shuffled(clean, np.random.default_rng(1)))).grid
    np.testing.assert_allclose(first.joints, other.joints, atol=1e-9)
    assert first.fixed == other.fixed


def test_beams_follow_the_order_and_sense_of_their_lines():
    clean = shuffled(l_grid(), np.random.default_rng(2))
    grid = grid_of(drawing(clean)).grid
    np.testing.assert_allclose(grid.joints[grid.beams], clean, atol=1e-9)


def test_joints_lie_at_the_crossing_of_axes_and_not_at_the_mean_of_ends():
    square = [
        [[0.7, 0], [60, 0]],
        [[60, -0.8], [60, 59.5]],
        [[60.9, 60], [-0.3, 60]],
        [[0, 60.6], [0, 0.9]],
    ]
    result = grid_of(drawing(square))
    assert same(result.grid, [[[0, 0], [60, 0]], [[60, 0], [60, 60]], [[60, 60], [0, 60]],
                              [[0, 60], [0, 0]]], 1e-6)  # fmt: skip
    assert codes(result) == {"gap": 2, "overshoot": 3}


def test_long_lines_are_split_at_crossings_and_touches():
    lines = [
        [[0, 0], [130, 0]],
        [[0, 65], [130, 65]],
        [[0, 130], [65, 130]],
        [[0, 0], [0, 130]],
        [[65, 0], [65, 130]],
        [[130, 0], [130, 65]],
    ]
    result = grid_of(drawing(lines))
    assert same(result.grid, l_grid())
    assert codes(result) == {"t-touch": 2, "crossing": 1}
    places = {mend.code: mend.places for mend in result.mends}
    assert places["crossing"] == ((65.0, 65.0),)


def test_parallel_lines_five_millimetres_apart_stay_two():
    near = [[[0, 0], [80, 0]], [[0, 5], [80, 5]], [[0, 0], [0, 5]], [[80, 0], [80, 5]]]
    result = grid_of(drawing(near), Options(unit="mm"))
    assert (len(result.grid.joints), len(result.grid.beams)) == (4, 4)
    assert not result.mends


def test_lines_end_to_end_in_a_straight_keep_their_joint_but_points_of_a_polyline_go():
    frame = [[[130, 0], [130, 65]], [[130, 65], [0, 65]], [[0, 65], [0, 0]]]
    apart = grid_of(drawing([*frame, [[0, 0], [65, 0]], [[65, 0], [130, 0]]]))
    assert len(apart.grid.beams) == 5
    assert not apart.mends
    line = grid_of(drawing([*frame, [[0, 0], [65, 0.1], [130, 0]]]))
    assert len(line.grid.beams) == 4
    assert codes(line) == {"straight": 1}
    kept = grid_of(
        drawing([*frame, [[0, 0], [65, 0.1], [130, 0]]]), Options(without=frozenset({"straight"}))
    )
    assert len(kept.grid.beams) == 5
    bent = grid_of(drawing([*frame, [[0, 0], [65, 2], [130, 0]]]))
    assert len(bent.grid.beams) == 5


def test_a_short_piece_of_a_straight_line_makes_no_joint():
    frame = [[[130, 0], [130, 65]], [[130, 65], [0, 65]], [[0, 65], [0, 0]]]
    result = grid_of(drawing([*frame, [[0, 0], [12, 0]], [[12, 0], [130, 0]]]))
    assert len(result.grid.beams) == 4
    assert codes(result) == {"straight": 1}


def test_a_closed_polyline_that_begins_on_a_straight_side():
    ring = [[30, 0], [60, 0], [60, 60], [0, 60], [0, 0], [30, 0]]
    result = grid_of(drawing([ring]))
    assert len(result.grid.joints) == 4
    assert codes(result) == {"straight": 1}


def test_a_joint_between_two_actuators_stays():
    ring = [[[0, 0], [10, 0]], [[10, 0], [60, 0]], [[60, 0], [60, 60]], [[60, 60], [0, 0]]]
    layers = ["top 0.5", "bottom 1", "passive", "passive"]
    grid = grid_of(drawing(ring, layers)).grid
    assert grid.actuators.tolist() == [0.5, -1, 0, 0]


def test_what_dangles_goes_with_all_that_dangles_then():
    square = [[0, 0], [60, 0], [60, 60], [0, 60], [0, 0]]
    tail = [[60, 60], [120, 60], [120, 120]]
    result = grid_of(drawing([square, tail, [[0, 0], [-8, -8]], [[300, 0], [360, 0]]]))
    assert len(result.grid.beams) == 4
    assert codes(result) == {"stub": 1, "leaf": 3}
    text = {mend.code: mend.message for mend in result.mends}["leaf"]
    assert text == "3 dangling beams, which close no loop, were removed; 4 beams stay"


def test_a_drawing_of_nothing_but_dangling_beams_stays_as_it_is():
    result = grid_of(drawing([[[0, 0], [60, 0], [60, 60]]]))
    assert len(result.grid.beams) == 2


@pytest.mark.parametrize(
    ("code", "lines", "beams"),
    [
        ("gap", [[[0.6, 0], [60, 0], [60, 60], [0, 60], [0, 0]]], 4),
        ("overshoot", [[[0, 0], [60, 0], [60, 60], [0, 60], [0, -0.8]]], 5),
        ("crossing", [[[0, 0], [60, 0], [60, 60], [0, 60], [0, 0]], [[-20, 30], [80, 31]]], 5),
        ("t-touch", [[[0, 0], [60, 0], [60, 60], [0, 60], [0, 0]], [[0, 30], [60, 30]]], 5),
        ("overlap", [[[0, 0], [60, 0], [60, 60], [0, 60], [0, 0]], [[20, 0], [40, 0]]], 6),
        ("stub", [[[0, 0], [60, 0], [60, 60], [0, 60], [0, 0]], [[0, 0], [-8, -8]]], 5),
        ("leaf", [[[0, 0], [60, 0], [60, 60], [0, 60], [0, 0]], [[0, 0], [-60, -60]]], 5),
    ],
)
def test_each_mend_can_be_left_undone(code, lines, beams):
    options = Options(without=frozenset({code, "leaf", "stub", "straight"}))
    mended = codes(grid_of(drawing(lines), replace(options, without=options.without - {code})))
    raw = grid_of(drawing(lines), options)
    assert code in mended
    assert code not in codes(raw)
    assert len(raw.grid.beams) == beams


def test_a_mend_that_does_not_exist_is_named():
    with pytest.raises(InputError, match='"gaps" is none of the mends; they are plane') as error:
        grid_of(drawing(l_grid()), Options(without=frozenset({"gaps"})))
    assert error.value.code == "mend-unknown"
    assert len(MENDS) == len(set(MENDS))


def test_lines_without_end_are_refused_in_time():
    angles = np.linspace(0, 3, 3000)
    fan = [
        [[500 * np.cos(a), 500 * np.sin(a)], [-500 * np.cos(a), -500 * np.sin(a)]] for a in angles
    ]
    with pytest.raises(InputError, match="at more than 300,000 places") as error:
        grid_of(drawing(fan))
    assert error.value.code == "too-large"

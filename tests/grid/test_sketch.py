"""From drawn lines to grids."""

import numpy as np
import pytest
from grids import MATERIAL
from hypothesis import given
from hypothesis import strategies as st

from simulearn.errors import InputError
from simulearn.grid import lattice, sketch, validate


def edges(grid):
    """Return the beams of a grid as a set of pairs of rounded places."""
    ends = grid.joints[grid.beams].round(3) + 0.0
    return {frozenset(map(tuple, pair)) for pair in ends.tolist()}


def test_six_lines_make_a_lattice():
    lines = [[[-65, y], [65, y]] for y in (-65, 0, 65)] + [
        [[x, -65], [x, 65]] for x in (-65, 0, 65)
    ]
    grid = sketch(lines)
    assert edges(grid) == edges(lattice((2, 2), 65.0))
    np.testing.assert_allclose(grid.joints[grid.fixed], 0, atol=1e-9)
    assert not grid.actuators.any()
    assert validate(grid, MATERIAL).valid


def test_ends_that_nearly_meet_are_joined():
    lines = [[[0, 0], [60, 0]], [[60.5, 0.3], [60, 60]], [[60, 60], [0, 60]], [[0, 60], [0.2, 0.4]]]
    grid = sketch(lines)
    assert (len(grid.joints), len(grid.beams)) == (4, 4)
    assert len(sketch(lines, tolerance=0.01).joints) == 6


def test_a_line_that_ends_on_another_splits_it():
    grid = sketch([[[0, 0], [100, 0]], [[50, 60], [50, 0.4]]])
    assert len(grid.beams) == 3
    assert np.bincount(grid.beams.ravel()).max() == 3


def test_lines_drawn_twice_give_their_beams_once():
    line = [[0, 0], [50, 0], [100, 0]]
    assert len(sketch([line, line[::-1], [[0, 0], [100, 0]]]).beams) == 2


def test_a_closed_polyline():
    assert len(sketch([[[0, 0], [60, 0], [60, 60], [0, 60], [0, 0]]]).beams) == 4


@given(st.permutations(range(6)), st.integers(0, 63))
def test_the_order_of_the_lines_and_their_sense_do_not_matter(order, senses):
    lines = [[[-65, y], [65, y]] for y in (-65, 0, 65)] + [
        [[x, -65], [x, 65]] for x in (-65, 0, 65)
    ]
    mixed = [lines[k][:: -1 if senses >> k & 1 else 1] for k in order]
    assert edges(sketch(mixed)) == edges(sketch(lines))


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ([], "the sketch has no lines"),
        ([[[0, 0], [1, 0]], [[0, 0]]], "line 1 is not a list of two or more points"),
        ([[[0, 0, 0], [1, 0, 0]]], "line 0 is not a list of two or more points"),
        ([[[0, 0], [1]]], "line 0 is not a list of points"),
        ([[[0, 0], [np.nan, 0]]], "line 0 has a coordinate that is not a finite number"),
    ],
)
def test_what_is_no_line_is_named(lines, words):
    with pytest.raises(InputError, match=words):
        sketch(lines)

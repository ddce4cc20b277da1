"""The lattice, and the designs with a name, against the published lists of the 2x2 grid."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from simulearn.errors import InputError
from simulearn.grid import drop_beams, lattice, library, make

CELLS = st.tuples(st.integers(1, 6), st.integers(1, 6))


@pytest.mark.parametrize(
    ("name", "ratios"),
    [
        ("flat", {}),
        ("cone", {-0.5: [3, 5, 7, 8]}),
        ("saddle", {0.25: [0, 2, 5, 7, 10, 11], -1: [1, 3, 4, 6, 8, 9]}),
        ("developable", {-1: [0, 2, 5, 7, 10, 11]}),
    ],
)
def test_published_designs(name, ratios):
    expected = np.zeros(12)
    for ratio, beams in ratios.items():
        expected[beams] = ratio
    np.testing.assert_array_equal(make(name).actuators, expected)


def test_the_lattice_is_numbered_in_rows():
    grid = lattice((2, 2), 65.0)
    np.testing.assert_array_equal(
        grid.joints[[0, 2, 4, 8]], [[-65, -65], [65, -65], [0, 0], [65, 65]]
    )
    assert grid.beams.tolist() == [
        [0, 1], [0, 3], [1, 2], [1, 4], [2, 5], [3, 4],
        [3, 6], [4, 5], [4, 7], [5, 8], [6, 7], [7, 8],
    ]  # fmt: skip
    assert grid.fixed == 4


@given(CELLS, st.floats(10, 200))
def test_a_lattice_has_all_its_beams_and_its_fixed_joint_in_the_middle(cells, length):
    grid = lattice(cells, length)
    nx, ny = cells
    assert len(grid.beams) == nx * (ny + 1) + ny * (nx + 1)
    ends = grid.joints[grid.beams]
    np.testing.assert_allclose(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1), length)
    np.testing.assert_array_equal(grid.joints[grid.fixed], 0)
    away = np.linalg.norm(grid.joints - grid.joints.mean(axis=0), axis=1).round(9)
    assert away.argmin() == grid.fixed


@given(st.sampled_from(list(library())), CELLS)
def test_any_design_in_any_size(name, cells):
    grid = make(name, cells)
    assert set(grid.actuators * 4) <= set(range(-4, 5))


@given(CELLS)
def test_symmetric_designs_are_symmetric(cells):
    middle = lattice(cells, 1.0).joints[lattice(cells, 1.0).beams].mean(axis=1)
    middle -= middle.mean(axis=0)
    order = np.lexsort(middle.round(6).T)
    mirrored = np.lexsort((middle * [-1, 1]).round(6).T)
    for name in ("cone", "saddle", "developable", "dome", "bowl", "hammock"):
        ratios = make(name, cells).actuators
        np.testing.assert_array_equal(ratios[order], ratios[mirrored])
    ratios = make("twist", cells).actuators
    np.testing.assert_array_equal(ratios[order], -ratios[mirrored])


def test_each_design_says_what_it_becomes():
    assert len(library()) >= 8
    assert all(len(text) > 10 for text in library().values())
    assert len({make(name).actuators.tobytes() for name in library()}) == len(library())


def test_beams_are_dropped_and_joints_stay():
    grid = drop_beams(make("saddle"), {0, 11})
    assert (len(grid.joints), len(grid.beams), len(grid.actuators)) == (9, 10, 10)
    np.testing.assert_array_equal(grid.beams, lattice().beams[1:11])
    with pytest.raises(InputError, match="beam 12 is not there; beams are 0 to 11"):
        drop_beams(lattice(), [12])


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("pyramid",), 'design "pyramid" is not known; known are flat, cone, saddle'),
        (("flat", (0, 2)), r"cells is \(0, 2\)"),
        (("flat", (2, 1.5)), r"cells is \(2, 1.5\)"),
        (("flat", (2, 1000)), r"cells is \(2, 1000\)"),
        (("flat", (2, 2), 0.0), "length is 0; a beam is longer than 0 mm"),
        (("flat", (2, 2), float("nan")), "length is nan"),
    ],
)
def test_what_cannot_be_made_is_named(arguments, words):
    with pytest.raises(InputError, match=words):
        make(*arguments)

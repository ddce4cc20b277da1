"""A grid holds what it is given, or refuses it by key and place."""

import pickle
from fractions import Fraction

import numpy as np
import pytest
from grids import moved

from simulearn.errors import InputError
from simulearn.grid import Grid, clean, drop_beams, lattice, make

SQUARE = lattice((1, 1))
GOOD = {
    "joints": SQUARE.joints.tolist(),
    "beams": SQUARE.beams.tolist(),
    "actuators": [0.0, 0.5, -1, 0],
    "fixed": 0,
}
CYCLE: list = []
CYCLE.append(CYCLE)


@pytest.mark.parametrize(
    ("key", "value", "code", "where", "line"),
    [
        ("joints", [[0, 0, 5]] * 4, "joints-in-space", "joint 0",
         "joints[0] is [0, 0, 5]; joints are a list of [x, y], finite numbers in mm; z is not 0"),
        ("joints", np.eye(3), "joints-in-space", "joint 2", "joints[2] is [0.0, 0.0, 1.0]; "),
        ("joints", [[0, 0, 0], [0, 1, None]], "joint-place", "joint 1", "joints[1] is [0, 1, n"),
        ("joints", [[0, 0, 0, 0]], "joint-place", "joint 0", "joints[0] is [0, 0, 0, 0]; joints"),
        ("joints", [[0, 0], [1, 1], [2]], "joint-place", "joint 2", "joints[2] is [2]; "),
        ("joints", [0, 0, 1, 1], "joint-place", "joint 0", "joints[0] is 0; joints are"),
        ("joints", np.zeros((2, 2, 2)), "joint-place", "joint 0", "joints[0][0] is [0.0, 0.0]; "),
        ("joints", [[0, 0], [0, float("nan")]], "joint-place", "joint 1", "joints[1][1] is NaN; "),
        ("joints", [[0, 0], [-np.inf, 0]], "joint-place", "joint 1", "joints[1][0] is -Infinity"),
        ("joints", [[0, 0], ["1", 0]], "joint-place", "joint 1", 'joints[1][0] is "1"; joints'),
        ("joints", [[0, 0], [None, 0]], "joint-place", "joint 1", "joints[1][0] is null; joints"),
        ("joints", [[0, 1j]], "joint-place", "joint 0", "joints[0][1] is a complex; joints"),
        ("joints", 7, "joint-place", "joints", "joints is 7; joints are a list"),
        ("joints", "abc", "joint-place", "joints", 'joints is "abc"; joints are a list'),
        ("joints", [[0, 10**400]], "joint-place", "joint 0", "joints[0][1] is 1000"),
        ("joints", CYCLE, "joint-place", "joint 0", "joints[0] is a list; joints are"),
        ("beams", [[0.9, 1.7]], "beam-index", "beam 0", "beams[0][0] is 0.9; beams are a list"),
        ("beams", [[0, 1], [0, "2"]], "beam-index", "beam 1", 'beams[1][1] is "2"; beams are'),
        ("beams", [[0, 1, 2]], "beam-index", "beam 0", "beams[0] is [0, 1, 2]; beams are a list"),
        ("beams", [[False, True]], "beam-index", "beam 0", "beams[0][0] is false"),
        ("beams", [[0, 1e30]], "beam-index", "beam 0", "beams[0][1] is 1e+30; beams are"),
        ("beams", np.array([[0, 2**63]], np.uint64), "beam-index", "beam 0", "beams[0][1] is 9223"),
        ("beams", [[0, np.nan]], "beam-index", "beam 0", "beams[0][1] is NaN; beams are"),
        ("actuators", [0, 0, "full", 0], "actuator-ratio", "beam 2", 'actuators[2] is "full"; '),
        ("actuators", [[0, 0], [0, 0]], "actuator-ratio", "beam 0", "actuators[0] is [0, 0]; "),
        ("actuators", [0, np.nan, 0, 0], "actuator-ratio", "beam 1", "actuators[1] is NaN; "),
        ("actuators", [0, Fraction(1, 2)], "actuator-ratio", "beam 1", "actuators[1] is a Frac"),
        ("fixed", 0.99, "fixed-index", "grid", "fixed is 0.99; the fixed joint is an index"),
        ("fixed", "0", "fixed-index", "grid", 'fixed is "0"; the fixed joint'),
        ("fixed", None, "fixed-index", "grid", "fixed is null; the fixed joint"),
        ("fixed", True, "fixed-index", "grid", "fixed is true; the fixed joint"),
        ("fixed", [0], "fixed-index", "grid", "fixed is [0]; the fixed joint"),
        ("fixed", [[0], [1, 2]], "fixed-index", "grid", "fixed is [[0], [1, 2]]; the fixed joint"),
        ("fixed", 10**500, "fixed-index", "grid", "fixed is 1000"),
        ("material", 3, "material", "material", "material is 3; a material is the name"),
        ("material", "", "material", "material", 'material is ""; a material is the name'),
    ],
)  # fmt: skip
def test_what_is_not_a_grid_is_refused_by_key_and_place(key, value, code, where, line):
    with pytest.raises(InputError) as refused:
        Grid(**{**GOOD, key: value})
    assert str(refused.value).startswith(line)
    assert len(str(refused.value).splitlines()) == 1
    assert (refused.value.code, refused.value.where) == (code, where)


@pytest.mark.parametrize("make_index", [int, float, np.int32, np.uint8, np.float32])
def test_indices_may_be_floats_that_are_integers(make_index):
    beams = [[make_index(i), make_index(j)] for i, j in GOOD["beams"]]
    for some in (beams, np.array(beams), tuple(map(tuple, beams))):
        grid = Grid(GOOD["joints"], some, GOOD["actuators"], make_index(2))
        assert grid.beams.dtype == np.int64
        assert grid.beams.tolist() == GOOD["beams"]
        assert (grid.fixed, type(grid.fixed)) == (2, int)


def test_arrays_are_the_grids_own_and_cannot_be_written():
    joints = np.array(GOOD["joints"])
    grid = Grid(joints, GOOD["beams"], GOOD["actuators"], 0)
    joints[0] = 99
    assert grid.joints[0, 0] != 99
    for array in (grid.joints, grid.beams, grid.actuators):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


@pytest.mark.parametrize("none", [[], (), np.zeros((0, 2)), np.zeros(0, int)])
def test_a_grid_may_be_empty(none):
    grid = Grid(none, none, [], 0)
    assert (grid.joints.shape, grid.beams.shape, grid.actuators.shape) == ((0, 2), (0, 2), (0,))


def test_a_grid_goes_through_pickle():
    grid = pickle.loads(pickle.dumps(make("saddle")))
    assert grid.digest == make("saddle").digest


# Digest and support


def test_the_digest_is_the_same_on_every_machine():
    assert make("saddle").digest == (
        "aeade984409394422a601d441ab54664cbeda717dfb0b15564fd5016af38bc4c"
    )


def test_the_digest_is_that_of_the_contents():
    grid = make("saddle")
    assert moved(grid).digest == grid.digest
    negative = np.where(grid.joints == 0, -0.0, grid.joints)
    assert moved(grid, joints=negative).digest == grid.digest
    others = [
        moved(grid, joints=grid.joints + 1e-9),
        moved(grid, beams=grid.beams[:, ::-1]),
        moved(grid, actuators=-grid.actuators),
        moved(grid, fixed=3),
        Grid(grid.joints, grid.beams, grid.actuators, grid.fixed, "mine.toml"),
    ]
    assert len({grid.digest, *(other.digest for other in others)}) == 6


def test_what_is_held_is_the_lower_half_of_the_fixed_joint():
    support = moved(make("saddle"), fixed=3).support
    assert (support.joint, support.lower, support.upper) == (3, -0.5, 0.0)


# Nothing is done that need not be


def test_a_grid_that_is_clean_and_centred_is_returned_itself():
    grid = make("saddle")
    cleaned, removed = clean(grid)
    assert cleaned is grid
    assert removed == []
    assert grid.centred is grid


def test_a_grid_is_moved_once():
    grid = moved(make("saddle"), fixed=0)
    np.testing.assert_array_equal(grid.centred.joints, grid.joints - grid.joints[0])
    assert grid.centred is grid.centred
    assert grid.centred.centred is grid.centred


def test_a_long_chain_of_dangling_beams_is_taken_off():
    tail = 5000
    joints = np.r_[SQUARE.joints, np.c_[100.0 + 60 * np.arange(tail), np.zeros(tail)]]
    chain = [[k, k + 1] for k in range(3, 3 + tail)]
    grid = Grid(joints, [*GOOD["beams"], *chain], np.zeros(4 + tail), 0)
    cleaned, removed = clean(grid)
    assert (len(cleaned.joints), len(cleaned.beams), len(removed)) == (4, 4, tail)
    assert clean(drop_beams(grid, {4 + tail // 2}))[0].digest == cleaned.digest

"""Measured joints beside simulated ones: poses, numbers, mirrors, and what cannot be compared."""

import numpy as np
import printed
import pytest

from simulearn.compare import JointPlaces, compare, read_measurement
from simulearn.compare.deviation import without_motion
from simulearn.compare.doubts import exchanged
from simulearn.compare.matching import matches
from simulearn.compare.report import figures, write_joints
from simulearn.errors import InputError
from simulearn.grid import Grid

BASE = printed.shape()
EVERY = np.arange(9)


def measured(seed=1, numbers=EVERY, noise=0.0, **changes):
    places = printed.shape(printed.material(**changes)).centres[-1][numbers]
    places = places + noise * np.random.default_rng(seed).normal(size=places.shape)
    return JointPlaces(printed.moved(places, seed), np.asarray(numbers))


def compared(places, **more):
    return compare(BASE.grid, places, printed.Simulator(), explain=False, **more)


def codes(found):
    return [m.code for m in found.messages]


def test_a_moved_print_of_the_simulated_shape_is_off_by_nothing():
    found = compared(measured())
    assert found.deviation.distances == pytest.approx(0, abs=1e-9)
    assert found.messages == ()


def test_the_deviation_is_what_no_motion_removes():
    move = np.zeros((9, 3))
    move[8, 2] = 3.0
    found = compared(JointPlaces(printed.moved(BASE.centres[-1] + move, 3), EVERY))
    rest = without_motion(move.ravel(), BASE.centres[-1]).reshape(9, 3)
    assert found.deviation.moves == pytest.approx(rest, abs=0.1)
    assert found.deviation.worst == 8
    assert found.deviation.beams[:, 1].max() == pytest.approx(found.deviation.distances[8])


def test_the_middle_of_a_face_is_compared_with_the_middle_of_that_face():
    top = BASE.joints[-1][:, 4:].mean(axis=1)
    places = JointPlaces(printed.moved(top, 2), EVERY)
    assert compared(places, at="top").deviation.mean < 1e-9
    assert compared(places).deviation.mean > 0.05


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_joints_without_numbers_are_found_though_some_are_missing(seed):
    order = np.random.default_rng(seed).permutation(9)[:7]
    named = measured(seed, order, noise=0.2, strain=1.15)
    found = compared(JointPlaces(named.places))
    assert found.deviation.measured.nonzero()[0].tolist() == sorted(order)
    assert found.deviation.joints == pytest.approx(compared(named).deviation.joints, nan_ok=True)
    assert codes(found) == ["joints-missing"]


def test_a_symmetric_grid_fits_in_several_orientations():
    flat = np.array([[x, y, 0.0] for y in (0, 40, 80) for x in (0, 40, 80)])
    found = matches(printed.moved(flat, 4), flat)
    assert len(found) == 8  # the symmetries of a square, either side up
    assert {one.residual < 1e-6 for one in found} == {True}


@pytest.mark.parametrize("named", [True, False])
def test_a_mirrored_measurement_is_noticed(named):
    places = measured(2).places * [1, -1, 1]
    found = compared(JointPlaces(places, EVERY if named else None))
    assert codes(found) == ["pose-mirrored"]
    assert found.deviation.mean < 1e-6
    assert compared(measured(2)).messages == ()


def test_other_units_are_said():
    places = measured(2)
    found = compared(JointPlaces(places.places / 1000, EVERY))
    assert codes(found) == ["measurement-unit"]
    assert found.deviation.mean < 1e-6


@pytest.mark.parametrize(
    ("places", "words"),
    [
        (JointPlaces(BASE.centres[-1][:3], EVERY[:3]), "3 joints are measured; at least 4"),
        (JointPlaces(BASE.centres[-1], EVERY + 1), "joint 9 is not in the grid.*count from 1"),
        (JointPlaces(BASE.centres[-1][:4], np.array([0, 1, 2, 40])), "joint 40 is not in the grid"),
        (JointPlaces(np.c_[EVERY * 12.0, 0 * EVERY, 0 * EVERY], EVERY), "lie on a line"),
        (JointPlaces(BASE.centres[-1], np.roll(EVERY, 4)), "another grid.*with other numbers"),
    ],
)
def test_what_cannot_be_compared_is_refused(places, words):
    with pytest.raises(InputError, match=words):
        compared(places)


def test_a_grid_that_hardly_fits_is_warned_of():
    places = BASE.centres[-1] + np.random.default_rng(0).normal(size=(9, 3)) * 7.0
    assert "measurement-far" in codes(compared(JointPlaces(places, EVERY)))


def test_numbers_are_those_of_the_file_though_beams_that_dangle_are_taken_off(tmp_path):
    grid = BASE.grid
    joints = np.r_[[[-99.0, -99.0], [-60.0, -45.0]], grid.joints]
    whole = Grid(joints, np.r_[grid.beams + 2, [[1, 2]]], np.r_[grid.actuators, 0.0],
                 grid.fixed + 2)  # fmt: skip

    class Cleaning(printed.Simulator):
        def simulate(self, grids, progress=None, cancel=None):
            return [BASE]

    places = measured(1)
    extra = np.r_[[[1.0, 2.0, 3.0]], places.places]
    named = JointPlaces(extra, np.r_[1, EVERY + 2])
    found = compare(whole, named, Cleaning(), explain=False)
    assert codes(found) == ["measurement-unused"]
    assert found.deviation.mean < 1e-9
    assert found.joint_numbers.tolist() == [*range(2, 11)]
    assert found.beam_numbers.tolist() == [*range(12)]
    data = figures(found)
    assert [row["joint"] for row in data["joints"]] == [*range(2, 11)]
    assert data["worst_joint"] == found.deviation.worst + 2
    write_joints(found, tmp_path / "joints.csv")
    again = read_measurement(tmp_path / "joints.csv", 11)
    assert again.numbers.tolist() == [*range(2, 11)]
    assert compare(whole, again, Cleaning(), explain=False).deviation.mean < 1e-3


@pytest.mark.parametrize("move", [[0, 0, 40.0], [7.0, 0, 0]])
def test_one_joint_that_alone_is_off_is_named(move):
    places = BASE.centres[-1] + 0.2 * np.random.default_rng(0).normal(size=(9, 3))
    assert "joint-alone" not in codes(compared(JointPlaces(places, EVERY)))
    places[5] += move
    found = compared(JointPlaces(printed.moved(places, 1), EVERY))
    (alone,) = (m for m in found.messages if m.code == "joint-alone")
    assert alone.where == "joint 5"
    off = float(alone.message.split("off by ")[1].split(" mm")[0])
    assert off == pytest.approx(np.linalg.norm(move), abs=1.0)


def test_the_flat_grid_itself_is_noticed():
    flat = np.c_[BASE.grid.joints, np.zeros(9)]
    found = compared(JointPlaces(printed.moved(flat, 2), EVERY))
    assert "measurement-flat" in codes(found)
    assert "measurement-flat" not in codes(compared(measured(noise=0.5, strain=0.8)))


def test_two_joints_of_many_that_are_exchanged_are_named():
    every = np.arange(100)
    places = np.stack([20.0 * (every % 10), 20.0 * (every // 10), 0.1 * (every % 7) ** 2], axis=1)
    wrong = every.copy()
    wrong[[41, 42]] = 42, 41
    (message,) = exchanged(places, places, wrong, 270.0, every + 100)
    assert "as joints 141, 142 for 142, 141" in message.message
    assert exchanged(places, places, every, 270.0, every) == []

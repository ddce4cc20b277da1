"""Results know their collisions: by every engine, in files, in words and in pictures."""

import dataclasses

import numpy as np
import pytest

import synthetic
from simulearn.collisions import Collision
from simulearn.errors import InputError
from simulearn.grid import library, make
from simulearn.show.deformed import deformed, qualified
from simulearn.simulate import (
    engine,
    read_json,
    read_npz,
    result_from_dict,
    result_to_dict,
    summary,
    write_json,
    write_npz,
)
from simulearn.simulate.colliding import (
    collision_place,
    collision_warnings,
    sections_of,
    with_collisions,
)
from simulearn.simulate.engines import Engine

ONE = Collision(("beam 3", "joint 7"), 9, 0.25, 10, 1.25, (1.0, -2.0, 3.5))

UP = np.array([0.0, 0.0, 1.0])


def coiled(p, s):
    """Roll points up so far that the ends of the grid pass each other."""
    return synthetic.cylinder(p, s, 0.055)


def test_an_engine_warns_of_collisions():
    def solver(grid, material, *, progress, cancel):
        return synthetic.result(grid, coiled)

    (result,) = Engine("fea", solver).simulate([synthetic.square_grid((3, 1))])
    assert result.collisions
    assert result.collisions[0].depth_mm == max(one.depth_mm for one in result.collisions)
    message = result.warnings[-1]
    assert message.code == "beams-pass"
    assert message.where == result.collisions[0].parts[0]
    first = min(one.first for one in result.collisions)
    assert 5 < first < 11
    assert f"from frame {first} on the shape is not to be believed" in message.message


@pytest.mark.parametrize(
    ("bound", "said"),
    [(None, ""), (0.2, ""), (0.8, "; 1 of 2 less deep than the shape may be off (0.8 mm)"),
     (2.0, "; all less deep than the shape may be off (2.0 mm)")],
)  # fmt: skip
def test_a_warning_says_which_collisions_may_not_happen(bound, said):
    two = ONE, dataclasses.replace(ONE, parts=("beam 1", "beam 2"), depth_mm=0.4)
    (message,) = collision_warnings(two, bound)
    assert message.message.endswith("may not happen") == bool(said)
    assert said in message.message


def test_the_solid_is_followed_where_there_is_one():
    result = synthetic.result(bend=synthetic.cylinder)
    along = sections_of(result)
    assert along.shape[2] == 81
    assert np.allclose(along[:, :, [0, 40, 80]], result.beams, atol=1e-6)
    without = dataclasses.replace(result, solid=None)
    assert sections_of(without) is result.beams


@pytest.mark.parametrize("name", sorted(library()))
def test_no_grid_of_the_library_collides(name):
    (result,) = engine("learned").simulate([make(name)])
    assert result.collisions == ()


def test_files_keep_collisions(tmp_path):
    result = dataclasses.replace(synthetic.result(), collisions=(ONE,))
    write_json(result, tmp_path / "a.json")
    write_npz(result, tmp_path / "a.npz")
    assert read_json(tmp_path / "a.json").collisions == (ONE,)
    assert read_npz(tmp_path / "a.npz").collisions == (ONE,)
    assert summary(result)["collisions"][0]["depth_mm"] == 1.25
    data = result_to_dict(result)
    del data["collisions"]  # files of earlier versions have none
    assert result_from_dict(data).collisions == ()
    for wrong in (3, [3], [{"parts": ["beam 3"]}]):
        with pytest.raises(InputError, match="collisions: is not a list"):
            result_from_dict({**data, "collisions": wrong})


def test_the_place_goes_along_with_the_part():
    result = synthetic.result(bend=synthetic.cylinder)
    middle = result.beams[-1, 3, 1].mean(axis=0)
    one = dataclasses.replace(ONE, frame=11, share=0.0, place=tuple(middle + UP))
    assert np.allclose(collision_place(result, one, -1), one.place)
    there = result.beams[0, 3, 1].mean(axis=0) + UP
    assert np.allclose(collision_place(result, one, 0), there)


def test_pictures_say_and_mark_it():
    result = with_collisions(synthetic.result(synthetic.square_grid((3, 1)), coiled))
    assert qualified(result)[0].startswith("collides: ")

    def rings(frame):
        lines = [line for ax in deformed(result, frame).axes for line in ax.lines]
        return [line for line in lines if line.get_marker() == "o"]

    assert len(rings(-1)) == len(result.collisions)
    assert not rings(2)

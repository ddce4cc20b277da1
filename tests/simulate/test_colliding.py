"""Beams that run through each other are told; neighbours and beams that only come near are not."""

import numpy as np
import pytest

import synthetic
from simulearn.grid import lattice, make
from simulearn.material import load_material
from simulearn.simulate.engines import Engine
from simulearn.simulate.passing import passing


def straight(*axes):
    """Return sections (B, 3, 4, 3) of straight beams without width, from start to end."""
    ends = np.array(axes, float)
    middle = ends.mean(axis=1, keepdims=True)
    return np.concatenate([ends[:, :1], middle, ends[:, 1:]], axis=1)[:, :, None].repeat(4, axis=2)


APART = np.array([[0, 1], [2, 3]])


@pytest.mark.parametrize(("gap", "told"), [(0.0, True), (3.0, True), (4.5, False)])
@pytest.mark.parametrize("copies", [1, 200])
def test_two_beams_across_each_other(gap, told, copies):
    two = straight([[0, 0, 0], [60, 0, 0]], [[33, -20, gap], [33, 41, gap]])
    apart = 1000.0 * np.arange(copies)[:, None, None, None, None]
    many = (two[None] + apart * [1, 0, 0]).reshape(-1, 3, 4, 3)
    ends = np.concatenate([APART + 4 * k for k in range(copies)])
    (messages,) = passing(many[None], ends, 4.0)
    assert bool(messages) == told
    if told:
        (message,) = messages
        assert (message.code, message.where) == ("beams-pass", "beam 0")
        assert "run through each other (0 and 1" in message.message
        assert ("195 more pairs" in message.message) == (copies == 200)


def test_beams_of_one_joint_are_not_compared():
    two = straight([[0, 0, 0], [60, 0, 0]], [[60, 0, 0], [0, 0, 1]])
    assert passing(two[None], np.array([[0, 1], [1, 2]]), 4.0) == [()]


def test_curled_beams_are_followed():
    """A beam that curls up around another passes nowhere near its own chord."""
    arch = straight([[0, 0, 0], [60, 0, 0]])
    arch[:, 1, :, 2] += 30.0
    over = straight([[30, -20, 30], [30, 20, 30]])
    under = straight([[30, -20, 0], [30, 20, 0]])
    assert passing(np.concatenate([arch, over])[None], APART, 4.0)[0]
    assert not passing(np.concatenate([arch, under])[None], APART, 4.0)[0]


def test_no_library_grid_passes_through_itself_flat():
    flat = lattice((3, 3))
    sections = synthetic.result(flat).beams[0]
    assert passing(sections[None], flat.beams, 4.0) == [()]


def test_the_engine_tells_it():
    def solver(grid, material, *, progress, cancel):
        trial = synthetic.result(grid)
        trial.beams[-1] *= 1e-3  # everything at one place
        return trial

    (result,) = Engine("fea", solver).simulate([make("cone")])
    assert result.warnings[-1].code == "beams-pass"
    assert load_material("pla-hot-water").section.thickness == 4.0

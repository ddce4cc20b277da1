"""What every engine does alike: validation before, the Result after, progress meanwhile."""

import dataclasses

import numpy as np
import pytest

import synthetic
from simulearn.errors import InputError
from simulearn.grid import Grid, grid_to_dict, make
from simulearn.simulate import ENGINES, Result, engine, summary
from simulearn.simulate.engines import Engine


def recording():
    """An engine by formula, and the grids that it solves."""
    solved = []

    def solver(grid, material, progress):
        solved.append((grid, material))
        for frame in range(12):
            progress(frame + 1, 12)
        return synthetic.result(grid)

    return Engine("formula", solver), solved


def test_results_come_in_the_order_of_the_grids_and_name_their_engine():
    simulator, solved = recording()
    grids = [make("saddle"), make("cone", (1, 2)), make("flat", (1, 1))]
    results = simulator.simulate(grids)
    assert [len(r.grid.joints) for r in results] == [9, 6, 4]
    assert all(isinstance(r, Result) and r.engine == "formula" for r in results)
    assert [m.name for _, m in solved] == ["pla-hot-water"] * 3


def test_the_fixed_joint_becomes_the_origin_and_dangling_beams_go():
    simulator, solved = recording()
    flat = make("flat", (1, 1))
    tail = Grid(
        [*(flat.joints + np.array([7, 9])).tolist(), [-100, 9]],
        [*flat.beams.tolist(), [0, 4]],
        [*flat.actuators, 1.0],
        flat.fixed,
    )
    (result,) = simulator.simulate([tail])
    assert len(result.grid.joints) == len(result.grid.beams) == 4
    np.testing.assert_array_equal(result.grid.joints[result.grid.fixed], [0, 0])
    assert result.grid is solved[0][0]


def test_all_grids_are_checked_before_the_first_is_solved():
    simulator, solved = recording()
    wrong = make("saddle")
    wrong = dataclasses.replace(wrong, joints=wrong.joints * 0.1)
    with pytest.raises(InputError) as error:
        simulator.simulate([make("saddle"), wrong])
    assert len(str(error.value).splitlines()) == 1
    assert "simulearn validate" in str(error.value)
    assert not solved
    with pytest.raises(InputError, match="unobtainium"):
        simulator.simulate([make("flat", material="unobtainium")])


def test_progress_runs_over_the_frames_of_all_grids():
    simulator, _ = recording()
    told = []
    simulator.simulate([make("flat", (1, 1))] * 2, lambda done, total: told.append((done, total)))
    assert told == [(k, 24) for k in range(1, 25)]


def test_engines_are_known_by_name():
    assert list(ENGINES) == ["fea", "calculix", "beams", "learned"]
    for name in ENGINES:
        assert engine(name).name == name
    with pytest.raises(InputError, match="known are fea, calculix, beams, learned"):
        engine("abaqus")


def test_a_summary_has_the_numbers_one_asks_for_first():
    result = synthetic.result(synthetic.square_grid((2, 2), 65.0))
    numbers = summary(result)
    assert numbers["dimension_mm"] == pytest.approx(65 * 2**0.5)
    rise = result.centres[-1, :, 2]
    assert abs(numbers["rise_mm"]) == pytest.approx(abs(rise).max(), abs=1e-6)
    assert rise[numbers["joint_risen"]] == pytest.approx(numbers["rise_mm"], abs=1e-6)
    z = np.concatenate([result.joints[-1].reshape(-1, 3), result.beams[-1].reshape(-1, 3)])[:, 2]
    assert (numbers["lowest_mm"], numbers["highest_mm"]) == pytest.approx((z.min(), z.max()))
    assert (numbers["iterations"], numbers["seconds"]) == (33, 1.25)
    without = dataclasses.replace(result, record={})
    assert "iterations" not in summary(without)
    assert grid_to_dict(without.grid) == grid_to_dict(result.grid)

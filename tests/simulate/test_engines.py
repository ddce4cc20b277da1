"""What every engine does alike: validation before, the Result after, progress meanwhile."""

import ast
import dataclasses
import re
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import simulearn
import synthetic
from simulearn.errors import CancelledError, ComputationError, InputError, Message, stop_if
from simulearn.grid import Grid, grid_to_dict, make
from simulearn.material import load_material
from simulearn.material.reading import HERE
from simulearn.schedule import Snap
from simulearn.simulate import (
    ENGINES,
    Result,
    engine,
    failure_to_dict,
    one,
    remarks,
    results,
    summary,
)
from simulearn.simulate.engines import Engine


def recording():
    """An engine by formula, and the grids that it solves."""
    solved = []

    def solver(grid, material, progress, cancel):
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


def test_nine_good_answers_survive_the_tenth():
    def solver(grid, material, progress, cancel):
        if grid.actuators[0] == 0.5:
            raise ComputationError("frame 3 of 11: no equilibrium", "no-equilibrium", "frame 3")
        return synthetic.result(grid)

    flat = make("flat", (1, 1))
    grids = [flat] * 10
    grids[4] = dataclasses.replace(flat, actuators=[0.5, 0, 0, 0])
    outcomes = Engine("formula", solver).simulate(grids)
    assert [isinstance(outcome, Result) for outcome in outcomes] == [k != 4 for k in range(10)]
    failure = outcomes[4]
    assert (failure.code, failure.where) == ("no-equilibrium", "frame 3")
    assert failure.grid is grids[4]
    assert failure_to_dict(failure) == {
        "schema": "simulearn.failure/1",
        "code": "no-equilibrium",
        "where": "frame 3",
        "message": "frame 3 of 11: no equilibrium",
        "hint": "",
    }
    with pytest.raises(ComputationError, match="no equilibrium") as error:
        results(outcomes)
    assert error.value.code == "no-equilibrium"


def test_a_design_that_is_not_valid_fails_in_its_place_and_says_all_that_is_wrong():
    simulator, solved = recording()
    saddle = make("saddle")
    small = dataclasses.replace(saddle, joints=saddle.joints * 0.12)
    strange = make("flat", (1, 1), material="unobtainium")
    good, wrong, other = simulator.simulate([saddle, small, strange])
    assert isinstance(good, Result)
    assert len(solved) == 1
    assert len(wrong.message.splitlines()) == 1
    assert "more errors" in wrong.message
    with pytest.raises(InputError) as error:
        one(wrong)
    assert error.value.code == wrong.code == wrong.invalid[0].code
    assert error.value.messages == wrong.invalid
    assert len(wrong.invalid) > 1
    assert other.code == "material-unknown"
    with pytest.raises(InputError, match="unobtainium"):
        one(other)
    assert one(good) is good


def test_a_failure_of_an_unusual_design_hints_at_that():
    def solver(grid, material, progress, cancel):
        raise ComputationError("no equilibrium")

    (failure,) = Engine("formula", solver).simulate([make("flat", (1, 1), 130.0)])
    assert "130.00 mm long" in failure.hint


def test_no_message_speaks_of_switches():
    package = Path(simulearn.__file__).parent
    for part in ("simulate", "inverse", "grid", "fea", "show", "interop"):
        for file in (package / part).rglob("*.py"):
            for node in ast.walk(ast.parse(file.read_text("utf-8"))):
                if isinstance(node, ast.Constant) and isinstance(node.value, str):
                    assert not re.search(r"(^|\s)--[a-z]|`simulearn ", node.value), (
                        file,
                        node.value,
                    )


def test_an_answer_carries_what_qualifies_it():
    mirror = Message("mirrored", "grid", "a mirrored shape is as likely")

    def solver(grid, material, progress, cancel):
        shape = synthetic.result(grid)
        return dataclasses.replace(shape, stable=False, snaps=(Snap(0.94, 10),), warnings=(mirror,))

    (result,) = Engine("formula", solver).simulate([make("saddle", length=120)])
    assert not result.stable
    assert result.snaps == (Snap(0.94, 10),)
    assert [m.code for m in result.warnings] == ["beam-long"] * 12 + ["mirrored"]
    assert result.material == load_material("pla-hot-water").identity
    assert result.model is None
    lines = remarks(result)
    assert "unstable balance" in lines[0]
    assert "snaps at 94.0%" in lines[1]
    numbers = summary(result)
    assert numbers["stable"] is False
    assert numbers["snaps"] == [{"released": 0.94, "frame": 10}]
    assert len(numbers["warnings"]) == 13


def test_a_token_stops_within_a_frame():
    token, frames = threading.Event(), []

    def solver(grid, material, progress, cancel):
        for frame in range(12):
            stop_if(cancel)
            frames.append(frame)
            progress(frame + 1, 12)
            if frame == 3:
                token.set()
        return synthetic.result(grid)

    with pytest.raises(CancelledError):
        Engine("formula", solver, workers=1).simulate([make("flat", (1, 1))] * 3, cancel=token)
    assert frames == [0, 1, 2, 3]
    with pytest.raises(CancelledError):
        Engine("formula", solver).simulate([make("flat", (1, 1))] * 3, cancel=token)
    assert frames == [0, 1, 2, 3]


def test_outcomes_stream_as_they_come_and_leaving_early_stops_the_others():
    begun, go_on = [], threading.Event()

    def solver(grid, material, progress, cancel):
        begun.append(grid)
        if len(begun) > 1:
            while not cancel.is_set() and not go_on.is_set():
                time.sleep(0.001)
            stop_if(cancel)
        return synthetic.result(grid)

    stream = Engine("formula", solver, workers=2).stream([make("flat", (1, 1))] * 20)
    _, outcome = next(stream)
    assert isinstance(outcome, Result)
    stream.close()
    assert len(begun) < 20


def test_progress_runs_over_the_frames_of_all_grids():
    simulator, _ = recording()
    reported = []
    simulator.simulate(
        [make("flat", (1, 1))] * 2, lambda done, total: reported.append((done, total))
    )
    assert reported == [(k, 24) for k in range(1, 25)]


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


@pytest.fixture(scope="module")
def cell():
    """A single cell by finite elements."""
    return make("twist", (1, 1), 45.0)


def test_an_edited_material_changes_the_next_answer(cell, tmp_path):
    text = (HERE / "pla-hot-water.toml").read_text("utf-8")
    path = tmp_path / "mine.toml"
    path.write_text(text, "utf-8")
    grid = dataclasses.replace(cell, material=str(path))
    simulator = engine("fea")
    (named, heavy) = results(simulator.simulate([cell, grid]))
    np.testing.assert_array_equal(heavy.joints, named.joints)
    assert heavy.material == named.material
    path.write_text(text.replace("acceleration = 2182", "acceleration = 0"), "utf-8")
    light = one(simulator.simulate([grid])[0])
    assert abs(light.centres[-1] - heavy.centres[-1]).max() > 0.1
    assert light.material.digest != heavy.material.digest
    # Without gravity the flat frame loaded by nothing stays where it is, and creep does nothing.
    np.testing.assert_allclose(light.joints[-1], light.joints[-2], atol=1e-3)
    # The learned engine has learnt the family that it is of.
    learnt = one(engine("learned").simulate([grid])[0])
    assert learnt.material == light.material
    away = np.linalg.norm(learnt.centres[-1] - light.centres[-1], axis=1)
    assert away.mean() < 0.02 * cell.dimension
    # Four times the strain is far outside: it refuses that, says in what, and names both.
    path.write_text(text.replace("active = 0.09261", "active = 0.37"), "utf-8")
    (refused,) = engine("learned").simulate([grid])
    assert refused.code == "material-not-learnt"
    assert "strain of the active half is 0.37, learnt 0.05" in refused.message
    assert engine("learned").material.digest[:12] in refused.message
    # A little outside it answers, and says so.
    path.write_text(text.replace("active = 0.09261", "active = 0.14"), "utf-8")
    near = one(engine("learned").simulate([grid])[0])
    assert "material-beyond" in {message.code for message in near.warnings}
    assert near.bound_mm > learnt.bound_mm


def test_threads_and_one_after_the_other_give_the_same_bits(cell):
    grids = [cell, dataclasses.replace(cell, actuators=-cell.actuators), cell]
    simulator = engine("fea")
    alone = results(dataclasses.replace(simulator, workers=1).simulate(grids))
    together = results(dataclasses.replace(simulator, workers=3).simulate(grids))
    for a, b in zip(alone, together, strict=True):
        np.testing.assert_array_equal(a.joints, b.joints)
        assert a.record == b.record


def test_a_token_stops_finite_elements(cell):
    token, frames = threading.Event(), []

    def progress(done, total):
        frames.append(done)
        token.set()

    with pytest.raises(CancelledError):
        engine("fea").simulate([cell], progress, token)
    assert len(frames) == 1

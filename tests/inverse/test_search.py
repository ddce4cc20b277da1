"""One search: limits, interrupts, going on, checks and corrections; engines are pretended."""

import dataclasses
import threading
import time

import numpy as np
import pytest
from toys import alone, toy

from simulearn.errors import CancelledError, ComputationError, InputError
from simulearn.grid import Rules, draw_valid, grid_to_dict, make
from simulearn.inverse import Goals, Past, optimize, search, task_from_dict
from simulearn.inverse.keeping import identity, read_past, write_past
from simulearn.inverse.reach import out_of_reach
from simulearn.material import load_material
from simulearn.simulate import Failure, Result


class Pretended:
    """An engine that answers by the toy, and is mistaken by a constant."""

    def __init__(self, name, mistake=0.0, bound=None):
        self.name, self.mistake, self.bound = name, mistake, bound

    def simulate(self, grids, progress=None, cancel=None):
        return [self._one(grid) for grid in grids]

    def _one(self, grid):
        centres = toy(alone(grid))[0] + [0, 0, self.mistake]
        return Result(
            grid=grid,
            engine=self.name,
            joints=np.repeat(centres[:, None], 8, axis=1)[None],
            beams=np.zeros((1, len(grid.beams), 3, 4, 3)),
            stress=None,
            seconds=0.0,
            material=load_material(grid.material).identity,
            bound_mm=self.bound,
        )


class Silent(Pretended):
    """An engine without an answer."""

    def _one(self, grid):
        return Failure(grid, "no-equilibrium", "frame 3", "did not converge")


@pytest.fixture
def task():
    wanted = toy(alone(draw_valid(Rules(), 701, 2)[0]))[0]
    return task_from_dict(
        {
            "schema": "simulearn.task/1",
            "grid": grid_to_dict(make("flat", length=60.0)),
            "goals": [
                {"vertex": ["joint", k, "centre"], "target": place.tolist()}
                for k, place in enumerate(wanted)
            ],
            "method": "brute-force",
            "engine": "beams",
            "limits": {"iterations": 4, "seconds": 20.0, "corrections": 0},
        }
    )


@pytest.fixture
def engines(monkeypatch):
    """Put pretended engines in place of real ones."""

    def put(mistake=0.0, bound=None):
        monkeypatch.setattr(
            search, "engine_of", lambda name, model=None: Pretended(name, mistake, bound)
        )
        monkeypatch.setattr("simulearn.inverse.checking.engine", lambda name, mesh: Pretended(name))

    monkeypatch.setattr(search, "warm", lambda engine: None)
    put()
    return put


def limited(task, **limits):
    return task.model_copy(update={"limits": task.limits.model_copy(update=limits)})


def test_iterations_are_limited_and_reported(task, engines):
    steps = []
    found = optimize(task, progress=steps.append)
    assert found.iterations == 4
    assert tuple(steps) == found.steps
    assert [step.iteration for step in steps] == [0, 1, 2, 3, 4]
    errors = [step.error_mm for step in steps]
    assert errors == sorted(errors, reverse=True)
    assert found.designs == steps[-1].designs > 4 * 60
    assert found.error_mm == pytest.approx(found.check.error_fea_mm)
    assert found.check.agrees is None


def test_time_is_limited(task, engines):
    found = optimize(limited(task, seconds=1e-3, iterations=1000))
    assert found.iterations < 4
    assert not found.interrupted


def test_an_engine_may_be_given(task, engines):
    found = optimize(task, engine=Pretended("mine", mistake=1.0))
    assert found.check.apart_mm == pytest.approx(1.0)


def test_a_token_stops_within_an_iteration_and_keeps_the_best(task, engines):
    token, counted = threading.Event(), []

    class Counting(Pretended):
        def simulate(self, grids, progress=None, cancel=None):
            counted.append(len(grids))
            if len(counted) == 3:
                token.set()
            return super().simulate(grids)

    found = optimize(limited(task, iterations=1000), engine=Counting("mine"), cancel=token)
    assert found.interrupted
    assert found.check is None
    assert len(counted) == 3
    assert found.error_mm == min(step.error_mm for step in found.steps)


def test_a_token_stops_the_check_too(task, engines, monkeypatch):
    token = threading.Event()

    class Slow(Pretended):
        def simulate(self, grids, progress=None, cancel=None):
            token.set()
            if cancel.is_set():
                raise CancelledError
            pytest.fail("went on")

    monkeypatch.setattr("simulearn.inverse.checking.engine", lambda name, mesh: Slow(name))
    found = optimize(task, cancel=token)
    assert found.interrupted
    assert found.error_mm == found.steps[-1].error_mm


def test_a_check_that_takes_too_long_is_given_up(task, engines, monkeypatch):
    class Endless(Pretended):
        def simulate(self, grids, progress=None, cancel=None):
            while not cancel.is_set():
                pass
            raise CancelledError

    monkeypatch.setattr("simulearn.inverse.checking.engine", lambda name, mesh: Endless(name))
    monkeypatch.setattr(search, "GRACE", 0.01)
    found = optimize(limited(task, seconds=0.01))
    assert not found.interrupted
    assert "time was over" in found.check.why
    assert found.check.error_fea_mm is None


def test_an_interrupt_keeps_the_best_and_the_search_goes_on(task, engines, tmp_path):
    steps = []

    def progress(step):
        steps.append(step)
        if step.iteration == 2:
            raise KeyboardInterrupt

    found = optimize(task, progress=progress)
    assert found.interrupted
    assert found.check is None
    assert found.error_mm == steps[-1].error_mm
    np.testing.assert_array_equal(found.grid.joints, steps[-1].joints)

    name = identity(task, None)
    write_past(tmp_path, name, steps)
    before = read_past(tmp_path, name)
    assert list(before.steps) == steps
    again = optimize(task, before=before)
    at_once = optimize(task)
    assert [s.error_mm for s in again.steps] == pytest.approx([s.error_mm for s in at_once.steps])
    assert again.seconds > steps[-1].seconds
    lines = (tmp_path / "history.csv").read_text().splitlines()
    assert lines[0] == "iteration,phase,seconds,designs,error_mm,words"
    assert len(lines) == 1 + len(steps)


def test_a_folder_with_another_search_is_refused(task, tmp_path):
    write_past(tmp_path, "another", [])
    with pytest.raises(InputError, match="is the search of another task"):
        read_past(tmp_path, identity(task, None))
    (tmp_path / "search.json").write_text("{")
    with pytest.raises(InputError, match="is damaged"):
        read_past(tmp_path, identity(task, None))
    longer = limited(task, seconds=99.0)
    assert identity(longer, None) == identity(task, None) != identity(task, "paper")


def test_corrected_targets_take_the_engines_mistake_away(task, engines):
    engines(mistake=4.0, bound=1.0)
    plain = optimize(task)
    assert plain.check.agrees is False
    assert plain.check.apart_mm == pytest.approx(4.0)
    corrected = optimize(limited(task, iterations=6, corrections=2))
    assert corrected.steps[-1].phase >= 1
    assert corrected.check.error_fea_mm < plain.check.error_fea_mm
    assert {step.phase for step in corrected.steps} <= {0, 1, 2}


def test_where_both_agree_nothing_is_corrected(task, engines):
    engines(mistake=0.05, bound=1.0)
    found = optimize(limited(task, corrections=2))
    assert found.check.agrees is True
    assert found.steps[-1].phase == 0


def test_a_search_goes_on_with_its_checks_in_mind(task, engines, tmp_path):
    engines(mistake=4.0, bound=1.0)
    first = optimize(limited(task, iterations=6, corrections=2))
    assert len(first.checks) > 1
    write_past(tmp_path, "name", first.steps, first.checks)
    past = read_past(tmp_path, "name")
    for one, other in zip(past.checks, first.checks, strict=True):
        assert one.error_fea_mm == pytest.approx(other.error_fea_mm)
        np.testing.assert_allclose(one.shift, other.shift)
    again = optimize(limited(task, iterations=7, corrections=2), before=past)
    assert again.steps[len(first.steps)].phase == first.steps[-1].phase
    assert again.check.error_fea_mm <= first.check.error_fea_mm
    # A later check that is worse does not replace an earlier one.
    better = dataclasses.replace(past.checks[0], error_fea_mm=0.0)
    kept = optimize(task, before=Past(past.steps, (better,)))
    assert kept.check.error_fea_mm == 0.0
    np.testing.assert_array_equal(kept.grid.joints, better.grid.joints)


def test_finite_elements_without_an_answer_are_reported(task, engines, monkeypatch):
    monkeypatch.setattr("simulearn.inverse.checking.engine", lambda name, mesh: Silent(name))
    found = optimize(task)
    assert found.check.error_fea_mm is None
    assert found.check.why == "did not converge"
    assert found.check.agrees is None
    assert found.error_mm == pytest.approx(found.steps[-1].error_mm, rel=1e-12)


def test_a_rollout_without_an_answer_does_not_end_a_search(task, engines):
    class LastFrameOnly(Pretended):
        """Answers while it is searched, and not when the best design is checked."""

        searched = False

        def _one(self, grid):
            return Silent._one(self, grid) if self.searched else super()._one(grid)

    engine = LastFrameOnly("mine", bound=1.0)

    def progress(step):
        engine.searched = step.iteration == task.limits.iterations

    found = optimize(task, engine=engine, progress=progress)
    assert found.check.result is None
    assert found.check.bound_mm is None
    assert found.check.error_fea_mm == pytest.approx(found.error_mm)
    assert found.check.shape is found.check.fea


def test_a_start_without_an_answer_is_an_error(task):
    with pytest.raises(ComputationError, match="no answer for the design to begin with"):
        optimize(task, engine=Silent("mine"))


@pytest.mark.parametrize(
    ("scale", "code"), [(0.7, None), (1e-3, "targets-tiny"), (10.0, "target-far")]
)
def test_targets_out_of_reach_are_named(task, engines, scale, code):
    goals = task.aims
    messages = out_of_reach(
        task.start, Goals.of(goals.vertices, scale * goals.targets, goals.weights)
    )
    assert {message.code for message in messages} == ({code} if code else set())
    warnings = optimize(task).warnings
    assert warnings[:-1] == tuple(out_of_reach(task.start, goals))
    assert warnings[-1].code == "nothing-near"


@pytest.mark.parametrize(
    ("scale", "words"),
    [
        (0.7, None),
        (1e-3, "they are probably in another unit"),
        (10.0, "they lie farther away than the beams reach"),
    ],
)
def test_a_warning_says_that_nothing_comes_near_and_why(task, engines, scale, words):
    goals = [
        goal.model_copy(update={"target": [scale * x for x in goal.target]}) for goal in task.goals
    ]
    found = optimize(task.model_copy(update={"goals": goals}))
    messages = [message.message for message in found.warnings if message.code == "nothing-near"]
    assert len(messages) == (words is not None)
    if words:
        assert words in messages[0]
        assert f"({found.error_mm:.0f} mm are left)" in messages[0]
    if scale < 0.1:
        assert "if they are in metres, multiply them by 1000" in found.warnings[0].message


def test_getting_ready_counts_but_leaves_half_of_the_time(task, engines, monkeypatch):
    monkeypatch.setattr(search, "warm", lambda engine: time.sleep(0.3))
    assert optimize(limited(task, seconds=20.0)).seconds > 0.3
    assert optimize(limited(task, seconds=0.2)).steps[0].seconds == pytest.approx(0.1, abs=0.05)


def test_what_is_not_known_is_named(task):
    with pytest.raises(InputError, match='method "magic" is not known; known are default'):
        optimize(task.model_copy(update={"method": "magic"}))
    with pytest.raises(InputError, match='engine "magic" is not known'):
        optimize(task.model_copy(update={"engine": "magic"}))

"""One search: limits, interrupts, going on, checks and corrections; engines are pretended."""

from types import SimpleNamespace

import numpy as np
import pytest
from toys import alone, toy

from simulearn.errors import ComputationError, InputError
from simulearn.grid import Rules, draw_valid, grid_to_dict, make
from simulearn.inverse import optimize, search, task_from_dict
from simulearn.inverse.keeping import identity, read_steps, write_steps


class Pretended:
    """An engine that answers by the toy, and is mistaken by a constant."""

    def __init__(self, name, mistake=0.0, bound=None):
        self.name, self.mistake, self.bound = name, mistake, bound

    def simulate(self, grids, progress=None):
        results = []
        for grid in grids:
            centres = toy(alone(grid))[0] + [0, 0, self.mistake]
            joints = np.repeat(centres[:, None], 8, axis=1)[None]
            record = {} if self.bound is None else {"bound_mm": self.bound}
            beams = np.zeros((1, len(grid.beams), 3, 4, 3))
            results.append(SimpleNamespace(joints=joints, beams=beams, record=record))
        return results


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
            search, "engine", lambda name, model=None: Pretended(name, mistake, bound)
        )
        monkeypatch.setattr("simulearn.inverse.checking.engine", lambda name: Pretended(name))

    put()
    return put


def limited(task, **limits):
    return task.model_copy(update={"limits": task.limits.model_copy(update=limits)})


def test_iterations_are_limited_and_told(task, engines):
    told = []
    found = optimize(task, tell=told.append)
    assert found.iterations == 4
    assert tuple(told) == found.steps
    assert [step.iteration for step in told] == [0, 1, 2, 3, 4]
    errors = [step.error_mm for step in told]
    assert errors == sorted(errors, reverse=True)
    assert found.designs == told[-1].designs > 4 * 60
    assert found.error_mm == pytest.approx(found.check.error_fea_mm)
    assert found.check.agrees is None


def test_time_is_limited(task, engines):
    found = optimize(limited(task, seconds=0.5, iterations=1000))
    assert found.seconds < 5
    assert not found.interrupted


def test_an_interrupt_keeps_the_best_and_the_search_goes_on(task, engines, tmp_path):
    steps = []

    def tell(step):
        steps.append(step)
        if step.iteration == 2:
            raise KeyboardInterrupt

    found = optimize(task, tell=tell)
    assert found.interrupted
    assert found.check is None
    assert found.error_mm == steps[-1].error_mm
    np.testing.assert_array_equal(found.grid.joints, steps[-1].joints)

    name = identity(task, None)
    write_steps(tmp_path, name, steps)
    before = read_steps(tmp_path, name)
    assert before == steps
    again = optimize(task, before=tuple(before))
    whole = optimize(task)
    assert [s.error_mm for s in again.steps] == pytest.approx([s.error_mm for s in whole.steps])
    assert again.seconds > steps[-1].seconds
    lines = (tmp_path / "history.csv").read_text().splitlines()
    assert lines[0] == "iteration,phase,seconds,designs,error_mm,words"
    assert len(lines) == 1 + len(steps)


def test_a_folder_with_another_search_is_refused(task, tmp_path):
    write_steps(tmp_path, "another", [])
    with pytest.raises(InputError, match="is the search of another task"):
        read_steps(tmp_path, identity(task, None))
    (tmp_path / "search.json").write_text("{")
    with pytest.raises(InputError, match="is damaged"):
        read_steps(tmp_path, identity(task, None))
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


def test_finite_elements_without_an_answer_are_told(task, engines, monkeypatch):
    class Silent(Pretended):
        def simulate(self, grids, progress=None):
            raise ComputationError("did not converge")

    monkeypatch.setattr("simulearn.inverse.checking.engine", lambda name: Silent(name))
    found = optimize(task)
    assert found.check.error_fea_mm is None
    assert found.check.why == "did not converge"
    assert found.check.agrees is None


def test_a_start_without_an_answer_is_an_error(task, monkeypatch):
    class Silent(Pretended):
        def simulate(self, grids, progress=None):
            raise ComputationError("did not converge")

    monkeypatch.setattr(search, "engine", lambda name, model=None: Silent(name))
    with pytest.raises(ComputationError, match="no answer for the design to begin with"):
        optimize(task)


def test_what_is_not_known_is_named(task):
    with pytest.raises(InputError, match='method "magic" is not known; known are default'):
        optimize(task.model_copy(update={"method": "magic"}))
    with pytest.raises(InputError, match='engine "magic" is not known'):
        optimize(task.model_copy(update={"engine": "magic"}))

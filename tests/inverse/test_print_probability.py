"""Tasks that ask something of prints: tolerances, probabilities, robust searches; a toy answers."""

import dataclasses
import json

import numpy as np
import pytest
from toys import alone, toy

from simulearn.cli import inverse as cli
from simulearn.cli.search_report import search_words
from simulearn.collisions import Collision
from simulearn.errors import InputError
from simulearn.grid import Grid, grid_to_dict, make
from simulearn.inverse import Space, optimize, rank, robust, search, search_figures, task_from_dict
from simulearn.inverse.keeping import ROBUST, identity, read_past, write_past
from simulearn.inverse.probability import probability
from simulearn.inverse.robust import robust_problem
from simulearn.inverse.task import Free, task_to_dict
from simulearn.material import Scatter, load_material
from simulearn.material.reading import HERE
from simulearn.simulate import Result, scatter
from simulearn.simulate.members import Prints
from simulearn.simulate.source import Source

PLA = load_material("pla-hot-water")
# Actuators that cancel each other: the joints hardly rise, and each print is another shape.
FRAGILE = (1.0, -1.0, -1.0, 1.0)


def prints(grid, materials, factors=None):
    """The last frames of prints by the toy: an actuator is as strong as its strain is large."""
    own = np.array([material.shrinkage.active for material in materials]) / PLA.shrinkage.active
    own = own[:, None] * (1.0 if factors is None else factors)
    base = alone(grid)
    many = dataclasses.replace(
        base,
        flat=np.repeat(base.flat, len(own), axis=0),
        actuators=base.actuators * own,
    )
    centres = toy(many)
    joints = np.repeat(centres[:, :, None], 8, axis=2)
    sections = np.zeros((len(own), len(grid.beams), 3, 4, 3))
    return Prints(joints, sections, np.ones(len(own), dtype=bool))


class Toy:
    """An engine that answers by the toy, and is mistaken by a constant."""

    def __init__(self, name, mistake=0.0):
        self.name, self.mistake = name, mistake

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
            material=PLA.identity,
        )


def answer(monkeypatch, frames):
    """Let a function answer in place of an engine, as many prints at once as one likes."""
    source = Source("toy", frames, count=16, chunk=100)
    monkeypatch.setattr(scatter, "source_of", lambda materials, engine=None: source)


@pytest.fixture(autouse=True)
def by_the_toy(monkeypatch):
    answer(monkeypatch, prints)
    monkeypatch.setattr(search, "warm", lambda engine: None)
    monkeypatch.setattr(search, "engine_of", lambda name, model=None: Toy(name))
    monkeypatch.setattr("simulearn.inverse.checking.engine", lambda name, mesh: Toy(name))
    monkeypatch.setattr("simulearn.inverse.ranking.engine_of", lambda name, model=None: Toy(name))


@pytest.fixture
def fragile():
    """A task whose start meets its goal exactly, by actuators that cancel each other."""
    flat = make("flat", (1, 1), 50.0)
    grid = Grid(flat.joints, flat.beams, FRAGILE, 0)
    target = toy(alone(grid))[0][3]
    return {
        "schema": "simulearn.task/1",
        "grid": grid_to_dict(grid),
        "goals": [{"vertex": ["joint", 3, "centre"], "target": target.tolist()}],
        "engine": "beams",
        "tolerance": 1.0,
        "limits": {"iterations": 8, "seconds": 20, "corrections": 0},
    }


def test_tolerances_are_of_a_goal_or_of_the_task(fragile):
    goal = fragile["goals"][0]
    task = task_from_dict(fragile | {"goals": [goal, goal | {"tolerance": 0.5}]})
    assert task.tolerances == (1.0, 0.5)
    assert task.of_prints
    del fragile["tolerance"]
    assert task_from_dict(fragile).tolerances == (None,)
    assert not task_from_dict(fragile).of_prints
    assert task_from_dict(fragile | {"robust": True}).of_prints


def test_what_is_not_requested_is_not_written(fragile):
    robust = task_from_dict(fragile | {"robust": True})
    assert task_to_dict(robust)["tolerance"] == 1.0
    assert task_to_dict(robust)["robust"] is True
    assert task_from_dict(task_to_dict(robust)) == robust
    del fragile["tolerance"]
    plain = task_to_dict(task_from_dict(fragile))
    assert not {"tolerance", "robust"} & {*plain, *plain["goals"][0]}


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"tolerance": 0}, "tolerance is 0; a tolerance is a length in mm, more than 0"),
        ({"tolerance": "3"}, 'tolerance is "3"'),
        ({"robust": 1}, "robust is 1; robust is true or false"),
    ],
)
def test_a_wrong_wish_is_named(fragile, change, says):
    with pytest.raises(InputError, match=says):
        task_from_dict(fragile | change)


def test_a_probability_is_counted_over_prints(fragile):
    task = task_from_dict(fragile)
    goals, grid = task.aims, task.start
    result = probability(grid, goals, (1.0,), count=400)
    draw = scatter.draw_prints(PLA, 4, 400, 1)
    away = goals.distances(goals.points(*prints(grid, draw.materials, draw.factors)[:2]))
    assert result.goals == (pytest.approx((away[:, 0] <= 1.0).mean()),)
    assert result.together == result.goals[0]
    assert result.between[0] < result.together < result.between[1]
    assert result.error_mm == pytest.approx(away.mean())
    assert result.error_90_mm == pytest.approx(np.percentile(away, 90))
    # Where finite elements know better, prints differ from there.
    known = goals.targets + np.array([0.0, 0.0, 40.0])
    assert probability(grid, goals, (30.0,), known, count=50).together == 0.0
    assert probability(grid, goals, (50.0,), known, count=50).together == 1.0
    without = probability(grid, goals, (None,), count=50)
    assert (without.goals, without.together, without.between) == ((None,), None, None)
    assert "within" not in without.words
    assert (result.print, result.beam, result.beyond) == (0.17, 0.085, 0)


def test_a_print_without_an_answer_meets_nothing(fragile, monkeypatch):
    def partly(grid, materials, factors=None):
        found = prints(grid, materials, factors)
        lost = np.array([m.shrinkage.active > 1.05 * PLA.shrinkage.active for m in materials])
        return found._replace(converged=~lost)

    answer(monkeypatch, partly)
    task = task_from_dict(fragile)
    result = probability(task.start, task.aims, (1000.0,), count=100)
    assert 0 < result.prints < 100
    assert result.together == result.prints / 100
    assert f"({100 - result.prints} without an answer)" in result.words


def test_all_goals_together_are_met_less_often_than_each(fragile):
    other = {"vertex": ["joint", 1, "centre"], "target": [49.0, 0.0, 3.0], "tolerance": 3.0}
    task = task_from_dict(fragile | {"goals": [*fragile["goals"], other]})
    result = probability(task.start, task.aims, task.tolerances, count=300)
    assert 0 < result.together <= min(result.goals)
    assert result.together < max(result.goals) < 1


def test_the_expected_error_is_the_error_of_repeated_goals(fragile):
    task = task_from_dict(fragile)
    goals, grid = task.aims, task.start
    many = goals.repeated(3)
    assert (len(many), many.weights.sum()) == (3, pytest.approx(1.0))
    space = Space.of(grid, Free())
    problem = robust_problem(space, goals, grid, None, None, np.inf, None, None)
    x, a = space.start
    draw = scatter.even_prints(PLA, 4, robust.PRINTS)
    each = goals.points(*prints(grid, draw.materials, draw.factors)[:2])
    assert problem.scored(x, a).error == pytest.approx(goals.error(each).mean())


def test_a_search_tells_how_often_prints_meet_the_goals(fragile):
    found = optimize(task_from_dict(fragile))
    assert found.nominal is None
    assert found.error_mm < 0.1
    assert 0 < found.probability.together < 0.7
    task = task_from_dict(fragile)
    assert found.probability == probability(found.grid, task.aims, (1.0,), task.aims.targets)
    del fragile["tolerance"]
    assert optimize(task_from_dict(fragile)).probability is None


def test_a_robust_search_finds_a_design_whose_prints_meet_the_goals_more_often(fragile, tmp_path):
    task = task_from_dict(fragile | {"robust": True})
    found = optimize(task)
    assert found.probability.together > found.nominal.together + 0.2
    assert found.probability.error_mm < 0.7 * found.nominal.error_mm
    phases = [step.phase for step in found.steps]
    assert phases == sorted(phases, reverse=True)
    assert phases[-1] == ROBUST
    expected = [step.error_mm for step in found.steps if step.phase == ROBUST]
    assert expected == sorted(expected, reverse=True)
    # The same command goes on from there, and does not lose it.
    write_past(tmp_path, identity(task, None), found.steps, found.checks)
    again = optimize(task, before=read_past(tmp_path, identity(task, None)))
    assert again.probability.together == pytest.approx(found.probability.together)
    np.testing.assert_allclose(again.grid.joints, found.grid.joints, atol=0.1)
    # Nor where its time is over, or other answers were looked for in between.
    late = task.model_copy(update={"limits": task.limits.model_copy(update={"seconds": 0.01})})
    again = optimize(late, before=read_past(tmp_path, identity(task, None)))
    np.testing.assert_array_equal(again.grid.joints, found.grid.joints)
    assert again.probability.together == pytest.approx(found.probability.together)
    several = late.model_copy(update={"limits": task.limits.model_copy(update={"answers": 3})})
    more = optimize(several, before=read_past(tmp_path, identity(task, None)))
    write_past(tmp_path, identity(task, None), more.steps, more.checks)
    last = optimize(several, before=read_past(tmp_path, identity(task, None)))
    for one in (more, last):
        assert one.probability.together == pytest.approx(found.probability.together)
        assert one.answers[0].share == one.probability.together


def test_a_robust_design_that_collides_is_not_taken(fragile, monkeypatch):
    one = Collision(("beam 0", "beam 2"), 11, 0.0, 8, 1.25, (1.0, -2.0, 3.5))
    own = Toy._one

    def colliding(self, grid):
        moved = not np.allclose(grid.centred.joints[3], 50.0)
        return dataclasses.replace(own(self, grid), collisions=(one,) * moved)

    monkeypatch.setattr("simulearn.inverse.checking.engine", lambda name, mesh: engine)
    engine = Toy("fea")
    monkeypatch.setattr(Toy, "_one", colliding)
    found = optimize(task_from_dict(fragile | {"robust": True}))
    assert not found.check.collisions
    assert found.probability is found.nominal


def test_where_nothing_is_more_robust_the_best_design_stays(fragile):
    fragile["grid"]["actuators"] = [0.0] * 4
    fragile["goals"][0]["target"] = [50.0, 50.0, 0.0]
    found = optimize(task_from_dict(fragile | {"robust": True}))
    assert found.probability is found.nominal
    assert found.probability.together == 1.0


def test_a_robust_search_without_time_says_so(fragile):
    fragile["limits"]["seconds"] = 1e-3
    found = optimize(task_from_dict(fragile | {"robust": True}))
    assert "robust-not-begun" in {message.code for message in found.warnings}
    assert found.probability is found.nominal is not None
    task = task_from_dict(fragile | {"robust": True})
    lines = list(search_words(search_figures(task, found), found))
    assert not any("no robust design was found" in line for line in lines)
    assert any("strains differ by 17.0% from print to print and 8.5% from" in x for x in lines)


def test_without_a_scatter_it_is_reported_or_refused(fragile, tmp_path):
    text = (HERE / "pla-hot-water.toml").read_text()
    own = tmp_path / "own.toml"
    own.write_text(text[: text.index("[scatter]")] + text[text.index("[bath]") :])
    assert load_material(own).scatter == Scatter()
    fragile["grid"]["material"] = str(own)
    found = optimize(task_from_dict(fragile, paths=True))
    assert found.probability is None
    assert [message.code for message in found.warnings] == ["material-scatter"]
    ranking = rank(task_from_dict(fragile, paths=True))
    assert [message.code for message in ranking.warnings] == ["material-scatter"]
    with pytest.raises(InputError, match="has no scatter"):
        optimize(task_from_dict(fragile | {"robust": True}, paths=True))


def test_suggestions_tell_how_often_prints_meet_the_goals(fragile):
    seen = []
    ranking = rank(task_from_dict(fragile), progress=lambda *now: seen.append(now))
    assert 0 < ranking.probability.together < 0.7
    for one in ranking.best:
        result = probability(one.grid, task_from_dict(fragile).aims, (1.0,), one.points)
        assert one.probability == result
    assert seen[-1] == (6 * 17, 6 * 17)
    assert all(one.probability is None for one in ranking.suggestions)
    del fragile["tolerance"]
    assert rank(task_from_dict(fragile)).probability is None


def test_the_commands_tell_probabilities(run, fragile, tmp_path, monkeypatch):
    monkeypatch.setattr(cli, "search_pictures", lambda *words: [])
    monkeypatch.setattr("simulearn.simulate.engine", lambda name, model=None: Toy(name))
    file, folder = tmp_path / "task.json", tmp_path / "found"
    del fragile["tolerance"]
    fragile["limits"]["iterations"] = 4
    file.write_text(json.dumps(fragile))
    words = ("optimize", file, "-o", folder, "--tolerance", 1, "--robust")
    code, out, _ = run(*words)
    assert code == 0
    assert "16 prints by toy are within all tolerances" in out
    assert "of the best design without regard to prints" in out
    assert "goal 0 (joint 3, centre): " in out
    assert " % within 1 mm" in out
    figures = json.loads((folder / "summary.json").read_text())
    assert figures["probability"]["together"] > figures["nominal_probability"]["together"]
    assert figures["corrections"] == 0
    ranking = json.loads(run("rank", file, "--tolerance", 1, "--json")[1])
    assert ranking["suggestions"][0]["probability"]["tolerances"] == [1.0]
    out = run("rank", file, "--tolerance", 1)[1]
    assert "prints within" in out
    assert "within the tolerances of all goals, of 16 prints by toy" in out
    plain = json.loads(run("optimize", file, "-o", tmp_path / "plain", "--json")[1])
    assert "probability" not in plain
    code, _, err = run("rank", "saddle", "--tolerance", 1)
    assert (code, "--tolerance is of goals" in err) == (1, True)

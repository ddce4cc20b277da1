"""Several answers: kinds that differ, the front, and one search that comes to all of them."""

import dataclasses
import json
import threading

import numpy as np
import pytest
from PIL import Image
from toys import alone, toy

from simulearn.cli.answers_report import answers_table
from simulearn.collisions import Collision
from simulearn.errors import InputError, Message
from simulearn.grid import grid_to_dict, make, read_grid
from simulearn.inverse import Past, Space, optimize, search, search_figures, task_from_dict
from simulearn.inverse.answers import print_times
from simulearn.inverse.archive import LEAST, Archive, Distance
from simulearn.inverse.checking import Check
from simulearn.inverse.front import Answer, actuators_of, choice, non_dominated, on_front
from simulearn.inverse.keeping import ANSWERS, read_past, write_past
from simulearn.inverse.probability import Probability
from simulearn.inverse.problem import Problem
from simulearn.inverse.task import Free
from simulearn.material import load_material
from simulearn.simulate import Result, engine

ONE = Collision(("beam 3", "beam 7"), 11, 0.0, 8, 1.25, (1.0, -2.0, 3.5))


@pytest.fixture
def space():
    return Space.of(make("flat", length=60.0), Free())


def test_the_distance_is_what_it_says(space):
    distance, grid = Distance.of(space), space.grid
    assert distance.length == pytest.approx(60.0)
    other = dataclasses.replace(grid, actuators=np.full(len(grid.beams), 0.25))
    assert distance.between(grid, other) == pytest.approx(0.25)
    moved = grid.joints + np.array([6.0, 0.0])
    moved[grid.fixed] = grid.joints[grid.fixed]
    assert distance.between(grid, dataclasses.replace(grid, joints=moved)) == pytest.approx(0.1)
    # A turned grid is another design only where shapes are seen from the fixed joint.
    turn = np.array([[0.6, 0.8], [-0.8, 0.6]])
    turned = dataclasses.replace(grid, joints=grid.centred.joints @ turn)
    assert distance.between(grid, turned) > 0.5
    assert Distance.of(space, turned=True).between(grid, turned) == pytest.approx(0, abs=1e-12)
    # What may not change does not count.
    bound = Distance.of(Space.of(make("flat", length=60.0), Free(joints=[1], actuators=[2])))
    assert bound.between(grid, other) == pytest.approx(0.25)
    assert list(bound.beams), list(bound.joints) == ([2], [1])


def test_an_archive_keeps_the_best_of_each_kind(space):
    archive, grid = Archive(Distance.of(space), most=30), space.grid
    source = np.random.default_rng(3)
    least = np.inf
    for _ in range(20):
        ratios = source.integers(-4, 5, (40, len(grid.beams))) / 4 * (source.random() < 0.5)
        joints = np.repeat(grid.joints[None], 40, axis=0) + source.normal(0, 3, (40, 9, 2))
        error = source.random(40)
        error[0] = np.inf
        archive.add(joints, ratios, error)
        least = min(least, error.min())
    away = archive.distance(archive.joints, archive.ratios, archive.joints, archive.ratios)
    assert (away + 9 * np.eye(len(archive)) >= LEAST).all()
    assert 1 < len(archive) <= 30
    assert archive.errors.min() == least


def test_the_front_is_what_nothing_beats():
    costs = np.array([[1.0, 5.0], [2.0, 3.0], [3.0, 3.0], [4.0, 1.0], [2.0, 3.0], [9.0, np.inf]])
    assert non_dominated(costs).tolist() == [True, True, False, True, True, False]
    unknown = np.array([[1.0, np.inf], [2.0, np.inf]])
    assert non_dominated(unknown).tolist() == [True, False]


def test_designs_are_chosen_for_what_they_cost_and_for_how_they_differ():
    errors = np.array([0.9, 0.1, 0.5, 0.6, 3.0, 0.7])
    costs = np.array([[5, 9], [4, 8], [1, 9], [6, 2], [0, 0], [7, 9]], dtype=float)
    distances = np.abs(np.arange(6)[:, None] - np.arange(6)).astype(float)
    # The closest, the cheapest in either respect, never the one that is not good.
    assert choice(errors, costs, distances, 1.0, 3) == [1, 2, 3]
    # Then what is farthest: no other beats it, or if all are beaten, by distance alone.
    assert choice(errors, costs, distances, 1.0, 4) == [1, 2, 3, 5]
    assert choice(errors, costs, distances, 1.0, 9) == [1, 2, 3, 5, 0]
    assert choice(errors, costs, distances, 0.05, 9) == []


def test_answers_know_what_they_take():
    grid = make("saddle", length=60.0)
    count, length = actuators_of(grid.centred)
    assert count == np.count_nonzero(grid.actuators)
    assert 0 < length < 60.0 * np.abs(grid.actuators).sum()
    name, (seconds,) = print_times([grid], None, [])
    assert (name, 600 < seconds < 36000) == ("prusa-mk4", True)
    with pytest.raises(InputError):
        print_times([grid], "no-printer", [])
    warnings = []
    large = make("flat", (6, 6), 60.0)
    assert print_times([large, large], "prusa-mk4", warnings)[1] == [None, None]
    assert [message.code for message in warnings] == ["answers-print"]
    answers = on_front(
        Answer(Check(grid, error), 3, length, None, "", seconds)
        for error, length, seconds in (
            (0.5, 90.0, 3000.0),
            (0.51, 100.0, 3001.0),
            (1.0, 20.0, None),
        )
    )
    assert [one.on_front for one in answers] == [True, False, True]
    assert "3 actuators of 90 mm in all, printed in 50 min" in answers[0].words
    json.dumps([one.to_dict() for one in answers], allow_nan=False)


def test_a_problem_scores_only_what_is_allowed(problem):
    problem.archive = Archive(Distance.of(problem.space))
    problem.allowed = lambda designs: designs.actuators[:, 0] == 0
    x, a = problem.space.start
    ratios = np.stack([a, a])
    ratios[1, 0] = 0.5
    points = problem.points(np.stack([x, x]), ratios)
    assert np.isfinite(points[0]).all()
    assert np.isnan(points[1]).all()
    assert problem.designs == len(problem.archive) == 1
    assert isinstance(problem, Problem)


class ByToy:
    """An engine that answers by the toy."""

    def __init__(self, name):
        self.name, self.calls = name, []

    def simulate(self, grids, progress=None, cancel=None):
        self.calls.append(len(grids))
        return [self._one(grid) for grid in grids]

    def _one(self, grid):
        centres = toy(alone(grid))[0]
        return Result(
            grid=grid,
            engine=self.name,
            joints=np.repeat(centres[:, None], 8, axis=1)[None],
            beams=np.zeros((1, len(grid.beams), 3, 4, 3)),
            stress=None,
            seconds=0.0,
            material=load_material(grid.material).identity,
        )


@pytest.fixture
def fea(monkeypatch):
    """Put a pretended engine in the place of finite elements."""
    engine = ByToy("fea-pretended")
    monkeypatch.setattr("simulearn.inverse.checking.engine", lambda name, mesh: engine)
    monkeypatch.setattr(search, "warm", lambda engine: None)
    monkeypatch.setattr("simulearn.inverse.answers.SLACK", 1.0)
    return engine


@pytest.fixture
def task(hidden):
    goals = [
        {"vertex": ["joint", k, "centre"], "target": place}
        for k, place in enumerate(toy(alone(hidden))[0].tolist())
    ]
    return task_from_dict(
        {
            "schema": "simulearn.task/1",
            "grid": grid_to_dict(make("flat", length=60.0)),
            "goals": goals,
            "engine": "beams",
            "limits": {"iterations": 3, "seconds": 60.0, "corrections": 0, "answers": 4},
        }
    )


def test_one_search_comes_to_several_answers_and_goes_on(task, fea, tmp_path):
    found = optimize(task, engine=ByToy("beams"))
    assert [step.phase for step in found.steps].count(ANSWERS) >= 4
    answers = found.answers
    assert 1 < len(answers) <= 4
    assert answers[0].check is found.check
    assert answers[0].error == min(one.error for one in answers)
    assert all(one.check.error_fea_mm is not None for one in answers)
    assert all(one.nearest >= LEAST - 1e-9 for one in answers)
    assert any(one.on_front for one in answers)
    codes = {message.code for message in found.warnings}
    assert ("answers-fewer" in codes) == (len(answers) < 4)
    figures = search_figures(task, found)
    assert [row["actuators"] for row in figures["answers"]] == [one.actuators for one in answers]
    # Going on, nothing is left to do, and the answers are the same.
    write_past(tmp_path, "name", found.steps, found.checks)
    fea.calls.clear()
    again = optimize(task, engine=ByToy("beams"), before=read_past(tmp_path, "name"))
    assert fea.calls == []
    assert [one.grid.digest for one in again.answers] == [one.grid.digest for one in answers]


def test_an_answer_that_collides_is_not_the_best_while_another_does_not(
    task, fea, tmp_path, monkeypatch
):
    first = optimize(task, engine=ByToy("beams"))
    closest = first.answers[0].grid.digest
    simulate = ByToy.simulate

    def colliding(self, grids, progress=None, cancel=None):
        found = simulate(self, grids, progress, cancel)
        if self is not fea:
            return found
        return [
            dataclasses.replace(one, collisions=(ONE,)) if one.grid.digest == closest else one
            for one in found
        ]

    monkeypatch.setattr(ByToy, "simulate", colliding)
    found = optimize(task, engine=ByToy("beams"))
    (bad,) = (one for one in found.answers if one.collides)
    assert bad.grid.digest == closest
    assert not bad.on_front
    assert not found.answers[0].collides
    assert not found.check.collisions
    assert "answers-collide" in {message.code for message in found.warnings}
    assert "parts run through each other" in bad.words
    assert bad.to_dict()["collisions"][0]["code"] == "beams-pass"
    assert [column.header for column in answers_table(found.answers).columns][-1] == "collides"
    # A run that goes on knows it, though it simulates nothing.
    write_past(tmp_path, "name", found.steps, found.checks)
    again = optimize(task, engine=ByToy("beams"), before=read_past(tmp_path, "name"))
    assert [one.collides for one in again.answers] == [one.collides for one in found.answers]
    assert not again.check.collisions


def test_of_a_robust_task_the_best_is_what_most_prints_meet_the_goals_of():
    grid = make("saddle", length=60.0)

    def one(share, *collisions):
        of = Probability(9, 9, "toy", (1.0,), (share,), share, (0.0, 1.0), 1.0, 2.0)
        return Answer(Check(grid, 1.0, 1.0, passes=collisions), 3, 90.0, None, probability=of)

    passing = Message("beams-pass", "beam 3", "parts run through each other")
    assert one(0.8).more_robust_than(one(0.6))
    assert not one(0.6).more_robust_than(one(0.8))
    assert not one(0.8, passing).more_robust_than(one(0.6))
    assert one(0.6).more_robust_than(one(0.8, passing))
    unknown = dataclasses.replace(one(0.8), probability=None)
    assert not unknown.more_robust_than(one(0.6))
    assert one(0.6).more_robust_than(unknown)


def test_one_answer_is_as_it_was(task, fea):
    limits = task.limits.model_copy(update={"answers": 1})
    one = task.model_copy(update={"limits": limits})
    found = optimize(one, engine=ByToy("beams"))
    assert found.answers == ()
    assert "answers" not in search_figures(one, found)
    assert "answers" not in one.model_dump()["limits"]
    assert task.model_dump()["limits"]["answers"] == 4
    # Other answers may be wanted later.
    more = optimize(task, engine=ByToy("beams"), before=Past(found.steps, found.checks))
    assert len(more.answers) > 1
    assert more.check.error_fea_mm <= found.check.error_fea_mm


def test_answers_that_are_fewer_or_far_are_named(task, fea, monkeypatch):
    monkeypatch.setattr("simulearn.inverse.answers.SLACK", 0.05)
    monkeypatch.setattr("simulearn.inverse.answers.FAR", 3.0)
    limits = task.limits.model_copy(update={"seconds": 0.5, "answers": 20})
    found = optimize(task.model_copy(update={"limits": limits}), engine=ByToy("beams"))
    codes = {message.code for message in found.warnings}
    assert ("answers-fewer" in codes) == (len(found.answers) < 20)
    good = min(one.check.error_mm for one in found.answers) + 0.05 * task.start.dimension
    if any(one.check.error_mm > good + 1.0 for one in found.answers[1:]):
        assert "answers-far" in codes


def test_a_token_ends_the_search_for_others_and_the_answers_so_far_are_kept(task, fea):
    token = threading.Event()

    def progress(step):
        if step.phase == ANSWERS:
            token.set()

    found = optimize(task, engine=ByToy("beams"), progress=progress, cancel=token)
    assert found.interrupted
    assert found.check.error_fea_mm is not None
    assert [one.grid for one in found.answers] == [found.grid]
    assert found.answers[0].nearest is None


def test_the_command_writes_answers_and_their_picture(run, small, tmp_path, monkeypatch):
    monkeypatch.setattr("simulearn.inverse.checking.engine", lambda name, mesh: engine("beams"))
    monkeypatch.setattr(search, "warm", lambda engine: None)
    path, folder = tmp_path / "task.json", tmp_path / "found"
    path.write_text(json.dumps(small))
    words = ("optimize", path, "-o", folder, "--answers", 2, "--seconds", 1)
    code, out, _ = run(*words, "--printer", "no-printer")
    assert code == 1
    code, out, _ = run(*words, "--printer", "voron")
    assert code == 0
    assert "print by" in out
    written = json.loads((folder / "answers.json").read_text())
    assert written["schema"] == "simulearn.answers/1"
    rows = written["answers"]
    grids = [read_grid(folder / f"answer-{k}.json") for k in range(1, len(rows) + 1)]
    assert grids[0].digest == read_grid(folder / "best.json").digest
    assert json.loads((folder / "summary.json").read_text())["answers"] == rows
    assert rows[0]["printer"] == "voron"
    with Image.open(folder / "answers.png") as picture:
        assert np.asarray(picture.convert("L")).std() > 10

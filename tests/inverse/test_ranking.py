"""Ranking: all valid modifications, the best first, five that differ."""

import numpy as np
import pytest
from toys import alone, toy

from simulearn.grid import make, validate
from simulearn.inverse import Goals, rank, ranking
from simulearn.inverse.task import Free
from simulearn.material import load_material


@pytest.fixture
def ranked(monkeypatch):
    """The ranking of a saddle by the toy, a cone being wanted."""
    monkeypatch.setattr(ranking, "places", lambda engine, goals, cancel: toy)
    goals = Goals.centres(toy(alone(make("cone", length=62.0)))[0])
    return ranking._ranked(make("saddle", length=60.0), goals, Free(), None, None)


def test_all_valid_modifications_are_ranked_by_their_error(ranked):
    errors = [one.error_mm for one in ranked.suggestions]
    assert errors == sorted(errors)
    assert 60 < len(errors) <= 88
    material = load_material("pla-hot-water")
    assert all(validate(one.grid, material).valid for one in ranked.suggestions)
    assert errors[0] < ranked.error_mm
    goals = Goals.centres(toy(alone(make("cone", length=62.0)))[0])
    for one in ranked.suggestions[::9]:
        assert goals.error(toy(alone(one.grid))[0]) == pytest.approx(one.error_mm)


def test_the_five_differ(ranked):
    assert len(ranked.best) == 5
    assert ranked.best[0] is ranked.suggestions[0]
    assert len({(one.change.part, one.change.indices) for one in ranked.best}) == 5
    moves = [(one.points - ranked.points).ravel() for one in ranked.best]
    moves = [move / np.linalg.norm(move) for move in moves]
    cosines = np.array([[a @ b for a in moves] for b in moves]) - np.eye(5)
    assert cosines.max() <= ranking.ALIKE


def test_where_few_may_change_the_next_best_fill_up(monkeypatch):
    monkeypatch.setattr(ranking, "places", lambda engine, goals, cancel: toy)
    goals = Goals.centres(np.zeros((9, 3)))
    free = Free(joints=[0], actuators=[])
    ranked = ranking._ranked(make("saddle", length=60.0), goals, free, None, None)
    assert len(ranked.suggestions) == 8
    assert len(ranked.best) == 5
    assert [one.error_mm for one in ranked.best] == sorted(one.error_mm for one in ranked.best)


def test_without_goals_what_changes_most_comes_first():
    from simulearn.simulate import engine

    ranked = rank(make("cone", (1, 1), 50.0), engine("beams"))
    moved = np.array([one.moved_mm for one in ranked.suggestions])
    assert np.diff(moved).max() < 0.1  # what a tolerance of the solver leaves
    assert ranked.error_mm == pytest.approx(0.0, abs=0.1)
    assert ranked.best[0] is ranked.suggestions[0]
    (moving,) = engine("beams").simulate([ranked.best[0].grid])
    away = np.linalg.norm(moving.centres[-1] - ranked.points, axis=1).mean()
    assert away == pytest.approx(ranked.best[0].moved_mm, abs=0.1)

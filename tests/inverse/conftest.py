"""A problem that a toy answers, and a small task for real engines."""

import pytest
from toys import alone, toy

from simulearn.grid import Grid, Rules, draw_valid, grid_to_dict, make
from simulearn.inverse import Goals, Space
from simulearn.inverse.problem import Problem
from simulearn.inverse.task import Free


@pytest.fixture
def hidden() -> Grid:
    return draw_valid(Rules(), 701, 2)[0]


@pytest.fixture
def problem(hidden) -> Problem:
    """Find, from a flat grid, one whose joints come where the hidden one's do."""
    goals = Goals.centres(toy(alone(hidden))[0])
    space = Space.of(make("flat", length=60.0), Free())
    return Problem(space, goals, toy, model=object())


@pytest.fixture
def small() -> dict:
    """A task on a single cell, as a file has it."""
    return {
        "schema": "simulearn.task/1",
        "grid": grid_to_dict(make("flat", (1, 1), 50.0)),
        "goals": [
            {"vertex": ["joint", 3, "centre"], "target": [45.0, 45.0, 6.0], "weight": 2},
            {"vertex": ["beam", 1, "middle", "centre"], "target": [0.0, 24.0, 4.0]},
        ],
        "engine": "beams",
        "limits": {"iterations": 3, "seconds": 20, "corrections": 0},
    }

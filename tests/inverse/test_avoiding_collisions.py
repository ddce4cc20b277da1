"""Searches prefer designs without collisions, and say where an answer has one."""

import dataclasses

import numpy as np
import pytest
from toys import alone, toy

from simulearn.collisions import Collision
from simulearn.grid import Rules, draw_valid, make
from simulearn.inverse import Goals
from simulearn.inverse.checking import Check
from simulearn.inverse.problem import Problem
from simulearn.inverse.scoring import places_and_collisions
from simulearn.inverse.space import Space
from simulearn.inverse.task import Free
from simulearn.material import load_material
from simulearn.simulate import Failure, Result, engine

ONE = Collision(("beam 3", "beam 7"), 11, 0.0, 8, 1.25, (1.0, -2.0, 3.5))


@pytest.fixture
def problem():
    wanted = toy(alone(draw_valid(Rules(), 701, 2)[0]))[0]
    space = Space.of(make("flat", length=60.0), Free())
    return Problem(space, Goals.centres(wanted), toy)


def result(grid, *collisions):
    centres = toy(alone(grid))[0]
    return Result(
        grid=grid,
        engine="pretended",
        joints=np.repeat(centres[:, None], 8, axis=1)[None],
        beams=np.zeros((1, len(grid.beams), 3, 4, 3)),
        stress=None,
        seconds=0.0,
        material=load_material(grid.material).identity,
        collisions=collisions,
    )


def batch(problem):
    """Return points one step of an actuator from the start, and their errors, the best first."""
    x, a = problem.space.start
    steps = a + problem.space.ratio * np.eye(len(a))
    errors = dataclasses.replace(problem).errors(np.repeat(x[None], len(a), axis=0), steps)
    order = np.argsort(errors)
    return np.repeat(x[None], len(a), axis=0), steps[order], errors[order]


def test_the_best_of_a_batch_that_does_not_collide_is_kept(problem):
    x, a, errors = batch(problem)
    checked = []

    def collides(designs):
        checked.append(designs)
        return len(checked) == 1

    problem.collides = collides
    problem.points(x, a)
    assert len(checked) == 2  # the best collides, the second does not
    assert problem.best.error == pytest.approx(errors[1])
    assert not problem.best.collides


def test_a_colliding_design_is_kept_for_want_of_others(problem):
    x, a, errors = batch(problem)
    problem.collides = lambda designs: True
    problem.points(x, a)
    assert problem.best.collides
    assert problem.best.error == pytest.approx(errors[0])
    problem.collides = lambda designs: False
    problem.points(x[-1:], a[-1:])  # much worse, but it does not collide
    assert problem.best.error == pytest.approx(errors[-1])
    assert not problem.best.collides
    assert not problem.scored(x[-1], a[-1]).collides


def test_no_design_is_looked_at_that_would_not_be_the_best(problem):
    x, a, _ = batch(problem)
    problem.points(x, a)
    problem.collides = lambda designs: pytest.fail("asked")
    problem.points(x[1:], a[1:])


def test_a_check_without_collisions_is_better():
    grid = make("flat")
    free, colliding = (Check(grid, 1.0, error, fea=result(grid, *some))
                       for error, some in ((2.0, ()), (0.5, (ONE,))))  # fmt: skip
    assert free.better_than(colliding)
    assert not colliding.better_than(free)
    assert colliding.better_than(Check(grid, 0.1))  # which finite elements have no answer for
    assert not free.collisions
    (message,) = colliding.collisions
    assert "beam 3 and beam 7" in message.message


def test_engines_say_what_collides():
    class Pretended:
        name = "pretended"

        def simulate(self, grids, progress=None, cancel=None):
            return [
                Failure(grid, "none", "", "") if grid.actuators[0] == 1
                else result(grid, *[ONE] * int(grid.actuators[0] == 0.5)) for grid in grids
            ]  # fmt: skip

    space = Space.of(make("flat", length=60.0), Free())
    x, a = space.start
    steps = np.repeat(a[None], 3, axis=0)
    steps[:, 0] = 0, 0.5, 1
    goals = Goals.centres(toy(alone(make("flat", length=60.0)))[0])
    places, collides = places_and_collisions(Pretended(), goals)
    designs = space.designs(np.repeat(x[None], 3, axis=0), steps)
    places(designs)
    assert [collides(designs.take([t])) for t in range(3)] == [False, True, False]
    _, learned = places_and_collisions(engine("learned"), goals)
    assert not learned(designs.take([0]))

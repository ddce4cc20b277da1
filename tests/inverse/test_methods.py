"""Methods of search: each goes down, and none leaves the valid designs."""

from itertools import islice

import numpy as np
import pytest
from toys import toy

from simulearn.grid import Grid, make, validate
from simulearn.inverse import Goals, Space, changes
from simulearn.inverse.methods import METHODS, method
from simulearn.inverse.problem import OutOfTime, Problem
from simulearn.inverse.task import Free
from simulearn.material import load_material

MATERIAL = load_material("pla-hot-water")
WITHOUT_SLOPES = [name for name in METHODS if name != "gradient"]


def watched(problem):
    """Return a problem that keeps the designs it is asked for."""
    simulated = []

    def places(designs):
        simulated.append(designs)
        return toy(designs)

    problem.places = places
    problem.model = None  # nothing relaxed: every design asked for is one
    return simulated


@pytest.mark.parametrize("name", WITHOUT_SLOPES)
def test_it_goes_down_and_asks_for_valid_designs_only(name, problem):
    simulated = watched(problem)
    start = problem.scored(*problem.space.start)
    list(islice(method(name)(problem, start), 4))
    assert problem.best.error < 0.9 * start.error
    count = 0
    for designs in simulated:
        count += len(designs)
        for flat, ratios in zip(designs.flat[::5], designs.actuators[::5], strict=True):
            grid = Grid(flat, designs.beams, ratios, designs.fixed)
            assert validate(grid, MATERIAL).valid
            assert np.abs(4 * ratios - np.round(4 * ratios)).max() < 1e-9
    assert problem.designs == count


def test_the_default_comes_close_within_a_few_iterations(problem):
    start = problem.scored(*problem.space.start)
    list(islice(method("default")(problem, start), 20))
    assert start.error > 10
    assert problem.best.error < 0.5


def test_brute_force_ends_where_no_single_modification_is_better(problem):
    space = problem.space
    list(method("brute-force")(problem, problem.scored(*space.start)))
    best = problem.best
    tried = changes(space, best.a)
    errors = problem.errors(
        best.x + np.array([change.dx for change in tried]),
        best.a + np.array([change.da for change in tried]),
    )
    assert errors.min() >= best.error


def test_actuators_alone_or_joints_alone_may_be_free(problem):
    for free in (Free(joints=[]), Free(actuators=[])):
        space = Space.of(make("twist", length=60.0), free)
        for name in WITHOUT_SLOPES:
            for model in (None, object()):
                some = Problem(space, problem.goals, toy, model=model)
                start = some.scored(*space.start)
                list(islice(method(name)(some, start), 12))
                assert some.best.error < start.error or name == "cma"


@pytest.mark.parametrize("cells", [(1, 1), (1, 3), (3, 2)])
def test_any_topology(cells):
    space = Space.of(make("flat", cells, 55.0), Free())
    twist = Space.of(make("twist", cells, 60.0), Free())
    goals = Goals.centres(toy(twist.designs(*(part[None] for part in twist.start)))[0])
    problem = Problem(space, goals, toy, model=object())
    start = problem.scored(*space.start)
    list(islice(method("default")(problem, start), 8))
    assert problem.best.error < 0.2 * start.error


def test_designs_without_an_answer_are_passed_over(problem):
    def places(designs):
        points = toy(designs)
        points[::2] = np.nan
        return points

    start = problem.scored(*problem.space.start)
    problem.places = places
    for name in WITHOUT_SLOPES:
        list(islice(method(name)(problem, start), 2))
    assert np.isfinite(problem.best.error)


def test_time_ends_a_search_and_the_best_is_kept(problem):
    ticks = iter(range(1000))
    problem.now, problem.until = lambda: next(ticks), 5
    start = problem.scored(*problem.space.start)
    with pytest.raises(OutOfTime):
        list(method("default")(problem, start))
    assert problem.best.error <= start.error

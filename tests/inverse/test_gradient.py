"""The error's gradient through the learned engine, and the method that goes down along it."""

from itertools import islice

import numpy as np
import pytest

from simulearn.errors import InputError
from simulearn.grid import Grid, make
from simulearn.inverse import Goals, Space, Vertex
from simulearn.inverse.goals import Part
from simulearn.inverse.gradient import fitting_slopes, gradient, lbfgs
from simulearn.inverse.kinds import OnSet
from simulearn.inverse.problem import Problem
from simulearn.inverse.scoring import places
from simulearn.inverse.task import Free
from simulearn.simulate import engine
from simulearn.surfaces import Plane, surface_of_heights

TIGHT = 1e-9  # mm


@pytest.fixture(scope="module")
def learned():
    return engine("beams")


@pytest.mark.parametrize("kind", ["points", "surface and plane"])
def test_the_gradient_is_the_slope_of_the_error(learned, kind):
    plain = make("flat", (1, 1), 55.0)
    joints = plain.joints + np.array([[0, 0], [3, -4], [5, 2], [-2, 6]])
    grid = Grid(joints, plain.beams, [0.75, -0.5, 1.0, -0.25], 0)
    space = Space.of(grid, Free())
    vertices = [Vertex("joint", 3), Vertex("joint", 1, 5), Vertex("beam", 2, 1, 1)]
    vertices.append(Vertex("beam", 3, None, 2))
    targets = np.array([[50, 50, 9.0], [40, 5, 3], [0, 20, 7], [30, 40, 5]])
    goals = Goals.of(vertices, targets, [1, 2, 3, 4])
    if kind != "points":
        waves = surface_of_heights("9+sin(x/9)+y*y/300", (-90, 90), (-90, 90), 1.0)
        plane = Plane.of([0, 0, 5], [1, 1, 3])
        parts = [
            Part(OnSet(waves, "surface"), tuple(vertices[:2]), np.array([1.0, 2])),
            Part(OnSet(plane, "plane"), tuple(vertices[2:]), np.array([3.0, 4])),
        ]
        goals = Goals.together(parts)
    model = learned.bundle.model

    def error(x, a):
        slopes = fitting_slopes(model, space.designs(x[None], a[None]), goals, tolerance=TIGHT)
        assert slopes.converged.all()
        return slopes

    x, a = space.start
    slopes = error(x, a)
    (result,) = learned.simulate([grid])
    points = goals.points(result.joints[-1], result.beams[-1])
    assert slopes.cost[0] == pytest.approx(goals.error(points), abs=0.05)
    own = np.r_[np.einsum("pjc,jc->p", space.motions, slopes.flat[0]), slopes.actuators[0]]
    step = 1e-3
    differences = [
        (error(x + e, a).cost[0] - error(x - e, a).cost[0]) / (2 * step)
        for e in step * np.eye(len(x))
    ] + [
        (error(x, a + e).cost[0] - error(x, a - e).cost[0]) / (2 * step)
        for e in step * np.eye(len(a))
    ]
    assert np.linalg.norm(own - differences) < 1e-4 * np.linalg.norm(own)


def test_the_method_goes_down_and_ends_with_whole_steps(learned, monkeypatch):
    # The kernel of the test before does: of one cell, four goals and this tolerance.
    monkeypatch.setattr("simulearn.inverse.gradient.TOLERANCE", TIGHT)
    target = learned.simulate([make("twist", (1, 1), 57.0)])[0].centres[-1]
    goals = Goals.centres(target)
    space = Space.of(make("flat", (1, 1), 52.0), Free())
    problem = Problem(space, goals, places(learned, goals), model=learned.bundle.model)
    start = problem.scored(*space.start)
    list(islice(gradient(problem, start), 60))
    assert problem.best.error < 0.3 * start.error
    assert np.abs(4 * problem.best.a - np.round(4 * problem.best.a)).max() < 1e-12


def test_an_engine_that_cannot_be_differentiated_is_refused(problem):
    start = problem.scored(*problem.space.start)
    with pytest.raises(InputError, match="learned engine"):
        next(gradient(problem, start))


def test_lbfgs_finds_the_lowest_point_of_a_valley_within_its_box():
    def valley(z):
        x, y = z
        value = (1 - x) ** 2 + 100 * (y - x**2) ** 2
        return value, np.array([-2 * (1 - x) - 400 * x * (y - x**2), 200 * (y - x**2)])

    *_, (z, _) = lbfgs(valley, np.array([-1.2, 1.0]), np.array([np.inf, np.inf]), 200)
    np.testing.assert_allclose(z, 1.0, atol=0.05)
    *_, (z, _) = lbfgs(valley, np.array([-0.2, 0.1]), np.array([0.5, 0.5]), 200)
    assert np.abs(z).max() <= 0.5

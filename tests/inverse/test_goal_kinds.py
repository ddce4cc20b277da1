"""Kinds of goals: distances, derivatives, sliding, shapes that may be placed anywhere."""

import numpy as np
import pytest
import trimesh

from simulearn.grid import make
from simulearn.inverse import Goals, Vertex
from simulearn.inverse.clear import ClearOf, ClearOfItself, courses
from simulearn.inverse.goals import Part
from simulearn.inverse.kinds import Apart, AtPoints, OnSet
from simulearn.inverse.naming import face_of
from simulearn.inverse.turning import Angle, Direction
from simulearn.rigid import Place
from simulearn.surfaces import Curve, Plane, Surface, surface_of_heights

GRID = make("flat", (1, 1), 50.0)
WAVES = surface_of_heights("8*sin(x/20)*cos(y/15)", (-80, 80), (-80, 80), 1.0)
BALL = trimesh.creation.icosphere(3, 18.0)
BALL = Surface(BALL.vertices + np.array([25.0, 20.0, 12.0]), BALL.faces)
# Four large triangles: points are far from their edges, where a derivative has kinks.
RIDGE = [[-90, -90, 0], [20, -90, 25], [130, -90, 0], [-90, 130, 0], [20, 130, 40], [130, 130, 0]]
ROOF = Surface(np.array(RIDGE, float), np.array([[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]]))
ARC = Curve(
    np.c_[40 * np.cos(np.linspace(0, 2, 90)), 40 * np.sin(np.linspace(0, 2, 90)), np.ones(90)]
)
CENTRES = tuple(Vertex("joint", k) for k in range(4))
TOP, SIDE = face_of(["joint", 3, "top"], "face", GRID), face_of(["joint", 1, 2], "face", GRID)
BEAM, SECTION = face_of(["beam", 0], "face", GRID), face_of(["beam", 2, "middle"], "face", GRID)
UP = face_of(["beam", 2, "end", "top"], "face", GRID)


def part(wanted, vertices, count=1):
    return Part(wanted, tuple(vertices), np.linspace(1, 2, count))


PARTS = {
    "point": part(AtPoints(np.arange(12.0).reshape(4, 3)), CENTRES, 4),
    "surface": part(OnSet(WAVES, "surface"), CENTRES, 4),
    "surface of large faces": part(OnSet(ROOF, "surface"), CENTRES, 4),
    "curve": part(OnSet(ARC, "curve"), CENTRES, 4),
    "plane": part(OnSet(Plane.of([0, 0, 4], [1, 2, 5]), "plane"), CENTRES, 4),
    "distance": part(Apart(30.0), CENTRES[1:3]),
    "direction": part(Direction(TOP, np.array([0.6, 0, 0.8])), TOP.vertices),
    "direction of a side": part(Direction(SIDE, np.array([0, 0.6, 0.8])), SIDE.vertices),
    "direction of a beam": part(Direction(BEAM, np.array([0.6, 0, 0.8])), BEAM.vertices),
    "direction of a beam's top": part(Direction(UP, np.array([0.6, 0, 0.8])), UP.vertices),
    "angle": part(Angle((TOP, SECTION), 1.0), TOP.vertices + SECTION.vertices),
    "away from a body": part(ClearOf(BALL, 2.0, 4.0), courses(4)),
    "away from a sheet": part(ClearOf(WAVES, 2.0, 4.0), courses(4)),
    "away from large faces": part(ClearOf(ROOF, 2.0, 40.0), courses(4)),
    "away from itself": part(ClearOfItself(GRID.beams, 2.0, 27.0), courses(4)),
}


def shape(goals, seed=0):
    """Return where the vertices of a crumpled grid are."""
    source = np.random.default_rng(seed)
    flat = np.pad(GRID.joints, ((0, 0), (0, 1)))
    joints = flat[:, None] + source.normal(size=(4, 8, 3)) * 4
    ends = flat[GRID.beams]
    share = np.array([0.2, 0.5, 0.8])[:, None]
    middles = ends[:, None, 0] + share * (ends[:, None, 1] - ends[:, None, 0])
    corners = np.array([[0, -3, -2], [0, 3, -2], [0, -3, 2], [0, 3, 2]])
    along = np.abs(ends[:, 1] - ends[:, 0])[:, 0] > 1
    turned = np.where(along[:, None, None], corners, corners[:, [1, 0, 2]])
    sections = middles[:, :, None] + turned[:, None] + source.normal(size=(4, 3, 4, 3))
    return goals.points(joints, sections)


# The best pose on small triangles has kinks everywhere, at which it has no derivative.
FREE = [kind for kind in PARTS if kind not in ("surface", "away from a sheet")]


@pytest.mark.parametrize(
    ("kind", "free"), [*((k, False) for k in PARTS), *((k, True) for k in FREE)]
)
def test_the_slope_is_that_of_the_error(kind, free):
    goals = Goals.together([PARTS[kind], PARTS["point"]], Place() if free else None)
    goals = goals.shifted(np.random.default_rng(1).normal(size=goals.offset.shape))
    points = shape(goals)
    error, slope = goals.slope(points)
    assert error == pytest.approx(float(goals.error(points)))
    for seed in (0, 1):
        step = 1e-4 * np.random.default_rng(seed).normal(size=points.shape)
        change = float(goals.error(points + step) - goals.error(points - step)) / 2
        assert (slope * step).sum() == pytest.approx(change, rel=2e-3, abs=2e-7)


@pytest.mark.parametrize("kind", PARTS)
def test_distances_are_lengths_of_residuals(kind):
    goals = Goals.together([PARTS[kind]])
    points = np.stack([shape(goals, seed) for seed in range(3)])
    residual, away = goals.residual(points), goals.distances(points)
    assert (away > 0).any()
    np.testing.assert_allclose((residual**2).sum(axis=1), away**2 @ goals.weights)
    lost = points.copy()
    lost[1, 0, 2] = np.nan
    assert np.isnan(goals.error(lost)).tolist() == [False, True, False]
    assert np.isnan(goals.residual(lost)[1]).all()
    assert len(goals.names) == len(goals.kinds) == len(goals) == away.shape[1]
    np.testing.assert_allclose(goals.residual(points[0]), residual[0])


@pytest.mark.parametrize("kind", ["surface", "curve", "plane", "direction", "angle", "distance"])
def test_least_squares_meet_a_goal_within_a_few_steps(kind):
    goals = Goals.together([PARTS[kind]])
    points = shape(goals)
    for _ in range(12):
        r = goals.residual(points)
        steps = 1e-3 * np.eye(points.size).reshape(-1, *points.shape)
        J = (goals.residual(points + steps) - r).T / 1e-3
        points = points - np.linalg.lstsq(J, r, rcond=1e-6)[0].reshape(points.shape)
    assert goals.error(points) < 0.02


def test_a_vertex_slides_on_a_surface_unless_it_may_not():
    points = np.array([[0.0, 0, 9], [20, 0, 9], [0, 20, 9], [9, 9, 9]])
    along = points + np.array([3.0, 0, 0])
    plane = Plane.of([0, 0, 0], [0, 0, 1])
    sliding, stuck = (
        Goals.together([part(OnSet(plane, "plane", slide), CENTRES, 4)]).begun(points)
        for slide in (True, False)
    )
    assert sliding.error(along) == pytest.approx(9.0)
    assert stuck.error(along) == pytest.approx(np.hypot(9, 3))
    assert stuck.kinds == sliding.kinds == ("plane",) * 4


def test_offsets_are_those_of_points():
    goals = Goals.together([PARTS["surface"]])
    points, by = shape(goals), np.random.default_rng(3).normal(size=(4, 3))
    np.testing.assert_allclose(goals.shifted(by).residual(points + by), goals.residual(points))
    pair = goals.repeated(2)
    both = np.concatenate([points, points + by])
    assert pair.error(both) == pytest.approx((goals.error(points) + goals.error(points + by)) / 2)


def test_directions_are_reported_in_degrees_and_mm():
    flat = Goals.together([part(Direction(TOP, np.array([0.6, 0, 0.8])), TOP.vertices)])
    corners = np.array([[-3, -3, 2], [3, -3, 2], [3, 3, 2], [-3, 3, 2.0]])
    assert TOP.direction(corners) == pytest.approx([0, 0, 1])
    angle = np.arctan2(0.6, 0.8)
    assert flat.degrees(corners)[0] == pytest.approx(np.degrees(angle))
    # About how far corners are off that are turned: the chord of their way.
    assert flat.distances(corners)[0] == pytest.approx(TOP.radius * 2 * np.sin(angle / 2))
    assert pytest.approx(np.hypot(3.6, 3.6)) == TOP.radius


def test_beams_outside_of_a_body_are_free_and_deep_ones_are_reported():
    course = np.array([[-30.0, 0, 0], [0, 0, 0], [30, 0, 0]])
    ball = trimesh.creation.icosphere(4, 10.0)
    clear = Goals.together(
        [part(ClearOf(Surface(ball.vertices, ball.faces), 1.0, 2.0), courses(1))]
    )
    for height, deep in ((20.0, 0.0), (13.5, 0.0), (12.0, 1.0), (5.0, 8.0), (-12.0, 1.0)):
        assert clear.error(course + np.array([0, 0, height])) == pytest.approx(deep, abs=0.05)


def test_beams_that_cross_are_too_close_and_neighbours_are_not():
    beams = np.array([[0, 1], [1, 2], [3, 4]])
    goals = Goals.together([part(ClearOfItself(beams, 1.0, 2.0), courses(3))])
    course = np.array([[-30.0, 0, 0], [0, 0, 0], [30, 0, 0]])
    along, across = course + np.array([60.0, 0, 0]), course[:, [1, 0, 2]]
    for height, deep in ((3.0, 2.0), (4.9, 0.1), (6.0, 0.0)):
        points = np.concatenate([course, along, across + np.array([7.0, 2, height])])
        # Both beams that cross are too deep by the same.
        assert goals.error(points) == pytest.approx(np.sqrt(2) * deep, abs=0.02)
    assert len(goals.lines(np.concatenate([course, along, across + np.array([7.0, 2, 3])]))) == 1


@pytest.mark.parametrize("kind", ["point", "surface"])
def test_a_free_pose_brings_a_shape_to_where_it_fits(kind):
    source = np.random.default_rng(5)
    vertices = [Vertex("joint", k) for k in range(9)]
    flat = np.stack(np.meshgrid([-40, 0, 40], [-40, 0, 40]), axis=-1).reshape(-1, 2).astype(float)
    there = np.c_[flat, 8 * np.sin(flat[:, 0] / 20) * np.cos(flat[:, 1] / 15)]
    wanted = AtPoints(there) if kind == "point" else OnSet(WAVES, "surface")
    goals = Goals.together([Part(wanted, tuple(vertices), np.ones(9))], Place())
    turn = np.linalg.qr(source.normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    points = Place(turn, source.normal(size=3) * 50)(there)
    begun = goals.begun(points)
    assert begun.error(points) < (1e-6 if kind == "point" else 0.6)
    placed = begun.place(points)(points)
    np.testing.assert_allclose(placed, begun.placed(points), atol=1e-9)
    # Each of several shapes has a motion of its own.
    other = Place.about_z(9.0)(points) + np.array([1.0, 2, 0])
    both = begun.repeated(2).error(np.concatenate([points, other]))
    assert both == pytest.approx((begun.error(points) + begun.error(other)) / 2)
    # Moving the shape as a whole changes nothing once the pose is found.
    moved = Place.about_z(3.0)(points) + np.array([0.5, 0, -0.5])
    assert begun.error(moved) == pytest.approx(float(begun.error(points)), abs=1e-3)
    assert np.isnan(begun.error(np.full((2, 9, 3), np.nan))).all()

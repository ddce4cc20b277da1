"""What may change: symmetry is kept, nothing invalid is let through, nothing valid is kept out."""

import numpy as np
import pytest
from toys import alone, toy

from simulearn.errors import InputError
from simulearn.grid import Grid, Rules, TrainingRange, draw_valid, make, validate
from simulearn.inverse import Goals, Space, Vertex, changes
from simulearn.inverse.task import Free, Pairs
from simulearn.material import load_material

MATERIAL = load_material("pla-hot-water")
# The mirror x -> -x of a 2x2 grid; joints 1, 4 and 7 lie on the line.
PAIRS = Pairs(
    flip="x",
    joints=[[0, 2], [3, 5], [6, 8], [1, 1], [7, 7]],
    actuators=[[0, 2], [1, 4], [5, 7], [6, 9], [10, 11]],
)


def test_a_2x2_grid_has_the_papers_88_modifications_beside_no_change():
    grid = make("saddle", length=65.0)
    space = Space.of(Grid(grid.joints, grid.beams, 0.5 * np.sign(grid.actuators), 4), Free())
    found = changes(space, space.start[1])
    assert len(found) == 8 * 8 + 2 * 12
    assert len({change.words for change in found}) == 88
    moved = [np.linalg.norm(change.dx) for change in found if change.part == "joint"]
    np.testing.assert_allclose(moved, 5.0)
    # An actuator at the end of its range goes one way only.
    full = Space.of(make("dome", length=65.0), Free())
    assert len(changes(full, full.start[1])) == 64 + 12


def test_a_point_leads_to_a_grid_and_back():
    grid = make("flat", length=60.0)
    space = Space.of(grid, Free(pairs=PAIRS))
    source = np.random.default_rng(0)
    x = source.normal(size=len(space.motions))
    a = np.round(4 * source.uniform(-1, 1, len(space.groups))) / 4
    back = space.point(space.grid_at(x, a))
    np.testing.assert_allclose(back[0], x)
    np.testing.assert_array_equal(back[1], a)


def test_partners_stay_symmetric():
    space = Space.of(make("flat", length=60.0), Free(pairs=PAIRS))
    x, a = space.start
    assert (len(x), len(a)) == (3 * 2 + 2, 7)
    source = np.random.default_rng(1)
    grid = space.grid_at(x + source.normal(size=len(x)), source.uniform(-1, 1, len(a)))
    mirror = [2, 1, 0, 5, 4, 3, 8, 7, 6]
    np.testing.assert_allclose(grid.joints[mirror] * [-1, 1], grid.joints, atol=1e-12)
    for b, c in PAIRS.actuators:
        assert grid.actuators[b] == grid.actuators[c]
    assert len(changes(space, a)) == 3 * 8 + 2 * 2 + 7 * 2


def test_what_is_not_free_stays():
    grid = make("cone", length=60.0)
    space = Space.of(grid, Free(joints=[0], actuators=[7]))
    x, a = space.start
    moved = space.grid_at(x + 3.0, a + 0.25)
    assert (moved.joints != grid.joints).any(axis=1).tolist() == [True] + 8 * [False]
    assert (moved.actuators != grid.actuators).nonzero()[0].tolist() == [7]


def test_valid_is_what_validation_says():
    space = Space.of(make("flat", length=45.0), Free())
    source = np.random.default_rng(2)
    x = source.normal(size=(60, len(space.motions))) * 12
    a = np.round(4 * source.uniform(-1, 1, (60, len(space.groups)))) / 4
    valid = space.valid(x, a)
    expected = [validate(space.grid_at(*pair), MATERIAL).valid for pair in zip(x, a, strict=True)]
    np.testing.assert_array_equal(valid, expected)
    assert 0 < valid.sum() < 60


def test_options_are_long_enough_and_nearest_takes_one():
    space = Space.of(draw_valid(Rules(length=(40, 42)), 5, 1)[0], Free())
    x, _ = space.start
    options = space.options(x)
    for b, some in enumerate(options):
        assert 0.0 in some
        for ratio in some:
            grid = Grid(space.grid.joints, space.grid.beams, np.eye(12)[b] * ratio, 4)
            assert validate(grid, MATERIAL).valid
    near = space.nearest(x, np.full(12, 0.2))
    assert all(r in some for r, some in zip(near, options, strict=True))
    assert space.valid(x[None], near[None]).all()


def test_designs_beyond_what_the_engine_has_seen_are_not_offered():
    training = TrainingRange(dimension=(60.0, 100.0), beam_length=(30.0, 70.0))
    grid = make("flat", length=60.0)
    far = np.zeros((1, 16))
    far[0, :2] = -20.0  # joint 0 goes outwards
    none = np.zeros((1, 12))
    assert Space.of(grid, Free()).valid(far, none).all()
    assert not Space.of(grid, Free(), training).valid(far, none).any()
    # A grid that is beyond it anyhow may be changed all the same.
    assert Space.of(make("flat", length=80.0), Free(), training).valid(0 * far, none).all()


@pytest.mark.parametrize(
    ("grid", "free", "message"),
    [
        (make("flat", length=60.0), Free(joints=[], actuators=[]), "lets nothing change"),
        (make("dome", length=16.0), Free(), "the design to begin with: "),
        (
            make("twist", length=60.0),
            Free(pairs=Pairs(actuators=[[0, 2]])),
            "whose ratios differ",
        ),
    ],
)
def test_a_space_that_cannot_be_is_refused(grid, free, message):
    with pytest.raises(InputError, match=message):
        Space.of(grid, free)


def test_vertices_are_picked_by_a_matrix_too():
    source = np.random.default_rng(3)
    joints, sections = source.normal(size=(4, 8, 3)), source.normal(size=(5, 3, 4, 3))
    vertices = [Vertex("joint", 2), Vertex("joint", 1, 6), Vertex("beam", 4, 3, 1)]
    vertices.append(Vertex("beam", 0, None, 2))
    goals = Goals.of(vertices, np.zeros((4, 3)))
    points = goals.points(joints, sections)
    np.testing.assert_array_equal(points[1], joints[1, 6])
    np.testing.assert_array_equal(points[2], sections[4, 1, 3])
    np.testing.assert_allclose(points[0], joints[2].mean(axis=0))
    corners = np.concatenate([joints.reshape(-1, 3), sections.reshape(-1, 3)])
    np.testing.assert_allclose(goals.matrix(4, 5) @ corners, points)


def test_the_error_is_the_weighted_mean_distance():
    goals = Goals.of([Vertex("joint", 0), Vertex("joint", 1)], np.eye(3)[:2], np.array([3, 1]))
    up = np.array([0, 0, 1.0])
    assert goals.error(goals.targets + 2 * up) == pytest.approx(2.0)
    assert goals.error(goals.targets + np.array([[4.0], [0.0]]) * up) == pytest.approx(3.0)
    grid = make("flat")
    assert toy(alone(grid)).shape == (1, 9, 3)

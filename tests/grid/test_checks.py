"""Many designs of one topology checked at once: as each alone."""

import numpy as np
import pytest
from grids import MATERIAL, drawn, moved
from hypothesis import given
from hypothesis import strategies as st

from simulearn.errors import InputError
from simulearn.grid import (
    Grid,
    Rules,
    TrainingRange,
    check_designs,
    clean,
    corner_topology,
    draw,
    drop_beams,
    errors_of,
    lattice,
    make,
    outline,
    validate,
)
from simulearn.grid.checks import coincident
from simulearn.grid.outline import outlines
from simulearn.material import Material

RANGE = TrainingRange(dimension=(60.0, 140.0), beam_length=(30.0, 90.0))


def check(grid, joints, actuators, **options):
    """Return the checks of designs, each of which `validate` judges alike."""
    checks = check_designs(grid.beams, grid.fixed, joints, actuators, MATERIAL, **options)
    for t, (places, ratios) in enumerate(zip(joints, actuators, strict=True)):
        alone = validate(moved(grid, joints=places, actuators=ratios), MATERIAL, **options)
        assert checks.valid[t] == alone.valid
        assert checks.usual[t] == (alone.valid and not alone.warnings)
        if alone.valid:
            net = [checks.net_lengths[t, b] for b in alone.net_lengths]
            np.testing.assert_allclose(net, list(alone.net_lengths.values()), rtol=1e-12)
    return checks


@given(drawn(), st.integers(0, 10**6), st.sampled_from([1.0, 5.0, 20.0]))
@pytest.mark.parametrize("training", [None, RANGE])
def test_a_design_is_valid_among_many_as_it_is_alone(training, grid, seed, size):
    random = np.random.default_rng(seed)
    joints = grid.joints + random.normal(0, size, (6, *grid.joints.shape))
    joints[0] = grid.joints
    joints[1, -1] = joints[1, 0]  # two at one place
    actuators = grid.actuators * random.choice([1.0, 0.5, 0.0], (6, len(grid.beams)))
    check(grid, joints, actuators, training=training)


def test_designs_of_a_valid_topology_are_distinguished():
    grids = [draw(Rules(), 1, k) for k in range(100)]
    checks = check(
        grids[0], np.stack([g.joints for g in grids]), np.stack([g.actuators for g in grids])
    )
    assert 90 < checks.valid.sum() < 100
    assert 0 < checks.usual.sum() < checks.valid.sum()


def test_the_errors_of_many_grids_are_those_of_each():
    grids = [draw(Rules(jitter=60.0), 2, k) for k in range(30)]
    grids += [lattice((1, 1), 8.0), lattice((1, 1)), moved(lattice((1, 1)), fixed=2)]
    grids += [moved(grids[k], fixed=99) for k in range(2)]
    grids += [moved(grids[k], actuators=[0.0]) for k in range(2)]
    grids += [moved(grids[0], joints=grids[0].joints * 1e6), lattice((2, 2))]
    errors = errors_of(grids, [MATERIAL] * len(grids))
    assert errors == [validate(grid, MATERIAL).errors for grid in grids]
    assert 5 < errors.count(()) < 35
    assert errors_of([], []) == []


def test_grids_of_other_materials_are_checked_by_theirs():
    data = MATERIAL.model_dump()
    data["limits"]["actuator_length"] = 50.0
    other = Material.model_validate(data)
    grids = [make("saddle")] * 4
    errors = errors_of(grids, [MATERIAL, other, MATERIAL, other])
    assert [bool(some) for some in errors] == [False, True, False, True]


def test_a_number_out_of_range_is_not_valid():
    grid = make("saddle")
    joints = np.stack([grid.joints] * 5)
    actuators = np.stack([grid.actuators] * 5)
    joints[1, 0, 0], joints[2, 0, 0] = np.nan, -1e9
    actuators[3, 0], actuators[4, 0] = 1.5, np.nan
    checks = check_designs(grid.beams, grid.fixed, joints, actuators, MATERIAL)
    assert checks.valid.tolist() == [True, False, False, False, False]


def test_a_topology_that_is_not_valid_has_no_valid_design():
    square = lattice((1, 1))
    two = Grid(
        np.r_[square.joints, square.joints + 200], np.r_[square.beams, square.beams + 4], [0] * 8, 0
    )
    assert not check(two, two.joints[None], two.actuators[None]).valid.any()
    tree = drop_beams(square, {0, 1})
    assert not check(tree, tree.joints[None], tree.actuators[None]).valid.any()


@pytest.mark.parametrize(
    ("beams", "fixed", "words"),
    [([[0, 9]], 0, "beams[0] is [0, 9]"), ([[0, 0]], 0, "beams[0]"), ([[0, 1]], 5, "fixed is 5")],
)
def test_a_topology_that_is_none_is_refused(beams, fixed, words):
    with pytest.raises(InputError) as refused:
        check_designs(np.array(beams), fixed, np.zeros((2, 4, 2)), np.zeros((2, 1)), MATERIAL)
    assert words in str(refused.value)


@given(st.integers(0, 10**6))
def test_joints_at_one_place_are_those_that_are_near(seed):
    joints = np.random.default_rng(seed).integers(0, 5, (3, 12, 2)) * 6e-4
    apart = np.linalg.norm(joints[:, :, None] - joints[:, None], axis=-1)
    expected = np.argwhere(np.triu(apart < 1e-3, k=1))
    np.testing.assert_array_equal(coincident(joints, 10**6), expected)
    assert set(coincident(joints, 1)[:, 0]) == set(expected[:, 0])


# The outline and its topology, of many designs


@given(drawn(), st.integers(0, 10**6))
def test_outlines_of_many_designs_are_those_of_each(grid, seed):
    try:
        grid = clean(grid)[0]
    except InputError:
        return
    joints = grid.joints + np.random.default_rng(seed).normal(0, 10.0, (4, *grid.joints.shape))
    many = outlines(grid.beams, joints, MATERIAL.section.width)
    topology = corner_topology(grid.beams, joints)
    for t, places in enumerate(joints):
        one = corner_topology(grid.beams, places[None])
        for here, there in zip(topology, one, strict=True):
            np.testing.assert_array_equal(here[t], there[0])
        if many.sound[t].all():
            shape = outline(moved(grid, joints=places), MATERIAL.section)
            np.testing.assert_array_equal(many.joints[t], shape.joints)
            np.testing.assert_array_equal(many.beams[t], shape.beams)
            np.testing.assert_array_equal(many.sides[t], shape.sides)
        else:
            with pytest.raises(InputError, match=f"joint {many.sound[t].argmin()} "):
                outline(moved(grid, joints=places), MATERIAL.section)


@given(drawn())
def test_corners_lie_between_the_beams_that_the_topology_names(grid):
    try:
        grid = clean(grid)[0]
        shape = outline(grid, MATERIAL.section)
    except InputError:
        return
    before, after, parts, part, side = (
        x[0] for x in corner_topology(grid.beams, grid.joints[None])
    )
    start, end = grid.joints[grid.beams.T]
    along = np.concatenate([end - start, start - end])
    first = np.arctan2(along[:, 1], along[:, 0])
    gap = (first[after] - first[before]) % (2 * np.pi)
    gap[before == after] = 2 * np.pi
    bisector = first[before] + gap / parts * (part + 0.5)
    corner = shape.joints - grid.joints[:, None]
    np.testing.assert_allclose(
        np.exp(1j * bisector), (corner @ [1, 1j]) / np.linalg.norm(corner, axis=-1), atol=1e-9
    )
    np.testing.assert_array_equal(side.T, shape.sides)
    # Around a joint each gap has its parts in turn, and there are four in all.
    for joint in range(len(grid.joints)):
        pairs = list(zip(before[joint], part[joint], parts[joint], strict=True))
        assert len(set(pairs)) == 4
        assert all((half, k, n) in pairs for half, _, n in pairs for k in range(n))


def test_a_joint_of_no_beam_or_five_has_no_topology():
    with pytest.raises(InputError, match="joint 2 has 0 beams; a joint takes 1 to 4"):
        corner_topology(np.array([[0, 1]]), np.zeros((1, 3, 2)))
    star = np.array([[0, k] for k in range(1, 6)])
    with pytest.raises(InputError, match="joint 0 has 5 beams"):
        corner_topology(star, np.random.default_rng(0).normal(size=(1, 6, 2)))


# Sizes


def ladder(n, apart):
    """Return a row of n squares."""
    x = apart * np.arange(n + 1)
    joints = np.concatenate([np.c_[x, 0 * x], np.c_[x, 0 * x + apart]])
    k = np.arange(n)
    beams = np.concatenate(
        [
            np.c_[k, k + 1],
            np.c_[k, k + 1] + n + 1,
            np.c_[np.arange(n + 1), np.arange(n + 1) + n + 1],
        ]
    )
    return Grid(joints, beams, np.zeros(len(beams)), 0)


def test_a_large_grid_is_validated():
    assert validate(ladder(999, 60.0), MATERIAL).valid


def test_a_grid_beyond_the_limit_is_refused_in_one_line():
    grid = ladder(10_000, 1.0)
    (error,) = validate(grid, MATERIAL).errors
    assert (error.code, error.where) == ("too-large", "grid")
    assert error.message == "the grid has 20002 joints; at most 20000 can be computed"


def test_of_countless_errors_of_one_kind_a_thousand_are_named():
    grid = ladder(200, 1.0)
    heap = moved(grid, joints=grid.joints * [1e-6, 60.0])
    assert sum(e.code == "joints-coincide" for e in validate(heap, MATERIAL).errors) == 1000
    crowd = moved(grid, joints=grid.joints * [0.05, 60.0])
    assert sum(e.code == "overlap" for e in validate(crowd, MATERIAL).errors) == 1000

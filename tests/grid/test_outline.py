"""Outlines: laws that hold for every grid, then the joint rule case by case."""

import numpy as np
import pytest
from grids import HALF, SECTION, around, corner_turns, cross, moved, outlined, star, valid
from hypothesis import given
from hypothesis import strategies as st

from simulearn.errors import InputError
from simulearn.grid import lattice, outline


def same_quads(a, b):
    """Whether quadrilaterals (J, 4, 2) are equal but for which corner is the first."""
    turned = np.stack([np.roll(b, k, axis=1) for k in range(4)])
    return (abs(turned - a).max(axis=(2, 3)) < 1e-9).any(axis=0).all()


# Laws


@given(outlined(), st.floats(0, 2 * np.pi))
def test_a_turned_grid_has_the_turned_outline(grid, angle):
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    here, there = outline(grid, SECTION), outline(moved(grid, grid.joints @ turn), SECTION)
    np.testing.assert_allclose(there.beams, here.beams @ turn, atol=1e-9)
    assert same_quads(there.joints, here.joints @ turn)


@given(outlined())
def test_a_mirrored_grid_has_the_mirrored_outline(grid):
    mirror = np.array([1, -1])
    here, there = outline(grid, SECTION), outline(moved(grid, grid.joints * mirror), SECTION)
    np.testing.assert_allclose(there.beams, here.beams[:, :, ::-1] * mirror, atol=1e-9)
    assert same_quads(there.joints, here.joints[:, ::-1] * mirror)


@given(outlined())
def test_a_beam_turned_end_for_end_has_the_same_outline(grid):
    here = outline(grid, SECTION)
    there = outline(moved(grid, beams=grid.beams[:, ::-1]), SECTION)
    np.testing.assert_array_equal(there.joints, here.joints)
    np.testing.assert_array_equal(there.sides, here.sides[:, ::-1])
    np.testing.assert_array_equal(there.beams, here.beams[:, ::-1, ::-1])


@given(outlined())
def test_long_edges_lie_half_a_width_beside_the_axis(grid):
    start, end = grid.joints[grid.beams.T]
    axis = (end - start) / np.linalg.norm(end - start, axis=1, keepdims=True)
    beside = cross(axis[:, None, None], outline(grid, SECTION).beams - start[:, None, None])
    np.testing.assert_allclose(beside, np.broadcast_to([-HALF, HALF], beside.shape), atol=1e-9)


@given(outlined())
def test_beams_end_in_the_very_corners_of_joints(grid):
    shape = outline(grid, SECTION)
    for (i, j), (a, b), (start, end) in zip(grid.beams, shape.sides, shape.beams, strict=True):
        np.testing.assert_array_equal(start, shape.joints[i][[a, (a + 1) % 4]])
        np.testing.assert_array_equal(end, shape.joints[j][[(b + 1) % 4, b]])


@given(outlined())
def test_no_two_beams_share_a_side(grid):
    sides = outline(grid, SECTION).sides
    taken = {(j, s) for j, s in zip(grid.beams.ravel(), sides.ravel(), strict=True)}
    assert len(taken) == sides.size


@given(outlined())
def test_joints_are_convex_and_begin_at_the_smallest_angle(grid):
    joints = outline(grid, SECTION).joints
    assert (corner_turns(joints) > 0).all()
    x, y = np.moveaxis(joints - grid.joints[:, None], -1, 0)
    angle = (np.arctan2(y, x) + 1e-8) % (2 * np.pi)
    assert (angle.argmin(axis=1) == 0).all()


@given(valid())
def test_every_part_of_a_valid_design_is_convex_and_positive(grid):
    shape = outline(grid, SECTION)
    assert (corner_turns(shape.joints) > 0).all()
    assert (corner_turns(around(shape.beams)) > 0).all()


# The joint rule


def corners(*angles, **options):
    """Return where (mm, degrees) the corners of a star's middle joint lie."""
    (x, y) = outline(star(*angles, **options), SECTION).joints[0].T
    return np.hypot(x, y), np.degrees(np.arctan2(y, x)) % 360


@pytest.mark.parametrize(
    ("angles", "expected"),
    [
        ((0, 90, 180, 270), (45, 135, 225, 315)),
        ((0, 90, 180), (45, 135, 225, 315)),  # the gap of 180 in two
        ((0, 90), (45, 135, 225, 315)),  # the gap of 270 in three
        ((0, 180), (45, 135, 225, 315)),  # both gaps in two
        ((0,), (45, 135, 225, 315)),  # a free end: one gap in four
        ((0, 80, 200), (40, 140, 240, 320)),  # the gap of 160 in two
        ((0, 150), (37.5, 112.5, 202.5, 307.5)),  # 210 first, then 150 is the largest part
        ((0, 100), (50, 100 + 130 / 3, 230, 360 - 130 / 3)),  # 260, 130: three parts
        ((0, 120), (30, 90, 180, 300)),  # 120 and 240 in two are tied: the whole gap is divided
        ((0, 120, 240), (30, 90, 180, 300)),  # all three tied: between beams 0 and 1
        ((0, 240, 120), (60, 180, 270, 330)),
    ],
)
@pytest.mark.parametrize("turn", [0.0, 0.1, 45.0, 179.0, 270.0])
def test_gaps_are_divided_where_their_parts_are_largest(angles, expected, turn):
    _, angle = corners(*angles, turn=turn)
    expected = np.sort((np.array(expected) + turn) % 360)
    np.testing.assert_allclose((angle - expected + 180) % 360, 180, atol=1e-9)


def test_a_corner_is_where_the_edges_of_its_neighbours_meet():
    reach, angle = corners(0, 60, 180, 270)
    np.testing.assert_allclose(angle, [30, 120, 225, 315])
    np.testing.assert_allclose(reach, HALF / np.sin(np.radians([30, 60, 45, 45])))


def test_the_joint_of_a_square_lattice_is_a_square():
    shape = outline(lattice((2, 2), 65.0), SECTION)
    square = HALF * np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
    np.testing.assert_allclose(shape.joints[4], square, atol=1e-12)
    np.testing.assert_allclose(
        shape.beams[7], [[[3.6, -3.6], [3.6, 3.6]], [[61.4, -3.6], [61.4, 3.6]]]
    )
    assert shape.sides[7].tolist() == [3, 1]  # the side to +x runs from corner 3 to corner 0
    assert shape.sides[8].tolist() == [0, 2]


@pytest.mark.parametrize("tiny", [-1e-15, 0.0, 1e-15])
def test_a_corner_at_angle_zero_is_the_first_whatever_rounding_did(tiny):
    diagonal = star(45, 135, 225, 315, turn=np.degrees(tiny))
    x, y = outline(diagonal, SECTION).joints[0][0]
    assert x > 0
    assert abs(y) < 1e-12


@pytest.mark.parametrize("tiny", [-1e-13, 0.0, 1e-13])
@pytest.mark.parametrize("angles", [(0, 90, 180), (0, 180), (0, 120), (0, 120, 240)])
def test_rounding_does_not_decide_how_gaps_are_divided(angles, tiny):
    first, *others = angles
    _, here = corners(*angles, turn=10)
    _, there = corners(first + tiny, *others, turn=10)
    np.testing.assert_allclose(there, here, atol=1e-9)


@pytest.mark.parametrize(
    ("grid", "words"),
    [
        (star(0, 5, 180, 270), "joint 0 has a corner of"),
        (star(0, 9), "joint 0 has a corner of"),
        (star(0, 72, 144, 216, 288), "joint 0 has 5 beams; a joint takes 2 to 4"),
        (star(0, 90, 90), "beams 1 and 2 leave joint 0 in one direction"),
        (star(0, 90, length=0.0), "joint 0 lies where joint 1 lies"),
        (moved(star(0), joints=[[0, 0], [60, 0], [0, 60]]), "joint 2 has 0 beams"),
    ],
)
def test_a_joint_without_a_sound_outline_is_named(grid, words):
    with pytest.raises(InputError, match=words):
        outline(grid, SECTION)

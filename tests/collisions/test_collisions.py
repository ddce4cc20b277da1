"""Beams and joints that meet are found, with depth, frame and place; what is joined is not."""

import numpy as np
import pytest
import trimesh

import synthetic
from simulearn.collisions import Body, against, between, find, find_all
from simulearn.grid import lattice, library, make

WIDE, THICK = 7.2, 4.0
APART = np.array([[0, 1], [2, 3]])


def beam(start, end, bulge=(0, 0, 0), up=(0, 0, 1)):
    """Return the sections (3, 4, 3) of a beam whose middle is moved by a bulge."""
    start, end, up = (np.asarray(x, float) for x in (start, end, up))
    left = np.cross(up, end - start)
    left *= WIDE / 2 / np.linalg.norm(left)
    over = THICK / 2 * up
    places = start, (start + end) / 2 + bulge, end
    return np.array([[c - left - over, c + left - over, c - left + over, c + left + over]
                     for c in places])  # fmt: skip


def cube(centre, size):
    """Return corners (8, 3) of a joint."""
    square = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]]) * size / 2
    flat = [np.column_stack([square, np.full(4, z)]) for z in (-size / 2, size / 2)]
    return np.concatenate(flat) + centre


FAR = np.array([cube((1000.0 + 100 * k, 0, 0), 7.2) for k in range(4)])


def found(*frames, ends=APART, joints=FAR, **options):
    """Return collisions of beams (B, 3, 4, 3) in each of several frames."""
    sections = np.array(frames)
    return find(np.repeat(joints[None], len(sections), axis=0), sections, ends, **options)


@pytest.mark.parametrize(("height", "depth"), [(0.0, 4.0), (1.0, 3.0), (3.5, 0.5), (4.2, 0)])
@pytest.mark.parametrize("angle", [20, 60, 90])
def test_two_crossing_beams_are_as_deep_as_they_overlap(height, depth, angle):
    c, s = 40 * np.cos(np.radians(angle)), 40 * np.sin(np.radians(angle))
    first = beam((0, 0, 0), (60, 0, 0))
    second = beam((31 - c, 2 - s, height), (31 + c, 2 + s, height))
    collisions = found([first, second])
    assert len(collisions) == (depth > 0)
    if depth:
        assert collisions[0].parts == ("beam 0", "beam 1")
        assert collisions[0].beams == (0, 1)
        assert collisions[0].depth_mm == pytest.approx(depth, abs=1e-9)
        assert np.allclose(collisions[0].place, (31, 2, height / 2), atol=6)
        assert collisions[0].first == collisions[0].frame == collisions[0].share == 0


def test_beams_side_by_side_are_as_deep_as_they_overlap():
    first = beam((0, 0, 0), (60, 0, 0))
    assert found([first, beam((5, 6.7, 0), (65, 6.7, 0))])[0].depth_mm == pytest.approx(0.5)
    assert not found([first, beam((5, 7.3, 0), (65, 7.3, 0))])


def test_curled_beams_are_followed():
    """A beam that curls up around another passes nowhere near its own chord."""
    flat = beam((0, 0, 0), (60, 0, 0))
    arch = beam((0, 0, 0), (60, 0, 0), (0, 0, 30))
    over, under = beam((30, -20, 31), (30, 20, 31)), beam((30, -20, 5), (30, 20, 5))
    aside = beam((30, 60, 0), (30, 90, 0))
    collisions = found([flat, aside], [arch, over], [arch, aside])
    assert collisions[0].frame == 1
    assert collisions[0].depth_mm == pytest.approx(3.0, abs=0.1)
    assert not found([flat, aside], [arch, under])


def test_a_meeting_between_two_frames_is_found():
    still = beam((0, 0, 0), (60, 0, 0))
    above, below = (beam((30, -20, z), (30, 20, z)) for z in (14, -18))
    (collision,) = found([still, above], [still, below])
    assert (collision.frame, collision.first) == (0, 1)
    assert collision.share == pytest.approx(14 / 32, abs=0.02)
    assert collision.depth_mm == pytest.approx(4.0, abs=0.3)
    assert not found([still, above], [still, beam((30, -20, 6), (30, 20, 6))])


def test_the_first_and_the_worst_frame():
    still = beam((0, 0, 0), (60, 0, 0))
    steps = [beam((30, -20, z), (30, 20, z)) for z in (9, 5, 3.5, 1, 3)]
    (collision,) = found(*[[still, step] for step in steps])
    assert (collision.first, collision.frame, collision.share) == (2, 3, 0)


def test_beams_of_one_joint_meet_only_away_from_it():
    joints = np.array([cube(c, 7.2) for c in ((-3.6, 0, 0), (63.6, 0, 0), (0, 500, 0))])
    ends = np.array([[0, 1], [1, 2]])
    first = beam((0, 0, 0), (60, 0, 0))
    side = beam((63.6, 3.6, 0), (63.6, 60, 0))
    assert not found([first, side], ends=ends, joints=joints)
    hair_pin = beam((67.2, 0, 0), (10, 0, 3), (30, 0, 20))  # curls up and back onto the first
    (collision, *_) = found([first, side], [first, hair_pin], ends=ends, joints=joints)
    assert collision.parts == ("beam 0", "beam 1")
    assert collision.place[0] < 40


def test_neighbours_that_pass_each_other_between_two_frames():
    """In both frames a plane parts them, but not the same one: as in a snap."""
    joints = np.array([cube(c, 7.2) for c in ((0, 0, 0), (-80, 0, 0), (0, 300, 0))])
    ends = np.array([[0, 1], [0, 2]])
    still = beam((-12, 0, 0), (-70, 0, 0))
    sides = [beam((-8, 8 * y, 0), (-45, 45 * y, 0)) for y in (1, -1)]
    assert not found([still, sides[0]], [still, sides[0]], ends=ends, joints=joints)
    assert not found([still, sides[1]], ends=ends, joints=joints)
    (collision,) = found([still, sides[0]], [still, sides[1]], ends=ends, joints=joints)
    assert collision.parts == ("beam 0", "beam 1")
    assert 0.2 < collision.share < 0.8


def test_a_joint_meets_a_beam_and_a_joint():
    still, aside = beam((0, 0, 0), (60, 0, 0)), beam((30, 60, 0), (30, 90, 0))
    joints = FAR.copy()
    joints[2] = cube((30, 0, 5.0), 7.2)
    (collision,) = found([still, aside], joints=joints)
    assert collision.parts == ("beam 0", "joint 2")
    assert collision.depth_mm == pytest.approx(0.6)
    joints[2], joints[3] = cube((30, 200, 0), 7.2), cube((30, 207, 0), 7.2)
    (collision,) = found([still, aside], joints=joints)
    assert collision.parts == ("joint 2", "joint 3")


def test_turned_and_moved_bodies_collide_alike():
    rng = np.random.default_rng(3)
    start = [beam((0, 0, 0), (60, 0, 0)), beam((30, -20, 9), (30, 20, 9))]
    end = [beam((0, 0, 0), (60, 0, 0), (0, 0, 9)), beam((25, -20, 8), (30, 20, 9), (2, 0, 1))]
    reference = found(start, end)
    q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    q *= np.linalg.det(q)
    shift = rng.normal(size=3) * 50
    moved = [np.array(f) @ q.T + shift for f in (start, end)]
    (turned,) = found(*moved, joints=FAR @ q.T + shift)
    assert turned.depth_mm == pytest.approx(reference[0].depth_mm, abs=1e-9)
    assert np.allclose(q @ reference[0].place + shift, turned.place)
    swapped = found(start[::-1], end[::-1])
    assert swapped[0].depth_mm == pytest.approx(reference[0].depth_mm, abs=1e-9)


def test_many_beams_and_many_designs():
    """The sweep over boxes finds what single comparisons find."""
    rng = np.random.default_rng(5)
    middles = rng.uniform(0, 150, (120, 3))
    directions = rng.normal(size=(120, 3)) * [1, 1, 0.2]
    directions *= 30 / np.linalg.norm(directions, axis=1, keepdims=True)
    beams = np.array([beam(m - w, m + w) for m, w in zip(middles, directions, strict=True)])
    ends = np.arange(240).reshape(120, 2)
    joints = np.array([cube((1e4 + 100 * k, 0, 0), 7.2) for k in range(240)])
    together = find_all(joints[None, None].repeat(2, 0), beams[None, None].repeat(2, 0), ends)
    assert together[0] == together[1]
    pairs = {c.beams: c.depth_mm for c in together[0]}
    assert len(pairs) > 30  # more than there is room for at first
    for i in range(0, 120, 7):
        for j in range(i + 1, 120):
            alone = found([beams[i], beams[j]])
            assert bool(alone) == ((i, j) in pairs)


@pytest.mark.parametrize("name", sorted(library()))
def test_no_grid_of_the_library_collides_flat(name):
    for grid in (make(name), make(name, (3, 1), 40.0), lattice((3, 3))):
        flat = synthetic.result(grid, solid=False)
        assert find(flat.joints[:1], flat.beams[:1], grid.beams, grid.actuators) == ()


def test_bodies_of_an_assembly():
    grid = lattice((2, 2))
    flat = synthetic.result(grid, solid=False)
    body = Body(flat.joints, flat.beams, grid.beams, grid.actuators)
    above, far = (
        body._replace(joints=body.joints + shift, sections=body.sections + shift)
        for shift in ([30, 5, 3.5], [0, 0, 90])
    )
    assert between([body, far]) == ()
    assert between([body]) == ()
    collisions = between([far, body, above])
    assert {c.bodies for c in collisions} == {(1, 2)}
    assert any(c.frame == 0 and c.first == 0 for c in collisions)
    assert max(int(c.parts[1].split()[1]) for c in collisions if "joint" in c.parts[1]) < 9


def test_an_obstacle():
    grid = lattice((2, 2))
    flat = synthetic.result(grid, solid=False)
    body = Body(flat.joints[:1], flat.beams[:1], grid.beams, grid.actuators)
    edge = float(flat.joints[0, ..., 0].max())
    wall = trimesh.creation.box((10, 400, 100))
    wall.apply_translation((edge + 5 - 1.5, 0, 0))
    collisions = against(body, wall.triangles)
    assert {c.parts[1] for c in collisions} == {"obstacle"}
    assert {c.parts[0] for c in collisions if "joint" in c.parts[0]} == {"joint 2", "joint 5",
                                                                        "joint 8"}  # fmt: skip
    assert max(c.depth_mm for c in collisions) == pytest.approx(1.5, abs=1e-6)
    wall.apply_translation((2, 0, 0))
    assert against(body, wall.triangles) == ()
    inside = trimesh.creation.box((1000, 1000, 1000))  # no triangle is near
    assert len(against(body, inside.triangles)) == len(grid.beams) + len(grid.joints)
    sheet = np.array([[[edge - 1, -900, -90], [edge - 1, 900, -90], [edge - 1, 0, 900]]])
    assert max(c.depth_mm for c in against(body, sheet)) == pytest.approx(1.0)
    assert against(body, np.empty((0, 3, 3))) == ()

"""Where grids lie on the bed."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from simulearn.errors import InputError
from simulearn.fabricate import load_printer, prepare
from simulearn.fabricate.bed import EDGE, GAP, _packed, place
from simulearn.grid import Grid, make, outline
from simulearn.material import load_material, material

SECTION = load_material("pla-hot-water").section


def boxes(grids):
    corners = [outline(grid, SECTION).joints.reshape(-1, 2) for grid in grids]
    return [(c.min(axis=0), c.max(axis=0)) for c in corners]


@pytest.mark.parametrize("name", ["prusa-mk4", "makerbot-2x"])
def test_one_grid_lies_amid_the_bed(name):
    bed = load_printer(name).bed
    ((low, high),) = boxes(place([make("dome")], SECTION, load_printer(name)))
    np.testing.assert_allclose((low + high) / 2, (np.array(bed.low) + bed.high) / 2, atol=1e-9)


def test_many_grids_lie_apart_and_on_the_bed():
    printer = load_printer("stacker-s4")
    grids = [make("dome", (1 + k % 3, 1 + k % 2), 30.0 + 4 * k) for k in range(6)]
    placed = boxes(place(grids, SECTION, printer))
    shapes = [shapely.box(*low, *high) for low, high in placed]
    for k, one in enumerate(shapes):
        for other in shapes[:k]:
            assert shapely.distance(one, other) >= GAP - 1e-6
    low, high = np.min([a for a, _ in placed], axis=0), np.max([b for _, b in placed], axis=0)
    assert (low >= np.array(printer.bed.low) + EDGE - 1e-6).all()
    assert (high <= np.array(printer.bed.high) - EDGE + 1e-6).all()


def test_a_long_grid_is_turned_where_that_helps_and_never_mirrored():
    printer = load_printer("prusa-mk4")  # 250 x 210
    grid = make("scroll", (1, 3), 75.0)  # 82 x 232
    (turned,) = place([grid], SECTION, printer)
    ((low, high),) = boxes([turned])
    np.testing.assert_allclose(high - low, [232.2, 82.2], atol=1e-6)
    before, after = (np.diff(g.joints[[0, 1, 2]], axis=0) for g in (grid, turned))
    assert np.linalg.det(before) * np.linalg.det(after) > 0
    np.testing.assert_allclose(after @ [[0, -1], [1, 0]], before, atol=1e-9)


def test_two_that_fit_only_when_turned_are_turned():
    grids = [make("flat", (1, 3), 55.0)] * 3  # 62 x 172
    placed = boxes(place(grids, SECTION, load_printer("prusa-mk4")))
    assert len(placed) == 3


@given(st.lists(st.tuples(st.floats(30.0, 120.0), st.floats(30.0, 120.0)), min_size=1, max_size=7))
def test_boxes_lie_in_the_room_and_apart(sizes):
    sizes, room = np.array(sizes), np.array([248.0, 208.0])
    packed = _packed(sizes, room)
    if packed is None:
        assert len(sizes) > 1
        return
    corners, turned = packed
    sizes = np.where(turned[:, None], sizes[:, ::-1], sizes)
    assert (corners >= 0).all()
    assert (corners + sizes <= room + 1e-6).all()
    for k, (corner, size) in enumerate(zip(corners, sizes, strict=True)):
        beside = np.maximum(corner - corners - sizes, corners - corner - size).max(axis=1)
        assert (np.delete(beside, k) >= GAP - 1e-6).all()


def test_grids_that_rows_do_not_take_fit():
    # Beside the tall one two low ones lie one above the other.
    sizes = np.array([[100.0, 200.0], [130.0, 90.0], [130.0, 95.0]])
    corners, turned = _packed(sizes, np.array([248.0, 208.0]))
    assert not turned.any()
    assert len(set(corners[:, 1])) == 2


def test_what_does_not_fit_is_refused_with_its_size():
    with pytest.raises(InputError, match=r"the grid is 307.2 x 307.2 mm, larger .*\(248.0 x 208.0"):
        prepare([make("dome", (4, 4), 75.0)], load_printer("prusa-mk4"))
    with pytest.raises(InputError, match="the 3 grids do not fit beside one another"):
        prepare([make("dome")] * 3, load_printer("prusa-mk4"))


def test_the_skirt_draws_near_where_the_bed_ends_or_is_left_out():
    ends = load_printer("prusa-mk4")
    job = prepare([make("dome", (3, 2), 75.0)], ends)  # 232 x 157 on 250 x 210
    assert [w.code for w in job.warnings] == ["untried", "override", "skirt"]
    low, high = job.path.bounds
    assert (low > 0).all()
    assert (high < (250, 210)).all()
    job = prepare([make("dome", (3, 2), 79.0)], ends)  # 244.2 wide
    assert "no room for a skirt" in job.warnings[-1].message
    assert {b.role for b in job.path.layers[0].beads} == {"brim", "shell", "active", "joint"}


def test_materials_are_not_mixed(tmp_path):
    text = (material.HERE / "pla-hot-water.toml").read_text()
    other = tmp_path / "other.toml"
    other.write_text(text.replace('name = "pla-hot-water"', 'name = "other"'))
    dome = make("dome", length=30.0)
    grid = Grid(dome.joints, dome.beams, dome.actuators, dome.fixed, str(other))
    with pytest.raises(InputError, match="of different materials"):
        prepare([dome, grid], load_printer("stacker-s4"), ["a", "b"])


def test_no_grid_is_no_print():
    with pytest.raises(InputError, match="there is no grid"):
        prepare([], load_printer("voron"))

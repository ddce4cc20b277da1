"""Where grids lie on the bed."""

import tomllib

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from simulearn.errors import InputError
from simulearn.fabricate import Printer, load_printer, prepare, profile_text
from simulearn.fabricate.bed import EDGE, GAP, _packed, place
from simulearn.grid import Grid, make, outline
from simulearn.material import load_material
from simulearn.material.reading import HERE

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
    text = (HERE / "pla-hot-water.toml").read_text()
    other = tmp_path / "other.toml"
    other.write_text(text.replace('name = "pla-hot-water"', 'name = "other"'))
    dome = make("dome", length=30.0)
    grid = Grid(dome.joints, dome.beams, dome.actuators, dome.fixed, str(other))
    with pytest.raises(InputError, match="of different materials"):
        prepare([dome, grid], load_printer("stacker-s4"), ["a", "b"])


def test_no_grid_is_no_print():
    with pytest.raises(InputError, match="there is no grid"):
        prepare([], load_printer("voron"))


def bed_of(name="ender-3", **bed):
    data = tomllib.loads(profile_text(name))
    data["bed"].pop("shape")
    data["bed"] |= bed
    data["code"] = {"start": "G28", "end": "M84"}
    data["print"]["nozzle"] = 0.6
    data.pop("reach", None)
    return Printer.model_validate(data)


def printed(job):
    """Return all points that are printed, (n, 2) mm."""
    return np.concatenate([bead.points for layer in job.path.layers for bead in layer.beads])


DELTA = {"width": 260.0, "depth": 260.0, "origin": "centre"}


def test_a_round_bed_takes_what_lies_in_its_circle():
    printer = bed_of(**DELTA, shape="round")
    job = prepare([make("dome", (2, 2), 78.0)], printer)  # corners 115 mm from the middle
    assert job.gcode
    assert np.hypot(*printed(job).T).max() <= 130.0
    assert any(w.code == "skirt" for w in job.warnings)  # 20 mm out it would leave the bed
    corner = bed_of(width=260.0, depth=260.0, shape="round")
    away = np.hypot(*(printed(prepare([make("dome", (2, 2), 60.0)], corner)) - 130.0).T)
    assert away.max() <= 130.0
    with pytest.raises(InputError, match=r"is 217.2 x 217.2 mm, larger than .* circle of 258.0 mm"):
        prepare([make("flat", (3, 3), 70.0)], printer)


def test_an_odd_grid_lies_amid_a_round_bed_by_its_circle():
    """A grid of three cells around a corner; its box would reach further out than its circle."""
    grid = make("flat", (2, 2), 80.0)
    kept = [k for k, beam in enumerate(grid.beams.tolist()) if 8 not in beam]  # without a corner
    ends = np.unique(grid.beams[kept])
    number = np.full(len(grid.joints), -1)
    number[ends] = np.arange(len(ends))
    odd = Grid(grid.joints[ends], number[grid.beams[kept]], grid.actuators[kept], 0)
    printer = bed_of(width=252.0, depth=252.0, shape="round")
    (placed,) = place([odd], SECTION, printer)
    corners = outline(placed, SECTION).joints.reshape(-1, 2)
    circle = shapely.minimum_bounding_circle(shapely.multipoints(corners))
    centre = shapely.get_coordinates(shapely.centroid(circle))[0]
    np.testing.assert_allclose(centre, (126.0, 126.0), atol=1e-6)


def test_several_grids_lie_in_a_round_bed():
    printer = bed_of(**DELTA, shape="round")
    job = prepare([make("dome", (1, 1), 70.0)] * 4, printer)
    assert job.gcode
    assert np.hypot(*printed(job).T).max() <= 130.0
    with pytest.raises(InputError, match="do not fit beside one another"):
        prepare([make("dome", (1, 1), 79.0)] * 5, printer)


def test_the_shape_is_computed_where_it_matters():
    printer = bed_of(**DELTA)
    grid = make("flat", (3, 3), 70.0)  # 154 mm from the middle
    with pytest.raises(InputError, match='write shape = "round" or shape = "rectangle"'):
        prepare([grid], printer)
    assert prepare([grid], bed_of(**DELTA, shape="rectangle")).gcode
    # The skirt alone: 20 mm out it leaves the circle.
    job = prepare([make("flat", (2, 2), 78.0)], printer)
    with pytest.raises(InputError, match="the print is wider than a round bed"):
        job.gcode  # noqa: B018
    assert prepare([make("flat", (1, 1), 70.0)], printer).gcode  # it does not matter
    assert not bed_of(width=246.0, depth=152.0, origin="centre").bed.shape_unclear
    assert not bed_of(width=260.0, depth=260.0).bed.shape_unclear


def test_start_and_end_code_stay_on_a_round_bed():
    data = bed_of(**DELTA, shape="round").model_dump()
    data["code"] |= {"start": "G28\nG0 X-120 Y-100 Z5"}
    with pytest.raises(
        InputError, match=r"leads 156.2 mm away from the middle of the bed, which is"
    ):
        prepare([make("flat", (1, 1), 70.0)], Printer.model_validate(data)).gcode  # noqa: B018
    data["bed"]["shape"] = None
    with pytest.raises(InputError, match=r"code.start, line 2: leads 156.2 mm .* write shape"):
        prepare([make("flat", (1, 1), 70.0)], Printer.model_validate(data)).gcode  # noqa: B018


@pytest.mark.parametrize("zone", [[[0, 0], [18, 28]], [[150, 220], [60, 190]], [[0, 0], [220, 70]]])
def test_nothing_is_printed_in_an_excluded_zone(zone):
    low, high = np.sort(np.array(zone, dtype=float), axis=0)
    printer = bed_of(excluded=[tuple(map(tuple, np.array(zone, dtype=float).tolist()))])
    for grids in ([make("dome", (2, 1), 70.0)], [make("twist", (1, 1), 50.0)] * 3):
        job = prepare(grids, printer)
        assert job.gcode
        for bead in (bead for layer in job.path.layers for bead in layer.beads):
            line = shapely.linestrings(bead.points)
            assert not shapely.intersects(line, shapely.box(*low, *high))


def test_a_grid_that_no_zone_leaves_room_for_is_refused():
    with pytest.raises(InputError, match="nothing is printed in its excluded zones"):
        prepare([make("flat", (3, 3), 78.0)], load_printer("bambu-x1"))
    amid = bed_of(excluded=[((100.0, 100.0), (120.0, 120.0))])
    with pytest.raises(InputError, match="nothing is printed in its excluded zones"):
        prepare([make("flat", (1, 2), 70.0)] * 3, amid)
    assert prepare([make("flat", (1, 1), 80.0)], amid).gcode


@pytest.mark.parametrize(
    ("bed", "words"),
    [
        ({"width": 200.0, "shape": "round"}, "a round bed is as deep as it is wide"),
        ({"excluded": [((0.0, 0.0), (0.0, 5.0))]}, "zone 0 has no area"),
        ({"excluded": [((0.0, 0.0),)]}, "excluded"),
    ],
)
def test_wrong_beds_are_refused(bed, words):
    with pytest.raises(ValidationError, match=words):
        bed_of(**bed)


def test_a_bed_of_another_origin_takes_over_no_shape_and_no_zones(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text('base = "bambu-x1"\n[bed]\norigin = "centre"\n')
    mine = load_printer(path)
    assert (mine.bed.shape, mine.bed.excluded, mine.reach.y) == (None, [], None)
    path.write_text('base = "bambu-x1"\ntitle = "mine"\n')
    assert load_printer(path).reach.y == (0.0, 265.0)

"""The first layer: speed, height and flow of its own, a skirt, and a brim that is cut off."""

import numpy as np
import pytest
import shapely
from reading import read

from simulearn.errors import InputError
from simulearn.fabricate import load_printer, prepare
from simulearn.fabricate.regions import footprint
from simulearn.grid import make, outline
from simulearn.material import load_material

SECTION = load_material("pla-hot-water").section
LINE, GAP = 0.6, 0.1
GRID = make("twist", (1, 1), 40.0)


def printed(grids=(GRID,), name="stacker-s4", bed=None, **settings):
    """Return a print with other settings, on a bed of another size."""
    printer = load_printer(name)
    update = {"print": printer.print | settings}
    if bed:
        width, depth = bed
        update["bed"] = printer.bed.model_copy(update={"width": width, "depth": depth})
    return prepare(list(grids), printer.model_copy(update=update))


def beads_of(job, *roles):
    return [
        (k, b) for k, layer in enumerate(job.path.layers) for b in layer.beads if b.role in roles
    ]


def area(grid):
    return footprint(outline(grid, SECTION))


def test_beads_of_the_first_layer_are_slow_but_never_faster_than_elsewhere():
    job = printed(first_layer_speed=1600.0)
    for k, bead in beads_of(job, "shell", "active", "passive", "joint"):
        assert bead.speed == (3000 if k else 1600)
    assert all(bead.speed == 1500 for _, bead in beads_of(job, "skirt", "brim"))
    file = read(job.gcode)
    assert set(file.speed[file.prints & (file.layer == 0)]) == {1500, 1600}


def test_the_flow_of_the_first_layer_is_over_that_of_each_role():
    usual, more = printed(first_layer_flow=1.0), printed(first_layer_flow=1.2)
    for (k, a), (_, b) in zip(
        *(
            beads_of(job, "skirt", "brim", "shell", "active", "passive", "joint")
            for job in (usual, more)
        ),
        strict=True,
    ):
        assert b.flow == pytest.approx(a.flow * (1 if k else 1.2))
    fed = [read(job.gcode) for job in (usual, more)]
    first = [file.fed[file.prints & (file.layer == 0)].sum() for file in fed]
    assert first[1] / first[0] == pytest.approx(1.2, rel=1e-4)


@pytest.mark.parametrize("height", [0.2, 0.25, 0.3, 0.35])
def test_a_first_layer_of_its_own_height_leaves_both_halves_as_thick(height):
    job = printed(first_layer_height=height, first_layer_flow=1.0)
    tops = np.array([layer.z for layer in job.path.layers])
    heights = np.array([layer.height for layer in job.path.layers])
    assert heights[0] == height
    np.testing.assert_allclose(heights[1:8], (2.0 - height) / 7)
    np.testing.assert_allclose(heights[8:], 0.25)
    assert (tops[0], tops[7], tops[-1]) == (height, 2.0, 4.0)
    np.testing.assert_allclose(np.cumsum(heights), tops, atol=1e-6)
    # The file has these heights, and as much plastic as without.
    file = read(job.gcode)
    np.testing.assert_allclose(np.unique(file.places[file.prints, 2]), tops, atol=5e-4)
    assert f";MINZ:{height:.3f}" in job.gcode
    same = printed(brim=0.0, skirt_distance=400.0, first_layer_flow=1.0)
    own = printed(brim=0.0, skirt_distance=400.0, first_layer_flow=1.0, first_layer_height=height)
    assert own.part_g == pytest.approx(same.part_g, rel=1e-5)


@pytest.mark.parametrize("height", [1.99, 0.01, 0.7])
def test_a_first_layer_that_leaves_nothing_sensible_is_refused(height):
    with pytest.raises(InputError, match=r"first_layer_height|thicker than the nozzle"):
        printed(first_layer_height=height)


def test_the_brim_runs_outside_the_outline_on_the_first_layer_only():
    job = printed()
    brim = beads_of(job, "brim")
    assert {k for k, _ in brim} == {0}
    assert len(brim) == round(4.0 / LINE)
    assert {bead.grid for _, bead in brim} == {0}
    part = area(job.grids[0])
    whole = shapely.polygons(shapely.get_exterior_ring(part))
    lines = [shapely.linestrings(b.points) for _, b in brim]
    assert not any(shapely.intersects(whole, line) for line in lines)  # nor in the cell
    away = [shapely.distance(part, line) for line in lines]
    wanted = GAP + LINE / 2 + LINE * np.arange(len(brim))
    np.testing.assert_allclose(sorted(away), wanted, atol=0.02)
    assert away == sorted(away, reverse=True)  # the row beside the part is the last
    # Rows tile the strip, to a percent.
    strips = shapely.union_all([shapely.buffer(line, LINE / 2) for line in lines])
    ring = shapely.buffer(whole, GAP + LINE * len(brim)).area - shapely.buffer(whole, GAP).area
    assert strips.area == pytest.approx(ring, rel=0.01)
    assert sum(b.lengths.sum() for _, b in brim) * LINE == pytest.approx(ring, rel=0.01)


def test_a_brim_is_to_be_cut_off_and_that_is_said():
    assert "; cut the brim off before the bath" in printed().gcode
    assert printed().facts["brim"]
    none = printed(brim=0.0)
    assert not none.facts["brim"]
    assert "brim off" not in none.gcode
    assert not beads_of(none, "brim")


def test_the_grids_weigh_what_the_print_does_without_skirt_and_brim():
    job = printed()
    volume = sum(
        float(b.lengths @ b.section) * job.path.layers[k].height
        for k, b in beads_of(job, "shell", "active", "passive", "joint")
    )
    assert job.facts["part_g"] == pytest.approx(volume * 1.25e-3)
    assert job.facts["part_g"] < job.facts["filament_g"]
    assert f"; the grids weigh {volume * 1.25e-3:.2f} g" in job.gcode


def test_brims_of_grids_that_are_near_merge():
    grids = [GRID, make("dome", (1, 1), 30.0)]
    apart = printed(grids)
    assert {bead.grid for _, bead in beads_of(apart, "brim")} == {0, 1}
    job = printed(grids, brim=9.0)  # they are 10 mm apart
    brim = beads_of(job, "brim")
    assert {bead.grid for _, bead in brim} == {-1, 0, 1}
    lines = [shapely.linestrings(bead.points) for _, bead in brim]
    for grid in job.grids:
        assert min(shapely.distance(area(grid), line) for line in lines) > GAP + LINE / 2 - 0.01
    # No bead lies on another: the strips' areas add up to that of their union.
    strips = [shapely.buffer(line, LINE / 2 - 0.01, cap_style="flat") for line in lines]
    total = sum(strip.area for strip in strips)
    assert shapely.union_all(strips).area == pytest.approx(total, rel=0.003)


@pytest.mark.parametrize(("spare", "rows"), [(12.0, 7), (3.0, 4), (1.1, 1), (1.0, 1)])
def test_where_the_bed_ends_the_brim_is_narrower(spare, rows):
    size = 40.0 + 7.2 + 2 * spare
    job = printed(bed=(size, 300.0))
    brim = beads_of(job, "brim")
    assert len(brim) == rows
    low, high = job.path.bounds
    assert low[0] >= LINE / 2
    assert high[0] <= size - LINE / 2
    messages = [w.message for w in job.warnings if w.code == "brim"]
    assert messages == (
        []
        if rows == 7
        else [f"the brim is {rows * LINE:.1f} mm wide instead of 4: the bed ends there"]
    )


def test_the_skirt_stays_outside_of_the_brim():
    job = printed(skirt_distance=2.0)
    (skirt,), brim = ([b for _, b in beads_of(job, role)] for role in ("skirt", "brim"))
    lines = [shapely.linestrings(bead.points) for bead in brim]
    ring = shapely.linestrings(skirt.points)
    assert min(shapely.distance(ring, line) for line in lines) >= LINE + 0.9
    assert shapely.contains(shapely.polygons(skirt.points), shapely.union_all(lines))
    assert [w.message for w in job.warnings if w.code == "skirt"] == [
        "the skirt is 5.3 mm out instead of 2: the brim is in between"
    ]


def test_without_room_for_a_skirt_the_brim_primes():
    job = printed(bed=(40.0 + 7.2 + 2 * 4.5, 300.0))
    assert not beads_of(job, "skirt")
    assert job.path.layers[0].beads[0].role == "brim"
    assert "the brim primes the nozzle" in job.warnings[-1].message

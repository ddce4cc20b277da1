"""Whole prints, read back by another parser: all grids of the library, random ones, more."""

from itertools import pairwise
from math import pi

import numpy as np
import pytest
import shapely
from reading import read

from simulearn.fabricate import load_printer, prepare
from simulearn.fabricate.motion import reach
from simulearn.fabricate.regions import _cuts
from simulearn.grid import Grid, Rules, draw_valid, library, make, outline
from simulearn.material import load_material

MATERIAL = load_material("pla-hot-water")
LINE, LAYER, OVERLAP = 0.6, 0.25, 0.18
FLOW = {"skirt": 0.95, "brim": 0.95, "shell": 0.95, "active": 0.95, "passive": 0.90, "joint": 0.93}
FIRST_FLOW, FIRST_SPEED = 1.05, 1200  # of the first layer
BESIDE = ("skirt", "brim")
PRINTERS = ["modix-big60", "voron", "stacker-s4", "bambu-x1"]
CHUNK = 20


def shape_of(grid):
    shape = outline(grid, MATERIAL.section)
    beams = shape.beams[:, [0, 1, 1, 0], [0, 0, 1, 1]]
    return shapely.union_all(shapely.polygons([*shape.joints, *beams])), shape


def check_file(job):
    """Check what is in the file alone: heat, reach, E, volume, travels, layers."""
    file = read(job.gcode)
    bed, settings = job.printer.bed, job.settings
    # What the start code feeds is not of the print.
    fed, prints = np.where(file.layer >= 0, file.fed, 0.0), file.prints & (file.layer >= 0)
    assert np.isfinite(fed).all()

    # Nothing is extruded cold.
    first, last = np.nonzero(fed > 0)[0][[0, -1]]
    wait = np.nonzero(file.command == "M109")[0]
    wait = wait[wait < first][-1]
    assert file.s[wait] == 205
    cold = np.isin(file.command, ["M104", "M109"]) & (np.nan_to_num(file.s, nan=0) < 205)
    assert not cold[wait:last].any()
    assert (np.nonzero((file.command == "M104") & (file.s == 0))[0] > last).any()

    # Every place is within reach, the whole width of a bead on the bed.
    known = ~np.isnan(file.places).any(axis=1)
    places = file.places[known]
    low, high = np.transpose(list(reach(job.printer).values()))
    assert (places >= low).all()
    assert (places <= high).all()
    low, high = bed.low, bed.high
    assert (file.places[prints, :2] >= np.add(low, LINE / 2)).all()
    assert (file.places[prints, :2] <= np.subtract(high, LINE / 2)).all()

    # Sixteen layers; the nozzle prints at their heights only.
    tops = np.array([layer.z for layer in job.path.layers])
    np.testing.assert_allclose(np.unique(file.places[prints, 2]), tops, atol=5e-4)
    np.testing.assert_allclose(file.places[prints, 2], tops[file.layer[prints]], atol=5e-4)

    # E rises along each bead: what is drawn back is drawn back between beads.
    inside = prints | ((fed != 0) & (file.moved > 0))
    assert (fed[inside] > 0).all()

    # Volume is path times section, bead by bead.
    count = len(file.roles)
    area = pi * settings.filament**2 / 4
    volume = area * np.bincount(file.bead[prints], fed[prints], count)
    beads = [bead for layer in job.path.layers for bead in layer.beads]
    assert [bead.role for bead in beads] == file.roles
    moved = file.moved
    starts = np.cumsum([0, *(len(b.widths) for b in beads)])
    assert starts[-1] == prints.sum()
    widths = np.concatenate([b.widths for b in beads])
    flow = np.array([FLOW[role] for role in file.roles])
    thick = np.array([layer.height for layer in job.path.layers])
    first_layer = file.layer[prints] == 0
    section = widths * thick[file.layer[prints]] * flow[file.bead[prints]]
    section *= np.where(first_layer, FIRST_FLOW, 1.0)
    expected = np.bincount(file.bead[prints], moved[prints] * section, count)
    np.testing.assert_allclose(volume, expected, rtol=0.01)
    np.testing.assert_allclose(volume.sum(), expected.sum(), rtol=1e-4)
    assert fed[prints].sum() == pytest.approx(job.estimate.filament_mm, rel=1e-6)

    # Filament is drawn back where a travel leaves the part, and only there; it is lifted then.
    travels = np.nonzero((file.command == "G0") & (file.moved > 0))[0]
    travels = travels[travels > first]
    drawn = np.cumsum(np.where(prints, 0.0, fed))
    assert (drawn[prints] > -1e-3).all()
    steps = np.stack([file.places[travels - 1, :2], file.places[travels, :2]], axis=1)
    part = shapely.buffer(shapely.union_all([shape_of(grid)[0] for grid in job.grids]), 5e-3)
    shapely.prepare(part)
    inside = shapely.covers(part, shapely.linestrings(steps))
    kinds = np.array(file.roles)
    to_brim = (kinds[file.bead[travels]] == "brim") & (file.moved[travels] < 2 * LINE)
    back = np.abs(drawn[travels] + settings.retraction) < 1e-3
    assert (back | (np.abs(drawn[travels]) < 1e-3)).all()
    assert (inside | to_brim | back).all()
    core = shapely.buffer(part, -1e-2)
    shapely.prepare(core)
    assert not (back & shapely.covers(core, shapely.linestrings(steps))).any()
    above = file.places[travels, 2] - tops[file.layer[travels]]
    assert (above[back] >= settings.lift - 1e-3).all()
    assert (above >= -1e-3).all()
    assert back.sum() / 16 <= 0.6 * len(beads) / 16

    # Speeds are the material's; the first layer is slow.
    shown = np.where(np.isin(kinds[file.bead[prints]], BESIDE), 1500, 3000)
    shown = np.where(first_layer, np.minimum(shown, FIRST_SPEED), shown)
    assert (file.speed[prints] == shown).all()


def strokes_of(bead):
    """Return where the strokes of a bead begin and how they lead, without its turns."""
    steps = np.diff(bead.points, axis=0)
    length = bead.lengths
    return bead.points[:-1], steps / length[:, None], length


def check_directions(job):
    """Check that each role runs as it should, where it should, on every kind of layer."""
    (grid,) = job.grids
    _, shape = shape_of(grid)
    axis = shape.beams.mean(axis=2)
    net = np.linalg.norm(axis[:, 1] - axis[:, 0], axis=1)
    along = (axis[:, 1] - axis[:, 0]) / net[:, None]
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    edges = shape.beams[:, :, 1] - shape.beams[:, :, 0]
    lean = np.abs(np.einsum("bec,bc->be", edges, along) / 7.2).max(axis=1)
    joints: dict[tuple[int, int], np.ndarray] = {}
    squares: list[float] = []  # share of strokes within 6 degrees of square
    for k in (0, 1, 8, 9):
        half = 1 if k >= 8 else -1
        measured = dict.fromkeys(range(len(grid.beams)), 0.0)
        for bead in job.path.layers[k].beads:
            if bead.role not in ("active", "passive", "joint"):
                continue
            number = int(bead.part.split()[1])
            points, direction, length = strokes_of(bead)
            if bead.role == "joint":
                double = (
                    direction[:, 0] + 1j * direction[:, 1]
                ) ** 2 @ length  # strokes go to and fro
                mean = np.sqrt(double / abs(double))
                joints[k, number] = np.array([mean.real, mean.imag])
                continue
            u, v = direction @ along[number], direction @ across[number]
            if bead.role == "active":
                assert half * grid.actuators[number] > 0
                strokes = length > 2 * length.min() + LINE
                assert (np.abs(v[strokes]) < 0.01).all()
                x = bead.points @ along[number]
                y = (bead.points - axis[number, 0]) @ across[number]
                middle = x[np.abs(y) < LINE / 2 + 0.01]
                measured[number] = np.ptp(middle) + LINE - 2 * OVERLAP
            else:
                y = (points - axis[number, 0]) @ across[number]
                inner = np.abs(y + v * length / 2) < 2.0  # not among the turns
                tilt = np.abs(u[inner] / v[inner])
                assert (tilt <= lean[number] + 0.02).all()
                x = (points[inner] - axis[number, 0]) @ along[number]
                # Square to the beam but near an oblique end.
                far = np.minimum(x, net[number] - x) > 13 * lean[number] + 4
                if abs(grid.actuators[number]) in (0, 1) and len(bead.points) > 2:
                    assert (tilt[far] < 0.02).all()
                    squares.append(float(length[inner] @ (tilt < 0.1) / length[inner].sum()))
        for number, length in measured.items():
            active = half * grid.actuators[number] > 0
            wanted = abs(grid.actuators[number]) * net[number] if active else 0.0
            assert abs(length - wanted) < 2 * LINE
    assert not squares or np.mean(squares) > 0.6
    for j in range(len(grid.joints)):
        for a, b in ((0, 1), (8, 9)):
            turn = joints[a, j] @ [joints[b, j][1], -joints[b, j][0]]
            assert abs(turn) > 0.3  # far from parallel
            np.testing.assert_allclose(np.abs(joints[a, j] @ joints[8, j]), 1, atol=1e-2)


def check_cover(job, kinds, hollows=0.02):
    """Check that beads cover the outline, no more and, but for overlaps, once.

    Hollows are mm2 that lie farther than a quarter of a line from any bead.
    """
    whole = shapely.union_all([shape_of(grid)[0] for grid in job.grids])
    size = shapely.area(whole)
    for k in kinds:
        layer = job.path.layers[k]
        beads = [bead for bead in layer.beads if bead.role not in BESIDE]
        pieces = np.concatenate([np.stack([b.points[:-1], b.points[1:]], 1) for b in beads])
        widths = np.concatenate([b.widths for b in beads])
        strips = shapely.buffer(shapely.linestrings(pieces), widths / 2, cap_style="square")
        cover = shapely.intersection(shapely.union_all(strips), whole)
        assert shapely.area(cover) > 0.995 * size
        hollow = shapely.buffer(shapely.difference(whole, cover), -LINE / 4)
        assert shapely.area(hollow) < hollows
        centres = shapely.union_all(shapely.linestrings(pieces))
        assert shapely.covers(shapely.buffer(whole, -LINE / 2 + 0.01), centres)
        area = sum(float(b.lengths @ b.widths) for b in beads)
        assert size * 0.995 < area < size * 1.06  # the rest is the overlap of strokes with shells
        check_volume(layer, size, FIRST_FLOW if k == 0 else 1.0)


def check_cover_by_points(job, k, count=800):
    """Check at points drawn in the outline that a bead reaches them: quicker than a union."""
    (grid,) = job.grids
    whole, _ = shape_of(grid)
    random = np.random.default_rng(k).uniform
    low, high = np.reshape(shapely.bounds(whole), (2, 2))
    points = shapely.points(random(low, high, (8 * count, 2)))
    shapely.prepare(whole)
    points = points[shapely.contains(whole, points)]
    beads = [bead for bead in job.path.layers[k].beads if bead.role not in BESIDE]
    pieces = np.concatenate([np.stack([b.points[:-1], b.points[1:]], 1) for b in beads])
    widths = np.concatenate([b.widths for b in beads])
    lines = shapely.linestrings(pieces)
    point, line = shapely.STRtree(lines).query(points, "dwithin", widths.max() / 2)
    near = shapely.distance(points[point], lines[line]) <= widths[line] / 2 + 1e-3
    assert len(points) > count / 4
    assert len(np.unique(point[near])) > 0.985 * len(points)  # a bead's ends are taken as round
    check_volume(job.path.layers[k], shapely.area(whole), FIRST_FLOW if k == 0 else 1.0)


def check_volume(layer, size, first=1.0):
    """Check that a layer's volume is its area by its height by the flow, but for overlaps."""
    beads = [bead for bead in layer.beads if bead.role not in BESIDE]
    volume = sum(float(b.lengths @ b.widths) * b.flow for b in beads) * LAYER
    assert 0.90 * first * size * LAYER < volume < 0.95 * 1.06 * first * size * LAYER


@pytest.mark.parametrize("name", library())
def test_library_grids(name):
    job = prepare([make(name)], load_printer("prusa-mk4"))
    check_file(job)
    check_directions(job)
    check_cover(job, (0, 1, 8, 9))


@pytest.mark.parametrize("first", range(0, 40, CHUNK))
def test_random_grids(first):
    for k in range(first, first + CHUNK):
        grid, _ = draw_valid(Rules(), 4, k)
        job = prepare([grid], load_printer(PRINTERS[k % len(PRINTERS)]))
        check_file(job)
        check_directions(job)
        check_cover_by_points(job, (0, 1, 8, 9)[k % 4])


@pytest.mark.parametrize(
    "rules",
    [
        Rules(cells=(3, 3), jitter=60.0, length=(25.0, 50.0), removed=(0, 4)),
        Rules(cells=(1, 1), jitter=60.0),
        Rules(cells=(3, 1), jitter=40.0, removed=(0, 2)),
        Rules(ratios=(0.31, 0.62, 0.97, 0.998), inactive=0.1),
    ],
)
def test_other_topologies_and_actuator_lengths(rules):
    for k in range(4):
        grid, _ = draw_valid(rules, 11, k)
        job = prepare([grid], load_printer("modix-big60"))
        check_file(job)
        # Some have joints with corners of 15 degrees, where rows begin and end in mid-joint.
        check_cover(job, [(0, 1, 8, 9)[k % 4]], hollows=1.0)


def test_several_grids_are_printed_layer_by_layer():
    grids = [make("dome", length=40.0), make("twist", (1, 2), 50.0), make("wave", (3, 1), 30.0)]
    job = prepare(grids, load_printer("bambu-x1"), ["a", "b", "c"])
    check_file(job)
    check_cover(job, (0, 9))
    for layer in job.path.layers:
        assert {bead.grid for bead in layer.beads} - {-1} == {0, 1, 2}


def test_the_print_is_the_same_wherever_e_is_counted_from():
    text = load_printer("voron")
    files = []
    for extrusion in ("absolute", "relative"):
        extruder = text.extruder.model_copy(update={"extrusion": extrusion})
        job = prepare([make("saddle")], text.model_copy(update={"extruder": extruder}))
        files.append(read(job.gcode))
    moves = [np.isin(file.command, ["G0", "G1"]) for file in files]
    np.testing.assert_allclose(files[0].fed[moves[0]], files[1].fed[moves[1]], atol=2e-5)
    np.testing.assert_array_equal(files[0].places[moves[0]], files[1].places[moves[1]])


def test_thick_filament_takes_less_length_for_the_same_volume():
    thin = load_printer("modix-big60")
    extruder = thin.extruder.model_copy(update={"filament": 2.85})
    thick = thin.model_copy(update={"extruder": extruder})
    a, b = (prepare([make("cone")], printer).estimate for printer in (thin, thick))
    assert a.filament_mm / b.filament_mm == pytest.approx((2.85 / 1.75) ** 2, rel=1e-4)
    assert a.filament_g == pytest.approx(b.filament_g, rel=1e-4)


def test_a_dangling_beam_is_not_printed():
    square = make("flat", (1, 1), 50.0)
    grid = Grid(
        [*square.joints.tolist(), [150.0, 0.0]], [*square.beams.tolist(), [1, 4]], [0.0] * 5, 0
    )
    job = prepare([grid], load_printer("prusa-mk4"))
    assert any("dangles" in warning.message for warning in job.warnings)
    assert len(job.grids[0].beams) == 4
    check_file(job)


@pytest.mark.parametrize(
    ("rest", "reaches"), [(0.0, True), (0.29, True), (0.31, False), (10.0, False)]
)
def test_an_actuator_is_printed_to_the_end_where_less_than_half_a_row_is_left(rest, reaches):
    net = 64.0
    cuts = _cuts((net - 2 * rest) / net, LINE / 2 / net)
    assert [role for role, *_ in cuts] == (
        ["active"] if reaches else ["passive", "active", "passive"]
    )
    assert (cuts[0][1], cuts[-1][2]) == (0.0, 1.0)
    assert all(a[2] == b[1] for a, b in pairwise(cuts))

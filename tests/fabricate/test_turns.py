"""Seams and turns over all layers: none stacks, and both halves get as much plastic."""

from collections import Counter, defaultdict
from math import ceil

import numpy as np
import pytest
import shapely

from simulearn.fabricate import load_printer, prepare
from simulearn.fabricate.order import printing_order
from simulearn.fabricate.regions import footprint
from simulearn.grid import Rules, draw_valid, make, outline

LINE = 0.6
DESIGNS = {
    "twist": make("twist"),
    "wave": make("wave", (2, 3), 50.0),
    "random": draw_valid(Rules(), 150, 3)[0],
    "skewed": draw_valid(Rules(cells=(1, 1), jitter=60.0), 11, 2)[0],
}


def printed(name, **settings):
    printer = load_printer("stacker-s4")
    printer = printer.model_copy(update={"print": printer.print | settings})
    return prepare([DESIGNS[name]], printer)


def beads_by_part(job):
    """Return the beads of each piece of a part on each half, of joints by parity."""
    found = defaultdict(list)
    half = len(job.path.layers) // 2
    for k, layer in enumerate(job.path.layers):
        for bead in layer.beads:
            if bead.role in ("active", "passive", "joint"):
                parity = k % 2 if bead.role == "joint" else 0
                # Strokes that are the same in another order: those of one piece.
                piece = tuple(np.sort(bead.points.round(2), axis=0).sum(axis=0).round(1))
                found[bead.role, bead.part, k // half, parity, piece].append(bead)
    return found


@pytest.mark.parametrize("name", DESIGNS)
def test_no_corner_carries_more_than_its_share_of_seams(name):
    job = printed(name)
    rings = defaultdict(list)
    for layer in job.path.layers:
        for bead in layer.beads:
            if bead.role == "shell":
                points = bead.points[:-1]
                rings[tuple(points.mean(axis=0).round(2))].append(bead.points)
    assert {len(beads) for beads in rings.values()} == {16}
    for beads in rings.values():
        points = beads[0][:-1]
        # Corners: points nearer to one another than a row count as one.
        apart = np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1) >= LINE
        begins = Counter(tuple(points[0]) for points in beads)
        assert len(begins) == min(16, apart.sum())
        assert max(begins.values()) == ceil(16 / apart.sum())
        places = np.array(list(begins))
        gaps = np.linalg.norm(places[:, None] - places, axis=2)[~np.eye(len(places), dtype=bool)]
        assert gaps.min() >= LINE


@pytest.mark.parametrize("name", DESIGNS)
def test_strokes_begin_at_each_of_their_four_ends_as_often(name):
    for (role, *_), beads in beads_by_part(printed(name)).items():
        begins = Counter(tuple(bead.points[0]) for bead in beads)
        assert len(beads) == (4 if role == "joint" else 8)
        if len(begins) == 4:
            assert set(begins.values()) == {len(beads) // 4}
        else:  # an odd number of rows ends at the other side, a single one has two ends
            assert max(begins.values()) <= len(beads) // 2


@pytest.mark.parametrize("name", ["twist", "wave"])
def test_turns_of_passive_strokes_lie_between_all_rows_in_turn(name):
    """A turn leads from one row to the next at one side; half of the layers turn at the other."""
    checked = 0
    for (role, *_), beads in beads_by_part(printed(name)).items():
        if role != "passive" or len(beads[0].points) < 8:
            continue
        turns = Counter()
        for bead in beads:
            short = bead.lengths < 2 * LINE
            middles = (bead.points[:-1] + bead.points[1:])[short] / 2
            turns.update(tuple(m) for m in middles.round(2))
        assert set(turns.values()) == {len(beads) // 2}
        checked += 1
    assert checked > 4


@pytest.mark.parametrize("name", DESIGNS)
def test_halves_weigh_the_same(name):
    job = printed(name, first_layer_flow=1.0)
    solid = footprint(outline(job.grids[0], job.material.section)).area * 2.0
    masses = []
    for half in (job.path.layers[:8], job.path.layers[8:]):
        beads = [(q, b) for q in half for b in q.beads if b.role not in ("skirt", "brim")]
        masses.append(sum(float(b.lengths @ b.section) * q.height for q, b in beads) / solid)
    assert all(0.945 < mass < 0.965 for mass in masses)
    assert masses[0] == pytest.approx(masses[1], abs=0.002)
    # A first layer with more flow adds its share of the half.
    more = printed(name)
    beads = [b for b in more.path.layers[0].beads if b.role not in ("skirt", "brim")]
    plain = [b for b in job.path.layers[0].beads if b.role not in ("skirt", "brim")]
    volume = [sum(float(b.lengths @ b.section) for b in layer) for layer in (beads, plain)]
    assert volume[0] / volume[1] == pytest.approx(1.05, rel=1e-3)


def test_strokes_of_an_actuator_and_of_its_joint_do_not_both_overlap():
    """Where both end at one side, only the actuator's reach beyond it."""
    job = prepare([make("dome", (1, 1), 50.0)], load_printer("stacker-s4"))
    shape = outline(job.grids[0], job.material.section)
    for k in (8, 9):
        reach = {}
        for bead in job.path.layers[k].beads:
            if bead.role in ("active", "joint"):
                strips = shapely.buffer(
                    shapely.linestrings(np.stack([bead.points[:-1], bead.points[1:]], axis=1)),
                    bead.widths / 2 - 1e-6,
                    cap_style="square",
                )
                reach[bead.part] = shapely.union_all(strips)
        inner = shapely.buffer(footprint(shape), -LINE - 0.02)
        for b, beam in enumerate(job.grids[0].beams):
            if f"beam {b}" not in reach:
                continue
            for j in beam:
                both = shapely.intersection(reach[f"beam {b}"], reach[f"joint {j}"])
                both = shapely.intersection(both, inner)
                low, high = np.reshape(shapely.bounds(both), (2, 2))
                assert min(high - low) < 0.18 + 0.02


def test_an_order_is_no_longer_than_that_of_always_the_nearest():
    random = np.random.default_rng(5)
    for count in (1, 2, 7, 30):
        begins = [random.uniform(0, 100, (4, 2)) for _ in range(count)]
        ends = [random.uniform(0, 100, (4, 2)) for _ in range(count)]
        used = [np.zeros(4, dtype=np.int64) for _ in range(count)]
        here, greedy, left = np.zeros(2), 0.0, set(range(count))
        while left:
            away = {(k, v): np.linalg.norm(begins[k][v] - here) for k in left for v in range(4)}
            k, v = min(away, key=away.get)
            greedy += away[k, v]
            here = ends[k][v]
            left.remove(k)
        order = printing_order(begins, ends, np.zeros(2), used)
        assert sorted(k for k, _ in order) == list(range(count))
        assert all(counts.sum() == 1 for counts in used)
        here, length = np.zeros(2), 0.0
        for k, v in order:
            length += np.linalg.norm(begins[k][v] - here)
            here = ends[k][v]
        assert length <= greedy + 1e-6
        again = printing_order(begins, ends, np.zeros(2), used)
        assert not set(order) & set(again)  # every bead begins at another end

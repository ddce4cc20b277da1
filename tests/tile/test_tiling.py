"""Tilings from beginning to end, small: found, stopped, gone on with, written, failed."""

import csv
import json
import os
import signal
import threading
import time
from dataclasses import replace

import numpy as np
import pytest
from modules import RING, command, here, pretended, ring, wavy
from PIL import Image

from simulearn.assembly import read_assembly, simulate_assembly
from simulearn.dataset import cluster_workers
from simulearn.errors import CancelledError, ComputationError, InputError
from simulearn.fabricate.bill import bill_of, bill_text
from simulearn.grid import read_grid
from simulearn.simulate import engine
from simulearn.tile import Settings, between, from_chart, from_quads, heights, tile
from simulearn.tile.pieces import assembled, pieces, tiling_figures
from simulearn.tile.searching import ModuleAnswer

SMALL = Settings(gap_mm=1.0, rounds=1)


@pytest.fixture(scope="module")
def tiled(tmp_path_factory):
    return tile(ring(), SMALL, tmp_path_factory.mktemp("ring"), here())


def test_a_ring_is_one_design_that_fits_the_surface_and_itself(tiled):
    assert len(tiled.grids) == 1
    assert tiled.answers[0].checked
    assert tiled.fit.error_mm < 0.5
    assert tiled.fit.gap_mm < 1.0
    figures = tiling_figures(tiled)
    assert figures["modules"] == 10
    assert figures["pieces"] == 1
    assert figures["deviation_max_mm"] < figures["beam_deviation_max_mm"] < 10
    json.dumps(figures, allow_nan=False)


def test_its_parts_are_where_its_joints_are(tiled):
    together = assembled(tiled)
    assert len(together.parts) == 10
    assert len(together.joined) == 10
    place = together.parts[3].place
    joints = place(np.array(tiled.answers[0].joints))
    np.testing.assert_allclose(joints[tiled.members[3].order], tiled.fit.joints[3], atol=1e-9)


def test_neighbours_lie_side_by_side(tiled):
    assert tiled.settings.inset_mm == 3.6
    together = assembled(tiled)
    assert together.joined_mm < 1.5
    shapes = simulate_assembly(together, engine("learned"))
    assert shapes.collisions == ()
    middles = tiled.beams
    beams = tiled.tiling.lattice.beams
    sides = [b for b in range(4) if abs(np.diff(tiled.tiling.lattice.joints[beams[b], 0])) < 0.1]
    apart = np.linalg.norm(
        middles[:, sides, None] - np.roll(middles, -1, 0)[:, None, sides], axis=-1
    )
    assert 6.0 < apart.min() < 8.4


def test_a_bill_counts_copies(tiled):
    own = pieces(tiled)
    rows = bill_of([(p.name, p.grid, tuple(map(str, p.modules))) for p in own], None)
    lines = list(csv.reader(bill_text(rows).splitlines()))
    assert lines[1][:3] == ["k1", "10", "0 1 2 3 4 5 6 7 8 9"]
    assert lines[-1][:2] == ["all", "10"]


def test_a_mirrored_module_is_printed_as_the_mirrored_grid(tiled):
    members = (replace(tiled.members[0], mirrored=True), *tiled.members[1:])
    own = pieces(replace(tiled, members=members))
    assert [piece.name for piece in own] == ["k1", "k1-mirrored"]
    assert own[1].modules == (0,)
    np.testing.assert_allclose(own[1].grid.joints, own[0].grid.joints * [-1, 1])
    np.testing.assert_array_equal(own[1].grid.actuators, own[0].grid.actuators)


def test_what_was_found_is_not_searched_again(tmp_path):
    seen = []
    first = tile(ring(), SMALL, tmp_path, here(pretended, seen))
    count = len(seen)
    again = tile(ring(), SMALL, tmp_path, here(pretended, seen))
    assert len(seen) == count > 0
    assert again.fit.gap_mm == first.fit.gap_mm
    for path in (tmp_path / "work").iterdir():
        path.write_text("{", encoding="utf-8")  # torn
    tile(ring(), SMALL, tmp_path, here(pretended, seen))
    assert len(seen) == 2 * count


def test_borders_come_together_in_rounds_and_the_best_is_kept():
    stages = []
    result = tile(
        wavy(), replace(SMALL, gap_mm=0.05, rounds=3), None, here(pretended), stages.append
    )
    gaps = [gap for gap, _ in result.rounds]
    assert len(gaps) > 1
    assert result.fit.gap_mm == min(gaps) < 0.6 * gaps[0]
    assert [message.code for message in result.warnings] == ["tile-gap"]
    assert {stage.round for stage in stages} >= {0, 1}


def test_a_shell_of_two_modules():
    chart = heights(
        lambda x, y: 12 * np.cos(x / 90 + 0.3) * np.cos(y / 80), (-55.0, 55.0), (-28.0, 28.0)
    )
    result = tile(from_chart(chart, (2, 1), (1, 1)), replace(SMALL, rounds=0), None, here())
    assert len(result.rounds) == 1
    assert result.fit.error_mm < 1.0
    assert result.fit.gap_mm < 1.5


def test_a_bridge_is_tiled_between_its_edges():
    chart = between([[0, 0, 0], [60, 0, 0]], [[0, 60, 8], [60, 60, 8]], [0, 60, 20], [0, 60, -4])
    result = tile(from_chart(chart, (1, 1), (1, 1)), SMALL, None, here())
    assert result.fit.error_mm < 1.0


def test_a_cluster_searches_too():
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None
    ) as cluster:
        team = cluster_workers(cluster.scheduler_address, work=pretended)
        result = tile(wavy(), replace(SMALL, rounds=0), None, team)
    assert len(result.answers) == len(result.grids) > 1


def test_a_token_stops_it():
    stop = threading.Event()
    stop.set()
    with pytest.raises(CancelledError):
        tile(ring(), SMALL, None, here(), cancel=stop)


def test_a_module_without_an_answer_is_named():
    def none(job):
        return ModuleAnswer(None, why="there is none")

    with pytest.raises(ComputationError, match="module r1c1: there is none"):
        tile(ring(), SMALL, None, here(none))

    def broken(job):
        raise OSError

    with pytest.raises(ComputationError, match="its worker died"):
        tile(ring(), SMALL, None, here(broken))


def test_without_finite_elements_it_is_said(tiled):
    def unchecked(job):
        return replace(tiled.answers[0], checked=False, why="no balance")

    result = tile(ring(), replace(SMALL, gap_mm=10.0), None, here(unchecked))
    assert [message.code for message in result.warnings] == ["tile-unchecked"]


def test_modules_of_a_wrong_size_are_reported_with_the_right_one():
    with pytest.raises(InputError, match=r"learnt\. Modules of about .*: --size"):
        tile(ring(3), SMALL, None, here())
    corners = np.array([[0.0, 0, 0], [300, 0, 0], [300, 300, 0], [0, 300, 0]])
    with pytest.raises(InputError, match="draw quads of that size, or give --cells"):
        tile(from_quads(corners, np.array([[0, 1, 2, 3]]), (2, 2)), SMALL, None, here())
    with pytest.raises(InputError, match="is too slow to tile with"):
        tile(ring(), replace(SMALL, engine="fea"), None, here())


def test_an_answer_that_is_worse_is_not_taken():
    def worse(job):
        answer = pretended(job)
        if job.grid is None:
            return answer
        return replace(answer, joints=(2 * np.array(answer.joints)).tolist())

    first = tile(wavy(), replace(SMALL, rounds=0), None, here(pretended))
    result = tile(wavy(), replace(SMALL, gap_mm=1e-6, rounds=2), None, here(worse))
    assert result.fit.gap_mm == first.fit.gap_mm


def test_the_command_is_killed_and_goes_on_and_writes_all(tmp_path, run):
    surface = tmp_path / "ring.json"
    surface.write_text(json.dumps(RING), encoding="utf-8")
    folder = tmp_path / "out"
    words = ["tile", surface, "--modules", "10x1", "--cells", "1x1"]
    words += ["--workers", 1, "--rounds", 0, "-o", folder]
    killed = command(*words)
    work, until = folder / "work", time.monotonic() + 120
    while time.monotonic() < until and killed.poll() is None and not list(work.glob("[!.]*.json")):
        time.sleep(0.05)
    os.killpg(killed.pid, signal.SIGKILL)
    killed.communicate()
    kept = {path.name: path.stat().st_mtime_ns for path in work.glob("[!.]*.json")}
    code, text, errors = run(*words, "--printer", "prusa-mk4", "--json")
    assert code == 0, errors
    assert kept == {path.name: path.stat().st_mtime_ns for path in work.glob("[!.]*.json")}
    assert json.loads(text)["modules"] == 10
    for name in ("assembly.glb", "tile.json", "bill.csv", "prints/k1-x10.gcode"):
        assert (folder / name).stat().st_size > 100
    for name in ("assembly.png", "deviation.png"):
        with Image.open(folder / name) as picture:
            assert picture.width > 800
    together = read_assembly(folder / "assembly.json")
    assert [part.copy_of for part in together.parts] == [None, *["r1c1"] * 9]
    np.testing.assert_allclose(
        together.parts[0].grid.joints, read_grid(folder / "modules" / "k1.json").joints
    )


def test_wrong_words_are_one_line(tmp_path, run):
    surface = tmp_path / "tile.json"
    surface.write_text(json.dumps(RING), encoding="utf-8")
    for words, part in (
        (["--modules", "five"], '--modules is "five"; it is two numbers such as 5x3'),
        (["--modules", "8x1", "--scheduler", "x", "--workers", 1], "--workers is for this machine"),
        (["--modules", "8x1", "--material", tmp_path / "no.toml"], "there is no such file"),
        ([], "say how many modules"),
        (["--modules", "8x1", "-o", tmp_path], "tile.json: is what is read, and would be replaced"),
    ):
        code, _, errors = run("tile", surface, "-o", tmp_path / "out", *words)
        assert code == 1
        assert part in errors
        assert "Traceback" not in errors
        assert len(errors.strip().splitlines()) == 1

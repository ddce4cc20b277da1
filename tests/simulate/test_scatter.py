"""Prints of one design: how they are drawn, what is reported of them, and their pictures."""

import json
import threading

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb

import synthetic
from simulearn.errors import CancelledError, ComputationError, InputError
from simulearn.grid import make, write_grid
from simulearn.material import Scatter, load_material
from simulearn.material.reading import HERE
from simulearn.palette import BAND
from simulearn.show import Camera, combined, deformed
from simulearn.show.band import PLACES, bands
from simulearn.simulate import (
    engine,
    one,
    read_json,
    read_npz,
    scatter,
    summary,
    write_json,
    write_npz,
)
from simulearn.simulate.members import Prints
from simulearn.simulate.scatter import (
    draw_prints,
    even_prints,
    material_of_print,
    scattered,
    simulate_prints,
)
from simulearn.simulate.source import BY_FEA, Source, frames_by_fea
from simulearn.simulate.spread import Spread

PLA = load_material("pla-hot-water")
SOME = PLA.model_copy(update={"scatter": Scatter(print=0.1, beam=0.04)})
NONE = PLA.model_copy(update={"scatter": Scatter()})


def strains(draw):
    return np.array([material.shrinkage.active for material in draw.materials])


def pretended(grid, materials, factors=None):
    """Prints of the synthetic saddle whose heights are as many times as large as their strain."""
    shape = synthetic.result(grid, solid=False)
    own = np.array([material.shrinkage.active for material in materials]) / PLA.shrinkage.active
    own = own * factors.mean(axis=1)
    up = np.stack([np.ones_like(own), np.ones_like(own), own], axis=-1)[:, None, None]
    joints = shape.joints[-1] * up
    return Prints(joints, shape.beams[-1] * up[:, None], np.isfinite(joints).all(axis=(1, 2, 3)))


def answer(monkeypatch, frames):
    """Let a function answer in place of an engine, as many prints at once as one likes."""
    source = Source("pretended", frames, count=16, chunk=50)
    monkeypatch.setattr(scatter, "source_of", lambda materials, engine=None: source)


@pytest.fixture
def quick(monkeypatch):
    answer(monkeypatch, pretended)


def test_prints_follow_the_law_and_are_the_same_for_a_seed():
    draw = draw_prints(SOME, 3, 4000, seed=5)
    of_prints = strains(draw) / PLA.shrinkage.active - 1
    for values, deviation in ((of_prints, 0.1), (draw.factors - 1, 0.04)):
        assert values.std() == pytest.approx(0.99 * deviation, rel=0.04)  # cut, so a little less
        assert abs(values.mean()) < 0.05 * deviation
        assert 2.5 * deviation < abs(values).max() <= 3 * deviation + 1e-12
    assert abs(np.corrcoef(of_prints, draw.factors[:, 0])[0, 1]) < 0.06
    # The first prints of many are those of few.
    few = draw_prints(SOME, 3, 7, seed=5)
    np.testing.assert_array_equal(few.factors, draw.factors[:7])
    assert (draw_prints(SOME, 3, 7, seed=6).factors != few.factors).any()


def test_few_even_prints_have_mean_and_deviation_of_many():
    draw = even_prints(SOME, 12, 8)
    np.testing.assert_allclose(draw.factors.mean(axis=0), 1.0)
    np.testing.assert_allclose(draw.factors.std(axis=0), 0.04)
    assert strains(draw).std() / PLA.shrinkage.active == pytest.approx(0.1)


def test_a_print_has_all_strains_and_its_curl_so_many_times_as_large():
    curled = PLA.model_copy(
        update={"shrinkage": PLA.shrinkage.model_copy(update={"curl": 0.01})}
    ).shrinkage
    other = material_of_print(PLA.model_copy(update={"shrinkage": curled}), 1.2).shrinkage
    for name in ("active", "shell", "passive", "joint", "curl"):
        assert getattr(other, name) == pytest.approx(1.2 * getattr(curled, name))


def test_a_spread_is_what_the_prints_do(monkeypatch):
    grid = make("saddle", (1, 1), 50.0)
    result = one(engine("fea").simulate([grid])[0])
    monkeypatch.setattr(scatter, "source_of", lambda materials, engine=None: BY_FEA)
    found = scattered(result, 4).scatter
    draw = draw_prints(PLA, 4, 4)
    centres = frames_by_fea(result.grid, draw.materials, draw.factors).centres
    np.testing.assert_allclose(found.mean, centres.mean(axis=0))
    np.testing.assert_allclose(found.up, centres[..., 2].std(axis=0))
    away = centres - centres.mean(axis=0)
    np.testing.assert_allclose(found.plane, np.sqrt((away[..., :2] ** 2).sum(-1).mean(0)))
    np.testing.assert_allclose(found.up_90, np.percentile(centres[..., 2], [5, 95], axis=0).T)
    in_space = np.sqrt((away**2).sum(-1).mean(0))
    assert found.overall == pytest.approx(in_space[1:].mean())
    assert found.percent == pytest.approx(100 * found.overall / grid.dimension)
    assert found.overall > 0.5
    assert (found.prints, found.drawn, found.engine) == (4, 4, "fea")


def test_a_spread_is_kept_in_files_and_summaries(quick, tmp_path):
    result = scattered(synthetic.result(), 20)
    assert "scatter" not in summary(synthetic.result())
    block = summary(result)["scatter"]
    assert (block["prints"], block["law"]) == (20, "normal, cut at 3 standard deviations")
    assert block["overall_percent"] == pytest.approx(result.scatter.percent, abs=1e-3)
    for name, write, read in (("a.json", write_json, read_json), ("a.npz", write_npz, read_npz)):
        write(result, tmp_path / name)
        again = read(tmp_path / name)
        for key in ("mean", "up", "plane", "up_90", "plane_90", "overall"):
            np.testing.assert_allclose(
                getattr(again.scatter, key), getattr(result.scatter, key), atol=1e-4
            )
        assert again.scatter.scatter == PLA.scatter
        assert summary(again)["scatter"] == block


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"joints": 3}, "scatter.joints: are not a list of objects with mean_mm, up_mm"),
        ({"joints": []}, "scatter.joints: are not"),
        ({"groups": ["many"]}, "scatter.groups: are not numbers of prints"),
        ({"prints": "many"}, "scatter.prints: is missing or of the wrong kind"),
        ({"print": 2.0}, "scatter.print: and beam are not from 0 to 0.5"),
    ],
)
def test_a_wrong_block_is_named(quick, tmp_path, change, says):
    write_json(scattered(synthetic.result(), 5), tmp_path / "a.json")
    data = json.loads((tmp_path / "a.json").read_text())
    data["scatter"] |= change
    (tmp_path / "a.json").write_text(json.dumps(data))
    with pytest.raises(InputError, match=says):
        read_json(tmp_path / "a.json")


def test_prints_that_come_to_two_shapes_are_said_to(monkeypatch, tmp_path):
    def snapping(grid, materials, factors=None):
        prints = pretended(grid, materials, factors)
        high = np.array([m.shrinkage.active for m in materials]) > 1.1 * PLA.shrinkage.active
        prints.joints[high, :, :, 2] *= -1
        return prints

    answer(monkeypatch, snapping)
    result = scattered(synthetic.result(), 60)
    high = int((strains(draw_prints(PLA, 12, 60)) > 1.1 * PLA.shrinkage.active).sum())
    assert result.scatter.groups == (60 - high, high)
    assert f"they come to 2 shapes ({60 - high} and {high} prints)" in result.scatter.words
    assert any("prints come to 2 shapes" in text.get_text() for text in deformed(result).texts)
    write_json(result, tmp_path / "a.json")
    assert read_json(tmp_path / "a.json").scatter.groups == (60 - high, high)
    answer(monkeypatch, pretended)
    assert scattered(synthetic.result(), 60).scatter.groups == ()
    assert scattered(synthetic.result(), 4).scatter.groups == ()


def test_prints_without_an_answer_are_reported(monkeypatch):
    def partly(grid, materials, factors=None):
        prints = pretended(grid, materials, factors)
        lost = np.array([material.shrinkage.active > 0.1 for material in materials])
        prints.joints[lost] = np.nan
        return prints._replace(converged=~lost)

    answer(monkeypatch, partly)
    found = scattered(synthetic.result(), 40).scatter
    lost = int((strains(draw_prints(PLA, 12, 40)) > 0.1).sum())
    assert 0 < lost == found.drawn - found.prints
    assert f"{40 - lost} prints ({lost} more have no answer) by" in found.words
    assert np.isfinite(found.up).all()
    answer(monkeypatch, lambda *a: partly(*a)._replace(converged=np.zeros(len(a[1]), bool)))
    with pytest.raises(ComputationError, match="only 0 of 40 prints have an answer"):
        scattered(synthetic.result(), 40)


def test_prints_are_counted_and_can_be_stopped():
    draw, seen, token = draw_prints(SOME, 12, 6), [], threading.Event()
    source = Source("pretended", pretended, count=16, chunk=4)
    simulate_prints(synthetic.square_grid(), draw, source, lambda *now: seen.append(now))
    assert seen == [(4, 6), (6, 6)]
    token.set()
    with pytest.raises(CancelledError):
        simulate_prints(synthetic.square_grid(), draw, source, cancel=token)


def test_a_band_holds_nine_of_ten_lines_and_is_drawn(quick):
    result = scattered(synthetic.result(), 60)
    camera = Camera()
    shapes = bands(result.scatter, camera)
    assert shapes.shape == (12, 2 * PLACES, 2)
    # At the middle of each beam, across the mean line, nine of ten prints lie between both rims.
    low, high = shapes[:, PLACES // 2], shapes[:, ::-1][:, PLACES // 2]
    middles = camera.see(result.scatter.lines[:, :, 1])[..., :2]
    across = (high - low) / np.linalg.norm(high - low, axis=-1, keepdims=True)
    place = ((middles - low) * across).sum(-1) / np.linalg.norm(high - low, axis=-1)
    inside = ((place > -1e-9) & (place < 1 + 1e-9)).mean(axis=0)
    np.testing.assert_allclose(inside, 0.9, atol=0.02)
    plain, banded = (pixels(combined(one)) for one in (synthetic.result(), result))
    purple = [(abs(a - to_rgb(BAND)) < 0.1).all(-1).sum() for a in (plain, banded)]
    assert purple[1] > 300 > 5 > purple[0]
    for rim in (banded[:6], banded[-6:], banded[:, :6], banded[:, -6:]):
        assert (rim == 1).all()


def pixels(figure):
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3] / 255.0


def test_a_spread_of_a_file_has_figures_and_no_band(quick, tmp_path):
    write_json(scattered(synthetic.result(), 5), tmp_path / "a.json")
    again = read_json(tmp_path / "a.json")
    assert isinstance(again.scatter, Spread)
    assert len(bands(again.scatter, Camera())) == 0
    texts = [text.get_text() for text in deformed(again).texts]
    assert any("5 prints differ by" in text and "band" not in text for text in texts)


def test_the_command_tells_and_writes_the_spread(run, quick, tmp_path):
    grid, file = tmp_path / "g.json", tmp_path / "r.json"
    for path in (grid, tmp_path / "h.json"):
        write_grid(make("saddle", (1, 1), 50.0), path)
    words = ("simulate", grid, "--engine", "fea", "--scatter", "--prints", 12)
    code, out, _ = run(*words, "-o", file)
    assert code == 0
    assert "12 prints by pretended differ by" in out
    assert "strains differ by 17.0% between prints, 8.5% between beams of one" in out
    block = json.loads(file.read_text())["scatter"]
    assert len(block["joints"]) == 4
    printed = json.loads(run(*words, "-o", file, "--json")[1])["summary"]["scatter"]
    assert printed == block
    assert "scatter" not in json.loads(run(*words[:4], "--json")[1])
    assert "differ by" not in run(*words[:4])[1]
    words = (
        "simulate",
        grid,
        tmp_path / "h.json",
        "--engine",
        "fea",
        "--scatter",
        "-o",
        f"{tmp_path}/all/",
    )
    code, out, _ = run(*words)
    assert code == 0
    assert "prints ±, mm" in out
    assert json.loads((tmp_path / "all" / "h.json").read_text())["scatter"]["drawn"] == 16


def test_a_material_without_scatter_says_what_to_do(run, tmp_path):
    text = (HERE / "pla-hot-water.toml").read_text()
    start = text.index("[scatter]")
    (tmp_path / "own.toml").write_text(text[:start] + text[text.index("[bath]") :])
    assert load_material(tmp_path / "own.toml").scatter == NONE.scatter
    words = ("simulate", "saddle", "--material", tmp_path / "own.toml", "--scatter")
    code, _, err = run(*words)
    assert code == 1
    assert "has no scatter" in err
    assert "calibrate it with several prints" in err
    code, _, err = run("simulate", "saddle", "--prints", 8)
    assert (code, "--prints goes with --scatter" in err) == (1, True)

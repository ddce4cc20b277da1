"""The paper's three examples run, small: by beam mechanics, with little time."""

import importlib.util
from pathlib import Path

import jax
import numpy as np
import pytest
from PIL import Image

from simulearn.assembly import read_assembly

FOLDER = Path(__file__).parent.parent / "examples"


@pytest.fixture(scope="module", autouse=True)
def quick_to_compile():
    """Compiling for speed takes longer than what is compiled here runs."""
    before = jax.config.read("jax_disable_most_optimizations")
    jax.config.update("jax_disable_most_optimizations", True)
    yield
    jax.config.update("jax_disable_most_optimizations", before)


def example(name):
    spec = importlib.util.spec_from_file_location(name, FOLDER / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_module_of_the_lampshade_fits_its_neighbours_and_the_shade():
    shade = example("lampshade")
    for upper, lower in ((0, 1), (1, 2)):
        np.testing.assert_allclose(shade.wanted(upper)[:3], shade.wanted(lower)[6:], atol=1e-9)
    seen = shade.seen_from_centre(shade.wanted(1))
    np.testing.assert_allclose(seen[4], 0, atol=1e-12)
    np.testing.assert_allclose(seen[[0, 3, 6]] * [-1, 1, 1], seen[[2, 5, 8]], atol=1e-9)
    assert (seen[[3, 5], 2] < -10).all()  # the rim bends back from the outside


def test_the_lampshade_comes_close(tmp_path):
    words = ["--seconds", "100", "--iterations", "1", "--engine", "beams"]
    found = example("lampshade").main(["-o", str(tmp_path), *words])
    assert len(found) == 3
    assert np.mean([outcome.check.error_fea_mm for outcome in found]) < 4.44  # the paper's
    with Image.open(tmp_path / "assembly.png") as picture:
        assert picture.width == 1040


def test_the_table_unit_reaches_its_contact_angle(tmp_path):
    words = ["-o", str(tmp_path), "--engine", "beams"]
    angle, _ = example("table").main(words)
    assert angle == pytest.approx(60.0, abs=5.0)
    for name in ("suggestions.png", "ring.png"):
        assert (tmp_path / name).exists()
    ring = read_assembly(tmp_path / "ring.json")
    assert ring.distinct == (0,) * 6


def test_the_joinery_meets_its_panels_and_nothing_hits_the_wood(tmp_path, capsys):
    joinery = example("joinery")
    joinery.WRITTEN = (".png", ".glb")
    shape, assembled = joinery.main(["-o", str(tmp_path), "--engine", "beams"])
    assert shape.turned == pytest.approx(90.0, abs=8.0)
    assert shape.slits[0] == pytest.approx(shape.slits[1], abs=0.5)
    assert shape.clearance > 10
    assert assembled.collisions == ()
    assert "tight, by beams: 0 collisions" not in capsys.readouterr().out
    with Image.open(tmp_path / "joinery.png") as picture:
        assert picture.width == 1040
    assert read_assembly(tmp_path / "joinery.json").obstacles[0].name == "left panel"

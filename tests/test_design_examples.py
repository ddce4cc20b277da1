"""The paper's three examples run, small: by beam mechanics, with little time."""

import importlib.util
from pathlib import Path

import pytest
from PIL import Image

from simulearn.assembly import read_assembly

FOLDER = Path(__file__).parent.parent / "examples"


def example(name):
    spec = importlib.util.spec_from_file_location(name, FOLDER / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_lampshade_comes_close(tmp_path):
    words = ["-o", str(tmp_path), "--cells", "1", "1", "--modules", "7", "4"]
    tiled = example("lampshade").main(words)
    assert len(tiled.tiling.names) == 28
    assert len(tiled.grids) == len(list(tmp_path.glob("k*.json"))) == 4
    assert tiled.fit.error_mm < 1.0
    assert tiled.fit.gap_mm < 2.0
    with Image.open(tmp_path / "deviation.png") as picture:
        assert picture.width == 1440


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

"""Every example is a valid grid or runs, and the notebooks are made of the scripts."""

import runpy
import warnings
from pathlib import Path

import nbformat
import pytest

import notebooks
from simulearn import simulate
from simulearn.grid import read_grid, validate
from simulearn.material import load_material

FOLDER = Path(__file__).parent.parent / "examples"


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.json")), ids=lambda path: path.stem)
def test_examples_are_valid(path: Path) -> None:
    grid = read_grid(path)
    assert validate(grid, load_material(grid.material)).valid


def test_the_random_example_simulates_and_is_stable() -> None:
    result = simulate(read_grid(FOLDER / "random.json"))
    assert result.stable
    assert -40 < result.centres[-1][:, 2].min() < -20


# The numbered examples


@pytest.mark.parametrize("script", notebooks.scripts(), ids=lambda path: path.stem)
def test_a_notebook_is_made_of_its_script(script: Path) -> None:
    text = script.with_suffix(".ipynb").read_text("utf-8")
    assert text == notebooks.notebook(script.read_text("utf-8")), "run benchmarks/notebooks.py"
    book = nbformat.reads(text, as_version=4)
    nbformat.validate(book)
    assert book.cells[0].cell_type == "markdown"
    assert not any(cell.get("outputs") for cell in book.cells)


@pytest.fixture
def small(monkeypatch, tmp_path):
    """Run in a folder of its own, at a small size."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("SIMULEARN_SMALL", "1")
    return tmp_path / "out"


EXPECTED = {  # example -> a file that it writes, words that it prints
    "1_forward": ("shape.stl", "mm above the bed"),
    "2_inverse": ("best.json", "mm away by the engine"),
    "3_own_material": ("my-PLA.png", "has learnt pla-hot-water"),
    "4_own_model": ("model/model.json", "% of the dimension"),
    "5_batch_on_a_cluster": ("rise.csv", "2 trials in"),
    "6_from_drawing_to_print": ("leaf.gcode", "g of filament"),
}


def test_all_numbered_examples_are_run() -> None:
    assert [script.stem for script in notebooks.scripts()] == list(EXPECTED)


@pytest.mark.parametrize("name", EXPECTED)
def test_a_numbered_example_runs(name, small, capsys) -> None:
    pytest.importorskip({"5": "distributed", "6": "svgelements"}.get(name[0], "numpy"))
    with warnings.catch_warnings():
        if name[0] == "5":  # Dask's own
            warnings.simplefilter("ignore")
        runpy.run_path(str(FOLDER / f"{name}.py"), run_name="__main__")
    file, words = EXPECTED[name]
    assert (small / name / file).stat().st_size > 0
    assert words in capsys.readouterr().out

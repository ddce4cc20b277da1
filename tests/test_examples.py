"""Every example in the repository is a valid grid, and the random one simulates."""

from pathlib import Path

import pytest

from simulearn.grid import read_grid, validate
from simulearn.material import load_material
from simulearn.simulate import engine

FOLDER = Path(__file__).parent.parent / "examples"


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.json")), ids=lambda path: path.stem)
def test_examples_are_valid(path: Path) -> None:
    grid = read_grid(path)
    assert validate(grid, load_material(grid.material)).valid


def test_the_random_example_simulates_and_is_stable() -> None:
    (result,) = engine("fea").simulate([read_grid(FOLDER / "random.json")])
    assert result.record["stable"]
    assert -40 < result.centres[-1][:, 2].min() < -20

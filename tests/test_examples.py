"""Every example in the repository is a valid grid, and the random one simulates."""

from pathlib import Path

import pytest

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

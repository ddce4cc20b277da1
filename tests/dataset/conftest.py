"""A small data set: single cells on a coarse mesh, a quarter of a second each."""

from pathlib import Path

import pytest
from running import command

from simulearn.dataset import Config, config_of

SMALL = """
name = "small"
trials = 12
seed = 7
test_every = 4

[rules]
cells = [1, 1]

[solver]
slabs = 4
"""


@pytest.fixture(scope="session")
def small() -> Config:
    import tomllib

    return config_of(tomllib.loads(SMALL), "small")


@pytest.fixture(scope="session")
def small_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("config") / "small.toml"
    path.write_text(SMALL, encoding="utf-8")
    return path


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory, small_file: Path) -> Path:
    """An undisturbed run of the small set."""
    path = tmp_path_factory.mktemp("sets") / "small"
    done = command("dataset", "generate", small_file, "-o", path).communicate()
    assert "12 trials, 0 failed" in done[0], done
    return path

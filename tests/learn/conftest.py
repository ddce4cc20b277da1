"""A small data set, a small model for it, and designs to ask about."""

from pathlib import Path

import equinox as eqx
import pytest
from conformance import designs_like

from simulearn.dataset import Dataset, read_dataset
from simulearn.grid import Rules
from simulearn.learn.common.model import Designs
from simulearn.learn.common.trials import split
from simulearn.learn.config import config_of
from simulearn.learn.paper.config import PaperConfig as Config
from simulearn.learn.paper.model import Paper
from simulearn.learn.paper.train import begin

SAMPLE = Path(__file__).parent.parent / "data" / "sample.h5"

WIDTHS = {"hidden": [12], "interaction": [8, 6], "latent": [5, 4], "activation": "silu"}
SMALL = {
    "name": "tiny",
    "data": str(SAMPLE),
    "validation": 4,
    "release": WIDTHS,
    "creep": WIDTHS,
    "optimiser": "muon",
    "rate": 1e-2,
    "phases": [{"epochs": 30, "unroll": 10, "noise": 0.0, "batch": 6}],
}


@pytest.fixture(scope="session")
def sample_file() -> Path:
    return SAMPLE


@pytest.fixture(scope="session")
def sample() -> Dataset:
    return read_dataset(SAMPLE)


@pytest.fixture(scope="session")
def small() -> Config:
    return config_of(SMALL, "small")


@pytest.fixture(scope="session")
def model(small: Config, sample: Dataset) -> Paper:
    """A model that has learnt nothing, but moves grids about as far as they move."""
    untrained = begin(small, split(small, sample)[0]).model

    def last(m):
        return [
            n.weights[-1] for e in (m.release, m.creep) for n in (e.second.joint, e.second.beam)
        ]

    return eqx.tree_at(last, untrained, [2 * x for x in last(untrained)])


@pytest.fixture(scope="session")
def designs() -> Designs:
    return designs_like(Rules(), 3)

"""Data sets: random designs and their trials, generated, packed and read."""

from simulearn.dataset.config import Config, config_of, read_config, shipped
from simulearn.dataset.generate import Tally, generate
from simulearn.dataset.pack import pack
from simulearn.dataset.packed import Batch, Dataset, checksum, read_dataset
from simulearn.dataset.workers import cluster_workers, local_workers

__all__ = [
    "Batch",
    "Config",
    "Dataset",
    "Tally",
    "checksum",
    "cluster_workers",
    "config_of",
    "generate",
    "local_workers",
    "pack",
    "read_config",
    "read_dataset",
    "shipped",
]

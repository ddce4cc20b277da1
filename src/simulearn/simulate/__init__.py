"""One interface to every engine, and the Result that all of them give."""

from simulearn.simulate.engines import ENGINES, engine
from simulearn.simulate.result import FRAMES, Result
from simulearn.simulate.resultfile import (
    read_json,
    read_npz,
    result_from_dict,
    result_to_dict,
    write_json,
    write_npz,
)
from simulearn.simulate.simulator import Progress, Simulator
from simulearn.simulate.skin import Skin, skin
from simulearn.simulate.summary import summary

__all__ = [
    "ENGINES",
    "FRAMES",
    "Progress",
    "Result",
    "Simulator",
    "Skin",
    "engine",
    "read_json",
    "read_npz",
    "result_from_dict",
    "result_to_dict",
    "skin",
    "summary",
    "write_json",
    "write_npz",
]

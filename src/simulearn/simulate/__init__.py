"""One interface to every engine, and the outcome that all of them give."""

from simulearn.simulate.engines import ENGINES, engine
from simulearn.simulate.result import FRAMES, Failure, Outcome, Result, one, results
from simulearn.simulate.resultfile import (
    failure_to_dict,
    outcome_to_dict,
    read_json,
    read_npz,
    result_from_dict,
    result_to_dict,
    write_json,
    write_npz,
)
from simulearn.simulate.simulator import Progress, Simulator
from simulearn.simulate.skin import Skin, skin
from simulearn.simulate.summary import remarks, summary

__all__ = [
    "ENGINES",
    "FRAMES",
    "Failure",
    "Outcome",
    "Progress",
    "Result",
    "Simulator",
    "Skin",
    "engine",
    "failure_to_dict",
    "one",
    "outcome_to_dict",
    "read_json",
    "read_npz",
    "remarks",
    "result_from_dict",
    "result_to_dict",
    "results",
    "skin",
    "summary",
    "write_json",
    "write_npz",
]

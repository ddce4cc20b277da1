"""One interface to every engine, and the outcome that all of them give."""

import sys
from types import ModuleType
from typing import Any

from simulearn.simulate.colliding import collision_place, collision_text
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
    "collision_place",
    "collision_text",
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


class _Callable(ModuleType):
    """The module as the function `simulearn.simulate`.

    The folder and the function have one name, and Python puts the module in the function's place
    as soon as anything of the folder is imported. So the module can be called, too.
    """

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        """Return outcomes; see `simulearn.simulate.calls.simulate`."""
        from simulearn.simulate.calls import simulate

        return simulate(*args, **kwargs)


sys.modules[__name__].__class__ = _Callable

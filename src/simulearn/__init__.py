"""SimuLearn: the shape a flat 4D-printed grid takes in hot water.

What most programs need is here; each name is imported when it is first used, so that importing
SimuLearn is quick and changes nothing in the host process.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from simulearn.errors import CancelledError as CancelledError
    from simulearn.errors import ComputationError as ComputationError
    from simulearn.errors import InputError as InputError
    from simulearn.errors import Message as Message
    from simulearn.grid import Grid as Grid
    from simulearn.grid import make as make
    from simulearn.grid import read_grid as read_grid
    from simulearn.inverse import optimize as optimize
    from simulearn.inverse import rank as rank
    from simulearn.simulate import Failure as Failure
    from simulearn.simulate import Outcome as Outcome
    from simulearn.simulate import Result as Result
    from simulearn.simulate import engine as engine
    from simulearn.simulate.calls import simulate as simulate
    from simulearn.simulate.calls import validate as validate
    from simulearn.simulate.calls import warm as warm

PLACES = {  # name -> module
    "CancelledError": "simulearn.errors",
    "ComputationError": "simulearn.errors",
    "Failure": "simulearn.simulate",
    "Grid": "simulearn.grid",
    "InputError": "simulearn.errors",
    "Message": "simulearn.errors",
    "Outcome": "simulearn.simulate",
    "Result": "simulearn.simulate",
    "engine": "simulearn.simulate",
    "make": "simulearn.grid",
    "optimize": "simulearn.inverse",
    "rank": "simulearn.inverse",
    "read_grid": "simulearn.grid",
    "validate": "simulearn.simulate.calls",
    "warm": "simulearn.simulate.calls",
}

__all__ = [
    "CancelledError",
    "ComputationError",
    "Failure",
    "Grid",
    "InputError",
    "Message",
    "Outcome",
    "Result",
    "engine",
    "make",
    "optimize",
    "rank",
    "read_grid",
    "simulate",
    "validate",
    "warm",
]


def __getattr__(name: str) -> Any:
    if name == "simulate":  # the folder of that name, which can be called; see there
        return import_module("simulearn.simulate")
    if name in PLACES:
        return getattr(import_module(PLACES[name]), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])

"""The methods of searching, by name; what they need is imported with the first search by them."""

from collections.abc import Callable, Iterator
from importlib import import_module

from simulearn.errors import InputError
from simulearn.extras import require
from simulearn.inverse.problem import Advance, Problem, Scored

Method = Callable[[Problem, Scored], Iterator[Advance]]

METHODS = {  # name -> module, function
    "default": ("simulearn.inverse.newton", "newton"),
    "brute-force": ("simulearn.inverse.brute_force", "brute_force"),
    "gradient": ("simulearn.inverse.gradient", "gradient"),
    "cma": ("simulearn.inverse.cma_es", "cma_es"),
}


def method(name: str) -> Method:
    """Return the method of a name.

    Raises:
        InputError: there is none.
    """
    if name not in METHODS:
        known = ", ".join(METHODS)
        raise InputError(
            f'method "{name}" is not known; known are {known}', "method-unknown", "method"
        )
    if name == "gradient":
        require("the method gradient needs", "jax")
    module, function = METHODS[name]
    search: Method = getattr(import_module(module), function)
    return search

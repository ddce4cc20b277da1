"""What a grid takes for its numbers: nothing is reshaped, cut off or converted from text.

An index may be a float such as 1.0, since many programs have no other numbers.
"""

import json
import sys
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError

KEYS = {
    "joints": "joints are a list of [x, y], finite numbers in mm",
    "beams": "beams are a list of [i, j], indices of joints counted from 0",
    "actuators": "actuators are a list of ratios in [-1, 1], one for each beam",
    "fixed": "the fixed joint is an index counted from 0",
    "material": "a material is the name of a material system or the path of its TOML file",
}
CODES = {
    "joints": ("joint-place", "joint"),
    "beams": ("beam-index", "beam"),
    "actuators": ("actuator-ratio", "beam"),
}

NOT_FLAT = "; z is not 0: a grid is drawn flat, in the plane z = 0"
INDEX = 2**31  # indices are below it
FLAT = 1e-6  # mm; places so near the plane z = 0 lie in it, whatever rounding did


def numbers(values: Any, key: str, width: int = 0) -> NDArray[np.float64]:
    """Return finite numbers as an array of their own, (n,) or (n, width).

    Args:
        values: lists, tuples or an array.
        key: "joints" or "actuators", for messages.
        width: how many numbers an entry has; 0 for entries that are numbers.

    Raises:
        InputError: the shape is another, or the named entry is not a finite number.
    """
    array = _array(values, key, width)
    if not np.isfinite(array).all():
        _refuse(values, key, width)
    return array.astype(np.float64, copy=False)


def places(values: Any) -> NDArray[np.float64]:
    """Return places in the plane as an array of their own, (n, 2) mm.

    Args:
        values: entries [x, y], or [x, y, z] where all z are 0, as programs for space write them.

    Raises:
        InputError: an entry is no such place; the message names it.
    """
    entries = _plain(values)
    if not isinstance(entries, list | tuple) or not any(map(_in_space, entries)):
        return numbers(values, "joints", 2)
    for k, entry in enumerate(entries):
        if not _in_space(entry):
            continue
        text, where = f"joints[{k}] is {shown(entry)}; {KEYS['joints']}", f"joint {k}"
        if not all(_is_number(_plain(x)) for x in entry):
            raise InputError(text, "joint-place", where)
        if abs(entry[2]) > FLAT:
            raise InputError(text + NOT_FLAT, "joints-in-space", where)
    return numbers([e[:2] if _in_space(e) else e for e in entries], "joints", 2)


def whole(value: Any) -> Any:
    """Return a float without a fraction as an int, such as 1.0 as 1, and all else as it is."""
    fits = isinstance(value, float) and value.is_integer() and abs(value) < INDEX
    return int(value) if fits else value


def indices(values: Any, key: str) -> NDArray[np.int64]:
    """Return pairs of integers as an array (n, 2) of their own.

    Args:
        values: lists, tuples or an array, also of floats such as 1.0.
        key: "beams", for messages.

    Raises:
        InputError: the shape is another, or the named entry is not an integer.
    """
    array = _array(values, key, 2)
    if array.dtype.kind != "i" and not ((array % 1 == 0) & (abs(array) < INDEX)).all():
        _refuse(values, key, 2)
    return array.astype(np.int64, copy=False)


def index(value: Any, key: str) -> int:
    """Return an integer.

    Args:
        value: an int, or a float such as 1.0.
        key: "fixed", for messages.

    Raises:
        InputError: it is not an integer.
    """
    plain = value if type(value) is int else _plain(value)
    if not _is_index(plain):
        raise InputError(f"{key} is {shown(value)}; {KEYS[key]}", "fixed-index", "grid")
    return int(plain)


def shown(value: Any, most: int = 40) -> str:
    """Return a value as short, plain text on one line."""
    try:
        text = json.dumps(_plain(value))
    except (TypeError, ValueError, RecursionError):
        text = f"a {type(value).__name__}"
    return text if len(text) <= most else text[: most - 3] + "..."


def _array(values: Any, key: str, width: int) -> NDArray[Any]:
    """Return an array of real numbers, (n,) or (n, width)."""
    try:
        array = np.array(values)
    except (TypeError, ValueError, OverflowError):
        _refuse(values, key, width)
    shape = (0, width) if width else (0,)
    if not array.size and array.ndim in (1, 2):
        return np.zeros(shape, np.int64)
    if array.dtype.kind not in "fiu" or array.ndim != len(shape) or array.shape[1:] != shape[1:]:
        _refuse(values, key, width)
    return array


def _refuse(values: Any, key: str, width: int) -> NoReturn:
    """Raise an InputError that names the first entry that is wrong."""
    code, part = CODES[key]
    place, where, wrong = key, key, _plain(values)
    good = _is_index if key == "beams" else _is_number
    for k, entry in enumerate(wrong if isinstance(wrong, (list, tuple)) else ()):
        entry = _plain(entry)
        place, where, wrong = f"{key}[{k}]", f"{part} {k}", entry
        if not width:
            if good(entry):
                continue
            break
        if not isinstance(entry, (list, tuple)) or len(entry) != width:
            break
        bad = [m for m, x in enumerate(entry) if not good(_plain(x))]
        if bad:
            place, wrong = f"{place}[{bad[0]}]", entry[bad[0]]
            break
    else:
        place, where, wrong = key, key, values
    text = f"{place} is {shown(wrong)}; {KEYS[key]}"
    raise InputError(text, code, where)


def _in_space(entry: Any) -> bool:
    return isinstance(entry, list | tuple) and len(entry) == 3


def _plain(value: Any) -> Any:
    """Return an array, or a number of an array library, as Python's lists and numbers."""
    return np.asarray(value).tolist() if hasattr(value, "__array__") else value


def _is_number(x: Any) -> bool:
    # A comparison, since a large int has no float; NaN compares false.
    return isinstance(x, int | float) and not isinstance(x, bool) and abs(x) <= sys.float_info.max


def _is_index(x: Any) -> bool:
    return _is_number(x) and x % 1 == 0 and abs(x) < INDEX

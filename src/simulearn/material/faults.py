"""What is wrong with the tables of a material, in words that name the key and what would be right.

Files and texts that requests bring are held to the same, so that a material which works in one
place works in all.
"""

from collections.abc import Iterable, Iterator
from typing import Any

from pydantic import ValidationError

MOST_SHOWN = 60  # characters of a value in a message
# Numbers far beyond what anybody prints overflow, or make a print of millions of strokes.
SIZES = (1e-15, 1e9, "")  # of a number that is not 0: least, most, unit
SIZE_OF: dict[tuple[str | int, ...], tuple[float, float, str]] = {
    ("section", "width"): (0.1, 100.0, "mm"),
    ("section", "thickness"): (0.1, 100.0, "mm"),
    ("laid", "width"): (0.1, 100.0, "mm"),
    ("laid", "thickness"): (0.1, 100.0, "mm"),
    ("print", "layer"): (0.01, 10.0, "mm"),
    ("print", "line_width"): (0.05, 10.0, "mm"),
    ("law", "modulus"): (1e-6, 1e6, "MPa"),
    ("gravity", "density"): (1e-15, 3e-8, "tonne/mm3"),
}


class MaterialError(ValueError):
    """Tables are no material system.

    Args:
        keys: where, such as "law.table[1]"; empty for all of it.
        reason: the rest of a sentence that begins with the place.
        line: of the text, such as "line 9", where it is no TOML.
    """

    def __init__(self, keys: str, reason: str, line: str = "") -> None:
        super().__init__(f"{keys} {reason}".strip())
        self.keys, self.reason, self.line = keys, reason, line


def fault_of(error: ValidationError, data: dict[str, Any]) -> MaterialError:
    """Return the first fault that pydantic found in tables."""
    first = error.errors(include_url=False)[0]
    keys = _keys(first["loc"], data)
    if first["type"].startswith("union_tag"):
        keys.append("kind")
    return MaterialError(_joined(keys), reason(first))


def size_fault(data: dict[str, Any]) -> MaterialError | None:
    """Return the first number of tables whose size cannot be meant; None if there is none."""
    for keys, number in _numbers(data):
        least, most, unit = SIZE_OF.get(keys, SIZES)
        if number and not least <= abs(number) <= most:
            between = f"{least:g} and {most:g} {unit}".rstrip()
            return MaterialError(_joined(keys), f"is {number:g}; its size lies between {between}")
    return None


def reason(error: Any) -> str:
    """Return one of pydantic's errors as the rest of a sentence that begins with a key."""
    kind, given = error["type"], error["input"]
    if kind in ("missing", "union_tag_not_found"):
        return "is missing"
    if kind == "union_tag_invalid":
        known = error["ctx"]["expected_tags"].replace("'", '"')
        return f'is "{str(error["ctx"]["tag"])[:MOST_SHOWN]}"; it is one of {known}'
    if kind == "extra_forbidden":
        return "is an unknown key"
    if kind == "value_error":
        return f"is wrong: {error['ctx']['error']}"
    try:
        shown = repr(given)[:MOST_SHOWN]
    except RecursionError:
        shown = "tables in tables"
    if kind == "float_type" and isinstance(given, str):
        return f"is {shown}; write a number without quotes and without a unit"
    return f"is {shown}; {error['msg'][:1].lower()}{error['msg'][1:]}"


def _numbers(
    data: Any, keys: tuple[str | int, ...] = ()
) -> Iterator[tuple[tuple[str | int, ...], float]]:
    """Yield the numbers of tables with their keys."""
    if isinstance(data, dict | list):
        pairs = data.items() if isinstance(data, dict) else enumerate(data)
        for key, value in pairs:
            yield from _numbers(value, (*keys, key))
    elif isinstance(data, int | float) and not isinstance(data, bool):
        yield keys, float(data)


def _keys(keys: Iterable[str | int], data: dict[str, Any]) -> list[str | int]:
    """Return a path of pydantic without the kind of law, which it names as if it were a key."""
    law = data.get("law")
    kind = law.get("kind") if isinstance(law, dict) else None
    return [key for key in keys if key != kind]


def _joined(keys: Iterable[str | int]) -> str:
    """Return keys as "law.table[1]"."""
    return "".join(f"[{k}]" if isinstance(k, int) else f".{k}" for k in keys).removeprefix(".")

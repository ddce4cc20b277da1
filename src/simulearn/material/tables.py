"""The tables of a material's TOML text, read safely: the text may come from anybody."""

import re
import tomllib
from typing import Any

from simulearn.material.faults import MaterialError

MOST_DOTS = 300  # on one line: reading tables so deep takes long


def tables(text: str) -> dict[str, Any]:
    """Return the tables of a TOML text.

    Raises:
        MaterialError: it is no TOML; `line` says where.
    """
    for k, line in enumerate(text.splitlines(), 1):
        if line.count(".") > MOST_DOTS:
            many = f"has more than {MOST_DOTS} dots on line {k}; write it on several lines"
            raise MaterialError("", many, f"line {k}")
    try:
        return tomllib.loads(text.removeprefix("\ufeff"))  # a byte order mark
    except ValueError as error:  # also of a number of thousands of digits
        found = re.search(r"line \d+", str(error))
        raise MaterialError("", f"is not valid TOML: {error}", found[0] if found else "") from error
    except RecursionError as error:
        raise MaterialError("", "is nested too deeply") from error

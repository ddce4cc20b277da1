"""Which reader a file needs, by its contents; what cannot be read is named with the way out."""

import json
from typing import Any

from simulearn.drawings.drawing import Drawing
from simulearn.drawings.lists import read_json_lines
from simulearn.errors import InputError
from simulearn.files import parse_json
from simulearn.grid import Grid, grid_from_dict


def own_grid(data: bytes) -> Grid | None:
    """Return the grid of a grid, result or task file of ours; None for any other file."""
    if not data.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"{") or b'"simulearn.' not in data:
        return None
    value = parse_json(data.decode("utf-8-sig"))
    schema = value.get("schema") if isinstance(value, dict) else None
    if not isinstance(schema, str) or not schema.startswith("simulearn."):
        return None
    return grid_from_dict(value if schema.startswith("simulearn.grid/") else value.get("grid"))


def read_drawing(data: bytes, name: str) -> Drawing:
    """Return what a drawing holds."""
    return read_json_lines(parse_json(data.decode("utf-8-sig")))

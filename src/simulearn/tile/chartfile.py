"""Surfaces that a few numbers describe, as a file: of revolution, of heights, between two edges.

JSON, `simulearn.chart/1`, with one of the keys `revolution`, `heights` and `between`.
"""

from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from simulearn.errors import InputError
from simulearn.files import parse_json, read_text
from simulearn.grid.arrays import shown
from simulearn.surfaces import read_curve
from simulearn.surfaces.heights import computed
from simulearn.tile.charts import Chart
from simulearn.tile.shapes import between, heights, interpolated, revolution

Number = Annotated[float, Field(ge=-1e6, le=1e6)]
Point = Annotated[list[Number], Field(min_length=3, max_length=3)]
Range = Annotated[list[Number], Field(min_length=2)]


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, strict=True, extra="forbid", allow_inf_nan=False)


class Revolution(_Part):
    """A profile around the z axis: [[radius, height], ...] mm, and how far around."""

    profile: Annotated[
        list[Annotated[list[Number], Field(min_length=2, max_length=2)]], Field(min_length=2)
    ]
    degrees: Annotated[float, Field(gt=0, le=360)] = 360.0


class Heights(_Part):
    """Heights z over x and y, mm: an expression over two ranges, or a table over two lists."""

    z: str | list[list[Number]]
    x: Range
    y: Range


class Between(_Part):
    """Two edge curves, each points or a file of one, and how the surface leaves and comes."""

    first: Annotated[list[Point], Field(min_length=2)] | str
    second: Annotated[list[Point], Field(min_length=2)] | str
    leaving: Point | None = None
    arriving: Point | None = None


class ChartFile(_Part):
    """The file."""

    schema_: Literal["simulearn.chart/1"] = Field(alias="schema")
    revolution: Revolution | None = None
    heights: Heights | None = None
    between: Between | None = None


PARTS: dict[str, type[_Part]] = {
    "revolution": Revolution,
    "heights": Heights,
    "between": Between,
}
KINDS = tuple(PARTS)
KEYS = {
    "schema": 'this program reads "simulearn.chart/1"',
    "revolution": "it has profile, a list of [radius, height] in mm, and degrees",
    "profile": "a profile is a list of [radius, height] in mm",
    "degrees": "it is more than 0 and at most 360",
    "heights": "they have z, an expression in x and y or rows of heights, and x and y",
    "z": 'z is an expression such as "40*cos(x/80)", or rows of heights in mm',
    "x": "x is [from, to] in mm, or the list of a table's columns",
    "y": "y is [from, to] in mm, or the list of a table's rows",
    "between": "it has first and second, curves as lists of [x, y, z] in mm or files",
    "first": "an edge is a list of [x, y, z] in mm, or the file of a curve",
    "second": "an edge is a list of [x, y, z] in mm, or the file of a curve",
    "leaving": "a direction is [x, y, z] in mm",
    "arriving": "a direction is [x, y, z] in mm",
}


def read_chart(path: Path | str) -> Chart:
    """Return the surface that a file describes.

    Raises:
        InputError: the file cannot be read or describes none; one line says where.
    """
    path = Path(path)
    text = read_text(path)
    try:
        return chart_from_dict(parse_json(text), path.parent)
    except InputError as error:
        raise InputError(f"{path}: {error}", error.code, error.where) from error


def chart_from_dict(data: Any, folder: Path | None = None) -> Chart:
    """Return the surface that a dict with the file's keys describes.

    Args:
        data: such as JSON gives.
        folder: from which files of curves are; None: no file may be opened.

    Raises:
        InputError: a key or number is wrong; one line says which.
    """
    if not isinstance(data, dict) or "schema" not in data:
        text = f"is no surface: an object with schema and one of {', '.join(KINDS)}"
        raise InputError(text, "chart", "schema")
    try:
        file = ChartFile.model_validate(data)
    except ValidationError as error:
        raise _wrong(error.errors(include_url=False)[0]) from error
    given = [kind for kind in KINDS if getattr(file, kind) is not None]
    if len(given) != 1:
        what = " and ".join(given) or "none of them"
        raise InputError(f"has {what}; give one of {', '.join(KINDS)}", "chart", "schema")
    try:
        if file.revolution is not None:
            return revolution(file.revolution.profile, file.revolution.degrees)
        if file.heights is not None:
            return _of_heights(file.heights)
        assert file.between is not None
        one = file.between
        first, second = (_edge(edge, folder) for edge in (one.first, one.second))
        return between(first, second, one.leaving, one.arriving)
    except InputError as error:
        raise InputError(f"{given[0]}: {error}", error.code, error.where) from error


def _of_heights(given: Heights) -> Chart:
    x, y = ((line[0], line[-1]) for line in (given.x, given.y))
    if not isinstance(given.z, str):
        return heights(interpolated(given.x, given.y, given.z), x, y)
    for name, line in (("x", given.x), ("y", given.y)):
        if len(line) != 2 or not line[0] < line[1]:
            text = f"{name} is {shown(line)}; of an expression it is [from, to] in mm"
            raise InputError(text, "chart", name)
    expression = given.z
    computed(expression, np.array(x), np.array(y))  # so that it is told here where it is wrong
    return heights(lambda a, b: computed(expression, a, b), x, y)


def _edge(edge: Any, folder: Path | None) -> Any:
    if not isinstance(edge, str):
        return edge
    if folder is None:
        raise InputError("an edge is a file; here it is a list of points", "chart", "first")
    points = read_curve(folder / edge).points
    # A spline through every chord of a fine curve would follow its noise.
    return points[np.unique(np.linspace(0, len(points) - 1, 33).round().astype(int))]


def _wrong(error: Any) -> InputError:
    """Return one of pydantic's errors in our words."""
    kinds = {"list[nullable]", "str"}
    keys = [k for k in error["loc"] if k not in kinds and "[" not in str(k)]
    names = [k for k in keys if isinstance(k, str)]
    where = "".join(f"[{k}]" if isinstance(k, int) else f".{k}" for k in keys).lstrip(".")
    hint = next((KEYS[name] for name in reversed(names) if name in KEYS), "")
    if error["type"] == "extra_forbidden":
        model = PARTS.get(names[0], ChartFile) if len(names) > 1 else ChartFile
        known = (field.alias or name for name, field in model.model_fields.items())
        text = f"{where} is not a key here; the keys are {', '.join(known)}"
    elif error["type"] == "missing":
        text = f"{where} is missing; {hint}"
    else:
        text = f"{where} is {shown(error['input'])}; {hint}"
    return InputError(text, "chart", where)

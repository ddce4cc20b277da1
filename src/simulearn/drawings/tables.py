"""Lines in tables: a row for each line, or a row for each point of polylines.

Rows of 4 or 6 numbers are lines: x1, y1, x2, y2 or x1, y1, z1, x2, y2, z2. Rows of 2 or 3 numbers
are points: x, y or x, y, z; a column of names, or an empty row, parts polylines. A header names the
columns in any order.
"""

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from simulearn.drawings.drawing import Drawing, Line, Unit
from simulearn.drawings.points import MOST_SEGMENTS, too_many
from simulearn.drawings.rows import SAMPLE, Row, number_in, rows_of, separator_of, value_in
from simulearn.drawings.units import unit_named
from simulearn.errors import InputError

GROUPS = ("id", "line", "polyline", "curve", "group", "name", "path", "beam", "part", "branch")
AXES = "xyz"
ENDS = ("from", "to", "start", "end", "begin", "a", "b", "p0", "p1", "p2", "pt1", "pt2")


@dataclass(frozen=True)
class Columns:
    """What the columns of a table are.

    Attributes:
        ends: columns of the points in each row: one point (x, y[, z]), or two.
        group: column that parts polylines; None without one.
        layer: column of the layer; None without one.
        unit: that the header names; None without one.
    """

    ends: tuple[tuple[int, ...], ...]
    group: int | None = None
    layer: int | None = None
    unit: Unit | None = None


def read_csv(text: str) -> Drawing:
    """Return the lines in a table.

    Args:
        text: rows separated by ends of lines, cells by one of ; tab , | or blanks.

    Raises:
        InputError: it is no such table, or a cell is no finite number; one line says where.
    """
    separator = separator_of(text)
    rows = list(rows_of(text, separator))
    filled = [row for row in rows if row.cells]
    if not filled:
        raise InputError("holds no rows", "no-lines", "lines")
    comma = separator != ","
    named = [k for k, cell in enumerate(filled[0].cells) if value_in(cell, comma) is None]
    columns = _named(filled[0].cells) if named else None
    if columns is None:
        columns = _unnamed(filled, comma)
    else:
        rows.remove(filled[0])
    if len(columns.ends) == 2:
        lines = [_of_row(row, columns, comma) for row in rows if row.cells]
    else:
        lines = list(_polylines(rows, columns, comma))
    if sum(len(line.points) - 1 for line in lines) > MOST_SEGMENTS:
        raise too_many()
    return Drawing("CSV", lines, unit=columns.unit, plain=columns.unit is None)


def _named(header: Sequence[str]) -> Columns | None:
    """Return what the columns are by a header; None if it names no x and y."""
    units, names = [], []
    for cell in header:
        found = re.search(r"[\[(]\s*([^\])]+?)\s*[\])]", cell)
        units.append(found[1] if found else None)
        name = re.sub(r"[\[(].*?[\])]", "", cell).casefold()
        names.append(re.sub(r"[^0-9a-z]", "", name))
    points: dict[str, dict[str, int]] = {}
    others: dict[str, int] = {}
    for k, name in enumerate(names):
        axis = _axis(name)
        if axis is None:
            others.setdefault(name, k)
        else:
            points.setdefault(axis[1], {}).setdefault(axis[0], k)
    ends = [tuple(at[a] for a in AXES if a in at) for at in points.values() if {*"xy"} <= {*at}]
    if not ends or len(ends) > 2:
        return None
    group = next((others[name] for name in GROUPS if name in others), None)
    unit = next((units[k] for end in ends for k in end if units[k]), None)
    named = unit_named(unit, f'"[{unit}]" in the header') if unit else None
    return Columns(tuple(ends), group, others.get("layer"), named)


def _axis(name: str) -> tuple[str, str] | None:
    """Return the axis and the end that a column's name says, as x and 1 for "x1" or "x_1"."""
    if name[:1] and name[0] in AXES and (len(name) < 3 or name[1:] in ENDS):
        return name[0], name[1:]
    if name[-1:] and name[-1] in AXES and name[:-1] in ENDS:
        return name[-1], name[:-1]
    return None


def _unnamed(rows: Sequence[Row], comma: bool) -> Columns:
    """Return what the columns are by their number; a first column of names parts polylines."""
    first = rows[0]
    width = Counter(len(row.cells) for row in rows[:SAMPLE]).most_common(1)[0][0]
    texts = [
        k
        for k in range(width)
        if all(len(r.cells) > k and value_in(r.cells[k], comma) is None for r in rows[:SAMPLE])
    ]
    numbers = [k for k in range(width) if k not in texts]
    if len(texts) > 1 or len(numbers) not in (2, 3, 4, 6):
        text = (
            f"row {first.number} has {len(numbers)} numbers; a line is x1, y1, x2, y2 or "
            "x1, y1, z1, x2, y2, z2; a point is x, y or x, y, z, after the name of its line"
        )
        raise InputError(text, "table", f"row {first.number}")
    text_column = texts[0] if texts else None
    if len(numbers) in (4, 6):
        half = len(numbers) // 2
        return Columns((tuple(numbers[:half]), tuple(numbers[half:])), layer=text_column)
    if len(numbers) == 3 and text_column is None and _are_names(rows, comma):
        return Columns(((1, 2),), group=0)
    return Columns((tuple(numbers),), group=text_column)


def _are_names(rows: Sequence[Row], comma: bool) -> bool:
    """Return whether a first column of numbers names the line of each point: 0, 0, 1, 1, 1, 2."""
    cells = (value_in(row.cells[0], comma) for row in rows)
    values = [value for value in cells if value is not None and value.is_integer()]
    if len(values) < len(rows):
        return False
    runs = [len(list(run)) for _, run in groupby(values)]
    return len(set(values)) == len(runs) and min(runs) > 1 and values == sorted(values)


def _points(row: Row, columns: Columns, comma: bool) -> list[list[float]]:
    """Return the points (x, y, z) in a row."""
    points = [[number_in(row, column, comma) for column in end] for end in columns.ends]
    return [[*point, 0.0][:3] for point in points]


def _layer(row: Row, columns: Columns) -> str:
    at = columns.layer
    return row.cells[at] if at is not None and at < len(row.cells) else ""


def _of_row(row: Row, columns: Columns, comma: bool) -> Line:
    """Return the line in a row."""
    points = np.array(_points(row, columns, comma))
    return Line(points, _layer(row, columns), where=f"row {row.number}")


def _polylines(rows: Sequence[Row], columns: Columns, comma: bool) -> Iterator[Line]:
    """Yield the polylines whose points are in rows that follow each other."""

    def part(row: Row) -> tuple[bool, str]:
        at = columns.group
        return bool(row.cells), row.cells[at] if at is not None and at < len(row.cells) else ""

    for (filled, _), run in groupby(rows, key=part):
        if not filled:
            continue
        own = list(run)
        points = [_points(row, columns, comma)[0] for row in own]
        if len(points) < 2:
            where = f"row {own[0].number}"
            raise InputError(f"{where} is a line of one point; a line has two", "table", where)
        yield Line(np.array(points), _layer(own[0], columns), where=f"row {own[0].number}")

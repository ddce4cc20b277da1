"""Rows of tables: what parts their cells, which are comments, and the numbers in them."""

import csv
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from math import isfinite

from simulearn.errors import InputError

SEPARATORS = (";", "\t", ",", "|", " ")
COMMENTS = ("#", "//")
# A table is known by its first rows.
SAMPLE = 50


@dataclass(frozen=True)
class Row:
    """A row of a table.

    Attributes:
        number: counted from 1, as in an editor.
        cells: without the blanks around them; none in an empty row.
    """

    number: int
    cells: list[str]


def separator_of(text: str) -> str:
    """Return what separates the cells: what parts the first rows into equally many, at least 2."""
    rows = [r for line in text.split("\n") if (r := line.strip()) and not r.startswith(COMMENTS)]
    best, most = ",", 0
    for separator in SEPARATORS:
        counts = Counter(len(_cells(row, separator)) for row in rows[:SAMPLE])
        cells, times = max(counts.items(), key=lambda item: item[1], default=(1, 0))
        if cells > 1 and times > most:
            best, most = separator, times
    return best


def _cells(row: str, separator: str) -> list[str]:
    if separator == " ":
        return row.split()
    return [cell.strip() for cell in next(csv.reader([row], delimiter=separator))]


def rows_of(text: str, separator: str) -> Iterator[Row]:
    """Yield the rows that are no comments."""
    for number, line in enumerate(text.split("\n"), 1):
        row = line.strip(" \n" if separator == "\t" else None)
        if row.startswith(COMMENTS):
            continue
        try:
            cells = _cells(row, separator) if row else []
        except csv.Error as error:
            raise InputError(f"row {number}: {error}", "table", f"row {number}") from error
        while cells and not cells[-1]:  # a separator at the end of the row
            del cells[-1]
        yield Row(number, cells)


def value_in(cell: str, comma: bool) -> float | None:
    """Return the number in a cell, also one that is not finite; None if it is none."""
    text = cell.replace("\u2212", "-")  # the minus sign of typesetters
    text = text.replace(",", ".") if comma and text.count(",") == 1 and "." not in text else text
    try:
        return float(text) if "_" not in text else None
    except ValueError:
        return None


def number_in(row: Row, column: int, comma: bool) -> float:
    """Return the number in a cell of a row, or raise InputError."""
    where = f"row {row.number}, column {column + 1}"
    if column >= len(row.cells):
        text = f"row {row.number} has {len(row.cells)} cells; column {column + 1} is missing"
        raise InputError(text, "table", where)
    value = value_in(row.cells[column], comma)
    if value is None or not isfinite(value):
        kind = "number" if value is None else "finite number"
        text = f'{where} is "{row.cells[column][:40]}"; a coordinate is a {kind}'
        raise InputError(text, "table", where)
    return value

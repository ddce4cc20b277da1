"""Tables of measured points: a joint and its place in each row, or the points of a cloud.

A header names the columns in any order (joint, x, y, z; more are passed over). Without one, four
columns are a joint and its place, three a place without a name. Titles above it are passed over.
"""

import re
from collections.abc import Sequence
from io import StringIO
from itertools import takewhile

import numpy as np

from simulearn.compare.headers import (
    Columns,
    columns_by_header,
    columns_by_number,
    joint_in,
    unit_in,
)
from simulearn.compare.measurement import JointPlaces
from simulearn.drawings.rows import Row, number_in, rows_of, separator_of, value_in
from simulearn.errors import InputError, Message

NOTHING = {"", "-", "--", "na", "n/a", "nan", "none", "null"}  # of a joint that was not measured
HEAD = 60  # rows by which a table is known
MANY = 20_000  # rows beyond which a table is read at once, without a message for each cell
COMMA = True  # a comma in a cell is a decimal one, else it would part cells


def read_table(text: str) -> JointPlaces:
    """Return the points in a table.

    Args:
        text: rows, their cells separated by one of ; tab , | or blanks; decimal commas are read
            where the comma separates no cells, or in quotes; # begins a comment.

    Raises:
        InputError: it is no such table, a cell is no finite number, or a joint has two rows.
    """
    text = re.sub(r"[ \t]*#[^\n]*", "", text)
    separator = separator_of(text)
    head = [row for row in rows_of(text[:10_000], separator) if row.cells][:HEAD]
    if not head:
        raise InputError("holds no rows", "measurement-table", "measurement")
    titles = len(list(takewhile(_title, head)))
    head = head[titles:] or head
    columns, head = _columns(head)
    if not head:
        raise InputError("holds a header and no rows", "measurement-table", "measurement")
    first = head[0].number
    if columns.joint is None and text.count("\n") > MANY:
        places = _at_once(text, columns, separator, first - 1)
        return JointPlaces(places, None, columns.unit, columns.messages)
    rows = [row for row in rows_of(text, separator) if row.cells and row.number >= first]
    if columns.joint is None:
        found = [[number_in(row, k, COMMA) for k in columns.places] for row in rows]
        return JointPlaces(np.array(found), None, columns.unit, columns.messages)
    return _of_joints(rows, columns)


def _columns(head: list[Row]) -> tuple[Columns, list[Row]]:
    """Return the columns of a table by its first rows, and the first of the rows with places."""
    if any(value_in(cell, COMMA) is not None for cell in head[0].cells):
        return columns_by_number(head), head
    below = head[1:]
    columns = columns_by_header(head[0], below)
    if below and (unit := unit_in(below[0], columns)) is not None:
        below = below[1:]
        columns = columns_by_header(head[0], below)._replace(unit=unit)
    return columns, below


def _title(row: Row) -> bool:
    """Return whether a row stands above a table: words, or the one number of how many follow."""
    numbers = [value_in(cell, COMMA) is not None for cell in row.cells]
    return len(numbers) == 1 or (len(numbers) == 2 and not all(numbers))


def _of_joints(rows: Sequence[Row], columns: Columns) -> JointPlaces:
    """Return the places of joints that are named; rows without a place are passed over."""
    places: dict[int, list[float]] = {}
    empty: list[int] = []
    for row in rows:
        joint = _joint(row, columns)
        if joint in places or joint in empty:
            where = f"row {row.number}"
            raise InputError(
                f"{where}: joint {joint} has a row already", "measurement-table", where
            )
        cells = [row.cells[k] for k in columns.places if k < len(row.cells)]
        if all(cell.casefold() in NOTHING for cell in cells):
            empty.append(joint)
            continue
        places[joint] = [number_in(row, k, COMMA) for k in columns.places]
    if not places:
        raise InputError("holds no joint with a place", "measurement-table", "measurement")
    messages = columns.messages
    if empty:
        text = f"joints without a place in the table are passed over: {', '.join(map(str, empty))}"
        messages = (*messages, Message("measurement-empty", "measurement", text))
    return JointPlaces(
        np.array(list(places.values())), np.array(list(places)), columns.unit, messages
    )


def _joint(row: Row, columns: Columns) -> int:
    assert columns.joint is not None
    cell = row.cells[columns.joint] if columns.joint < len(row.cells) else ""
    number = joint_in(cell)
    if number is None:
        where = f"row {row.number}"
        text = f'{where} names the joint "{cell[:40]}"; a joint is named by its number, from 0'
        raise InputError(text, "measurement-table", where)
    return number


def _at_once(text: str, columns: Columns, separator: str, skip: int) -> np.ndarray:
    """Return the places in a long table of numbers."""
    if separator != ",":
        text = text.replace(",", ".")
    try:
        places = np.loadtxt(
            StringIO(text.replace("\u2212", "-")),
            delimiter=None if separator in " \t" else separator,
            skiprows=skip,
            usecols=columns.places,
            comments="//",
            ndmin=2,
        )
    except ValueError as error:
        raise InputError(
            f"a row is not as the others: {error}", "measurement-table", "measurement"
        ) from error
    if not np.isfinite(places).all():
        row = int(np.flatnonzero(~np.isfinite(places).all(axis=1))[0])
        text = f"row {row + skip + 1} has a coordinate that is no finite number"
        raise InputError(text, "measurement-table", f"row {row + skip + 1}")
    return np.asarray(places)

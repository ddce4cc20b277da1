"""Tables of measured points: a joint and its place in each row, or the points of a cloud.

A header names the columns in any order (joint, x, y, z; more are passed over). Without one, four
columns are a joint and its place, three a place without a name.
"""

import re
from collections import Counter
from collections.abc import Sequence
from io import StringIO
from typing import NamedTuple

import numpy as np

from simulearn.compare.measurement import JointPlaces
from simulearn.drawings.rows import Row, number_in, rows_of, separator_of, value_in
from simulearn.drawings.units import unit_named
from simulearn.errors import InputError, Message

NAMES = ("joint", "joints", "number", "no", "nr", "id", "index", "point", "name", "label")
AXES = ("x", "y", "z")
UNIT = r"(?:[\[(]\s*|^[xyz][ _-]+)([^\[\]()]+?)\s*[\])]?$"  # as in "x [mm]", "x (mm)", "x_mm"
MANY = 20_000  # rows beyond which a table is read at once, without a message for each cell


class Columns(NamedTuple):
    """Which columns hold what; a unit that the header names, in mm."""

    places: tuple[int, int, int]
    joint: int | None
    unit: float | None = None


def read_table(text: str) -> JointPlaces:
    """Return the points in a table.

    Args:
        text: rows, their cells separated by one of ; tab , | or blanks; decimal commas are read
            where the comma separates no cells; # begins a comment.

    Raises:
        InputError: it is no such table, a cell is no finite number, or a joint has two rows.
    """
    text = re.sub(r"[ \t]*#[^\n]*", "", text)
    separator = separator_of(text)
    comma = separator != ","
    head = [row for row in rows_of(text[:10_000], separator) if row.cells][:60]
    if not head:
        raise InputError("holds no rows", "measurement-table", "measurement")
    named = all(value_in(cell, comma) is None for cell in head[0].cells)
    columns = _named(head[0].cells) if named else _unnamed(head, comma)
    if columns.joint is None and text.count("\n") > MANY:
        return JointPlaces(_at_once(text, columns, separator, head[0].number * named), None,
                           columns.unit)  # fmt: skip
    rows = [row for row in rows_of(text, separator) if row.cells][named:]
    if not rows:
        raise InputError("holds a header and no rows", "measurement-table", "measurement")
    if columns.joint is None:
        places = [[number_in(row, k, comma) for k in columns.places] for row in rows]
        return JointPlaces(np.array(places), None, columns.unit)
    return _of_joints(rows, columns, comma)


def _of_joints(rows: Sequence[Row], columns: Columns, comma: bool) -> JointPlaces:
    """Return the places of joints that are named; rows without a place are passed over."""
    places: dict[int, list[float]] = {}
    empty: list[int] = []
    for row in rows:
        joint = _joint(row, columns, comma)
        if joint in places or joint in empty:
            where = f"row {row.number}"
            raise InputError(
                f"{where}: joint {joint} has a row already", "measurement-table", where
            )
        if not any(k < len(row.cells) and row.cells[k] for k in columns.places):
            empty.append(joint)
            continue
        places[joint] = [number_in(row, k, comma) for k in columns.places]
    if not places:
        raise InputError("holds no joint with a place", "measurement-table", "measurement")
    messages = []
    if empty:
        text = f"joints without a place in the table are passed over: {', '.join(map(str, empty))}"
        messages.append(Message("measurement-empty", "measurement", text))
    return JointPlaces(
        np.array(list(places.values())), np.array(list(places)), columns.unit, tuple(messages)
    )


def _joint(row: Row, columns: Columns, comma: bool) -> int:
    assert columns.joint is not None
    cell = row.cells[columns.joint] if columns.joint < len(row.cells) else ""
    found = re.fullmatch(r"(?:joint|j)?[ _#-]*(\d{1,9})(?:[.,]0*)?", cell.strip(), re.I)
    if found is None:
        where = f"row {row.number}"
        text = f'{where} names the joint "{cell[:40]}"; a joint is named by its number, from 0'
        raise InputError(text, "measurement-table", where)
    return int(found[1])


def _named(header: Sequence[str]) -> Columns:
    """Return the columns that a header names."""
    at: dict[str, int] = {}
    units: dict[str, str] = {}
    for k, cell in enumerate(header):
        name = re.sub(r"[\[(].*?[\])]", "", cell).strip().casefold()
        name = re.sub(r"[ _-]?(mm|cm|m|in)$", "", name) if name[:1] in AXES else name
        if unit := re.search(UNIT, cell.casefold()):
            units[name] = unit[1]
        at.setdefault(name, k)
    missing = [axis for axis in AXES if axis not in at]
    if missing:
        text = (
            f'row 1 is "{", ".join(header)[:60]}", which names no column {missing[0]}; '
            "a table has the columns joint, x, y, z"
        )
        raise InputError(text, "measurement-table", "row 1")
    of = [units[axis] for axis in AXES if axis in units]
    mm = unit_named(of[0], f'"{of[0]}" in the header').mm if of else None
    joint = next((at[name] for name in NAMES if name in at), None)
    return Columns((at["x"], at["y"], at["z"]), joint, mm)


def _unnamed(rows: Sequence[Row], comma: bool) -> Columns:
    """Return what the columns are by their number."""
    width = Counter(len(row.cells) for row in rows).most_common(1)[0][0]
    if width == 3 or width >= 6:  # more are normals or colours
        return Columns((0, 1, 2), None)
    if width == 4:
        return Columns((1, 2, 3), 0)
    text = (
        f"row {rows[0].number} has {width} cells; a row is joint, x, y, z, or x, y, z without "
        "the number of the joint"
    )
    raise InputError(text, "measurement-table", f"row {rows[0].number}")


def _at_once(text: str, columns: Columns, separator: str, skip: int) -> np.ndarray:
    """Return the places in a long table of numbers."""
    if separator != ",":
        text = text.replace(",", ".")
    try:
        places = np.loadtxt(
            StringIO(text),
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

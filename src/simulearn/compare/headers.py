"""Which columns of a table of measured points hold what, by its header or by their number.

People write headers in their own language and programs in their own form: a column is an axis where
one of its words is x, y or z, in whatever order. The column of the joints is known by its name, or
by what it holds: different whole numbers, left of the coordinates.
"""

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from simulearn.drawings.rows import Row, value_in
from simulearn.drawings.units import unit_named
from simulearn.errors import InputError, Message

NAMES = ("joint", "joints", "number", "no", "nr", "id", "index", "point", "name", "label")
AXES = ("x", "y", "z")
CYRILLIC = str.maketrans("ху", "xy")  # which look the same
# A joint may have a word before its number, as in J3, Joint 3, P-3.
JOINT = re.compile(r"(?:[^\W\d_]\D{0,20})?(\d{1,9})(?:[.,]0*)?")
MANY = 20  # rows of four cells without a whole number in front: x, y, z and something more


class Columns(NamedTuple):
    """Which columns hold what.

    Attributes:
        places: of x, y, z.
        joint: of the joint's number; None without one.
        unit: that the header names, in mm.
        messages: what was taken for what, where that is no matter of course.
    """

    places: tuple[int, int, int]
    joint: int | None = None
    unit: float | None = None
    messages: tuple[Message, ...] = ()


def joint_in(cell: str) -> int | None:
    """Return the number of the joint that a cell names; None if it names none."""
    found = JOINT.fullmatch(cell.strip())
    return None if found is None else int(found[1])


def columns_by_header(header: Row, rows: Sequence[Row]) -> Columns:
    """Return the columns that a header names.

    Args:
        header: the row.
        rows: some of those below it.

    Raises:
        InputError: an axis is missing or there twice, or what stands for a unit is none.
    """
    where = f"row {header.number}"
    names = [_words(cell) for cell in header.cells]
    found = [_axis(axis, names, where) for axis in AXES]
    if None in found:
        text = (
            f'{where} is "{", ".join(header.cells)[:60]}", which names no column '
            f"{AXES[found.index(None)]}; a table has the columns joint, x, y, z"
        )
        raise InputError(text, "measurement-table", where)
    x, y, z = (k for k in found if k is not None)
    units = {_unit(header.cells[k]) for k in (x, y, z)} - {None}
    if len(units) > 1:
        text = f"{where} names different units for x, y and z; give all three in one"
        raise InputError(text, "measurement-table", where)
    unit = units.pop() if units else None
    others = [k for k in range(len(names)) if k not in (x, y, z)]
    joint = next((k for name in NAMES for k in others if name in names[k]), None)
    messages: tuple[Message, ...] = ()
    if joint is None:
        joint = next((k for k in range(min(x, y, z)) if _numbers_joints(rows, k)), None)
        if joint is not None:
            text = (
                f'column {joint + 1} ("{header.cells[joint][:40]}") is taken for the numbers of '
                'joints; call it "joint" to be sure'
            )
            messages = (Message("measurement-column", "measurement", text),)
    return Columns((x, y, z), joint, unit, messages)


def columns_by_number(rows: Sequence[Row]) -> Columns:
    """Return what the columns are by how many there are.

    Raises:
        InputError: neither a joint and its place nor a place.
    """
    width = Counter(len(row.cells) for row in rows).most_common(1)[0][0]
    where = f"row {rows[0].number}"
    if width == 3 and len(rows) > 3 and _counts(rows):
        text = (
            f"{where} has 3 cells, the first of which counts the rows: joints with x and y, and no "
            "z; a row is joint, x, y, z"
        )
        raise InputError(text, "measurement-table", where)
    if width == 3 or width >= 6:  # more are normals or colours
        return Columns((0, 1, 2))
    if width == 4:
        numbers = sum(joint_in(row.cells[0]) is not None for row in rows)
        return Columns((0, 1, 2)) if numbers < len(rows) / 2 and len(rows) > MANY else (
            Columns((1, 2, 3), 0)
        )  # fmt: skip
    text = (
        f"{where} has {width} cells; a row is joint, x, y, z, or x, y, z without the number of the "
        "joint"
    )
    raise InputError(text, "measurement-table", where)


def unit_in(row: Row, columns: Columns) -> float | None:
    """Return the unit, in mm, of a row that has units in place of coordinates; else None."""
    cells = [row.cells[k] for k in columns.places if k < len(row.cells)]
    units = {_known(cell.strip(" []()")) for cell in cells}
    return units.pop() if len(units) == 1 and len(cells) == 3 else None


def _words(cell: str) -> list[str]:
    name = re.sub(r"[\[(].*?[\])]", "", cell).strip().casefold().translate(CYRILLIC)
    return re.findall(r"[^\W_]+", name)


def _axis(axis: str, names: Sequence[Sequence[str]], where: str) -> int | None:
    """Return the column of an axis: that of its name alone, else that with it among its words."""
    alone = [k for k, words in enumerate(names) if _without_unit(words) == [axis]]
    if alone:
        return alone[0]
    at = [k for k, words in enumerate(names) if axis in words]
    if len(at) > 1:
        text = f"{where} names {len(at)} columns {axis}; call the measured one {axis} alone"
        raise InputError(text, "measurement-table", where)
    return at[0] if at else None


def _unit(cell: str) -> float | None:
    """Return the unit, in mm, that a heading names, as in "x [mm]", "x (mm)", "x_mm", "x in mm".

    Raises:
        InputError: what stands in brackets is no unit.
    """
    inside = re.search(r"[\[(]\s*(.+?)\s*[\])]", cell)
    if inside:
        return unit_named(inside[1], f'"{inside[1]}" in the header').mm
    words = _words(cell)
    return _known(words[-1]) if len(words) > 1 else None


def _without_unit(words: Sequence[str]) -> list[str]:
    if len(words) > 1 and _known(words[-1]) is not None:
        words = words[:-1]
    return [word for word in words if word != "in"] if len(words) == 2 else list(words)


def _known(word: str) -> float | None:
    try:
        return unit_named(word, "").mm
    except InputError:
        return None


def _numbers_joints(rows: Iterable[Row], column: int) -> bool:
    """Return whether a column holds different whole numbers, at least two."""
    numbers = [joint_in(row.cells[column]) for row in rows if column < len(row.cells)]
    return len(numbers) > 1 and None not in numbers and len({*numbers}) == len(numbers)


def _counts(rows: Sequence[Row]) -> bool:
    """Return whether the first cells count from 0 or 1."""
    first = [value_in(row.cells[0], True) for row in rows]
    return first in ([*range(len(rows))], [*range(1, len(rows) + 1)])

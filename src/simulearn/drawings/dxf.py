"""DXF files, text or binary, of all versions: their lines, curves, layers and unit."""

from typing import Any

import numpy as np

from simulearn.drawings.cad_units import likely_unit, unit
from simulearn.drawings.drawing import Drawing, Line, Unit
from simulearn.drawings.dxf_file import document
from simulearn.drawings.dxf_walk import Walk
from simulearn.errors import InputError
from simulearn.extras import require

# By the number in $INSUNITS; 0 is "no unit".
_UNITS = (
    *("", "in", "ft", "mi", "mm", "cm", "m", "km", "microinch", "mil", "yd", "angstrom", "nm"),
    *("um", "dm", "dam", "hm", "Gm", "astronomical unit", "light year", "parsec"),
    *("US survey ft", "US survey in", "US survey yd", "US survey mi"),
)


def read_dxf(data: bytes) -> Drawing:
    """Read a DXF file.

    Read is what is seen in the model space: lines, polylines and curves, blocks as they are
    placed. All else is counted.

    Args:
        data: the file.

    Returns:
        The drawing, in the unit of the file.

    Raises:
        InputError: it is no DXF file, too damaged or too large.
    """
    require("DXF files need", "ezdxf")
    found, messages = document(data)
    walk = Walk(found)
    try:
        with np.errstate(all="ignore"):  # numbers that are none are reported
            walk.run()
    except InputError:
        raise
    except Exception:  # a damaged file fails in the library in any way
        raise InputError(
            "the DXF file is damaged: its parts do not fit together", "dxf-broken"
        ) from None
    number = _variable(data, found, "$INSUNITS")
    named = unit(_UNITS[number], f"$INSUNITS of the file is {number}") if _known(number) else None
    if number and not named:
        messages.append(f"$INSUNITS of the file is {number}, which is no unit.")
    return Drawing(
        "DXF",
        walk.found.lines,
        walk.found.curves,
        walk.found.left_out,
        unit=named,
        guess=None if named else _guess(_variable(data, found, "$MEASUREMENT"), walk.found.lines),
        messages=[*messages, *walk.found.messages],
    )


def _known(number: Any) -> bool:
    return isinstance(number, int) and 0 < number < len(_UNITS)


def _variable(data: bytes, found: Any, name: str) -> Any:
    """Return a variable of the head, or None: ezdxf fills the head of files that have none."""
    return found.header.get(name) if name.encode() in data else None


def _guess(measurement: Any, lines: list[Line]) -> Unit | None:
    """Return the likeliest unit of a file that names none, or None.

    Args:
        measurement: what $MEASUREMENT says: 1 is metric, 0 English.
        lines: in the unit of the file.
    """
    reason = f"$MEASUREMENT of the file is {measurement}"
    if measurement == 1:
        return likely_unit(lines, ("mm", "cm", "m"), f"{reason}: metric")
    if measurement == 0:
        return likely_unit(lines, ("in", "ft"), f"{reason}: inches")
    return None

"""Reading what CalculiX printed.

The `.dat` file holds displacements and stresses with seven digits, one more than the `.frd` file;
the `.sta` file counts increments and iterations while they are computed.
"""

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import ComputationError

Array = NDArray[np.float64]

TITLE = re.compile(r"^ (displacements|stresses) \(")
SHORT = re.compile(r"(\d)([+-]\d{3})")  # Fortran drops the E of exponents with three digits


def read_dat(path: Path, nodes: int, bricks: int) -> tuple[list[Array], list[Array]]:
    """Return displacements and stresses at the end of each step.

    Args:
        path: the `.dat` file.
        nodes: number of nodes N.
        bricks: number of bricks E.

    Returns:
        One (N, 3) mm for each step, and one (E, 8, 6) MPa: Cauchy stress in global axes, order
        11 22 33 12 13 23, at the points `brick.POINTS`.

    Raises:
        ComputationError: the file is incomplete or holds something else than numbers.
    """
    found: dict[str, list[Array]] = {"displacements": [], "stresses": []}
    shape = {"displacements": (nodes, 3), "stresses": (bricks, 8, 6)}
    for title, lines in _blocks(path):
        try:
            table = np.array([line.split() for line in lines], float)
            values = table[:, -shape[title][-1] :].reshape(shape[title])
        except ValueError as error:
            raise ComputationError(f"CalculiX wrote incomplete {title}: {error}") from error
        if not np.isfinite(values).all():
            raise ComputationError(f"CalculiX wrote {title} that are not numbers")
        found[title].append(values)
    return found["displacements"], found["stresses"]


def _blocks(path: Path) -> Iterator[tuple[str, list[str]]]:
    title, lines = "", list[str]()
    for line in path.read_text(encoding="ascii").splitlines():
        if match := TITLE.match(line):
            if title:
                yield title, lines
            title, lines = match[1], []
        elif line.strip():
            lines.append(SHORT.sub(r"\1E\2", line))
    if title:
        yield title, lines


def read_sta(path: Path) -> list[tuple[int, int, int]]:
    """Return (step, increment, iterations) of every increment that converged so far.

    An attempt that did not is marked by a letter after its number.
    """
    if not path.exists():
        return []
    rows = (line.split() for line in path.read_text(encoding="ascii").splitlines()[2:])
    return [(int(r[0]), int(r[1]), int(r[3])) for r in rows if len(r) == 7 and r[2].isdigit()]


def last_error(log: str) -> str:
    """Return CalculiX's own last error message as one line, or an empty string."""
    lines = log.splitlines()
    starts = [k for k, line in enumerate(lines) if "*ERROR" in line]
    if not starts:
        return ""
    message = lines[starts[-1] : starts[-1] + 3]
    stop = next((k for k, line in enumerate(message) if not line.strip()), len(message))
    return " ".join(" ".join(message[:stop]).split()).replace("*ERROR", "").lstrip(" :")

"""Results as one binary message, so that a browser draws them without parsing text.

The message is `SLF1`, the length of a header (uint32), the header (JSON, padded with blanks to a
multiple of four bytes), and float32 numbers; all little-endian. The header has one entry for each
design: what qualifies its result, and where its arrays begin, counted in numbers.
"""

import json
import struct
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.grid import Grid, validate
from simulearn.grid.cleaning import kept
from simulearn.material import load_material
from simulearn.simulate import Failure, Outcome, Result, remarks, summary
from simulearn.simulate.resultfile import failure_to_dict

MAGIC = b"SLF1"
SCHEMA = "simulearn.frames/1"
DIGITS = 3  # of lengths, mm
PRINTS = 60  # of a spread that are drawn: more hide one another
MEDIA_TYPE = "application/vnd.simulearn.frames"
IN_RESPONSES: dict[int | str, dict[str, Any]] = {  # for the description of a route
    200: {"content": {MEDIA_TYPE: {"schema": {"type": "string", "format": "binary"}}}}
}


def to_bytes(grids: Sequence[Grid], outcomes: Sequence[Outcome]) -> bytes:
    """Return outcomes as a binary message.

    Args:
        grids: the designs as they were given; entries of the header are numbered by them.
        outcomes: of each.
    """
    arrays: list[NDArray[np.float32]] = []
    entries, start = [], 0
    for grid, outcome in zip(grids, outcomes, strict=True):
        if isinstance(outcome, Failure):
            entries.append(_failure(grid, outcome))
            continue
        entry = _result(grid, outcome)
        parts = {"joints": outcome.joints, "beams": outcome.beams}
        if outcome.stress is not None:
            parts["mises"] = mises(outcome.stress)
        if outcome.scatter is not None and outcome.scatter.lines is not None:
            parts["prints"] = outcome.scatter.lines[:PRINTS]
        entry["arrays"] = {}
        for name, values in parts.items():
            entry["arrays"][name] = {"start": start, "shape": list(values.shape)}
            arrays.append(values.astype("<f4"))
            start += values.size
        entries.append(entry)
    header = json.dumps({"schema": SCHEMA, "results": entries}, allow_nan=False).encode()
    header += b" " * (-len(header) % 4)
    numbers = [np.ascontiguousarray(a).tobytes() for a in arrays]
    return b"".join([MAGIC, struct.pack("<I", len(header)), header, *numbers])


def from_bytes(message: bytes) -> list[dict[str, Any]]:
    """Return the entries of a message, each with its arrays in place of where they begin.

    Raises:
        ValueError: it is not such a message, or is damaged.
    """
    try:
        (size,) = struct.unpack_from("<I", message, len(MAGIC))
        head = len(MAGIC) + 4 + size
        numbers = np.frombuffer(message, "<f4", offset=head)
        entries = json.loads(message[len(MAGIC) + 4 : head])["results"]
        for entry in entries:
            for name, place in entry.pop("arrays", {}).items():
                first, shape = place["start"], tuple(place["shape"])
                entry[name] = numbers[first : first + int(np.prod(shape))].reshape(shape)
    except (struct.error, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise ValueError("is not a message of frames") from error
    if not message.startswith(MAGIC):
        raise ValueError("is not a message of frames")
    return list(entries)


def mises(stress: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the equivalent stress (von Mises), MPa, of components 11 22 33 12 13 23 (..., 6)."""
    a, b, c, ab, ac, bc = np.moveaxis(stress, -1, 0)
    square = ((a - b) ** 2 + (b - c) ** 2 + (c - a) ** 2) / 2 + 3 * (ab**2 + ac**2 + bc**2)
    equivalent: NDArray[np.float64] = np.sqrt(square)
    return equivalent


def _result(grid: Grid, result: Result) -> dict[str, Any]:
    joints, beams = kept(grid.beams, len(grid.joints))
    numbers = np.flatnonzero(beams).tolist()
    return {
        "ok": True,
        "engine": result.engine,
        **summary(result),
        "remarks": remarks(result),
        "joint_numbers": np.flatnonzero(joints).tolist(),
        "beam_numbers": numbers,
        "net_lengths": dict(zip(numbers, _lengths(result), strict=True)),
    }


def _failure(grid: Grid, failure: Failure) -> dict[str, Any]:
    return {
        "ok": False,
        **failure_to_dict(failure),
        "errors": [asdict(message) for message in failure.invalid],
        "net_lengths": _net_lengths(grid),
    }


def _lengths(result: Result) -> list[float]:
    """Return the length of each beam between its joints, mm: from section to section, flat."""
    centres = result.beams[0].mean(axis=2)
    along = centres[:, 2] - centres[:, 0]
    lengths: list[float] = np.linalg.norm(along, axis=1).round(DIGITS).tolist()
    return lengths


def _net_lengths(grid: Grid) -> dict[int, float]:
    """Return the same of a design without a result, for the beams that have an outline."""
    try:
        report = validate(grid, load_material(grid.material))
    except InputError:
        return {}
    return {b: round(length, DIGITS) for b, length in report.net_lengths.items()}

"""Lines of an OBJ file: its `l` elements; groups, objects and materials are layers."""

from collections import Counter
from collections.abc import Iterator
from math import isfinite

import numpy as np

from simulearn.drawings.convention import ratio_of_layer
from simulearn.drawings.drawing import Drawing, LeftOut, Line
from simulearn.drawings.points import MOST_SEGMENTS, too_many
from simulearn.errors import InputError

Place = tuple[float, float, float]

# Elements that would be drawn, by their keywords.
OTHERS = {"f": "face", "p": "point", "curv": "curve", "curv2": "curve", "surf": "surface"}
REASONS = {"face": "is no line; only l elements are read"}


def read_obj(text: str) -> Drawing:
    """Return the lines of an OBJ file.

    Args:
        text: of the file.

    Raises:
        InputError: a vertex is no place, or a line names a vertex that does not exist.
    """
    vertices: list[Place] = []
    lines: list[tuple[list[int], str, int]] = []
    left_out: Counter[tuple[str, str]] = Counter()
    group, material, segments = "", "", 0
    for number, words in _statements(text):
        keyword, values = words[0], words[1:]
        if keyword == "v":
            vertices.append(_vertex(values, number))
        elif keyword in ("g", "o"):
            group = " ".join(values)
        elif keyword == "usemtl":
            material = " ".join(values)
        elif keyword == "l":
            indices = [_index(value, len(vertices), number) for value in values]
            segments += len(indices) - 1
            if segments > MOST_SEGMENTS:
                raise too_many()
            if len(indices) < 2:
                where = f"line {number}"
                raise InputError(f"{where}: l names fewer than two vertices", "obj", where)
            lines.append((indices, _layer(group, material), number))
        elif keyword in OTHERS:
            left_out[OTHERS[keyword], _layer(group, material)] += 1
    points = np.array(vertices).reshape(-1, 3)
    found = []
    for indices, layer, number in lines:
        if max(indices) >= len(points):
            raise _missing(max(indices) + 1, len(points), number)
        found.append(Line(points[indices], layer, where=f"line {number}"))
    rest = [
        LeftOut(kind, count, layer, REASONS.get(kind, "is no line"))
        for (kind, layer), count in left_out.items()
    ]
    return Drawing("OBJ", found, left_out=rest, plain=True)


def _statements(text: str) -> Iterator[tuple[int, list[str]]]:
    r"""Yield the number of each line of text and its words; a \ at its end joins the next one."""
    held: list[str] = []
    for number, line in enumerate(text.split("\n"), 1):
        row = line.split("#", 1)[0].rstrip()
        joined = row.endswith("\\")
        held += row.rstrip("\\").split()
        if held and not joined:
            yield number, held
            held = []
    if held:
        yield number, held


def _layer(group: str, material: str) -> str:
    """Return the layer of an element; a material that names an actuator is its last level."""
    if group and material and ratio_of_layer(material) is not None:
        return f"{group}::{material}"
    return group or material


def _vertex(values: list[str], number: int) -> Place:
    where = f"line {number}"
    try:
        x, y, *rest = (float(value) for value in values[:3])
    except ValueError as error:
        text = f'{where} is "v {" ".join(values)[:40]}"; a vertex has the numbers x, y and z'
        raise InputError(text, "obj", where) from error
    place = (x, y, rest[0] if rest else 0.0)
    if not all(map(isfinite, place)):
        text = f"{where}: a vertex has a coordinate that is not a finite number"
        raise InputError(text, "obj", where)
    return place


def _index(value: str, vertices: int, number: int) -> int:
    """Return the index of a vertex from 0; negative ones count back from the latest vertex."""
    where = f"line {number}"
    try:
        index = int(value.split("/", 1)[0])
    except ValueError as error:
        text = f'{where}: "{value[:40]}" is no number of a vertex'
        raise InputError(text, "obj", where) from error
    if index == 0 or index < -vertices:
        raise _missing(index, vertices, number)
    return index - 1 if index > 0 else vertices + index


def _missing(index: int, vertices: int, number: int) -> InputError:
    text = f"line {number} names the vertex {index}; vertices are numbered 1 to {vertices}"
    return InputError(text, "obj", f"line {number}")

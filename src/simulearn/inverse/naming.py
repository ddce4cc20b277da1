"""Vertices and faces by their names in a task file."""

from typing import Any

import numpy as np

from simulearn.errors import InputError
from simulearn.grid import Grid
from simulearn.grid.arrays import shown
from simulearn.grid.outline import outline
from simulearn.inverse.vertex import SECTIONS, Face, Vertex
from simulearn.material import Section, load_material

VERTEX = '["joint", k, "centre"], ["joint", k, corner] or ["beam", b, section, corner]'
FACE = '["joint", k, "top"], ["joint", k, side], ["beam", b], ["beam", b, section] and maybe "top"'
AROUND = (0, 1, 3, 2)  # corners of a section, counter-clockwise seen from the end of the beam
# What makes directions of four corners: a cross product of diagonals, from bottom to top.
DIAGONALS = ((-1, 0, 1, 0), (0, -1, 0, 1))
UPWARDS = (-1, -1, 1, 1)


def vertex_of(words: list[Any], where: str, grid: Grid) -> Vertex:
    """Return the vertex that a task names.

    Raises:
        InputError: there is no such vertex.
    """

    def corner(place: int, count: int) -> int | None:
        if words[place] == "centre":
            return None
        return _number(words, place, count, "corners", where)

    match words:
        case ["joint", _, _]:
            joint = _number(words, 1, len(grid.joints), "joints", where)
            return Vertex("joint", joint, corner(2, 8))
        case ["beam", _, _, _]:
            beam = _number(words, 1, len(grid.beams), "beams", where)
            section = _section(words, where)
            return Vertex("beam", beam, corner(3, 4), section)
    text = f"{where} is {shown(words)}; a vertex is {VERTEX}"
    raise InputError(text, "task", where)


def face_of(words: list[Any], where: str, grid: Grid) -> Face:
    """Return the face that a task names.

    Of a joint: its top, or a side of it (0 to 3), outwards. Of a beam: its course from start to
    end, a section of it, whose direction is the same, or the top there.

    Raises:
        InputError: there is no such face.
    """
    section = load_material(grid.material).section
    match words:
        case ["joint", _, named]:
            joint = _number(words, 1, len(grid.joints), "joints", where)
            corners = outline(grid, section).joints[joint]
            if named == "top":
                four = tuple(Vertex("joint", joint, k) for k in (4, 5, 6, 7))
                return Face(f"joint {joint}, top", four, _radius(corners), *DIAGONALS)
            side = _number(words, 2, 4, "sides", where)
            right, left = side, (side + 1) % 4
            four = tuple(Vertex("joint", joint, k) for k in (right, left, left + 4, right + 4))
            length = float(np.linalg.norm(corners[left] - corners[right]))
            return Face(f"joint {joint}, side {side}", four, _half(length, section), *DIAGONALS)
        case ["beam", _]:
            beam = _number(words, 1, len(grid.beams), "beams", where)
            start, end = grid.joints[grid.beams[beam]]
            two = Vertex("beam", beam, None, 0), Vertex("beam", beam, None, 2)
            return Face(f"beam {beam}", two, float(np.linalg.norm(end - start)) / 2, (-1, 1))
        case ["beam", _, _] | ["beam", _, _, "top"]:
            beam = _number(words, 1, len(grid.beams), "beams", where)
            k = _section(words, where)
            name, radius = f"beam {beam}, {SECTIONS[k]}", _half(section.width, section)
            four = tuple(Vertex("beam", beam, c, k) for c in AROUND)
            if len(words) == 3:
                return Face(name, four, radius, *DIAGONALS)
            return Face(f"{name}, top", four, radius, UPWARDS)
    text = f"{where} is {shown(words)}; a face is {FACE}"
    raise InputError(text, "task", where)


def _section(words: list[Any], where: str) -> int:
    named = words[2]
    return SECTIONS.index(named) if named in SECTIONS else _number(words, 2, 3, "sections", where)


def _number(words: list[Any], place: int, count: int, what: str, where: str) -> int:
    k = words[place]
    if isinstance(k, bool) or not isinstance(k, int) or not 0 <= k < count:
        raise InputError(
            f"{where}[{place}] is {shown(k)}; {what} are numbered 0 to {count - 1}",
            "task",
            f"{where}[{place}]",
        )
    return k


def _radius(corners: Any) -> float:
    return float(np.sqrt(((corners - corners.mean(axis=0)) ** 2).sum(axis=1).mean()))


def _half(length: float, section: Section) -> float:
    """Return half the diagonal of a side of so many mm."""
    return float(np.hypot(length, section.thickness)) / 2

"""Files of surfaces and curves: which reader takes which, and their units.

STL, OBJ and PLY know no unit: millimetres, unless a person says otherwise. GLB is in metres with y
up by its specification, and a Rhino file says its unit.
"""

import json
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from simulearn.drawings.cad_units import rhino_unit
from simulearn.drawings.reading import read_drawing
from simulearn.drawings.rhino_file import by_process, damaged
from simulearn.drawings.units import unit_named
from simulearn.errors import InputError, Message
from simulearn.surfaces.chains import chained
from simulearn.surfaces.curve import Curve
from simulearn.surfaces.mending import mended_surface
from simulearn.surfaces.meshfile import FORMATS, contents, loaded
from simulearn.surfaces.surface import Surface

METRE = 1000.0  # mm
Z_UP = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])  # turns +y up into +z up
KINDS = (*FORMATS.values(), "glb", "3dm")
READ = " ".join(f".{kind}" for kind in KINDS)
USUAL = (5.0, 5000.0)  # mm, across what people mean
TABLES = (".csv", ".tsv", ".txt")
CHORD = 0.01  # mm, distance between a curve and its chords


def read_surface(path: Path | str, unit: str | None = None) -> Surface:
    """Return the surface in a file, in mm; what was mended or guessed is in its warnings.

    Args:
        path: .stl, .obj, .ply, .glb or .3dm.
        unit: of the file, such as "m" or "in"; what the file or its format says if not given, else
            mm.

    Raises:
        InputError: the file cannot be read, is damaged or holds no triangle; one line says why.
    """
    path = Path(path)
    if unit is not None:
        unit_named(unit, "as given")  # before a file is looked for
    kind = path.suffix.lower().removeprefix(".")
    data = contents(path, "surface")
    if kind not in KINDS:
        raise InputError(f"{path}: the ending is not one of {READ}", "surface-format", str(path))
    return surface_in(data, kind, path, unit)


def surface_in(data: bytes, kind: str, path: Path, unit: str | None = None) -> Surface:
    """Return the surface in the contents of a file, as `read_surface` does.

    Args:
        data: the contents.
        kind: one of `KINDS`.
        path: of the file, for messages.
        unit: of the file.
    """
    mm = None if unit is None else unit_named(unit, "as given").mm
    says: list[Message] = []
    if kind == "3dm":
        vertices, faces, own, says = _of_rhino(data, path)
    else:
        shape = loaded(data, kind, str(path), "surface")
        if shape is None or not len(getattr(shape, "faces", ())):
            what = (
                "is damaged or holds nothing" if shape is None else "holds points and no triangles"
            )
            text = f"{path}: {what}; a surface has triangles"
            raise InputError(text, "surface-empty", str(path))
        vertices, faces = np.asarray(shape.vertices, np.float64), np.asarray(shape.faces)
        own = METRE if kind == "glb" else None
        if kind == "glb":
            vertices = vertices @ Z_UP.T
    try:
        surface = mended_surface(vertices, faces)
    except InputError as error:
        raise InputError(f"{path}: {error}", error.code, str(path)) from error
    surface = surface.scaled(mm or own or 1.0)
    if mm is None:
        says += _odd(surface.size, "surface", own)
    named = tuple(
        replace(one, where=str(path), message=f"{path.name}: {one.message}")
        for one in (*says, *surface.warnings)
    )
    return replace(surface, warnings=named)


def read_curve(path: Path | str, unit: str | None = None) -> Curve:
    """Return the curve in a file, in mm; pieces that meet are joined.

    Args:
        path: a table of points (.csv and others), or a drawing with one curve (.3dm, .dxf, .svg,
            .obj, .json).
        unit: of the file; what the file says if not given, else mm.

    Raises:
        InputError: the file cannot be read, or holds no curve or several; one line says why.
    """
    path = Path(path)
    mm = None if unit is None else unit_named(unit, "as given").mm
    data = contents(path, "curve")
    says: list[Message] = []
    try:
        drawing = read_drawing(data, path.name)
        if mm is None:
            mm = 1.0 if drawing.unit is None else drawing.unit.mm
        parts = [line.points for line in drawing.lines]
        parts += [curve.flatten(CHORD / mm) for curve in drawing.curves]
        chains = chained([mm * part for part in parts])
        if len(chains) != 1:
            count = f"{len(chains)} separate curves" if chains else "no curve"
            why = "".join(f"; {out.count} {out.kind} {out.reason}" for out in drawing.left_out[:3])
            if path.suffix.lower() in TABLES and chains:
                why = "; in a table with a row for each point there are two or three columns"
            raise InputError(f"holds {count}; a file of a curve has one{why}", "curve-count")
        curve = Curve(chains[0])
    except InputError as error:
        raise InputError(f"{path}: {error}", error.code, str(path)) from error
    if unit is None:
        says += _odd(curve.size, "curve", None if drawing.unit is None else mm)
    if drawing.left_out:
        lost = sum(part.count for part in drawing.left_out)
        says.append(Message("curve-left-out", "", f"{lost} things that are no lines are left out"))
    named = (replace(s, where=str(path), message=f"{path.name}: {s.message}") for s in says)
    return replace(curve, warnings=tuple(named))


def _odd(size: float, what: str, own: float | None) -> list[Message]:
    """Return a warning where a size in mm is hardly meant.

    Args:
        size: mm.
        what: has it.
        own: mm, the unit that the file itself says; None where it says none.
    """
    if USUAL[0] <= size <= USUAL[1]:
        return []
    taken = (
        "the file has no unit and is taken to be in mm"
        if own is None
        else f"the unit of the file is {own:g} mm"
    )
    text = f"{taken}; so the {what} is {size:.3g} mm across"
    if size < USUAL[0] and own is None:
        text += '; if it is in metres or inches, say "unit": "m" or "in"'
    if size > USUAL[1] and own not in (None, 1.0):
        text += '; if it was drawn in mm, say "unit": "mm"'
    return [Message("surface-unit", what, text)]


def _of_rhino(data: bytes, path: Path) -> tuple[Any, Any, float | None, list[Message]]:
    """Return vertices, faces, mm that the unit is (None if not known), and what is to be said."""
    try:
        written = by_process(data, Path(__file__).with_name("rhino_surface_process.py"))
        if written is None:
            raise damaged()
    except InputError as error:
        raise InputError(f"{path}: {error}", error.code, str(path)) from error
    with np.load(BytesIO(written)) as found:
        vertices, faces, says = found["vertices"], found["faces"], json.loads(bytes(found["says"]))
    messages = []
    if says["left_out"]:
        parts = ", ".join(f"{count} {kind}" for kind, count in says["left_out"].items())
        messages.append(Message("surface-left-out", "", f"what is no surface is left out: {parts}"))
    if says["untrimmed"]:
        text = (
            f"{says['untrimmed']} trimmed faces have no render mesh and are taken whole; shade "
            "the model in Rhino before saving it, or save a mesh"
        )
        messages.append(Message("surface-untrimmed", "", text))
    if not len(faces):
        why = f" ({messages[0].message})" if messages else ""
        text = f"{path}: holds no surface, polysurface or mesh{why}"
        raise InputError(text, "surface-empty", str(path))
    named = rhino_unit(says["unit"], "of the file")
    return vertices, faces, None if named is None else named.mm, messages

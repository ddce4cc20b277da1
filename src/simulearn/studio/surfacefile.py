"""Surfaces that people drop on the page: known by their contents, small enough for a document.

A file may hold lines, from which a grid is made, as well as triangles. Then a person says which of
both is meant.
"""

import re
from pathlib import Path
from typing import Any

import numpy as np

from simulearn.drawings.units import Unit, UnitError, unit_named
from simulearn.errors import InputError
from simulearn.grid.structure import FARTHEST
from simulearn.surfaces import Surface, simplified, surface_in

MOST_TRIANGLES = 4000  # of a surface in a document
MOST_READ = 2_000_000  # triangles of a file
ROUND = 4  # decimals of mm, finer than any print
SHOWN = 50  # places of one kind
LINES = ("Curve", "Polyline")  # in names of Rhino's kinds
USUAL = (20.0, 2000.0)  # mm, across what a grid lies on
LIKELY = ("mm", "m", "in", "cm")
STARTS = (
    ("ply", re.compile(rb"ply\r?\n")),
    ("glb", re.compile(rb"glTF")),
    ("3dm", re.compile(rb"3D Geometry File Format")),
    ("stl", re.compile(rb"\s*solid\b(?=[\s\S]{0,400}?(?:facet|endsolid)\b)")),
)
OBJ_VERTEX = re.compile(rb"^[ \t]*v[ \t]+[-+.\d]", re.MULTILINE)
OBJ_FACE = re.compile(rb"^[ \t]*f[ \t]+[-\d]", re.MULTILINE)
OBJ_LINE = re.compile(rb"^[ \t]*l[ \t]+[-\d]", re.MULTILINE)
HEAD, RECORD = 84, 50  # bytes of a binary STL


def kind_of(data: bytes) -> str | None:
    """Return what may be a surface by its contents: stl, obj, ply, glb or 3dm; None of others."""
    for kind, start in STARTS:
        if start.match(data):
            return kind
    count = int.from_bytes(data[HEAD - 4 : HEAD], "little")
    if count and len(data) == HEAD + RECORD * count:
        return "stl"
    text = data[:1] not in (b"{", b"[", b"<") and b"\0" not in data[:1000]
    return "obj" if text and OBJ_VERTEX.search(data) and OBJ_FACE.search(data) else None


def surface_of(
    data: bytes, name: str, unit: str | None = None, *, meant: bool = False
) -> dict[str, Any] | None:
    """Return the surface that a file holds, as a document has it; None where it holds none.

    Args:
        data: the contents.
        name: of the file.
        unit: of the file; what it says if not given, else mm.
        meant: whether a person has said that a surface is meant.

    Returns:
        vertices and faces (mm); format, triangles, unit and size of what the file holds; what was
        mended, guessed and changed, with its places.

    Raises:
        InputError: it is damaged or too large, or it holds lines, too, and nobody has said which.
        UnitError: its unit is not known, and in mm its size makes no sense.
    """
    kind = kind_of(data)
    if kind is None:
        if meant:
            text = "is no surface; a surface is an STL, OBJ with faces, PLY, GLB or .3dm file"
            raise InputError(text, "surface-format", "file")
        return None
    if kind == "obj" and not meant and OBJ_LINE.search(data):
        raise _either("lines and faces")
    if kind == "stl" and len(data) > HEAD + RECORD * MOST_READ:
        raise _many((len(data) - HEAD) // RECORD)
    try:
        surface = surface_in(data, kind, Path(name or "surface"), unit)
    except InputError as error:
        if kind == "3dm" and not meant and error.code == "surface-empty":
            return None
        raise InputError(_short(str(error), name), error.code, "file") from error
    left_out = " ".join(m.message for m in surface.warnings if m.code == "surface-left-out")
    if kind == "3dm" and not meant and any(word in left_out for word in LINES):
        raise _either("curves and surfaces")
    if len(surface.faces) > MOST_READ:
        raise _many(len(surface.faces))
    if unit is None and any(one.code == "surface-unit" for one in surface.warnings):
        raise _unit_error(surface)
    return _described(surface, kind, name, unit)


def small(surface: Surface) -> tuple[dict[str, Any], float]:
    """Return vertices and faces as a document has them, and how far off (mm) they are."""
    made, apart = simplified(surface, MOST_TRIANGLES)
    if float(np.abs(made.box).max()) > FARTHEST:
        text = f"reaches farther than {FARTHEST / 1000:g} m from its origin; move it there"
        raise InputError(text, "surface-far", "file")
    vertices = made.vertices.round(ROUND) + 0.0
    return {"vertices": vertices.tolist(), "faces": made.faces.tolist()}, apart


def _described(surface: Surface, kind: str, name: str, unit: str | None) -> dict[str, Any]:
    mesh, apart = small(surface)
    messages = [
        {
            "code": one.code,
            "where": "surface",
            "message": _short(one.message, name),
            "places": surface.places.get(one.code, np.zeros((0, 3)))[:SHOWN].round(3).tolist(),
        }
        for one in surface.warnings
    ]
    if apart > 0:
        text = (
            f"has {len(surface.faces):,} triangles and was simplified to {len(mesh['faces']):,}; "
            f"it is nowhere farther than {apart:.2g} mm from the file's"
        )
        messages.append(
            {"code": "surface-simplified", "where": "surface", "message": text, "places": []}
        )
    said = "given" if unit is not None else {"glb": "format", "3dm": "file"}.get(kind, "guess")
    low, high = surface.box
    return {
        **mesh,
        "format": kind.upper() if kind != "3dm" else "Rhino",
        "triangles": len(surface.faces),
        "apart_mm": apart,
        "unit": unit or {"glb": "m"}.get(kind, "mm"),
        "unit_by": said,
        "size": (high - low).round(3).tolist(),
        "messages": messages,
    }


def _short(text: str, name: str) -> str:
    """Return a message without the name of the file, which is said elsewhere."""
    return text.removeprefix(f"{name or 'surface'}: ")


def _either(what: str) -> InputError:
    text = f"holds {what}; say whether it is a surface or a drawing"
    return InputError(text, "surface-or-drawing", "file")


def _many(count: int) -> InputError:
    text = f"has {count:,} triangles; at most {MOST_READ:,} are read; save it coarser"
    return InputError(text, "surface-many", "file")


def _unit_error(surface: Surface) -> UnitError:
    """Return the error of a surface whose size in mm makes no sense."""
    low, high = surface.box
    size = tuple((high - low).round(6).tolist())
    units = [unit_named(name, "the usual size of surfaces") for name in LIKELY]
    guess: Unit | None = next(
        (unit for unit in units if USUAL[0] <= surface.size * unit.mm <= USUAL[1]), None
    )
    text = f"has no unit, and in mm it would be {surface.size:.3g} mm across"
    return UnitError(text, guess, size)

"""Which reader a file needs, by its contents; what cannot be read is named with the way out."""

import gzip
import re
import zlib
from io import BytesIO

from simulearn.drawings.drawing import Drawing
from simulearn.drawings.lists import read_json_lines
from simulearn.drawings.objfile import read_obj
from simulearn.drawings.pages import page_contents
from simulearn.drawings.tables import read_csv
from simulearn.drawings.text import decoded
from simulearn.errors import InputError
from simulearn.extras import require
from simulearn.files import parse_json
from simulearn.grid import Grid, grid_from_dict

MOST_BYTES = 2**25
READ = "DXF, SVG, Rhino (.3dm), JSON, CSV and OBJ"
PICTURE = "a picture; lines are read from DXF, SVG and .3dm"
# Kinds of files by their first bytes, and what to do about them.
OTHERS = (
    (rb"AC10\d\d", "a DWG file; save it as DXF"),
    (rb"%PDF", "a PDF or Illustrator file; save it as SVG or DXF"),
    (rb"%!PS|\xc5\xd0\xd3\xc6", "a PostScript file; save it as SVG or DXF"),
    (rb"ISO-10303-21", "a STEP file; save its curves as DXF or .3dm"),
    (rb".{72}S {0,6}0*1\s", "an IGES file; save its curves as DXF or .3dm"),
    (rb"solid\b|.{80}(?=.{4}(?:.{48}\0\0)+\Z)", "an STL mesh; save lines as DXF, .3dm or OBJ"),
    (rb"ply\r?\n", "a PLY mesh; save lines as DXF, .3dm or OBJ"),
    (rb"glTF", "a glTF model; save lines as DXF, .3dm or OBJ"),
    (rb"\x89PNG|\xff\xd8\xff|GIF8|BM.{4}\0\0\0\0|II\*\0|MM\0\*|RIFF.{4}WEBP", PICTURE),
    (rb"\x89HDF", "an HDF5 file; a drawing has lines"),
    (rb"BLENDER", "a Blender file; save its edges as OBJ"),
    (rb"(?:\s*;[^\n]*\n)*\s*[GM]\d+\b", "G-code of a print; open the design that it was made from"),
    (rb"PK\x03\x04", "a ZIP archive (3MF, FreeCAD and others); save lines as DXF or SVG"),
    (rb"\xff\xfe\xff\x0eS\0k\0e\0t\0c\0h\0", "a SketchUp file; save it as DXF"),
    (rb"\xd0\xcf\x11\xe0", "an old Office or CAD file; save lines as DXF or SVG"),
)
DXF = re.compile(r"\s*(?:999[ \t]*\n.*\n\s*)*0[ \t]*\n[ \t]*SECTION\b", re.IGNORECASE)
SVG = re.compile(r"<(?:[A-Za-z_][\w.-]*:)?svg[\s>/]")
OBJ = re.compile(r"^[ \t]*v[ \t]+[-+.\d]", re.MULTILINE)
BEFORE_JSON = b"\xef\xbb\xbf\xff\xfe\0 \t\r\n"
NUMBERS = re.compile(r"[-+]?[\d.]")


def own_grid(data: bytes) -> Grid | None:
    """Return the grid of a grid, result, task or page of ours; None for any other file.

    Args:
        data: contents of the file.

    Raises:
        InputError: it is one of ours, but not sound.
    """
    if len(data) > MOST_BYTES:
        return None
    page = page_contents(data)
    if page is None and not data.lstrip(BEFORE_JSON).startswith(b"{"):
        return None
    try:
        value = parse_json(decoded(data) if page is None else page)
    except InputError:
        return None
    schema = value.get("schema")
    if {"joints", "beams"} <= set(value):
        return grid_from_dict(value)
    if not isinstance(schema, str) or not schema.startswith("simulearn."):
        return None
    if "grid" not in value:
        raise InputError(f'is a file of the kind "{schema}", which holds no grid', "format")
    return grid_from_dict(value["grid"])


def read_drawing(data: bytes, name: str) -> Drawing:
    """Return what a drawing holds.

    Args:
        data: contents of the file.
        name: of the file; used only to say what is wrong with contents that are of no known kind.

    Raises:
        InputError: it is none of the kinds that are read, too large or damaged, or its reader
            needs a package.
    """
    if len(data) > MOST_BYTES:
        raise _too_large()
    if data.startswith(b"\x1f\x8b"):
        data = _unzipped(data)
    if not data.strip(b"\0 \t\r\n\xef\xbb\xbf"):
        raise InputError("is empty", "format")
    if data.startswith(b"AutoCAD Binary DXF"):
        return _dxf(data)
    if data.startswith(b"3D Geometry File Format"):
        return _3dm(data)
    for start, what in OTHERS:
        if re.match(start, data, re.DOTALL):
            raise InputError(f"is {what}", "format")
    return _of_text(data, name)


def _of_text(data: bytes, name: str) -> Drawing:
    """Return what a drawing that is text holds."""
    text = decoded(data)
    begin = text.lstrip()
    if DXF.match(text):
        return _dxf(data)
    if begin.startswith(("{", "[")):
        return read_json_lines(parse_json(text))
    if begin.startswith("<"):
        if SVG.search(text):
            return _svg(data)
        root = re.search(r"<([A-Za-z_][\w:.-]*)", begin)
        kind = f"<{root[1][:40]}>" if root else "no element"
        raise InputError(f"is XML with {kind} but no <svg>; {READ} are read", "format")
    if OBJ.search(text):
        return read_obj(text)
    rows = (row for row in text.split("\n") if row.strip() and not row.startswith(("#", "//")))
    if any(NUMBERS.match(row.strip()) or re.search(r"[,;\t|]", row) for row in rows):
        return read_csv(text)
    ending = f"whatever its name ends in ({name[-20:]})" if "." in name else "by its contents"
    raise InputError(f"is of no kind that is read, {ending}; {READ} are read", "format")


def _too_large() -> InputError:
    text = f"is too large; a drawing has at most {MOST_BYTES // 2**20} MiB"
    return InputError(text, "too-large")


def _unzipped(data: bytes) -> bytes:
    """Return the contents of a gzip file, as an .svgz is."""
    try:
        with gzip.open(BytesIO(data)) as file:
            contents = file.read(MOST_BYTES + 1)
    except (OSError, EOFError, zlib.error) as error:
        raise InputError(f"is a damaged gzip file ({error})", "format") from error
    if len(contents) > MOST_BYTES:
        raise _too_large()
    return contents


def _dxf(data: bytes) -> Drawing:
    from simulearn.drawings.dxf import read_dxf

    return read_dxf(data)


def _3dm(data: bytes) -> Drawing:
    from simulearn.drawings.rhino import read_3dm

    return read_3dm(data)


def _svg(data: bytes) -> Drawing:
    require("SVG files need", "svgelements", "tinycss2")
    from simulearn.drawings.svg import read_svg

    return read_svg(data)

"""Mesh files (STL, OBJ, PLY, GLB) as Trimesh reads them, in one line where it cannot."""

import re
from codecs import BOM_UTF8
from io import BytesIO
from pathlib import Path
from stat import S_ISDIR, S_ISREG
from typing import Any

from simulearn.errors import InputError
from simulearn.files import MOST_BYTES

FROM_ZERO = re.compile(rb"^f(?:[ \t]+[^\s]+)*?[ \t]+0(?:[/\s]|$)", re.MULTILINE)
FORMATS = {".stl": "stl", ".ply": "ply", ".obj": "obj"}  # without a unit
# How files begin, which may be called by the wrong ending.
SIGNS = {
    b"ply\n": "PLY",
    b"ply\r": "PLY",
    b"glTF": "GLB",
    b"PK\x03\x04": "3MF or ZIP",
    b"ISO-10303": "STEP",
    b"3D Geometry": "Rhino",
    b"\x89PNG": "PNG",
    b"%PDF": "PDF",
}
HEAD, TRIANGLE = 84, 50  # bytes of a binary STL: before the triangles, and of each


def loaded(data: bytes, ending: str, name: str, code: str) -> Any:
    """Return the shape in a file: what Trimesh calls a mesh or a cloud; None if there is none.

    Args:
        data: contents of the file.
        ending: "stl", "ply", "obj" or "glb".
        name: of the file, for messages.
        code: of messages; the word for what the file should be.

    Raises:
        InputError: it is damaged, or no such file.
    """
    import trimesh

    if data[:40].startswith(b"version https://git-lfs"):
        raise InputError(f"{name}: is a pointer of Git LFS and no {code}; `git lfs pull`", code)
    more: Any = {"skip_materials": True} if ending == "obj" else {}
    data = data.removeprefix(BOM_UTF8)  # Trimesh would take it for a part of the first line
    if wrong := _wrong(data, ending):
        raise InputError(f"{name}: {wrong}", code, name)
    if ending == "obj" and FROM_ZERO.search(data):  # Trimesh would take the last vertex
        raise InputError(f"{name}: a face has the vertex 0; OBJ counts from 1", code, name)
    try:
        shape: Any = trimesh.load(BytesIO(data), file_type=ending, process=False, **more)
        if isinstance(shape, trimesh.Scene):
            shape = _joined(shape)
    except Exception as error:  # whatever a reader of foreign bytes stumbles on
        reason = f"{type(error).__name__}: {error}".replace("\n", " ")[:120]
        raise InputError(
            f"{name}: is damaged, or no {ending.upper()} file ({reason})", code, name
        ) from error
    if shape is None or len(getattr(shape, "vertices", ())) == 0:
        return None
    return shape


def _wrong(data: bytes, ending: str) -> str:
    """Return what is wrong with a file by its beginning and its length; "" if nothing is."""
    kind = next((kind for sign, kind in SIGNS.items() if data.startswith(sign)), None)
    if kind is not None and kind.casefold() != ending:
        return f"is a {kind} file by its contents, and no {ending.upper()} file"
    if ending != "stl" or not data:
        return ""
    if data[:5].lower() == b"solid" and b"facet" in data[:2000]:
        return "" if b"endsolid" in data[-2000:].lower() else "is cut off: it has no endsolid"
    if re.match(rb"(?:#[^\n]*\n|\s)*(?:mtllib|o|g|v|vt|vn)[ \t]", data[:2000]):
        return "is an OBJ file by its contents, and no STL file"
    count, held = int.from_bytes(data[80:HEAD], "little"), max(len(data) - HEAD, 0) // TRIANGLE
    if data[:5].lower() != b"solid" and held < count:
        return f"is damaged or cut off: it says that it has {count:,} triangles, and has {held:,}"
    return ""


def _joined(scene: Any) -> Any:
    """Return the meshes of a scene in their places as one; else its largest cloud."""
    import trimesh

    parts = [part for part in scene.geometry.values() if len(getattr(part, "vertices", ()))]
    if any(isinstance(part, trimesh.Trimesh) and len(part.faces) for part in parts):
        return scene.to_mesh()
    return max(parts, key=lambda part: len(part.vertices), default=None)


def contents(path: Path, code: str) -> bytes:
    """Return the bytes of a file.

    Raises:
        InputError: it is missing, too large or cannot be read.
    """
    try:
        status = path.stat()
        if not S_ISREG(status.st_mode) and not S_ISDIR(status.st_mode):
            raise InputError(f"{path}: is a device or a pipe; name a file", code)
        if status.st_size > MOST_BYTES:
            most = f"{MOST_BYTES / 2**20:g} MiB"
            raise InputError(f"{path}: is too large; at most {most} can be read", code)
        return path.read_bytes()
    except FileNotFoundError as error:
        web = "; an address on the web is no file: load it first" if _web(path) else ""
        raise InputError(f"{path}: there is no such file{web}") from error
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from error
    except InputError:
        raise
    except ValueError as error:
        raise InputError(f"{str(path)!r}: is not the name of a file ({error})", code) from error


def _web(path: Path) -> bool:
    """Return whether a path was an address; paths have single slashes."""
    return any(part in ("http:", "https:") for part in path.parts)

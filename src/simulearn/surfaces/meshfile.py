"""Mesh files (STL, OBJ, PLY, GLB) as Trimesh reads them, in one line where it cannot."""

from io import BytesIO
from pathlib import Path
from typing import Any

from simulearn.errors import InputError
from simulearn.files import MOST_BYTES

FORMATS = {".stl": "stl", ".ply": "ply", ".obj": "obj"}  # without a unit


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
        if path.stat().st_size > MOST_BYTES:
            most = f"{MOST_BYTES / 2**20:g} MiB"
            raise InputError(f"{path}: is too large; at most {most} can be read", code)
        return path.read_bytes()
    except FileNotFoundError as error:
        raise InputError(f"{path}: there is no such file") from error
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from error

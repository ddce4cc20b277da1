"""Files of quad meshes: OBJ and PLY, as modelling programs write them."""

import struct
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.files import decoded
from simulearn.surfaces.mending import FARTHEST
from simulearn.surfaces.meshfile import contents

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

MOST_FACES = 100_000  # of a mesh that may have been drawn quad by quad

CODES = {
    "char": "b", "int8": "b", "uchar": "B", "uint8": "B", "short": "h", "int16": "h",
    "ushort": "H", "uint16": "H", "int": "i", "int32": "i", "uint": "I", "uint32": "I",
    "float": "f", "float32": "f", "double": "d", "float64": "d",
}  # fmt: skip


def read_quads(path: Path | str) -> tuple[Array, Indices] | None:
    """Return the vertices (V, 3) and quads (M, 4) of a file; None if it holds other faces only.

    Vertices at one place are one.

    Raises:
        InputError: the file cannot be read, is damaged, or mixes quads with other faces.
    """
    path = Path(path)
    data = contents(path, "surface")
    if data.count(b"\nf ") > MOST_FACES:
        return None
    try:
        if path.suffix.lower() == ".obj":
            vertices, faces = _obj(decoded(data))
        elif path.suffix.lower() == ".ply":
            vertices, faces = _ply(data)
        else:
            return None
        quads = np.array([face for face in faces if len(face) == 4], dtype=np.int64)
        if not len(quads):
            return None
        if len(quads) < len(faces):
            text = (
                f"{path}: has {len(quads)} quads and {len(faces) - len(quads)} other faces; a "
                "module has four sides. Draw quads only, or say --modules or --size to tile the "
                "surface as a whole"
            )
            raise InputError(text, "quads-mixed", str(path))
        places = np.array(vertices, dtype=float).reshape(-1, 3)
        if quads.min() < 0 or quads.max() >= len(places):
            raise ValueError("a face has a vertex that is not there")
        used, quads = np.unique(quads, return_inverse=True)
        quads, places = quads.reshape(-1, 4), places[used]
        if not (np.abs(places) < FARTHEST).all():
            raise ValueError(f"a vertex has a coordinate that is no number below {FARTHEST:g}")
    except (ValueError, IndexError, KeyError, struct.error, UnicodeDecodeError) as error:
        if isinstance(error, InputError):
            raise
        text = f"{path}: is damaged, or no mesh file ({error})"
        raise InputError(text, "surface", str(path)) from error
    scale = max(float(np.ptp(places, axis=0).max()), 1e-300)
    _, first, one = np.unique(
        (places / scale * 1e7).round(), axis=0, return_index=True, return_inverse=True
    )
    return places[first], one.reshape(-1)[quads]


def _obj(text: str) -> tuple[list[list[float]], list[list[int]]]:
    vertices: list[list[float]] = []
    faces = []
    for line in text.replace("\\\n", " ").splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append([float(word) for word in words[1:4]])
        elif words[:1] == ["f"]:
            numbers = [int(word.split("/")[0]) for word in words[1:]]
            faces.append([k - 1 if k > 0 else len(vertices) + k for k in numbers])
    return vertices, faces


def _ply(data: bytes) -> tuple[list[list[float]], list[list[int]]]:
    head, _, body = data.partition(b"end_header")
    body = body[body.index(b"\n") + 1 :]
    lines = [line.split() for line in head.decode("ascii", "replace").splitlines()]
    if lines[:1] != [["ply"]]:
        raise ValueError("it does not begin with ply")
    form = next(words[1] for words in lines if words[:1] == ["format"])
    elements: list[tuple[str, int, list[list[str]]]] = []
    for words in lines:
        if words[:1] == ["element"]:
            elements.append((words[1], int(words[2]), []))
        elif words[:1] == ["property"]:
            elements[-1][2].append(words[1:])
    if any(name == "face" and count > MOST_FACES for name, count, _ in elements):
        return [], []
    read = _text_reader(body) if form == "ascii" else _binary_reader(body, form)
    vertices: list[list[float]] = []
    faces: list[list[int]] = []
    for name, count, properties in elements:
        for _ in range(count):
            row = {}
            for words in properties:
                if words[0] == "list":
                    row[words[3]] = [read(words[2]) for _ in range(int(read(words[1])))]
                else:
                    row[words[1]] = [read(words[0])]
            if name == "vertex":
                vertices.append([row[axis][0] for axis in "xyz"])
            elif name == "face":
                own = row.get("vertex_indices") or row["vertex_index"]
                faces.append([int(k) for k in own])
    return vertices, faces


def _text_reader(body: bytes):  # type: ignore[no-untyped-def]
    words = iter(body.split())
    return lambda kind: float(next(words, b"nothing"))


def _binary_reader(body: bytes, form: str):  # type: ignore[no-untyped-def]
    order, place = "<" if "little" in form else ">", 0

    def read(kind: str) -> float:
        nonlocal place
        code = order + CODES[kind]
        (value,) = struct.unpack_from(code, body, place)
        place += struct.calcsize(code)
        return float(value)

    return read

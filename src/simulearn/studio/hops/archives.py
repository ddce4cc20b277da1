"""Geometry as Rhino writes it in JSON: an archive of one object, in base64.

The library that reads archives trusts them: where a length in one is wrong, it may take a minute
and all memory. So the chunks of an archive are checked first, each by its own checksum, and what
else hangs on an object is left off.
"""

import base64
import binascii
import json
import struct
from collections.abc import Mapping
from typing import Any
from uuid import UUID
from zlib import crc32

from simulearn.errors import InputError
from simulearn.studio.problems import Problem

OBJECT, CLASS, DATA, END = 0x00027FFA, 0x0002FFFB, 0x0002FFFC, 0x80027FFF  # codes of chunks
HEAD = struct.Struct("<Iq")  # of a chunk: its code, and its length
CHECKSUM = struct.Struct("<I")
DEEPEST = 4  # objects within objects, as segments of a curve
OLDEST = 50  # archives before it have shorter lengths
READ = {  # classes that are read
    "4ed7d4db-e947-11d3-bfe5-0010830122f0",  # LineCurve
    "4ed7d4e6-e947-11d3-bfe5-0010830122f0",  # PolylineCurve
    "4ed7d4dd-e947-11d3-bfe5-0010830122f0",  # NurbsCurve
    "4ed7d4e0-e947-11d3-bfe5-0010830122f0",  # PolyCurve
    "cf33be2a-09b4-11d4-bffb-0010830122f0",  # ArcCurve
    "c3101a1d-f157-11d3-bfe7-0010830122f0",  # Point
}


def library() -> Any:
    """Return the library for Rhino's geometry.

    Raises:
        Problem: it is not installed.
    """
    try:
        import rhino3dm
    except ImportError as error:
        text = "Rhino's geometry needs a package: pip install 'simulearn[rhino]'"
        raise Problem(501, "package-missing", text, "rhino3dm") from error
    return rhino3dm


def decoded(fields: Any, place: str) -> Any:
    """Return the object of an archive.

    Args:
        fields: version, archive3dm, opennurbs and data, as Rhino and rhino3dm write them.
        place: what it is, for messages.

    Raises:
        InputError: the archive is damaged, or holds something else than a curve or a point.
        Problem: the library is not installed.
    """
    rhino = library()
    if not isinstance(fields, Mapping) or not isinstance(fields.get("data"), str):
        raise InputError(f"{place} is no geometry of Rhino: it has no data", "geometry", place)
    try:
        numbers = {key: int(fields[key]) for key in ("version", "archive3dm", "opennurbs")}
        data = base64.b64decode(fields["data"], validate=True)
        if numbers["archive3dm"] < OLDEST or not -(2**31) <= numbers["opennurbs"] < 2**31:
            raise ValueError
        clean = _checked(data, place)
        text = base64.b64encode(clean).decode()
        found = rhino.CommonObject.Decode({**numbers, "data": text})
    except (KeyError, ValueError, TypeError, binascii.Error, struct.error, RuntimeError) as error:
        if isinstance(error, InputError):
            raise
        raise _damaged(place) from error
    if found is None:
        raise _damaged(place)
    return found


def encoded(geometry: Any) -> str:
    """Return an object of the library as JSON."""
    return json.dumps(geometry.Encode())


def _damaged(place: str) -> InputError:
    return InputError(f"{place} is a damaged archive of Rhino", "geometry", place)


def _checked(data: bytes, place: str) -> bytes:
    """Return the archive of an object without what hangs on it.

    Raises:
        InputError: the object is of a class that is not read.
        ValueError: a length or a checksum is wrong.
    """
    body, end = _chunk(data, 0, OBJECT)
    clean = _object(body, place, DEEPEST)
    if any(data[end:]):  # zeros may fill it up
        raise ValueError
    return HEAD.pack(OBJECT, len(clean)) + clean


def _object(body: bytes, place: str, depth: int) -> bytes:
    """Return the contents of an object's chunk: its class, its data, the end."""
    if depth == 0:
        raise ValueError
    name, at = _chunk(body, 0, CLASS)
    if len(name) != 20 or not _holds(name, name[-4:]):
        raise ValueError
    if str(UUID(bytes_le=name[:16])) not in READ:
        text = f"{place} is neither a curve nor a point"
        raise InputError(text, "geometry", place)
    data, _ = _chunk(body, at, DATA)
    if not _holds(data, data[-4:]):
        data = _segments(data, place, depth)
    return body[:at] + HEAD.pack(DATA, len(data)) + data + HEAD.pack(END, 0)


def _segments(data: bytes, place: str, depth: int) -> bytes:
    """Return data that ends with objects, which its checksum leaves out."""
    code = OBJECT.to_bytes(4, "little")
    start = data.find(code)
    while start >= 0 and not _holds(data[:start] + data[-4:], data[-4:]):
        start = data.find(code, start + 1)
    if start < 0:
        raise ValueError
    clean = data[:start]
    while start < len(data) - 4:
        body, start = _chunk(data, start, OBJECT)
        inner = _object(body, place, depth - 1)
        clean += HEAD.pack(OBJECT, len(inner)) + inner
    return clean + data[-4:]


def _chunk(data: bytes, at: int, code: int) -> tuple[bytes, int]:
    """Return what a chunk of this code holds, and where it ends."""
    found, length = HEAD.unpack_from(data, at)
    begin = at + HEAD.size
    if found != code or not 4 <= length <= len(data) - begin:
        raise ValueError
    return data[begin : begin + length], begin + length


def _holds(body: bytes, checksum: bytes) -> bool:
    return crc32(body[:-4]) == CHECKSUM.unpack(checksum)[0]

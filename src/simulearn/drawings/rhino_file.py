"""A .3dm file as plain values, read in a process of its own; see `rhino_process`."""

import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from simulearn.errors import InputError
from simulearn.extras import require

TIMEOUT = 30.0  # s; a file as large as is taken is read in far less

_BEGINNING = b"3D Geometry File Format "  # then the version, eight letters

# Kinds of chunks: the table of objects, one object in it; in short ones the length is the value.
_OBJECTS, _OBJECT, _SHORT = 0x10000013, 0x20008070, 0x80000000


def contents(data: bytes) -> dict[str, Any]:
    """Return what a file holds, as `rhino_process` writes it.

    `lost` is added: how many objects rhino3dm passed over without a word, as they are damaged.

    Args:
        data: the file.

    Raises:
        InputError: it is no .3dm file, damaged or too large, or rhino3dm is missing.
    """
    written = by_process(data, Path(__file__).with_name("rhino_process.py"))
    found: dict[str, Any] = {} if written is None else json.loads(written)
    if "too_large" in found:
        raise InputError(
            "the drawing has too many objects or points; keep only the lines of the grid",
            "too-large",
        )
    count = len(found.get("objects", ()))
    lost = max(_objects(data) - count, 0)
    if not found or lost > count == 0:
        raise damaged()
    return found | {"lost": lost}


def damaged() -> InputError:
    """Return the error of a file that cannot be read."""
    text = "the Rhino file is damaged; open it in Rhino, run Audit and save it anew"
    return InputError(text, "3dm-broken")


def by_process(data: bytes, program: Path) -> bytes | None:
    """Return what a program writes of a file; None where it crashes or writes nothing.

    Args:
        data: the file.
        program: is called with the paths of the file and of what it shall write.

    Raises:
        InputError: it is no .3dm file, the program does not end, or rhino3dm is missing.
    """
    require("Rhino files need", "rhino3dm")
    if not data.startswith(_BEGINNING):
        raise InputError("this is no Rhino file: it does not begin as a .3dm file", "3dm-broken")
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder, "drawing.3dm"), Path(folder, "contents")
        source.write_bytes(data)
        _run(program, source, target)
        return target.read_bytes() if target.exists() else None


def _objects(data: bytes) -> int:
    """Return how many objects a file holds; those that come after a broken chunk are not seen."""
    version = data[len(_BEGINNING) : 32].strip()
    size = 8 if version.isdigit() and int(version) >= 50 else 4  # bytes of a length
    for kind, start, end in _chunks(data, 32, len(data), size):
        if kind == _OBJECTS:
            return sum(1 for kind, _, _ in _chunks(data, start, end, size) if kind == _OBJECT)
    return 0


def _chunks(data: bytes, start: int, end: int, size: int) -> Iterator[tuple[int, int, int]]:
    """Return the chunks that follow each other in a file: kind, and where its contents are."""
    while start + 4 + size <= end:
        kind = int.from_bytes(data[start : start + 4], "little")
        length = int.from_bytes(data[start + 4 : start + 4 + size], "little")
        start += 4 + size
        yield kind, start, start + length
        start += 0 if kind & _SHORT else length


def _run(program: Path, source: Path, target: Path) -> None:
    """Run the process; where it crashes, there is no target."""
    try:
        subprocess.run(
            # -P: modules that lie beside the program must not hide those of the library.
            [sys.executable, "-P", str(program), str(source), str(target)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            timeout=TIMEOUT,
            check=False,
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
        )
    except subprocess.TimeoutExpired:
        raise InputError(
            f"the Rhino file is damaged or too large: it could not be read in {TIMEOUT:.0f} s",
            "3dm-broken",
        ) from None

"""A .3dm file as plain values, read in a process of its own; see `rhino_process`."""

import json
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from simulearn.drawings import collecting
from simulearn.errors import InputError

TIMEOUT = 30.0  # s; a file as large as is taken is read in far less

_BEGINNING = b"3D Geometry File Format "


def contents(data: bytes) -> dict[str, Any]:
    """Return what a file holds, as `rhino_process` writes it.

    Args:
        data: the file.

    Raises:
        InputError: it is no .3dm file, damaged or too large, or rhino3dm is missing.
    """
    if find_spec("rhino3dm") is None:
        raise InputError(
            "Rhino files need a package: pip install 'simulearn[rhino]'", "package-missing"
        )
    if not data.startswith(_BEGINNING):
        raise InputError("this is no Rhino file: it does not begin as a .3dm file", "3dm-broken")
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder, "drawing.3dm"), Path(folder, "contents.json")
        source.write_bytes(data)
        _run(source, target)
        if not target.exists():
            raise InputError(
                "the Rhino file is damaged; open it in Rhino, run Audit and save it anew",
                "3dm-broken",
            )
        found: dict[str, Any] = json.loads(target.read_text(encoding="utf-8"))
    if "too_large" in found:
        raise InputError(
            f"the drawing has more than {collecting.MAX_SEGMENTS:,} line segments; keep only the"
            " lines of the grid",
            "too-large",
        )
    return found


def _run(source: Path, target: Path) -> None:
    """Run the process; where it crashes or does not end, there is no target."""
    program = Path(__file__).with_name("rhino_process.py")
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
            f"the Rhino file is damaged: it could not be read in {TIMEOUT:.0f} s", "3dm-broken"
        ) from None

"""Results as files: each format of `outputs`, written in a temporary folder and read back."""

import threading
import zipfile
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory

from simulearn import outputs
from simulearn.errors import Cancel, InputError
from simulearn.simulate import Result

# Matplotlib is made for one thread; others wait for their turn.
_drawing = threading.Lock()
SEVERAL = (".pvd",)  # formats of more than one file
NAMED = (*SEVERAL, ".html")  # formats that say their own name, which then is what the person wants
TYPES = {
    ".json": "application/json",
    ".png": "image/png",
    ".pdf": "application/pdf",
    ".svg": "image/svg+xml",
    ".csv": "text/csv",
    ".gif": "image/gif",
    ".html": "text/html; charset=utf-8",
    ".mp4": "video/mp4",
    ".webm": "video/webm",
    ".glb": "model/gltf-binary",
    ".morph.glb": "model/gltf-binary",
    ".3dm": "model/vnd.3dm",
    ".stl": "model/stl",
    ".obj": "model/obj",
    ".zip": "application/zip",
}


def check_format(ending: str) -> None:
    """Raise InputError where no result can be written in a format here."""
    if ending not in outputs.WRITERS:
        text = f"format is {ending[:20]!r}; it is one of {' '.join(outputs.WRITERS)}"
        raise InputError(text, "format-unknown", "format")
    with TemporaryDirectory() as folder:
        try:
            outputs.check([Path(folder) / f"result{ending}"])
        except InputError as error:
            reason = str(error).replace(f"{Path(folder) / f'result{ending}'}: ", f"{ending} ")
            raise InputError(reason, "format-missing", "format") from error


def exported(
    result: Result, ending: str, stem: str, cancel: Cancel | None = None
) -> tuple[bytes, str, str]:
    """Return a file of a result: its contents, name and media type.

    Several files become one ZIP archive.

    Args:
        result: what to write.
        ending: one of `outputs.WRITERS`.
        stem: name of the file without its ending, safe on every system.
        cancel: stops an animation, which takes by far the longest.

    Raises:
        InputError: the disk is full.
        CancelledError: the token was set.
    """
    with TemporaryDirectory(prefix="simulearn-") as folder:
        several = ending in SEVERAL
        path = Path(folder) / f"{stem if ending in NAMED else 'result'}{ending}"
        with _drawing:
            outputs.write(result, path, cancel)
        data = _zipped(Path(folder)) if several else path.read_bytes()
    ending = ".zip" if several else ending
    return data, f"{stem}{ending}", TYPES.get(ending, "application/octet-stream")


def _zipped(folder: Path) -> bytes:
    """Return all files of a folder as an archive."""
    content = BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in sorted(folder.rglob("*")):
            if file.is_file():
                archive.write(file, file.relative_to(folder).as_posix())
    return content.getvalue()

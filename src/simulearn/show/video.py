"""Films by ffmpeg, a program that is used where it is installed: MP4 (H.264) and WebM (VP9)."""

import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterable
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.files import replacing

Pixels = NDArray[np.uint8]

RATE = 25  # pictures a second
# The options of each format; every player knows 4:2:0, and the index at the front of an MP4 lets
# it start before all of it is there.
FORMATS = {
    ".mp4": "-f mp4 -c:v libx264 -preset fast -crf 18 -movflags +faststart",
    ".webm": "-f webm -c:v libvpx-vp9 -crf 24 -b:v 0 -deadline realtime -cpu-used 5 -row-mt 1",
}
INPUT = "-loglevel error -y -f rawvideo -pix_fmt rgb24"
COLOURS = (
    "-vf scale=out_color_matrix=bt709:out_range=tv,format=yuv420p "
    "-colorspace bt709 -color_primaries bt709 -color_trc bt709 -color_range tv"
)
INSTALL = (
    "films need the program ffmpeg: apt install ffmpeg, brew install ffmpeg or "
    "winget install ffmpeg; or pip install imageio-ffmpeg"
)


def ffmpeg() -> str:
    """Return the path of ffmpeg: what IMAGEIO_FFMPEG_EXE names, on PATH, or of imageio-ffmpeg.

    Raises:
        InputError: it is not installed.
    """
    for name in (os.environ.get("IMAGEIO_FFMPEG_EXE"), "ffmpeg"):
        if name and (path := shutil.which(name)):
            return path
    if find_spec("imageio_ffmpeg") is not None:
        package: Any = __import__("imageio_ffmpeg")
        try:
            return str(package.get_ffmpeg_exe())
        except RuntimeError:
            pass
    raise InputError(INSTALL, "package-missing")


def write_video(pictures: Iterable[Pixels], path: Path | str, comment: str = "") -> None:
    """Write a film, `RATE` pictures a second, as .mp4 or .webm by the ending of the path.

    Args:
        pictures: (h, w, 3) each, all of one size.
        path: the file.
        comment: what the file says about itself.

    Raises:
        InputError: ffmpeg is not installed or cannot write the file.
    """
    program = ffmpeg()
    ending = Path(path).suffix.lower()
    with replacing(path) as temporary, tempfile.TemporaryFile() as log:
        process: subprocess.Popen[bytes] | None = None
        try:
            for picture in pictures:
                pixels = _even(picture)
                if process is None:
                    height, width = pixels.shape[:2]
                    command = [
                        program,
                        *INPUT.split(),
                        *("-s", f"{width}x{height}", "-r", f"{RATE}", "-i", "-"),
                        *COLOURS.split(),
                        *FORMATS[ending].split(),
                        *("-metadata", f"comment={comment}", str(temporary)),
                    ]
                    process = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=log)
                assert process.stdin is not None
                process.stdin.write(pixels.tobytes())
        except OSError:
            pass  # ffmpeg has stopped, and says why
        except BaseException:
            if process is not None:
                process.kill()
                process.communicate()
            raise
        if process is None:
            raise ValueError("there are no pictures")
        process.communicate()
        if process.returncode != 0:
            log.seek(0)
            lines = log.read().decode("utf-8", "replace").strip().splitlines()
            reason = lines[0] if lines else f"it stopped with {process.returncode}"
            raise InputError(f"{path}: ffmpeg cannot write it ({reason})")


def _even(picture: Pixels) -> Pixels:
    """Return a picture with an even number of rows and columns, as 4:2:0 needs them."""
    height, width = picture.shape[:2]
    return np.pad(picture, ((0, height % 2), (0, width % 2), (0, 0)), mode="edge")

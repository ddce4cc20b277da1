"""A photo as it came from the camera: its pixels upright, and what its file says of the lens.

Telephones write the focal length that a lens would have on 35 mm film. It fixes how far away the
camera was where the sheet alone does not, as in a photo from straight above.
"""

import warnings
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError

FILM_DIAGONAL = 43.27  # mm, of a frame of 36 x 24 mm
FOCAL_IN_35_MM = 0xA405  # tags of EXIF 2.32 (CIPA DC-008)
EXIF_BLOCK, PIXELS_ACROSS, PIXELS_DOWN = 0x8769, 0xA002, 0xA003
SHORTEST = 500  # pixels of the shorter side
LONGEST = 4600  # pixels of the longer side; more are averaged, since they carry no more
MOST_PIXELS = 178_000_000  # Pillow opens no more
SIXTEEN = ("I", "I;16", "I;16B", "I;16L", "I;16N")  # modes that hold a grey of 16 bits


@dataclass(frozen=True, eq=False)
class Photo:
    """A photo.

    Attributes:
        name: of its file.
        pixels: (H, W, 3) red, green and blue of 0 to 255.
        focal: focal length, pixels; None where the file does not say it.
        cropped: whether the file says that it once had another shape.
        shrunk: how many pixels of the file, in a row, each of these pixels is the mean of.
    """

    name: str
    pixels: NDArray[np.uint8]
    focal: float | None
    cropped: bool
    shrunk: float = 1.0

    @property
    def size(self) -> tuple[int, int]:
        """Width and height, pixels."""
        return self.pixels.shape[1], self.pixels.shape[0]

    @cached_property
    def light(self) -> NDArray[np.float32]:
        """(H, W, 3) amounts of light of 0 to 1: sRGB without its tone curve (IEC 61966-2-1)."""
        level = np.arange(256) / 255
        curve = np.where(level <= 0.04045, level / 12.92, ((level + 0.055) / 1.055) ** 2.4)
        return curve.astype(np.float32)[self.pixels]


def read_photo(path: Path | str) -> Photo:
    """Return the photo in a file, turned upright.

    Raises:
        InputError: there is no such file, it is no picture, or it is too small or too large.
    """
    from PIL import Image, ImageOps

    path = Path(path)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            image = Image.open(path)
        with image:
            if image.width * image.height > MOST_PIXELS:
                raise Image.DecompressionBombError
            exif = image.getexif()
            upright = _coloured(ImageOps.exif_transpose(image))
    except FileNotFoundError as error:
        raise InputError(f"{path}: there is no such file") from error
    except Image.DecompressionBombError as error:
        many = f"has more than {MOST_PIXELS / 1e6:g} million pixels; save a smaller copy"
        raise _wrong(path, many) from error
    except Image.UnidentifiedImageError as error:
        hint = "a photo is a JPEG or PNG file"
        if path.suffix.lower() in (".heic", ".heif", ".dng"):
            hint = (
                f"of a {path.suffix} file save a copy as JPEG, which telephones do when they share"
            )
        raise _wrong(path, f"is not a picture that can be read; {hint}") from error
    except (OSError, SyntaxError, ValueError) as error:  # as of a file that ends in its middle
        if isinstance(error, InputError):
            raise
        reason = getattr(error, "strerror", None) or error
        raise _wrong(path, f"cannot be read as a picture ({reason})") from error
    size = upright.size
    if min(size) < SHORTEST:
        raise InputError(
            f"{path}: has {size[0]} x {size[1]} pixels; the shorter side needs {SHORTEST}: "
            "take the photo as the camera gave it, and not a preview of it",
            "photo-small",
            str(path),
        )
    focal, cropped = _lens(exif, size)
    shrunk = max(1.0, max(size) / LONGEST)
    if shrunk > 1:
        upright = upright.resize(
            (round(size[0] / shrunk), round(size[1] / shrunk)), Image.Resampling.BOX
        )
    focal = focal / shrunk if focal else None
    return Photo(str(path), np.asarray(upright), focal, cropped, shrunk)


def _coloured(image: Any) -> Any:
    """Return a picture in red, green and blue of 8 bits."""
    from PIL import Image

    if image.mode in SIXTEEN:
        grey = np.asarray(image).astype(np.float64)
        image = Image.fromarray((grey / 257).clip(0, 255).astype(np.uint8))
    elif image.mode == "F":
        raise ValueError("its pixels are no whole numbers; save a copy as JPEG")
    return image.convert("RGB")


def _wrong(path: Path, text: str) -> InputError:
    return InputError(f"{path}: {text}", "photo-file", str(path))


def _lens(exif: Any, size: tuple[int, int]) -> tuple[float | None, bool]:
    """Return the focal length in pixels, if it is known, and whether the photo was cropped."""
    block = exif.get_ifd(EXIF_BLOCK)
    try:
        film = float(block.get(FOCAL_IN_35_MM, 0))
        before = sorted((float(block[PIXELS_ACROSS]), float(block[PIXELS_DOWN])))
    except (KeyError, TypeError, ValueError, ZeroDivisionError):
        before = sorted(map(float, size))
        film = float(block.get(FOCAL_IN_35_MM, 0) or 0)
    after = sorted(size)
    cropped = before[0] > 0 and abs(after[1] / after[0] - before[1] / before[0]) > 0.02
    known = 8 <= film <= 300 and not cropped
    return (film / FILM_DIAGONAL * float(np.hypot(*size)) if known else None), cropped

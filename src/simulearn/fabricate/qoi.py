"""Pictures as QOI, the format of the previews that Prusa's printers show.

Written after the specification "The Quite OK Image Format", version 1.0 (qoiformat.org,
2022-01-05). A picture is mostly runs of one colour, so runs are found first, all at once; only the
first pixel of each is looked at one by one.
"""

from struct import pack

import numpy as np
from numpy.typing import NDArray

Pixel = tuple[int, ...]

INDEX, DIFFERENCE, LUMA, RUN, RGB, RGBA = 0x00, 0x40, 0x80, 0xC0, 0xFE, 0xFF
LONGEST = 62  # pixels, of a run
END = bytes(7) + b"\x01"


def encode(pixels: NDArray[np.uint8]) -> bytes:
    """Return a picture as a QOI file.

    Args:
        pixels: (height, width, 4) red, green, blue, opacity.
    """
    height, width, _ = pixels.shape
    flat = pixels.reshape(-1, 4)
    first = np.append(True, (flat[1:] != flat[:-1]).any(axis=1)).nonzero()[0]
    lengths = np.diff(np.append(first, len(flat))).tolist()
    out = bytearray(b"qoif" + pack(">IIBB", width, height, 4, 0))
    seen: list[Pixel] = [(0, 0, 0, 0)] * 64
    before: Pixel = (0, 0, 0, 255)
    for colour, length in zip(flat[first].tolist(), lengths, strict=True):
        pixel: Pixel = tuple(colour)
        if pixel == before:  # only the very first one may be; it then belongs to the run
            length += 1
        else:
            r, g, b, a = pixel
            place = (r * 3 + g * 5 + b * 7 + a * 11) % 64
            out += bytes([INDEX | place]) if seen[place] == pixel else _step(before, pixel)
            seen[place] = before = pixel
        whole, rest = divmod(length - 1, LONGEST)
        out += bytes([RUN | (LONGEST - 1)]) * whole
        if rest:
            out.append(RUN | (rest - 1))
    return bytes(out) + END


def _step(before: Pixel, pixel: Pixel) -> bytes:
    """Return what leads from one pixel to another, as short as it can be said."""
    r, g, b, a = pixel
    if a != before[3]:
        return bytes((RGBA, r, g, b, a))
    # Differences of bytes wrap around: -128 to 127.
    dr, dg, db = ((p - q + 128) % 256 - 128 for p, q in zip(pixel[:3], before[:3], strict=True))
    if all(-2 <= d <= 1 for d in (dr, dg, db)):
        return bytes([DIFFERENCE | (dr + 2) << 4 | (dg + 2) << 2 | (db + 2)])
    if -32 <= dg <= 31 and -8 <= dr - dg <= 7 and -8 <= db - dg <= 7:
        return bytes((LUMA | (dg + 32), (dr - dg + 8) << 4 | (db - dg + 8)))
    return bytes((RGB, r, g, b))

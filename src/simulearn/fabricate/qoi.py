"""Pictures as QOI, the format of the previews that Prusa's printers show.

Written after the specification "The Quite OK Image Format", version 1.0 (qoiformat.org,
2022-01-05). A picture is mostly runs of one colour, so runs are found first, all at once; only the
first pixel of each is looked at one by one.
"""

from struct import pack

import numpy as np
from numpy.typing import NDArray

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
    seen = [(0, 0, 0, 0)] * 64
    before = (0, 0, 0, 255)
    for (r, g, b, a), length in zip(flat[first].tolist(), lengths, strict=True):
        pixel = (r, g, b, a)
        place = (r * 3 + g * 5 + b * 7 + a * 11) % 64
        dr, dg, db = (_signed(p - q) for p, q in zip(pixel[:3], before[:3], strict=True))
        if pixel == before:  # only the very first one, which then belongs to the run
            length += 1
        elif seen[place] == pixel:
            out.append(INDEX | place)
        elif a != before[3]:
            out += bytes((RGBA, r, g, b, a))
        elif all(-2 <= d <= 1 for d in (dr, dg, db)):
            out.append(DIFFERENCE | (dr + 2) << 4 | (dg + 2) << 2 | (db + 2))
        elif -32 <= dg <= 31 and -8 <= dr - dg <= 7 and -8 <= db - dg <= 7:
            out += bytes((LUMA | (dg + 32), (dr - dg + 8) << 4 | (db - dg + 8)))
        else:
            out += bytes((RGB, r, g, b))
        seen[place] = before = pixel
        whole, rest = divmod(length - 1, LONGEST)
        out += bytes([RUN | (LONGEST - 1)]) * whole
        if rest:
            out.append(RUN | (rest - 1))
    return bytes(out) + END


def _signed(difference: int) -> int:
    """Return a difference of two bytes as it wraps around, -128 to 127."""
    return (difference + 128) % 256 - 128

"""A result read back from the page that `write_html` made of it."""

import re
import zlib
from base64 import b64decode

import numpy as np
from numpy.typing import NDArray

from simulearn.drawings.pages import page_contents
from simulearn.errors import InputError
from simulearn.files import parse_json
from simulearn.interop import frames
from simulearn.simulate import Result, result_from_dict
from simulearn.simulate.resultfile import SCHEMA as RESULT

MOST_BYTES = 2**28  # of the unpacked frames
FRAMES = re.compile(rb'<script type="text/plain" id="simulearn-frames">([^<]*)</script>')


def result_of_html(data: bytes, *, paths: bool = False) -> Result:
    """Return the result that a page shows; corners to 0.0005 mm, without stresses and solid.

    Args:
        data: contents of the file.
        paths: whether the grid's material may be the path of a file; if not, it must be a name.

    Raises:
        InputError: the file is not a page made by SimuLearn, or is damaged.
    """
    text, packed = page_contents(data), FRAMES.search(data)
    if text is None or packed is None:
        raise InputError("is not a page with a result of SimuLearn", "html-other")
    try:
        contents = parse_json(text)
        arrays = _arrays(packed[1])
    except InputError:
        raise
    except (ValueError, zlib.error) as error:
        raise InputError("the page is damaged: its frames cannot be read", "html") from error
    if not isinstance(contents, dict):
        raise InputError("the page is damaged: its result is not an object", "html")
    return result_from_dict({**contents, **arrays, "schema": RESULT}, paths=paths)


def _arrays(packed: bytes) -> dict[str, NDArray[np.float32]]:
    """Return the corners of joints and beams from the packed message of frames."""
    unpacking = zlib.decompressobj(16 + zlib.MAX_WBITS)  # gzip
    message = unpacking.decompress(b64decode(packed, validate=True), MOST_BYTES)
    if unpacking.unconsumed_tail:
        raise InputError(f"its frames take more than {MOST_BYTES >> 20} MiB", "too-large")
    (entry,) = frames.from_bytes(message)
    return {name: entry[name] for name in ("joints", "beams") if name in entry}

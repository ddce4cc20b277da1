"""A result as one HTML file that plays in any browser, without a server and without a network.

The page is the studio's view of the shape, with the plan and what qualifies the answer beside it.
Its program, the libraries and the frames are compressed in the page, which its own security policy
forbids to load or run anything else. The design can be read back from the page.
"""

import gzip
import json
import struct
from base64 import b64encode
from collections.abc import Mapping
from functools import cache
from hashlib import sha256
from html import escape
from pathlib import Path
from string import Template
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from simulearn import __version__
from simulearn.drawings.pages import SCHEMA as PAGE
from simulearn.files import replacing
from simulearn.grid import grid_to_dict
from simulearn.interop import frames
from simulearn.interop.bundle import Bundle
from simulearn.interop.libraries import libraries
from simulearn.interop.plan import plan
from simulearn.interop.png import png
from simulearn.show import deformed
from simulearn.show.deformed import dimensions
from simulearn.simulate import Result
from simulearn.simulate.resultfile import qualities

OWN = Path(__file__).parent / "page"
STUDIO = Path(__file__).parents[1] / "studio" / "page"  # read as data, not imported
STYLES = (STUDIO / "style" / "tokens.css", STUDIO / "style" / "shape.css", OWN / "page.css")
STEP = 2.0**-10  # mm (and MPa): what the frames are rounded to, so that they compress


def write_html(result: Result, path: Path | str) -> None:
    """Write a result as a page that plays the morph offline; its title is the file's name.

    Args:
        result: what to write.
        path: the file.

    Raises:
        InputError: the package with three.js is not installed, or the file cannot be written.
    """
    text = page(result, Path(path).stem)
    with replacing(path) as temporary:
        temporary.write_bytes(text.encode("utf-8"))


def page(result: Result, title: str = "Shape") -> str:
    """Return the page of a result, the same for the same result and title.

    Args:
        result: what to show.
        title: of the page, and of the design that can be downloaded from it.

    Raises:
        InputError: the package with three.js is not installed.
    """
    contents = {
        "schema": PAGE,
        "grid": grid_to_dict(result.grid),
        "engine": result.engine,
        "seconds": round(float(result.seconds), 3),
        **qualities(result),
    }
    return filled(
        "main.js",
        title,
        contents,
        _rounded(frames.to_bytes([result.grid], [result])),
        deformed(result),
        f"The shape after creep: {dimensions(result)}",
        plan(result.grid),
    )


def filled(
    main: str,
    title: str,
    contents: Mapping[str, Any],
    data: bytes,
    picture: Figure,
    words: str,
    plan: str = "",
) -> str:
    """Return a page that runs without a server and without a network.

    Args:
        main: its program, a module in the folder `page`.
        title: of the page.
        contents: what the program reads as JSON.
        data: what it unpacks.
        picture: what is seen where nothing can move.
        words: that say the same as the picture.
        plan: a drawing (SVG) beside it.

    Raises:
        InputError: the package with three.js is not installed.
    """
    start, program, digest = _program(main)
    style = "\n".join(path.read_text("utf-8") for path in STYLES)
    pixels, width, height = png(picture)
    policy = {
        "default-src": "'none'",
        "script-src": f"'sha256-{_digest(start)}' 'sha256-{digest}'",
        "style-src": f"'sha256-{_digest(style)}'",
        "img-src": "data:",
        "base-uri": "'none'",
        "form-action": "'none'",
    }
    return Template((OWN / "index.html").read_text("utf-8")).substitute(
        policy="; ".join(f"{key} {value}" for key, value in policy.items()),
        version=__version__,
        title=escape(title),
        icon=_data("image/svg+xml", (STUDIO / "icon.svg").read_bytes()),
        style=style,
        picture=_data("image/png", pixels),
        width=width,
        height=height,
        words=escape(words),
        plan=plan,
        # In a script element only "<" could end it; in JSON it can be written so.
        result=json.dumps(contents, allow_nan=False).replace("<", "\\u003c"),
        frames=_packed(data),
        program=program,
        start=start,
    )


@cache
def _program(main: str) -> tuple[str, str, str]:
    """Return the script that starts the page, the packed program, and the program's digest."""
    found = libraries()
    files = {f"/libraries/{name}": path for name, path in found.items()}
    instead = {STUDIO / "text" / "text.js": OWN / "text.js"}
    start = Bundle().script(OWN / "start.js")
    program = Bundle({"/page/": STUDIO}, files, instead).script(OWN / main)
    return start, _packed(program.encode("utf-8")), _digest(program)


def _rounded(message: bytes) -> bytes:
    """Return a message of frames whose numbers are multiples of STEP."""
    (size,) = struct.unpack_from("<I", message, 4)
    head = 8 + size
    numbers = np.frombuffer(message, "<f4", offset=head)
    return message[:head] + (np.round(numbers / STEP) * STEP + 0.0).astype("<f4").tobytes()


def _packed(data: bytes) -> str:
    return b64encode(gzip.compress(data, 9, mtime=0)).decode("ascii")


def _data(kind: str, content: bytes) -> str:
    return f"data:{kind};base64,{b64encode(content).decode('ascii')}"


def _digest(text: str) -> str:
    return b64encode(sha256(text.encode("utf-8")).digest()).decode("ascii")

"""The small pictures in a print file: the print from above, coloured by role and half.

One layer of each half is drawn, the top one over the bottom one, three times as large as it will
be, and then made smaller, which smooths it. A beam's actuator lies in one half only,
so both halves show: the active beads of the bottom half are drawn above what is passive in the
top half. The smaller a picture, the wider are its beams and the fewer of the shells are left.
"""

from base64 import b64encode
from collections.abc import Iterator
from io import BytesIO

import numpy as np
from PIL import Image, ImageDraw

from simulearn.fabricate import qoi
from simulearn.fabricate.toolpath import ACTIVE, JOINT, PASSIVE, SHELL, Layer, Toolpath
from simulearn.palette import BEADS, BOTTOM, TOP

Size = tuple[int, int]

PNG: tuple[Size, ...] = ((32, 32), (48, 48), (300, 300))
# What each firmware's own display asks for; Bambu's takes its pictures from the package.
PRUSA_QOI: tuple[Size, ...] = ((16, 16), (313, 173), (440, 240))
LINE = 78  # characters of a line of base64
FINE = 3  # pixels that are drawn for each that is kept, along each side
SMALL = 64  # pixels; below, beams are drawn as bare lines of at least THICK pixels
THICK = 2.4
MARGIN = 0.04
CLOSED = 1.5  # of a bead's width: what closes rows to an area
DRAWN = (PASSIVE, JOINT, ACTIVE, SHELL)  # from below upwards


def thumbnails(path: Toolpath, firmware: str) -> Iterator[str]:
    """Yield the comments that hold the small pictures of a print.

    Each picture stands between two lines that name its size and the number of its letters, as
    PrusaSlicer writes it and all readers of print files expect it.
    """
    if firmware == "bambu":
        return
    both = [(size, "") for size in PNG]
    if firmware == "prusa":
        both += [(size, "_QOI") for size in PRUSA_QOI]
    for size, kind in both:
        picture = draw(path, size)
        data = png(picture) if not kind else qoi.encode(np.asarray(picture))
        text = b64encode(data).decode()
        yield ";"
        yield f"; thumbnail{kind} begin {size[0]}x{size[1]} {len(text)}"
        for begin in range(0, len(text), LINE):
            yield f"; {text[begin : begin + LINE]}"
        yield f"; thumbnail{kind} end"
        yield ";"


def png(picture: Image.Image) -> bytes:
    """Return a picture as a PNG file."""
    file = BytesIO()
    picture.save(file, "PNG", optimize=True)
    return file.getvalue()


def draw(path: Toolpath, size: Size) -> Image.Image:
    """Return the picture of a print on a transparent ground.

    Args:
        path: what to draw, without its skirt and brim.
        size: width and height, pixels.
    """
    middle = len(path.layers) // 2
    bottom, top = path.layers[middle - 1 if middle else 0], path.layers[-1]
    points = np.concatenate([b.points for q in (bottom, top) for b in q.beads if b.role in DRAWN])
    low, high = points.min(axis=0), points.max(axis=0)
    room = np.array(size) * FINE
    bare = min(size) < SMALL
    thick = THICK * FINE if bare else 0.0
    scale = float(min((room * (1 - 2 * MARGIN) - thick) / np.maximum(high - low, 1e-6)))
    offset = (room - scale * (low + high)) / 2
    canvas = Image.new("RGBA", (int(room[0]), int(room[1])), (0, 0, 0, 0))
    pen = ImageDraw.Draw(canvas)
    for role in DRAWN:
        if bare and role == SHELL:
            continue
        for layer, half in ((bottom, BOTTOM), (top, TOP)):
            colour = half if role == ACTIVE else BEADS[role]
            _strokes(pen, layer, role, colour, scale, offset, thick, room[1])
    return canvas.resize(size, Image.Resampling.BOX)


def _strokes(
    pen: ImageDraw.ImageDraw,
    layer: Layer,
    role: str,
    colour: str,
    scale: float,
    offset: np.ndarray,
    thick: float,
    height: float,
) -> None:
    """Draw the beads of a role; y, which points up on the bed, points down in a picture."""
    for bead in layer.beads:
        if bead.role != role:
            continue
        width = max(thick, CLOSED * float(np.median(bead.widths)) * scale)
        places = bead.points * scale + offset
        places[:, 1] = height - places[:, 1]
        joint = "curve" if thick or role == SHELL else None  # rows close without rounded turns
        pen.line(places.ravel().tolist(), colour, max(1, round(width)), joint)

"""Pictures of what moves, before a fixed view; and the GIF or film that they become."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import repeat
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from simulearn.errors import Cancel, stop_if
from simulearn.files import replacing
from simulearn.show import style
from simulearn.show.camera import Camera
from simulearn.show.deformed import EDGE, draw_ghost, draw_triad, painted
from simulearn.show.video import RATE, Pixels
from simulearn.simulate import Skin

Array = NDArray[np.float64]

PAUSE = 1400  # ms, at both ends
COLOURS = 192
RING = 9.0, 1.6  # points: radius and line of a ring


def pictures(
    moments: Iterable[tuple[Array, str, Array]],
    surface: Skin,
    rgb: Array,
    box: tuple[Array, Array],
    camera: Camera,
    width: float,
    dpi: int,
    finer: int,
    ghost: bool = False,
    cancel: Cancel | None = None,
) -> Iterator[Pixels]:
    """Yield a picture (h, w, 3) of each moment.

    Args:
        moments: vertices (V, 3) mm, the words beneath, and places (N, 3) mm with a ring around.
        surface: whose vertices these are.
        rgb: (Q, 3) colours of its quadrilaterals.
        box: lower left and upper right corner (2,) of what is seen, mm.
        camera: where the viewer is.
        width: of the pictures, inches.
        dpi: their pixels per inch.
        finer: rows and columns that are painted for one of the picture.
        ghost: whether the surface's own vertices are drawn beneath in light grey.
        cancel: stops it within a picture.
    """
    low, high = box
    fig = Figure(figsize=(width, width), dpi=dpi)
    canvas = FigureCanvasAgg(fig)
    ax, inch = style.footed(fig, low, high)
    if ghost:
        draw_ghost(ax, surface, camera)
    draw_triad(ax, high[0] - 0.2 * inch, low[1] - 0.1 * inch, 0.2 * inch, camera)
    words = style.words(fig, "")
    words.set_animated(True)
    style.legend(fig)
    style.ink(fig)
    canvas.draw()
    still = canvas.copy_from_bbox(fig.bbox)
    to_pixels = ax.transData.frozen()
    for vertices, text, rings in moments:
        stop_if(cancel)
        canvas.restore_region(still)
        words.set_text(text)
        fig.draw_artist(words)
        page = np.array(canvas.buffer_rgba())[..., :3]
        drawing = painted(vertices, surface, -1, camera, rgb)
        yield _paint(page, drawing, camera.see(rings)[:, :2], to_pixels, dpi, finer)


def vertices_at(surface: Skin, frame: float) -> Array:
    """Return the vertices (V, 3) mm of a skin in a frame, or on straight lines between two."""
    before = min(int(frame), len(surface.vertices) - 2)
    share = frame - before
    if share in (0.0, 1.0):
        return surface.vertices[before + int(share)]
    now: Array = (1 - share) * surface.vertices[before] + share * surface.vertices[before + 1]
    return now


def still_at_ends(pictures: Iterator[Pixels]) -> Iterator[Pixels]:
    """Yield pictures, the first and the last of them for a while."""
    count = PAUSE * RATE // 1000
    picture = next(pictures)
    yield from repeat(picture, count)
    for picture in pictures:
        yield picture
    yield from repeat(picture, count - 1)


def write_gif(
    pictures: Sequence[NDArray[np.uint8]], durations: Sequence[int], path: Path | str
) -> None:
    """Write pictures (h, w, 3), each shown for so many ms, as a GIF without end."""
    images = [Image.fromarray(pixels) for pixels in pictures]
    # One palette for all, or colours would flicker.
    palette = _palette(images[-1])
    frames = [p.quantize(palette=palette, dither=Image.Dither.NONE) for p in images]
    with replacing(path) as temporary:
        frames[0].save(
            temporary,
            format="GIF",
            save_all=True,
            append_images=frames[1:],
            duration=list(durations),
            loop=0,
            optimize=False,
        )


def _paint(
    page: Pixels, drawing: Any, rings: Array, to_pixels: Any, dpi: int, finer: int
) -> Pixels:
    """Return a page (h, w, 3) with a drawing of `painted` on it.

    Matplotlib takes ten times as long for so many small polygons, and looks the same.
    """
    faces, rgb, lines, order = drawing
    height = len(page)
    image = Image.fromarray(page.repeat(finer, axis=0).repeat(finer, axis=1))
    draw = ImageDraw.Draw(image)

    def places(points: NDArray[np.float64]) -> list[list[float]]:
        x, y = to_pixels.transform(points.reshape(-1, 2)).T
        pairs = np.stack([x, height - y], axis=1) * finer - 0.5
        return pairs.reshape(len(points), -1).tolist()

    shapes = places(faces) + places(lines)
    fill = [tuple(colour) for colour in (255 * rgb).round().astype(int).tolist()]
    ink = tuple(round(255 * x) for x in to_rgb(style.INK))
    edge = max(1, round(finer * dpi / 72 * EDGE))
    for k in order.tolist():
        if k < len(fill):
            draw.polygon(shapes[k], fill[k])
        else:
            draw.line(shapes[k], ink, edge)
    radius, line = (finer * dpi / 72 * points for points in RING)
    for x, y in places(rings) if len(rings) else []:
        box = (x - radius, y - radius, x + radius, y + radius)
        draw.ellipse(box, outline=style.COLLISION, width=max(1, round(line)))
    return np.asarray(image.reduce(finer))


def _palette(picture: Image.Image) -> Image.Image:
    """Return a palette for all pictures: the legend's colours exactly, then a picture's own."""
    tints = style.tint([-1, -0.75, -0.5, -0.25, 0, 0.25, 0.5, 0.75, 1])
    others = [to_rgb(c) for c in ("white", style.INK, style.JOINT, style.FIXED, style.GHOST)]
    exact = np.round(255 * np.concatenate([tints, others])).astype(int)
    own = np.array(picture.quantize(COLOURS - len(exact)).getpalette()).reshape(-1, 3)
    own = own[own.min(axis=1) < 246]  # a second white would turn paper grey
    palette = Image.new("P", (1, 1))
    palette.putpalette(np.concatenate([exact, own]).ravel().tolist())
    return palette

"""The grid morphing: a fixed view of all frames, still at both ends; an animated GIF or a film."""

from collections.abc import Iterator, Sequence
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
from simulearn.show.deformed import (
    EDGE,
    SPACING,
    draw_ghost,
    draw_triad,
    extent,
    painted,
    qualified,
)
from simulearn.show.video import FORMATS, RATE, Pixels, write_video
from simulearn.simulate import FRAMES, Result, skin

# Of a GIF, and of a film.
BETWEEN = 3, 5  # pictures from one frame to the next
FINER = 3, 2  # rows and columns that are painted for one of the picture
PICTURE, PAUSE = 60, 1400  # ms
COLOURS = 192
FILMED = 1.5  # pixels of a film for one of a GIF


def animate(
    result: Result,
    path: Path | str,
    camera: Camera = Camera(),
    width: float = 5.2,
    dpi: int = 120,
    cancel: Cancel | None = None,
) -> None:
    """Write the animation of a result, as .gif, .mp4 or .webm by the ending of the path.

    Args:
        result: what to show.
        path: the file.
        camera: where the viewer is.
        width: of the pictures, inches.
        dpi: their pixels per inch; a film has half as many again.
        cancel: stops it within a picture.

    Raises:
        InputError: the file cannot be written; for a film, ffmpeg is not installed.
        CancelledError: the token was set.
    """
    if Path(path).suffix.lower() in FORMATS:
        dpi = round(FILMED * dpi)
        film = _pictures(result, camera, width, dpi, BETWEEN[1], FINER[1], cancel)
        words = "; ".join([f"engine {result.engine}", *qualified(result)])
        write_video(_still_at_ends(film), path, words)
        return
    pictures = list(_pictures(result, camera, width, dpi, BETWEEN[0], FINER[0], cancel))
    write_gif(pictures, [PAUSE, *[PICTURE] * (len(pictures) - 2), PAUSE], path)


def _still_at_ends(pictures: Iterator[Pixels]) -> Iterator[Pixels]:
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


def _pictures(
    result: Result,
    camera: Camera,
    width: float,
    dpi: int,
    between: int,
    finer: int,
    cancel: Cancel | None,
) -> Iterator[Pixels]:
    """Yield the pictures, (h, w, 3) each, so many from one frame to the next."""
    surface = skin(result, SPACING)
    fig = Figure(figsize=(width, width), dpi=dpi)
    canvas = FigureCanvasAgg(fig)
    low, high = extent(surface, camera, list(range(FRAMES)))
    ax, inch = style.footed(fig, low, high)
    draw_ghost(ax, surface, camera)
    draw_triad(ax, high[0] - 0.2 * inch, low[1] - 0.1 * inch, 0.2 * inch, camera)
    words = style.words(fig, "")
    words.set_animated(True)
    style.legend(fig)
    style.ink(fig)
    canvas.draw()
    still = canvas.copy_from_bbox(fig.bbox)
    to_pixels = ax.transData.frozen()
    for moment in np.linspace(0, FRAMES - 1, between * (FRAMES - 1) + 1):
        stop_if(cancel)
        before = min(int(moment), FRAMES - 2)
        share = moment - before
        now = (1 - share) * surface.vertices[before] + share * surface.vertices[before + 1]
        canvas.restore_region(still)
        words.set_text(_stage(float(moment)))
        fig.draw_artist(words)
        page = np.array(canvas.buffer_rgba())[..., :3]
        drawing = painted(now, surface, result.grid.fixed, camera)
        yield _paint(page, drawing, to_pixels, dpi, finer)


def _paint(page: Pixels, drawing: Any, to_pixels: Any, dpi: int, finer: int) -> Pixels:
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


def _stage(moment: float) -> str:
    """Return what happens at a moment, counted in frames."""
    if moment <= FRAMES - 2:
        return f"residual stress released: {100 * moment / (FRAMES - 2):.0f} %"
    return "creep under gravity"

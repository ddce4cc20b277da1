"""The grid morphing, as an animated GIF: a fixed view of all frames, still at both ends."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image

from simulearn.errors import Cancel, stop_if
from simulearn.files import replacing
from simulearn.show import style
from simulearn.show.camera import Camera
from simulearn.show.deformed import SPACING, draw_ghost, draw_skin, draw_triad, extent
from simulearn.simulate import FRAMES, Result, skin

BETWEEN = 3  # pictures from one frame to the next
PICTURE, PAUSE = 60, 1400  # ms
COLOURS = 192


def animate(
    result: Result,
    path: Path | str,
    camera: Camera = Camera(),
    width: float = 5.2,
    dpi: int = 120,
    cancel: Cancel | None = None,
) -> None:
    """Write the animation of a result.

    Args:
        result: what to show.
        path: of the GIF.
        camera: where the viewer is.
        width: of the pictures, inches.
        dpi: their pixels per inch.
        cancel: stops it within a picture.

    Raises:
        CancelledError: the token was set.
    """
    pictures = _pictures(result, camera, width, dpi, cancel)
    write_gif(pictures, [PAUSE, *[PICTURE] * (len(pictures) - 2), PAUSE], path)


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
    result: Result, camera: Camera, width: float, dpi: int, cancel: Cancel | None
) -> list[NDArray[np.uint8]]:
    """Return the pictures, (h, w, 3) each."""
    surface = skin(result, SPACING)
    fig = Figure(figsize=(width, width), dpi=dpi)
    canvas = FigureCanvasAgg(fig)
    low, high = extent(surface, camera, list(range(FRAMES)))
    ax, inch = style.footed(fig, low, high)
    draw_ghost(ax, surface, camera)
    draw_triad(ax, high[0] - 0.2 * inch, low[1] - 0.1 * inch, 0.2 * inch, camera)
    words = style.words(fig, "")
    style.legend(fig)
    style.ink(fig)
    pictures = []
    for moment in np.linspace(0, FRAMES - 1, BETWEEN * (FRAMES - 1) + 1):
        stop_if(cancel)
        before = min(int(moment), FRAMES - 2)
        share = moment - before
        now = (1 - share) * surface.vertices[before] + share * surface.vertices[before + 1]
        drawn = draw_skin(ax, now, surface, result.grid.fixed, camera)
        words.set_text(_stage(float(moment)))
        canvas.draw()
        pictures.append(np.array(canvas.buffer_rgba())[..., :3])
        drawn.remove()
    return pictures


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

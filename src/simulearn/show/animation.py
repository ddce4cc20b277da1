"""The grid morphing: its frames, with others in between, seen by a camera that stands still."""

import io
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image

from simulearn.files import replacing
from simulearn.show import style
from simulearn.show.camera import Camera
from simulearn.show.deformed import draw_ghost, draw_skin, extent
from simulearn.simulate import Result, skin

Array = NDArray[np.float64]

BETWEEN = 3  # pictures from one frame to the next
WAIT = 700  # ms on the first and on the last picture
STEP = 60  # ms on each other


def save_animation(
    result: Result, path: Path | str, camera: Camera = Camera(), pixels: int = 560
) -> None:
    """Write the frames as an animated GIF.

    Args:
        result: what to show.
        path: the file.
        camera: where the viewer is.
        pixels: width of the picture.

    Raises:
        InputError: the file cannot be written.
    """
    surface = skin(result)
    frames = len(surface.vertices)
    low, high = extent(surface, camera, list(range(frames)))
    span, margin = high - low, 0.06 * float(max(high - low))
    width, caption = 5.0, 0.3
    height = width * (span[1] + 2 * margin) / (span[0] + 2 * margin) + caption
    pictures = []
    times = np.linspace(0, frames - 1, BETWEEN * (frames - 1) + 1)
    with style.paper():
        for time in times:
            k = min(int(time), frames - 2)
            vertices = surface.vertices[k] + (time - k) * (
                surface.vertices[k + 1] - surface.vertices[k]
            )
            fig = Figure(figsize=(width, height), dpi=pixels / width)
            ax = fig.add_axes((0, caption / height, 1, 1 - caption / height))
            draw_ghost(ax, surface, camera)
            draw_skin(ax, vertices, surface, result.grid.fixed, camera)
            style.bare(ax, low, high, margin)
            fig.text(0.5, 0.1 / height, _caption(time, frames), ha="center", fontsize=8)
            pictures.append(_picture(fig))
    # One palette for all, so that colours do not flicker.
    palette = pictures[-1].quantize(128)
    quantized = [p.quantize(palette=palette, dither=Image.Dither.NONE) for p in pictures]
    durations = [STEP] * len(quantized)
    durations[0] = durations[-1] = WAIT
    with replacing(path) as temporary:
        quantized[0].save(
            temporary,
            save_all=True,
            append_images=quantized[1:],
            duration=durations,
            loop=0,
            optimize=True,
        )


def _caption(time: float, frames: int) -> str:
    released = 100 * min(time / (frames - 2), 1.0)
    if time == 0:
        return "flat"
    return f"{released:.0f} % of the stress released" if time <= frames - 2 else "creep"


def _picture(fig: Figure) -> Image.Image:
    buffer = io.BytesIO()
    fig.savefig(buffer, format="png", facecolor="white")
    return Image.open(buffer).convert("RGB")

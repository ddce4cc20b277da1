"""The grid morphing: a fixed view of all frames, still at both ends; an animated GIF or a film."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from simulearn.errors import Cancel
from simulearn.show import style
from simulearn.show.camera import Camera
from simulearn.show.deformed import SPACING, extent, qualified
from simulearn.show.moving import PAUSE, pictures, still_at_ends, vertices_at, write_gif
from simulearn.show.video import FORMATS, Pixels, write_video
from simulearn.simulate import FRAMES, Result, skin

# Of a GIF, and of a film.
BETWEEN = 3, 5  # pictures from one frame to the next
FINER = 3, 2  # rows and columns that are painted for one of the picture
PICTURE = 60  # ms
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
        write_video(still_at_ends(film), path, words)
        return
    drawn = list(_pictures(result, camera, width, dpi, BETWEEN[0], FINER[0], cancel))
    write_gif(drawn, [PAUSE, *[PICTURE] * (len(drawn) - 2), PAUSE], path)


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
    rgb = style.colours(surface.ratio, surface.joint, result.grid.fixed)
    box = extent(surface, camera, list(range(FRAMES)))
    moments = (
        (vertices_at(surface, moment), _stage(moment), np.zeros((0, 3)))
        for moment in np.linspace(0, FRAMES - 1, between * (FRAMES - 1) + 1).tolist()
    )
    yield from pictures(
        moments, surface, rgb, box, camera, width, dpi, finer, ghost=True, cancel=cancel
    )


def _stage(moment: float) -> str:
    """Return what happens at a moment, counted in frames."""
    if moment <= FRAMES - 2:
        return f"residual stress released: {100 * moment / (FRAMES - 2):.0f} %"
    return "creep under gravity"

"""Parts put together: a picture of the end, a strip of moments, the whole sequence moving."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from simulearn.assembly import Assembled
from simulearn.errors import Cancel
from simulearn.rigid import Place
from simulearn.show import style
from simulearn.show.camera import Camera
from simulearn.show.deformed import draw_skin, draw_triad
from simulearn.show.moving import PAUSE, pictures, still_at_ends, write_gif
from simulearn.show.scene import Scene, scene, scene_of
from simulearn.show.video import FORMATS, RATE, Pixels, write_video
from simulearn.simulate import Result

Array = NDArray[np.float64]
Progress = Callable[[int, int], None]

CAMERA = Camera(azimuth=-62.0, elevation=18.0)
MOST_PICTURES = 160  # of a GIF
PICTURE = 0.06  # s, of a GIF, at least
FINER = 2  # rows and columns that are painted for one of an animation's
FILMED = 1.5  # pixels of a film for one of a GIF
RINGED = 0.5  # s before and after its worst moment that a collision has a ring
ROW = 4  # moments of a strip that stay in one row
MOMENTS = 40  # by which it is found how much of the picture the sequence needs


def assembly(
    parts: Sequence[tuple[Result, Place]],
    text: str,
    camera: Camera = CAMERA,
    width: float = 5.2,
    obstacles: Mapping[str, Any] | None = None,
) -> Figure:
    """Return the picture of parts put together.

    Args:
        parts: results and where they go.
        text: words beneath.
        camera: where the viewer is.
        width: of the figure, inches.
        obstacles: surfaces around the parts, in their places, by their names.
    """
    numbered = [(k, result, place) for k, (result, place) in enumerate(parts)]
    shown = scene(numbered, obstacles or {}, camera)
    return _picture(shown, text, [], np.zeros((0, 3)), width)


def assembled_picture(assembled: Assembled, camera: Camera = CAMERA, width: float = 5.2) -> Figure:
    """Return the picture of an assembly's end: obstacles, and rings where parts collide.

    Args:
        assembled: the assembly.
        camera: where the viewer is.
        width: of the figure, inches.
    """
    assembled.require()
    shown = scene_of(assembled, camera)
    places = [one.place for one in assembled.collisions]
    count = len(assembled.assembly.parts)
    text = f"{count} part" + "s" * (count > 1)
    if assembled.assembly.name:
        text = f"{assembled.assembly.name}: {text}"
    return _picture(shown, text, qualified(assembled), np.reshape(places, (-1, 3)), width)


def strip(
    assembled: Assembled, count: int | None = None, camera: Camera = CAMERA, width: float = 7.2
) -> Figure:
    """Return pictures of several moments side by side.

    Args:
        assembled: the assembly.
        count: of moments, evenly over the sequence; None: the start, and the end of each step.
        camera: where the viewer is.
        width: of the figure, inches.
    """
    assembled.require()
    times = _times(assembled, count)
    moments = [assembled.timeline.at(time) for time in times]
    shown = scene_of(assembled, camera, [moment[1:] for moment in moments])
    low, high = shown.box
    across, up = high - low
    gap = 0.06 * across
    columns = len(times)
    if columns > ROW:
        columns = min(columns, max(2, round(float(np.sqrt(3.2 * columns * up / across)))))
    rows = -(-len(times) // columns)
    line = 0.22 * across * columns / width  # mm, for the words beneath each
    size = np.array([columns * (across + gap) - gap, rows * (up + gap + line) - gap])
    fig = Figure(figsize=(width, width), dpi=style.DPI)
    ax, inch = style.footed(fig, np.zeros(2), size)
    for n, (time, (step, frames, shifts)) in enumerate(zip(times, moments, strict=True)):
        corner = np.array(
            [(n % columns) * (across + gap), size[1] - (n // columns) * (up + gap + line) - up]
        )
        own = ax.inset_axes((*corner, across, up), transform=ax.transData)
        own.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
        own.axis("off")
        draw_skin(own, shown.at(frames, shifts), shown.surface, -1, camera, shown.rgb)
        _rings(own, _at(assembled, time), camera)
        words = "start" if time == 0 else _stage(assembled, step)
        ax.text(
            corner[0] + across / 2, corner[1] - 0.1 * inch, words, fontsize=7, ha="center", va="top"
        )
    style.remark(fig, qualified(assembled))
    style.legend(fig)
    return style.ink(fig)


def animate_assembly(
    assembled: Assembled,
    path: Path | str,
    camera: Camera = CAMERA,
    width: float = 5.2,
    dpi: int = 120,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
) -> None:
    """Write the whole sequence as .gif, .mp4 or .webm by the ending of the path.

    Args:
        assembled: the assembly.
        path: the file.
        camera: where the viewer is.
        width: of the pictures, inches.
        dpi: their pixels per inch; a film has half as many again.
        progress: called with the pictures done and the pictures in all.
        cancel: stops it within a picture.

    Raises:
        InputError: the file cannot be written; for a film, ffmpeg is not installed.
        CancelledError: the token was set.
    """
    assembled.require()
    seconds = assembled.timeline.seconds
    film = Path(path).suffix.lower() in FORMATS
    each = 1 / RATE if film else max(PICTURE, seconds / MOST_PICTURES)
    count = max(2, round(seconds / each) + 1)
    times = np.linspace(0, seconds, count).tolist()
    moments = assembled.timeline
    some = np.linspace(0, len(moments.times) - 1, MOMENTS).astype(int)
    seen = [(moments.frames[m], moments.shifts[m]) for m in np.unique(some)]
    shown = scene_of(assembled, camera, seen)

    def sequence() -> Iterator[tuple[Array, str, Array]]:
        for n, time in enumerate(times):
            step, frames, shifts = moments.at(time)
            yield shown.at(frames, shifts), _stage(assembled, step), _at(assembled, time)
            if progress is not None:
                progress(n + 1, count)

    dots = round(FILMED * dpi) if film else dpi
    drawn = pictures(
        sequence(), shown.surface, shown.rgb, shown.box, camera, width, dots, FINER, cancel=cancel
    )
    if film:
        words = "; ".join([f"engine {assembled.engine}", *qualified(assembled)])
        write_video(still_at_ends(drawn), path, words)
        return
    images: list[Pixels] = list(drawn)
    write_gif(images, [PAUSE, *[round(1000 * each)] * (count - 2), PAUSE], path)


def qualified(assembled: Assembled) -> list[str]:
    """Return in few words what qualifies an assembly, for the line beneath its picture."""
    words = []
    missing = sorted(assembled.failures)
    if missing:
        words.append(f"without {', '.join(missing)}")
    count = len(assembled.collisions)
    if count:
        worst = assembled.collisions[0]
        words.append(f"{count} collision" + "s" * (count > 1) + f", the deepest {worst.words}")
    bounds = [one.bound_mm for _, _, one in assembled.present if one.bound_mm is not None]
    if bounds:
        words.append(f"error of a part below {max(bounds):.2f} mm (9 of 10)")
    return words


def _times(assembled: Assembled, count: int | None) -> list[float]:
    moments = assembled.timeline
    if count is not None:
        return np.linspace(0, moments.seconds, count).tolist()
    ends = [moments.times[moments.of_step(k)[-1]] for k in range(len(assembled.assembly.order))]
    return [0.0, *map(float, ends)]


def _stage(assembled: Assembled, step: int) -> str:
    """Return the words beneath a picture: which step it is."""
    steps = assembled.assembly.order
    return f"step {step + 1} of {len(steps)}: {steps[step].title}"


def _at(assembled: Assembled, time: float) -> Array:
    """Return the places (N, 3) mm of the collisions about a time."""
    places = [one.place for one in assembled.collisions if abs(one.time - time) <= RINGED]
    return np.reshape(np.array(places, dtype=np.float64), (-1, 3))


def _picture(shown: Scene, text: str, remarks: list[str], rings: Array, width: float) -> Figure:
    low, high = shown.box
    fig = Figure(figsize=(width, width), dpi=style.DPI)
    ax, inch = style.footed(fig, low, high)
    draw_skin(ax, shown.surface.vertices[0], shown.surface, -1, shown.camera, shown.rgb)
    _rings(ax, rings, shown.camera)
    draw_triad(ax, high[0] - 0.1 * inch, low[1] - 0.1 * inch, 0.2 * inch, shown.camera)
    style.words(fig, text)
    style.remark(fig, remarks)
    style.legend(fig)
    return style.ink(fig)


def _rings(ax: Axes, places: Array, camera: Camera) -> None:
    """Draw a ring around each place (N, 3) mm."""
    x, y = camera.see(places)[:, :2].T
    ax.plot(x, y, "o", ms=11, mfc="none", mec=style.COLLISION, mew=1.3, zorder=5, clip_on=False)

"""What was found in the photo of a strip, drawn over it."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Polygon, Rectangle
from numpy.typing import NDArray

from simulearn.calibrate.photo import StripPhoto
from simulearn.calibrate.photo_measures import outline_pixels
from simulearn.calibrate.photo_reference import found
from simulearn.palette import BOTTOM, TOP
from simulearn.show.style import INK, nice_length

WIDTH = 8.0  # inches
WORDS = 0.62  # inches below the photo
SIDE = 0.28  # of the width, the whole photo
AROUND = 0.22  # of the strip's box, what is shown around it
MOST = 1400  # pixels of a shown part; more are averaged


def photo_picture(strip: StripPhoto) -> Figure:
    """Return the photo with outline, chord, rise and scale drawn over it.

    Args:
        strip: measured in the photo.
    """
    edge = outline_pixels(strip.curve, strip.reference, strip.section.width)
    low, high = _box(strip, edge)
    wide, tall = high - low
    main = 1 - SIDE
    height = np.clip(WIDTH * main * tall / wide, 2.6, 7.0)
    figure = Figure((WIDTH, height + WORDS))
    bottom = WORDS / (height + WORDS)
    ax = figure.add_axes((0.01, bottom, main - 0.02, 1 - bottom - 0.01))
    _shown(ax, strip.photo.pixels, low, high)
    _strip(ax, strip, edge)
    _scale(ax, strip, low, high)
    side = figure.add_axes((main, bottom, SIDE - 0.01, 1 - bottom - 0.01), anchor="N")
    _whole(side, strip, low, high)
    _words(figure, strip)
    return figure


def _box(strip: StripPhoto, edge: NDArray[np.float64]) -> tuple[Any, Any]:
    """Return the corners of what is shown of the photo, whole pixels."""
    points = np.concatenate([edge, strip.measures.chord_pixels])
    low, high = points.min(axis=0), points.max(axis=0)
    margin = AROUND * (high - low).max()
    low = np.maximum(np.floor(low - margin), 0).astype(int)
    return low, np.minimum(np.ceil(high + margin), strip.photo.size).astype(int)


def _shown(ax: Any, pixels: NDArray[np.uint8], low: Any, high: Any) -> None:
    step = max(1, int(max(high - low) / MOST))
    part = pixels[low[1] : high[1] : step, low[0] : high[0] : step]
    extent = (low[0] - 0.5, high[0] - 0.5, high[1] - 0.5, low[1] - 0.5)
    ax.imshow(part, extent=extent, interpolation="antialiased")
    ax.set_xlim(extent[:2])
    ax.set_ylim(extent[2:])
    ax.axis("off")


def _strip(ax: Any, strip: StripPhoto, edge: NDArray[np.float64]) -> None:
    """Draw outline, chord and rise, each with a light border, as photos have any colour."""
    ax.add_patch(Polygon(edge, fill=False, ec="white", lw=2.2, joinstyle="miter"))
    ax.add_patch(Polygon(edge, fill=False, ec=TOP, lw=1.1, joinstyle="miter"))
    chord, rise = strip.measures.chord_pixels, strip.measures.rise_pixels
    for line in (chord, rise):
        ax.plot(*line.T, color="white", lw=2.6, solid_capstyle="round")
        ax.plot(*line.T, color=BOTTOM, lw=1.3, solid_capstyle="round")
    ax.plot(*chord.T, "o", color=BOTTOM, mec="white", ms=5)
    label = {"fontsize": 9, "color": BOTTOM, "ha": "center", "va": "center"}
    box = {"boxstyle": "round,pad=0.25", "fc": "white", "ec": "none", "alpha": 0.85}
    at = chord[0] + 0.25 * (chord[1] - chord[0])
    ax.text(*at, f"chord {strip.chord:.1f}", bbox=box, **label)
    ax.text(*rise.mean(axis=0), f"rise {strip.measures.rise:.1f}", bbox=box, **label)


def _scale(ax: Any, strip: StripPhoto, low: Any, high: Any) -> None:
    """Draw a bar of a round length on the sheet, at the lower edge of what is shown."""
    corner = np.array([low[0] + 0.06 * (high - low)[0], high[1] - 0.06 * (high - low)[1]])
    start, end = strip.camera.on_plane([corner, np.add(corner, [0.5 * (high - low)[0], 0])])
    length = nice_length(2 * float(np.linalg.norm(end - start)))
    direction = (end - start) / np.linalg.norm(end - start)
    ends = np.array([start, start + length * direction])
    bar = strip.camera.pixels(np.column_stack([ends, [0, 0]]))
    ax.plot(*bar.T, color="white", lw=4.5, solid_capstyle="butt")
    ax.plot(*bar.T, color=INK, lw=2.2, solid_capstyle="butt")
    box = {"boxstyle": "round,pad=0.2", "fc": "white", "ec": "none", "alpha": 0.85}
    middle = bar.mean(axis=0) - [0, 0.035 * (high - low)[1]]
    ax.text(*middle, f"{length:g} mm", fontsize=8, color=INK, ha="center", va="bottom", bbox=box)


def _whole(ax: Any, strip: StripPhoto, low: Any, high: Any) -> None:
    """Draw the whole photo small, with the points that gave its scale."""
    _shown(ax, strip.photo.pixels, np.array([0, 0]), np.array(strip.photo.size))
    points = strip.reference.points
    if strip.reference.markers:
        for corners in points.reshape(-1, 4, 2):
            ax.add_patch(Polygon(corners, fill=False, ec=TOP, lw=1.2))
    else:
        ax.plot(*points.T, "-o", color=TOP, lw=1.2, ms=3)
    ax.add_patch(Rectangle(low, *(high - low), fill=False, ec=BOTTOM, lw=0.8))


def _words(figure: Figure, strip: StripPhoto) -> None:
    """Write what was measured, how surely, and by what."""
    height = figure.get_size_inches()[1]
    size = strip.measures
    sign = "" if strip.sign is None else "+" if strip.sign > 0 else "−"
    unsigned = " (size only)" if strip.sign is None else ""
    first = (
        f"chord {size.chord:.2f} ± {size.chord_deviation:.2f} mm,   "
        f"rise {sign}{size.rise:.2f} ± {size.rise_deviation:.2f} mm{unsigned},   "
        f"{strip.curve.length:.1f} mm along the middle,   {strip.curve.thickness:.2f} mm thick"
    )
    figure.text(0.015, 0.36 / height, first, fontsize=8.5, color=INK, va="center")
    figure.text(0.015, 0.14 / height, found(strip.reference), fontsize=7, color=INK, va="center")

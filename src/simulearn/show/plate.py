"""A calibration plate from above, with the labels of its strips, and how a strip is measured."""

from math import cos, pi, sin
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse, Patch, Polygon, Rectangle
from numpy.typing import NDArray

from simulearn.calibrate import Plate, label
from simulearn.show import style
from simulearn.show.flat import draw_flat

Array = NDArray[np.float64]
WIDTH = 7.2  # of the figure, inches
MARGIN = 6.0  # mm around the bed
DRAWING = 2.1  # inches below the map for how it is measured
ARC = 1.15  # radians of the strip that is drawn, either side of its middle
ARROW: dict[str, Any] = {
    "arrowstyle": "<->",
    "color": style.INK,
    "lw": 0.9,
    "shrinkA": 0,
    "shrinkB": 0,
}


def plate_map(plate: Plate) -> Figure:
    """Return the picture of a plate on its bed, and of how a strip is measured.

    Args:
        plate: what is printed.
    """
    bed = plate.job.printer.bed
    low, high = np.array(bed.low) - MARGIN, np.array(bed.high) + MARGIN
    across, up = high - low
    width = WIDTH
    tall = width * up / across
    height = tall + style.FOOT + DRAWING
    fig = Figure(figsize=(width, height), dpi=style.DPI)
    ax = fig.add_axes((0, (style.FOOT + DRAWING) / height, 1, tall / height))
    ax.set_xlim(low[0], high[0])
    ax.set_ylim(low[1], high[1])
    ax.set_aspect("equal")
    ax.axis("off")
    _bed(ax, plate)
    size = min(8.0, 72 * width / across * 5.5)  # points; labels fit between two strips
    kinds = {
        label(kind, k): kind for kind, r in plate.form.strips.items() for k in range(r.repeats)
    }
    for grid, name in zip(plate.job.grids, plate.job.names, strict=True):
        place = grid.joints[grid.fixed]
        draw_flat(ax, grid, numbers=False, at=(float(place[0]), float(place[1])))
        half = plate.job.material.section.width / 2
        x, y = grid.joints.min(axis=0)[0] - half, grid.joints.max(axis=0)[1] + half + 1.0
        kind = kinds[name]
        ax.text(x, y, name, fontsize=size, fontweight="bold", va="bottom")
        ax.text(
            x + 1.1 * size * across / width / 72 * len(name),
            y,
            f"{kind}, {plate.length[kind]:g} mm",
            fontsize=0.75 * size,
            va="bottom",
        )
    style.words(fig, "The black end is held in the bath.")
    style.legend(fig)
    _measuring(fig.add_axes((0, style.FOOT / height, 1, DRAWING / height)))
    return style.ink(fig)


def _bed(ax: Axes, plate: Plate) -> None:
    """Draw the edge of the bed and where its front is."""
    bed = plate.job.printer.bed
    (x0, y0), (x1, y1) = bed.low, bed.high
    if bed.round:
        edge: Patch = Ellipse(((x0 + x1) / 2, (y0 + y1) / 2), x1 - x0, y1 - y0)
    else:
        edge = Rectangle((x0, y0), x1 - x0, y1 - y0)
    edge.set(fc="none", ec=style.GHOST_LINE, lw=1.0)
    ax.add_patch(edge)
    words = f"front of the bed of {plate.job.printer.title}"
    ax.text((x0 + x1) / 2, y0 - 1.0, words, fontsize=6.5, ha="center", va="top")


def _measuring(ax: Axes) -> None:
    """Draw a strip on its side with a straight edge across its tips."""
    thick, radius = 4.0, 26.0
    ax.set_xlim(-WIDTH / DRAWING * 18, WIDTH / DRAWING * 18)
    ax.set_ylim(-22, 14)
    ax.set_aspect("equal")
    ax.axis("off")
    angles = np.linspace(-ARC, ARC, 60) - pi / 2
    centre = radius * cos(ARC)  # so that the tips of the hollow side lie at 0
    inner, outer = (
        np.stack([r * np.cos(angles), r * np.sin(angles) + centre], axis=1)
        for r in (radius, radius + thick)
    )
    held = angles < angles[0] + 0.14
    ax.add_patch(
        Polygon(np.concatenate([inner, outer[::-1]]), fc=style.PASSIVE, ec=style.LINE, lw=0.8)
    )
    ends = np.concatenate([inner[held], outer[held][::-1]])
    ax.add_patch(Polygon(ends, fc=style.FIXED, ec=style.LINE, lw=0.8))
    tip, low = radius * sin(ARC), centre - radius
    ax.add_patch(Rectangle((-tip - 8, 0), 2 * tip + 16, 2.4, fc=style.GHOST, ec=style.LINE, lw=0.8))
    ax.annotate("", (-tip, 6.5), (tip, 6.5), arrowprops=ARROW)
    for x in (-tip, tip):
        ax.plot([x, x], [0, 8], color=style.LINE, lw=0.6)
    ax.annotate("", (0, 0), (0, low), arrowprops=ARROW)
    ax.text(0, 7.2, "chord", fontsize=8, ha="center", va="bottom")
    ax.text(1.0, low / 2, "rise", fontsize=8, va="center")
    beside = tip + 9.5
    for x, y, align, words in (
        (beside, 1.2, "left", "straight edge across\nthe tips of the hollow side"),
        (
            beside,
            -12,
            "left",
            "rise is + where the hollow\nside was up in the print,\nand - where it was down",
        ),
        (-beside, -12, "right", "the strip lies\non its side"),
    ):
        ax.text(x, y, words, fontsize=6.5, va="center", ha=align)

"""The sheet that a strip is photographed on, as a page to print."""

from typing import Any

import numpy as np
import shapely
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch, Rectangle
from matplotlib.path import Path

from simulearn.calibrate.photo_sheet import (
    CELLS,
    DARK,
    FIELD,
    FRAME,
    FRAME_SIZE,
    INSET,
    MARKER,
    MARKERS,
    PAPERS,
    marker_corners,
)
from simulearn.extras import require
from simulearn.show.style import INK
from simulearn.units import INCH

DARK_GREY = "#303030"  # of the dark sheet's inside; deep enough for white strips
BLACK = "#000000"


def photo_sheet(paper: str = "a4", dark: bool = False) -> Figure:
    """Return the page, in its true size.

    Args:
        paper: "a4" or "letter".
        dark: with a dark inside, for white and other light strips.
    """
    require("the sheet needs", "cv2")
    width, height = PAPERS[paper]
    figure = Figure((width / INCH, height / INCH))
    ax = figure.add_axes((0, 0, 1, 1))
    left, low = (width - FIELD[0]) / 2, (height - FIELD[1]) / 2
    ax.set_xlim(-left, width - left)
    ax.set_ylim(-low, height - low)
    ax.axis("off")
    for number in range(MARKERS):
        ax.add_patch(_marker(number + (DARK if dark else 0)))
    _frame(ax, dark)
    _words(ax, dark)
    return figure


def _marker(number: int) -> PathPatch:
    """Return a marker as one shape, so that no viewer shows seams between its cells."""
    import cv2

    family = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)
    black = cv2.aruco.generateImageMarker(family, number, CELLS) < 128
    left, low = marker_corners(number)[3]
    cell = MARKER / CELLS
    boxes = [
        shapely.box(
            left + column * cell,
            low + MARKER - (row + 1) * cell,
            left + (column + 1) * cell,
            low + MARKER - row * cell,
        )
        for row, column in np.argwhere(black)
    ]
    whole = shapely.union_all(boxes)
    parts = getattr(whole, "geoms", [whole])
    rings = [ring for part in parts for ring in (part.exterior, *part.interiors)]
    path = Path.make_compound_path(*(Path(np.array(ring.coords), closed=True) for ring in rings))
    return PathPatch(path, fc=BLACK, lw=0, snap=False)


def _frame(ax: Any, dark: bool) -> None:
    """Draw the frame with a tick outwards for each millimetre, and a longer one for each 5, 10."""
    left, low, right, high = FRAME
    inside: dict[str, Any] = {"fc": DARK_GREY if dark else "none", "ec": INK, "lw": 0.5}
    ax.add_patch(Rectangle((left, low), right - left, high - low, **inside))
    lines = []
    for k in range(round(FRAME_SIZE[0]) + 1):
        long = _tick(k)
        lines += [[(left + k, low), (left + k, low - long)]]
        lines += [[(left + k, high), (left + k, high + long)]]
    for k in range(round(FRAME_SIZE[1]) + 1):
        long = _tick(k)
        lines += [[(left, low + k), (left - long, low + k)]]
        lines += [[(right, low + k), (right + long, low + k)]]
    ax.add_collection(LineCollection(lines, colors=INK, linewidths=0.25, capstyle="butt"))


def _tick(k: int) -> float:
    return 3.0 if k % 10 == 0 else 2.2 if k % 5 == 0 else 1.4


def _words(ax: Any, dark: bool) -> None:
    """Write what to do around the frame, where no marker is."""
    small = {"fontsize": 7, "color": INK, "ha": "center", "va": "center"}
    middle, top = FIELD[0] / 2, FIELD[1]
    kind = (
        "dark sheet, for light strips"
        if dark
        else "white sheet, for strips of any colour but white"
    )
    ax.text(middle, -8, f"SimuLearn: {kind}. Print at 100 %, not “fit to page”.", **small)
    ax.text(
        middle,
        top + 8,
        "Lay the strip on its side within the frame, and photograph it from above with all the "
        "markers. Do not crop the photo.",
        **small,
    )
    quarter = FIELD[1] / 4
    side = {**small, "rotation": 90}
    ax.text(
        (INSET - 3) / 2,
        quarter,
        f"frame: {FRAME_SIZE[0]:g} mm across,\n{FRAME_SIZE[1]:g} mm along; measure it",
        **side,
    )
    right = FIELD[0] - (INSET - 3) / 2
    ax.text(right, quarter - 8, "the side that lay on top\nin the printer faces this way", **side)
    tail, head = (right - 7, quarter + 18), (right + 7, quarter + 18)
    arrow = {"arrowstyle": "-|>,head_width=0.4,head_length=0.8", "color": INK, "lw": 1.5}
    ax.annotate("", head, tail, arrowprops={**arrow, "shrinkA": 0, "shrinkB": 0})

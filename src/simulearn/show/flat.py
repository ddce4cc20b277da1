"""The flat grid seen from above: what is printed where."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from simulearn.grid import Grid, outline
from simulearn.material import load_material
from simulearn.show import style

Array = NDArray[np.float64]


def draw_flat(ax: Axes, grid: Grid, numbers: bool = True) -> tuple[Array, Array]:
    """Draw a grid from above.

    Args:
        ax: where to draw, in mm.
        grid: the design.
        numbers: whether joints and beams carry their numbers.

    Returns:
        The lower left and the upper right corner (2,) of what was drawn, mm.
    """
    grid = grid.centred
    shape = outline(grid, load_material(grid.material).section)
    ends = shape.beams  # (B, [start, end], [right, left], 2)

    def across(t: Array) -> Array:
        """Return the right and left points of the beams at t (B,): (B, 2, 2)."""
        return (1 - t)[:, None, None] * ends[:, 0] + t[:, None, None] * ends[:, 1]

    def between(a: Array, b: Array) -> Array:
        right_left, far = across(a), across(b)
        return np.stack([right_left[:, 0], far[:, 0], far[:, 1], right_left[:, 1]], axis=1)

    ratio = grid.actuators
    none = np.zeros(len(ratio))
    active = np.abs(ratio) > 0
    draw: Any = ax.add_collection
    edge: dict[str, Any] = {"edgecolors": style.LINE, "linewidths": 0.6, "joinstyle": "round"}
    draw(PolyCollection(list(between(none, none + 1)), facecolors=style.PASSIVE, **edge))
    a, b = (1 - np.abs(ratio)) / 2, (1 + np.abs(ratio)) / 2
    draw(PolyCollection(list(between(a, b)[active]), facecolors=style.tint(ratio[active]), **edge))
    faces = [style.FIXED if j == grid.fixed else style.JOINT for j in range(len(grid.joints))]
    draw(PolyCollection(list(shape.joints), facecolors=faces, **edge))
    if numbers:
        _numbers(ax, grid, across(none + 0.5).mean(axis=1))
    corners = shape.joints.reshape(-1, 2)
    return corners.min(axis=0), corners.max(axis=0)


def _numbers(ax: Axes, grid: Grid, middles: Array) -> None:
    centre: dict[str, Any] = {"ha": "center", "va": "center_baseline"}
    for j, (x, y) in enumerate(grid.joints):
        colour = "white" if j == grid.fixed else style.INK
        ax.text(x, y, str(j), color=colour, fontsize=6, fontweight="bold", **centre)
    for b, (x, y) in enumerate(middles):
        strong = abs(grid.actuators[b]) > 0.5
        ax.text(x, y, str(b), color="white" if strong else style.INK, fontsize=5.5, **centre)


def flat(grid: Grid, numbers: bool = True, width: float = 5.2) -> Figure:
    """Return the picture of a flat grid.

    Args:
        grid: the design.
        numbers: whether joints and beams carry their numbers.
        width: of the figure, inches.
    """
    with style.paper():
        fig = Figure(figsize=(width, width), dpi=style.DPI)
        ax = fig.add_axes((0, 0, 1, 1))
        low, high = draw_flat(ax, grid, numbers)
        span = high - low
        margin = 0.06 * float(max(span))
        foot = 0.62  # inches for scale bar and legend
        height = (width * (span[1] + 2 * margin) / (span[0] + 2 * margin)) + foot
        fig.set_size_inches(width, height)
        ax.set_position((0, foot / height, 1, 1 - foot / height))
        style.bare(ax, low, high, margin)
        inch = (span[0] + 2 * margin) / width  # mm
        style.scale_bar(ax, low[0], low[1] - margin - 0.16 * inch, style.nice_length(span[0]))
        style.legend(fig, (width - style.LEGEND_WIDTH) / 2 + 0.1, 0.14)
    return fig

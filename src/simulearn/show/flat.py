"""The flat grid seen from above: what is printed where."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from simulearn.grid import Grid, Outline, outline
from simulearn.material import load_material
from simulearn.show import style

Array = NDArray[np.float64]


def draw_flat(
    ax: Axes, grid: Grid, numbers: bool = True, at: tuple[float, float] = (0.0, 0.0)
) -> None:
    """Draw a grid from above.

    Args:
        ax: where to draw, in mm.
        grid: the design.
        numbers: whether joints and beams carry their numbers.
        at: where its fixed joint comes to lie, mm.
    """
    grid = grid.centred
    shape = _outline(grid)
    ends = shape.beams + np.array(at)  # (B, [start, end], [right, left], 2)

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
    draw(PolyCollection(list(shape.joints + np.array(at)), facecolors=faces, **edge))
    if numbers:
        joints = shape.joints.mean(axis=1) + np.array(at)
        _numbers(ax, grid, joints, across(none + 0.5).mean(axis=1), _beam_width(ax, grid))


def extent(grid: Grid) -> tuple[Array, Array]:
    """Return the lower left and upper right corner (2,) of a grid, mm from its fixed joint."""
    corners = _outline(grid.centred).joints.reshape(-1, 2)
    return corners.min(axis=0), corners.max(axis=0)


def _outline(grid: Grid) -> Outline:
    return outline(grid, load_material(grid.material).section)


def _beam_width(ax: Axes, grid: Grid) -> float:
    """Return how wide a beam is drawn, points."""
    mm = load_material(grid.material).section.width
    (left, _), (right, _) = ax.transData.transform([(0, 0), (mm, 0)])
    return float(right - left) * 72 / ax.figure.dpi


def _numbers(ax: Axes, grid: Grid, joints: Array, middles: Array, width: float) -> None:
    """Write the numbers of joints and beams, so small that two digits fit across a beam."""
    centre: dict[str, Any] = {"ha": "center", "va": "center_baseline"}
    size = min(6.0, width / 1.5)
    for j, (x, y) in enumerate(joints):
        colour = "white" if j == grid.fixed else style.INK
        ax.text(x, y, str(j), color=colour, fontsize=size, fontweight="bold", **centre)
    for b, (x, y) in enumerate(middles):
        colour = "white" if abs(grid.actuators[b]) > 0.5 else style.INK
        ax.text(x, y, str(b), color=colour, fontsize=0.92 * size, **centre)


def flat(grid: Grid, numbers: bool = True, width: float = 5.2) -> Figure:
    """Return the picture of a flat grid.

    Args:
        grid: the design.
        numbers: whether joints and beams carry their numbers.
        width: of the figure, inches.
    """
    fig = Figure(figsize=(width, width), dpi=style.DPI)
    ax, _ = style.footed(fig, *extent(grid))
    draw_flat(ax, grid, numbers)
    style.legend(fig)
    return style.ink(fig)

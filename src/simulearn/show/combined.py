"""A design and what it becomes in one figure and one scale: flat on the left, deformed right."""

import numpy as np
from matplotlib.figure import Figure

from simulearn.show import style
from simulearn.show.camera import Camera
from simulearn.show.deformed import SPACING, dimensions, draw_deformed, draw_triad, qualified
from simulearn.show.deformed import extent as extent_deformed
from simulearn.show.flat import draw_flat
from simulearn.show.flat import extent as extent_flat
from simulearn.simulate import Result, skin


def combined(
    result: Result, numbers: bool = True, camera: Camera = Camera(), width: float = 7.2
) -> Figure:
    """Return the picture of a result, its flat grid beside its last frame.

    Args:
        result: what to show.
        numbers: whether joints and beams of the flat grid carry their numbers.
        camera: where the viewer of the deformed grid is.
        width: of the figure, inches.
    """
    surface = skin(result, SPACING)
    left = extent_flat(result.grid)
    right = extent_deformed(surface, camera, [0, -1], result.scatter)
    gap = 0.1 * float(right[1][0] - right[0][0])
    # The flat grid stands to the left of the deformed one, their middles at one height.
    at = np.array(
        [right[0][0] - gap - left[1][0], (right[0] + right[1] - left[0] - left[1])[1] / 2]
    )
    corners = np.array([left[0] + at, left[1] + at, *right])
    low, high = corners.min(axis=0), corners.max(axis=0)
    fig = Figure(figsize=(width, width), dpi=style.DPI)
    ax, inch = style.footed(fig, low, high)
    draw_flat(ax, result.grid, numbers, (float(at[0]), float(at[1])))
    draw_deformed(ax, result, surface, -1, camera)
    draw_triad(ax, high[0] - 0.2 * inch, low[1] + 0.05 * inch, 0.2 * inch, camera)
    style.words(fig, dimensions(result))
    style.remark(fig, qualified(result))
    style.legend(fig)
    return style.ink(fig)

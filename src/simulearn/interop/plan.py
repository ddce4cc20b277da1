"""The plan of a grid as SVG: what a page or notebook shows of a design without drawing a picture.

Colours are attributes that a style sheet may replace by the classes plan-beam, plan-top,
plan-bottom, plan-joint, plan-fixed and plan-number.
"""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.grid import Grid, outline
from simulearn.grid.structure import structure_errors
from simulearn.material import load_material

COLOURS = {
    "beam": "#c9cdd6",
    "top": "#d55e00",
    "bottom": "#0072b2",
    "joint": "#868d9b",
    "fixed": "#2b2f36",
}
MOST_NUMBERS = 60  # joints and beams that are numbered; more could not be read
WIDTH = 5.0  # mm, of a beam that is drawn as a line
MARGIN = 4.0  # mm
Array = NDArray[np.float64]


def plan(grid: Grid) -> str:
    """Return the plan of a grid as an SVG element, +y up.

    A grid without a sound outline is drawn by its axes.

    Args:
        grid: the design.
    """
    shapes = _shapes(grid)
    points = np.concatenate([shape.reshape(-1, 2) for shape in shapes.values()])
    if not len(points):
        points = np.zeros((1, 2))
    low, high = points.min(axis=0) - MARGIN, points.max(axis=0) + MARGIN
    wide, deep = high - low
    name = f"Plan: {len(grid.joints)} joints, {len(grid.beams)} beams"
    return "".join(
        [
            f'<svg class="plan" xmlns="http://www.w3.org/2000/svg" role="img" aria-label="{name}" ',
            f'viewBox="{low[0]:.1f} {-high[1]:.1f} {wide:.1f} {deep:.1f}">',
            *(_path(name, polygons) for name, polygons in shapes.items() if len(polygons)),
            *_numbers(grid, points),
            "</svg>",
        ]
    )


def _shapes(grid: Grid) -> dict[str, Array]:
    """Return the polygons (N, 4, 2) of each class, mm."""
    joints, ends, ratio = _outline(grid) or _axes(grid)
    part = np.clip(np.abs(ratio), 0, 1)[:, None, None]

    def at(t: Array) -> Array:
        return (1 - t) * ends[:, 0] + t * ends[:, 1]

    first, last = at((1 - part) / 2), at((1 + part) / 2)
    active = np.stack([first[:, 0], last[:, 0], last[:, 1], first[:, 1]], axis=1)
    fixed = np.arange(len(joints)) == grid.fixed
    return {
        "beam": np.stack([ends[:, 0, 0], ends[:, 1, 0], ends[:, 1, 1], ends[:, 0, 1]], axis=1),
        "top": active[ratio > 0],
        "bottom": active[ratio < 0],
        "joint": joints[~fixed],
        "fixed": joints[fixed],
    }


def _outline(grid: Grid) -> tuple[Array, Array, Array] | None:
    """Return corners of joints (J, 4, 2), those of beams (B, 2, 2, 2), and ratios (B,), if sound.

    Of beams, the axes are [start, end], [right, left] and x and y.
    """
    if structure_errors(grid):
        return None
    try:
        shape = outline(grid, load_material(grid.material).section)
    except InputError:
        return None
    return shape.joints, shape.beams, grid.actuators


def _axes(grid: Grid) -> tuple[Array, Array, Array]:
    """Return the same for a grid without an outline: beams between joints that exist, as lines."""
    half = WIDTH / 2
    joints = grid.joints[:, None] + half * np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
    known = ((grid.beams >= 0) & (grid.beams < len(joints))).all(axis=1)
    axes = grid.joints[grid.beams[known]]
    along = axes[:, 1] - axes[:, 0]
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
    left = half * np.stack([-along[:, 1], along[:, 0]], axis=1)[:, None]
    ratio = np.zeros(len(grid.beams))
    ratio[: len(grid.actuators)] = grid.actuators[: len(ratio)]
    return joints, np.stack([axes - left, axes + left], axis=2), ratio[known]


def _path(kind: str, polygons: Array) -> str:
    d = "".join(
        "M" + "L".join(f"{x:.1f} {-y:.1f}" for x, y in corners) + "Z" for corners in polygons
    )
    return f'<path class="plan-{kind}" fill="{COLOURS[kind]}" d="{d}"/>'


def _numbers(grid: Grid, points: Array) -> Iterable[str]:
    """Yield the numbers of joints (bold) and of beams."""
    if len(grid.joints) + len(grid.beams) > MOST_NUMBERS:
        return
    size = float(np.clip(0.045 * np.ptp(points, axis=0).max(), 4.0, 7.0))  # mm
    yield (
        f'<g class="plan-number" fill="#14171d" stroke="#ffffff" stroke-width="{size / 5:.1f}" '
        f'paint-order="stroke" stroke-linejoin="round" text-anchor="middle" '
        f'font-family="system-ui, sans-serif" font-size="{size:.1f}">'
    )
    middles = [
        (b, grid.joints[[i, j]].mean(axis=0))
        for b, (i, j) in enumerate(grid.beams)
        if min(i, j) >= 0 and max(i, j) < len(grid.joints)
    ]
    for weight, places in (("400", middles), ("700", enumerate(grid.joints))):
        for k, (x, y) in places:
            place = f'x="{x:.1f}" y="{0.35 * size - y:.1f}"'
            yield f'<text {place} font-weight="{weight}">{k}</text>'
    yield "</g>"

"""The picture of a comparison: the grid from above and in space, coloured by deviation.

The simulated grid is drawn, paler the nearer the print is to it; rings are where joints were
measured, lines lead to them from where they were simulated, dots are points of a scan.
"""

from textwrap import fill
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import LinearSegmentedColormap, Normalize, to_rgb
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from simulearn.compare import Comparison
from simulearn.compare.report import verdict
from simulearn.palette import BOTTOM, TOP
from simulearn.show import style
from simulearn.show.camera import Camera
from simulearn.simulate import Skin, skin

Array = np.ndarray
SHADES = LinearSegmentedColormap.from_list("deviation", ["#f4f1ec", "#f3b98c", TOP, "#7a3300"])
UNKNOWN = "#c9d3da"  # what was not measured
MEASURED = BOTTOM
DOTS = 6000  # points of a scan that are drawn
SPACING = 2.0  # mm, length of the quadrilaterals along a beam
ABOVE = Camera(azimuth=-90.0, elevation=90.0)
WRAPPED = 136  # letters in a line of words, at a width of 7.2 inches


def compared(comparison: Comparison, camera: Camera = Camera(), width: float = 7.2) -> Figure:
    """Return the picture of a comparison.

    Args:
        comparison: what to show.
        camera: where the viewer of the right half is.
        width: of the figure, inches.
    """
    surface = skin(comparison.result, SPACING)
    off = comparison.deviation
    values = quad_values(comparison, surface)
    known = np.concatenate([off.distances, off.beams[:, 1]])
    norm = Normalize(0, max(float(np.nanmax(known)), 1e-3))
    boxes = [_extent(comparison, surface, c) for c in (ABOVE, camera)]
    spans = [high - low for low, high in boxes]
    across = sum(float(s[0]) for s in spans) * 1.08
    tall = max(float(s[1]) for s in spans) * 1.06
    text = _words(comparison, width)
    foot = 0.75 + 0.15 * text.count("\n")
    height = width * tall / across + foot
    fig = Figure(figsize=(width, height), dpi=style.DPI)
    left = 0.02 * across
    for view, (low, high), span, numbers in zip((ABOVE, camera), boxes, spans, (True, False),
                                                strict=True):  # fmt: skip
        part = float(span[0]) / across
        ax = fig.add_axes((left / across, foot / height, part, 1 - foot / height))
        middle = float(low[1] + high[1]) / 2
        ax.set_xlim(low[0], high[0])
        ax.set_ylim(middle - tall / 2, middle + tall / 2)
        ax.set_aspect("equal")
        ax.axis("off")
        _draw_shape(ax, surface, values, norm, view)
        _draw_measured(ax, comparison, view, numbers)
        left += float(span[0]) + 0.04 * across
    _scale(fig, norm, foot, height)
    bar = fig.add_axes((0.03, (foot - 0.22) / height, 0.3, 0.1 / height))
    length = style.nice_length(across)
    bar.set_xlim(0, 0.3 * across)
    bar.set_ylim(-1, 1)
    bar.axis("off")
    style.scale_bar(bar, 0, 0, length)
    fig.text(0.03, 0.08 / height, text, fontsize=7, va="bottom", linespacing=1.35)
    return style.ink(fig)


def quad_values(comparison: Comparison, surface: Skin) -> Array:
    """Return the deviation (Q,) at each quadrilateral: of its joint, or between along its beam."""
    off, result = comparison.deviation, comparison.result
    values = np.full(len(surface.quads), np.nan)
    on_joint = surface.joint >= 0
    values[on_joint] = off.distances[surface.joint[on_joint]]
    middles = surface.vertices[0][surface.quads].mean(axis=1)[:, :2]
    a, b = result.centres[0][result.grid.beams].swapaxes(0, 1)[..., :2]
    along = b - a
    place = np.einsum("qbx,bx->qb", middles[:, None] - a, along) / (along**2).sum(axis=1)
    away = np.linalg.norm(middles[:, None] - a - np.clip(place, 0, 1)[..., None] * along, axis=2)
    beam = away.argmin(axis=1)
    t = np.clip(place[np.arange(len(beam)), beam], 0, 1)
    stations = np.linalg.norm(off.stations - off.expected, axis=2)
    for k in range(len(result.grid.beams)):
        mine = ~on_joint & (beam == k)
        ends = off.distances[result.grid.beams[k]]
        rows = np.array([ends[0], *stations[k], ends[1]])
        at = np.array([0, 0.25, 0.5, 0.75, 1])
        good = np.isfinite(rows)
        if good.any():
            # Beyond what was measured nothing is known.
            values[mine] = np.interp(t[mine], at[good], rows[good], left=np.nan, right=np.nan)
    return values


def _extent(comparison: Comparison, surface: Skin, camera: Camera) -> tuple[Array, Array]:
    off = comparison.deviation
    points = [surface.vertices[-1], off.joints[off.measured]]
    seen = np.concatenate([camera.see(p)[:, :2] for p in points])
    room = 0.03 * float(np.ptp(seen, axis=0).max())
    return seen.min(axis=0) - room, seen.max(axis=0) + room


def _draw_shape(ax: Axes, surface: Skin, values: Array, norm: Normalize, camera: Camera) -> None:
    """Draw the simulated shape, what is near over what is far."""
    corners = surface.vertices[-1][surface.quads]
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    normals = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    front = normals @ camera.axes[2] > 0
    seen = camera.see(corners[front])
    rgb = np.array(SHADES(norm(np.nan_to_num(values[front]))))[:, :3]
    rgb[np.isnan(values[front])] = to_rgb(UNKNOWN)
    rgb = rgb * (0.35 + 0.65 * camera.light(normals[front]))[:, None]
    order = np.argsort(seen[..., 2].mean(axis=1))
    drawn: Any = PolyCollection(
        list(seen[order][..., :2]), facecolors=rgb[order], edgecolors=rgb[order], linewidths=0.35
    )
    ax.add_collection(drawn, autolim=False)


def _draw_measured(ax: Axes, comparison: Comparison, camera: Camera, numbers: bool) -> None:
    off = comparison.deviation
    if len(comparison.points):
        some = comparison.points[:: max(1, len(comparison.points) // DOTS)]
        # Stray points far from the grid would only widen the picture; the axes cut them off.
        x, y = camera.see(some)[:, :2].T
        ax.plot(x, y, ",", color=MEASURED, alpha=0.35, zorder=3)
    here, there = camera.see(off.simulated)[:, :2], camera.see(off.joints)[:, :2]
    for j in np.flatnonzero(off.measured).tolist():
        ax.plot(*np.stack([here[j], there[j]]).T, color=MEASURED, lw=1.0, zorder=5)
    measured = there[off.measured]
    ax.plot(*measured.T, "o", ms=4.5, mfc="none", mec=MEASURED, mew=1.0, zorder=6)
    if numbers:
        for j, (x, y) in enumerate(here):
            ax.annotate(
                str(comparison.joint_numbers[j]), (x, y), xytext=(5, 4),
                textcoords="offset points", fontsize=6, zorder=7,
                path_effects=[withStroke(linewidth=1.4, foreground="white")],
            )  # fmt: skip


def _scale(fig: Figure, norm: Normalize, foot: float, height: float) -> None:
    ax = fig.add_axes((0.6, (foot - 0.28) / height, 0.37, 0.07 / height))
    bar = fig.colorbar(ScalarMappable(norm, SHADES), cax=ax, orientation="horizontal")
    bar.ax.tick_params(labelsize=6, length=2, pad=1)
    bar.outline.set_linewidth(0.4)
    bar.ax.set_title("deviation, mm (rings: measured)", fontsize=6.5, loc="left", pad=2)


def _words(comparison: Comparison, width: float) -> str:
    off, size = comparison.deviation, comparison.result.grid.dimension
    worst = float(off.distances[off.worst])
    joint = comparison.joint_numbers[off.worst]
    first = (
        f"Mean deviation {off.mean:.2f} mm ({off.mean / size:.1%} of the dimension), worst "
        f"{worst:.2f} mm ({worst / size:.1%}, joint {joint}); prints of one design differ by "
        f"{comparison.scatter.mm:.1f} mm."
    )
    letters = int(WRAPPED * width / 7.2)
    reason = verdict(comparison)
    return "\n".join([fill(first, letters), fill(reason[0].upper() + reason[1:] + ".", letters)])

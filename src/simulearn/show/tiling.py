"""The map of a tiling: patches of the surface, joints and beams by how far off they are."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray

from simulearn.show import style
from simulearn.show.camera import Camera
from simulearn.show.compare import SHADES
from simulearn.tile import Tiled
from simulearn.tile.pieces import deviations

Array = NDArray[np.float64]

PATCH, PATCH_LINE, BACK = "#f1f3f4", "#c9d0d4", "#e4e8ea"
FOOT = 0.62  # inches beneath the map
AROUND = 0.3  # of the normals' mean length, below which a surface is seen from two sides
NAMED = 60  # modules, of more the names would cover the map


def deviation_map(tiled: Tiled, width: float = 7.2) -> Figure:
    """Return the map of how far joints and middles of beams are from the surface.

    A surface that goes around is seen from two sides.

    Args:
        tiled: the tiling.
        width: of the figure, inches.
    """
    joints, beams = deviations(tiled)
    norm = Normalize(0, max(float(joints.max()), float(beams.max()), 0.1))
    cameras = _cameras(tiled.tiling.normals)
    seen = [camera.see(tiled.fit.joints.reshape(-1, 3)) for camera in cameras]
    lows = [points.min(axis=0)[:2] for points in seen]
    highs = [points.max(axis=0)[:2] for points in seen]
    room = 0.06 * max(float((high - low).max()) for low, high in zip(lows, highs, strict=True))
    across = sum(float(high[0] - low[0]) + 2 * room for low, high in zip(lows, highs, strict=True))
    tall = max(float(high[1] - low[1]) + 2 * room for low, high in zip(lows, highs, strict=True))
    height = width * tall / across + FOOT
    fig = Figure(figsize=(width, height), dpi=style.DPI)
    left = 0.0
    for camera, low, high in zip(cameras, lows, highs, strict=True):
        part = float(high[0] - low[0] + 2 * room) / across
        ax = fig.add_axes((left, FOOT / height, part, 1 - FOOT / height))
        middle = float(low[1] + high[1]) / 2
        ax.set_xlim(low[0] - room, high[0] + room)
        ax.set_ylim(middle - tall / 2, middle + tall / 2)
        ax.set_aspect("equal")
        ax.axis("off")
        _draw(ax, tiled, camera, joints, beams, norm)
        left += part
    _scale(fig, norm, height)
    bar = fig.add_axes((0.03, 0.36 / height, 0.3, 0.1 / height))
    bar.set_xlim(0, 0.3 * across)
    bar.set_ylim(-1, 1)
    bar.axis("off")
    style.scale_bar(bar, 0, 0, style.nice_length(across))
    text = (
        f"{len(tiled.tiling.names)} modules, {len(tiled.grids)} kinds; joints "
        f"{tiled.fit.error_mm:.2f} mm from their targets in the mean, largest gap "
        f"{tiled.fit.gap_mm:.2f} mm"
    )
    fig.text(0.03, 0.14 / height, text, fontsize=7, va="bottom")
    return style.ink(fig)


def _cameras(normals: Array) -> list[Camera]:
    mean = normals.mean(axis=0)
    if np.linalg.norm(mean) < AROUND:
        return [Camera(-62.0, 18.0), Camera(118.0, 18.0)]
    if abs(mean[2]) < 0.5 * np.linalg.norm(mean):  # upright: from where it faces
        return [Camera(float(np.degrees(np.arctan2(mean[1], mean[0]))) + 20.0, 18.0)]
    return [Camera(-70.0, 48.0)]


def _draw(
    ax: Axes, tiled: Tiled, camera: Camera, joints: Array, beams: Array, norm: Normalize
) -> None:
    """Draw the patches from the farthest to the nearest, each with its beams and joints."""
    tiling, grid = tiled.tiling, tiled.tiling.lattice
    rim = _rim(grid.joints)
    points = camera.see(tiled.fit.joints)
    middles = camera.see(tiled.beams)
    normals = tiling.normals[tiling.modules].mean(axis=1) @ camera.axes[2]
    two = len(_cameras(tiling.normals)) > 1
    for m in np.argsort(points[..., 2].mean(axis=1)).tolist():
        if two and normals[m] < 0:  # the other side has a view of its own
            continue
        x, y = points[m, rim, :2].T
        ax.fill(x, y, fc=PATCH if normals[m] > 0 else BACK, ec=PATCH_LINE, lw=0.5, zorder=2)
        for b, (i, j) in enumerate(_beams(tiled, m)):
            line = np.stack([points[m, i], middles[m, b], points[m, j]])[:, :2].T
            for colour, wide in ((style.LINE, 2.6), (SHADES(norm(beams[m, b])), 2.0)):
                ax.plot(*line, color=colour, lw=wide, zorder=2.1, solid_capstyle="round")
        dots: dict[str, Any] = {"edgecolors": style.LINE, "linewidths": 0.3, "zorder": 2.2}
        colours = SHADES(norm(joints[m]))
        x, y = points[m, :, :2].T
        ax.scatter(x, y, s=11, c=colours, **dots)
        if len(tiling.names) <= NAMED:
            x, y = points[m, :, :2].mean(axis=0)
            ax.annotate(tiling.names[m], (x, y), xytext=(3, 3), textcoords="offset points",
                        fontsize=4.5, zorder=2.3)  # fmt: skip


def _beams(tiled: Tiled, module: int) -> list[tuple[int, int]]:
    """Return the ends of a module's beams, in the order of its patch's points."""
    member = tiled.members[module]
    place = np.argsort(member.order)  # of the kind's joints among the patch's points
    ends = place[tiled.tiling.lattice.beams]
    return [(int(a), int(b)) for a, b in ends]


def _rim(joints: Array) -> NDArray[np.int64]:
    """Return the joints around a lattice, one after the other."""
    low, high = joints.min(axis=0), joints.max(axis=0)
    on = np.flatnonzero(((joints == low) | (joints == high)).any(axis=1))
    away = joints[on] - (low + high) / 2
    order: NDArray[np.int64] = on[np.argsort(np.arctan2(away[:, 1], away[:, 0]))]
    return order


def _scale(fig: Figure, norm: Normalize, height: float) -> None:
    ax = fig.add_axes((0.66, 0.2 / height, 0.31, 0.07 / height))
    bar = fig.colorbar(ScalarMappable(norm, SHADES), cax=ax, orientation="horizontal")
    bar.ax.tick_params(labelsize=6, length=2, pad=1)
    bar.outline.set_linewidth(0.4)
    bar.ax.set_title("distance from the surface, mm", fontsize=6.5, loc="left", pad=2)

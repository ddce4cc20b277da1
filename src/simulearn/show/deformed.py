"""The grid in space: its shaded skin, hidden parts hidden, with the flat grid as a ghost.

Quadrilaterals are drawn from the farthest to the nearest (the painter's algorithm). They are
short and of similar size, so that sorting them by their middles is right; faces turned away are
left out.
"""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from numpy.typing import NDArray

from simulearn.show import style
from simulearn.show.band import bands, draw_band
from simulearn.show.camera import Camera
from simulearn.simulate import Result, Skin, collision_place, collision_text, skin, summary
from simulearn.simulate.spread import Spread

Array = NDArray[np.float64]
SPACING = 2.0  # mm, length of the quadrilaterals along a beam
# An edge stands this far (mm) before its face, so that the next faces do not paint over half of it.
LIFT = 1.3 * SPACING
RIM, EDGE = 0.35, 0.55  # points, line weights of faces and edges


def draw_deformed(
    ax: Axes, result: Result, surface: Skin, frame: int = -1, camera: Camera = Camera()
) -> None:
    """Draw a frame of a result over the ghost of the flat grid."""
    draw_ghost(ax, surface, camera)
    draw_skin(ax, surface.vertices[frame], surface, result.grid.fixed, camera)
    draw_collisions(ax, result, frame, camera)
    if result.scatter is not None and frame in (-1, len(surface.vertices) - 1):
        draw_band(ax, result.scatter, camera)


def draw_collisions(ax: Axes, result: Result, frame: int, camera: Camera) -> None:
    """Mark where parts have met by a frame."""
    frame %= len(result.joints)
    for one in result.collisions:
        if one.first <= frame:
            x, y = camera.see(collision_place(result, one, frame))[:2]
            ax.plot(x, y, "o", ms=9, mfc="none", mec=style.COLLISION, mew=1.1, zorder=3)


def draw_ghost(ax: Axes, surface: Skin, camera: Camera) -> None:
    """Draw the flat grid in light grey beneath all else."""
    corners = surface.vertices[0][surface.quads]
    top = _normals(corners)[:, 2] > 0.5
    projected = camera.see(corners)[..., :2]
    draw: Any = ax.add_collection
    fill: dict[str, Any] = {"facecolors": style.GHOST, "edgecolors": style.GHOST, "linewidths": 0.4}
    draw(PolyCollection(list(projected[top]), zorder=1, **fill))
    lines = _sharp_edges(projected, surface.sharp & top[:, None])
    line: dict[str, Any] = {"facecolors": "none", "edgecolors": style.GHOST_LINE, "linewidths": 0.5}
    draw(PolyCollection(list(lines), closed=False, zorder=1.1, **line))


def draw_skin(
    ax: Axes,
    vertices: Array,
    surface: Skin,
    fixed: int,
    camera: Camera,
    colours: Array | None = None,
) -> PolyCollection:
    """Draw a skin with its vertices (V, 3) where they are now, and return what was drawn."""
    faces, rgb, lines, order = painted(vertices, surface, fixed, camera, colours)
    ink = np.array(to_rgb(style.INK))
    shapes = [*faces, *lines]
    fill = np.concatenate([np.c_[rgb, np.ones(len(rgb))], np.zeros((len(lines), 4))])
    # A face's own colour around it closes the hairlines between neighbours.
    rims = np.concatenate([rgb, np.tile(ink, (len(lines), 1))])
    widths = np.repeat([RIM, EDGE], [len(rgb), len(lines)])
    drawn = PolyCollection(
        [shapes[k] for k in order],
        facecolors=fill[order],
        edgecolors=rims[order],
        linewidths=widths[order],
        joinstyle="round",
        capstyle="round",
        zorder=2,
    )
    ax.add_collection(drawn, autolim=False)
    return drawn


def painted(
    vertices: Array,
    surface: Skin,
    fixed: int,
    camera: Camera,
    colours: Array | None = None,
) -> tuple[Array, Array, Array, NDArray[np.int64]]:
    """Return what a painter draws of a skin.

    Args:
        vertices: (V, 3) where its vertices are now.
        surface: the skin.
        fixed: the fixed joint.
        camera: where the viewer is.
        colours: (Q, 3) of the quadrilaterals; None: those of joints and actuators.

    Returns:
        faces (Q, 4, 2) that are turned to the viewer, mm to the right and up; their colours (Q, 3);
        edges (E, 2, 2); and the order in which to draw faces and edges, numbered after the faces.
    """
    corners = vertices[surface.quads]
    normals = _normals(corners)
    front = normals @ camera.axes[2] > 0
    corners, normals = corners[front], normals[front]
    if colours is None:
        colours = style.colours(surface.ratio, surface.joint, fixed)
    rgb = colours[front] * camera.light(normals)[:, None]
    projected = camera.see(corners)

    sharp = _outlined(surface, front)[front]
    lines = _sharp_edges(projected, sharp)
    depth = projected[..., 2].mean(axis=1)
    above = np.maximum(lines[..., 2].mean(axis=1), depth[np.nonzero(sharp)[0]]) + LIFT
    order = np.argsort(np.concatenate([depth, above]))
    return projected[..., :2], rgb, lines[..., :2], order


def extent(
    surface: Skin, camera: Camera, frames: list[int], spread: Spread | None = None
) -> tuple[Array, Array]:
    """Return the lower left and upper right corner (2,) of what frames and prints cover, mm."""
    projected = camera.see(surface.vertices[frames])[..., :2].reshape(-1, 2)
    if spread is not None:
        projected = np.concatenate([projected, bands(spread, camera).reshape(-1, 2)])
    return projected.min(axis=0), projected.max(axis=0)


def draw_triad(ax: Axes, x: float, y: float, length: float, camera: Camera) -> None:
    """Draw the directions of x, y and z from the point (x, y) of the picture."""
    for name, tip in zip("xyz", camera.see(np.eye(3))[:, :2] * length, strict=True):
        ax.annotate(
            "",
            (x + tip[0], y + tip[1]),
            (x, y),
            arrowprops={
                "arrowstyle": "-|>,head_width=.12,head_length=.25",
                "lw": 0.7,
                "color": style.INK,
                "shrinkA": 0,
                "shrinkB": 0,
            },
            annotation_clip=False,
        )
        at_x, at_y = np.array([x, y]) + tip[:2] * 1.3
        ax.text(
            at_x,
            at_y,
            name,
            fontsize=7,
            fontstyle="italic",
            ha="center",
            va="center_baseline",
            clip_on=False,
        )


def dimensions(result: Result) -> str:
    """Return the words beneath a deformed picture."""
    numbers = summary(result)
    low, high = numbers["lowest_mm"], numbers["highest_mm"]
    text = (
        f"dimension {numbers['dimension_mm']:.0f} mm, height {high - low:.1f} mm "
        f"(z {low:+.1f} to {high:+.1f} mm)"
    )
    return text.replace("-", "\N{MINUS SIGN}")


def qualified(result: Result) -> list[str]:
    """Return in few words what qualifies an answer, for the line beneath its picture."""
    words = [] if result.stable else ["unstable balance"]
    if result.snaps:
        words.append("snaps at " + ", ".join(f"{snap.released:.0%}" for snap in result.snaps))
    if result.bound_mm is not None:
        words.append(f"error below {result.bound_mm:.2f} mm (9 of 10)")
    spread = result.scatter
    if spread is not None:
        band = "" if spread.lines is None else "; purple band: 9 of 10"
        sizes = " and ".join(map(str, spread.groups))
        shapes = f"come to {len(spread.groups)} shapes ({sizes}) and " if spread.groups else ""
        words.append(
            f"{spread.prints} prints {shapes}differ by {spread.overall:.1f} mm "
            f"({spread.percent:.1f} %{'' if shapes else ', standard deviation'}){band}"
        )
    if result.collisions:
        count = len(result.collisions)
        more = f" and {count - 1} more" if count > 1 else ""
        words.append(f"collides: {collision_text(result.collisions[0])}{more}")
    said = ("snap", "beams-pass")
    others = [message for message in result.warnings if message.code not in said]
    if len(others) == 1:
        words.append(others[0].message)
    elif others:
        words.append(f"{len(others)} warnings")
    return words


def deformed(
    result: Result, frame: int = -1, camera: Camera = Camera(), width: float = 5.2
) -> Figure:
    """Return the picture of a deformed grid.

    Args:
        result: what to show.
        frame: which frame; the last by default.
        camera: where the viewer is.
        width: of the figure, inches.
    """
    surface = skin(result, SPACING)
    low, high = extent(surface, camera, [0, frame], result.scatter)
    fig = Figure(figsize=(width, width), dpi=style.DPI)
    ax, inch = style.footed(fig, low, high)
    draw_deformed(ax, result, surface, frame, camera)
    draw_triad(ax, high[0] - 0.2 * inch, low[1] - 0.15 * inch, 0.22 * inch, camera)
    style.words(fig, dimensions(result))
    style.remark(fig, qualified(result))
    style.legend(fig)
    return style.ink(fig)


def _outlined(surface: Skin, front: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return which edges (Q, 4) are drawn: the sharp ones, and where a strip turns away."""
    sharp = surface.sharp.copy()
    first, second = surface.quads[:-1], surface.quads[1:]
    turns = (first[:, 3] == second[:, 0]) & (front[:-1] != front[1:])
    sharp[:-1, 2] |= turns
    sharp[1:, 0] |= turns
    return sharp


def _normals(corners: Array) -> Array:
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    # A face of no area has no normal, and is not drawn.
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)


def _sharp_edges(corners: Array, sharp: NDArray[np.bool_]) -> Array:
    """Return the sharp edges (E, 2, d) of quadrilaterals with corners (Q, 4, d)."""
    quad, k = np.nonzero(sharp)
    return np.stack([corners[quad, k], corners[quad, (k + 1) % 4]], axis=1)

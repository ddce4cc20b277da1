"""What is wanted, drawn: points, surfaces, curves and planes, and how far vertices are from them.

A target that is a point is a green ring with a dot; a line leads to it from the vertex that is
wanted there. Surfaces and planes are a light green net near the shape, curves a green line; the dot
where a vertex should be on them is the darker the farther it is away. Bodies that are to be kept
away from are grey.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from simulearn.inverse.clear import ClearOf
from simulearn.inverse.goals import Goals
from simulearn.inverse.kinds import AtPoints, OnSet
from simulearn.palette import TOP
from simulearn.show.camera import Camera
from simulearn.simulate import Skin
from simulearn.surfaces import Curve, Plane, Surface

Array = NDArray[np.float64]

TARGET = "#009e73"  # of Okabe and Ito's palette, as the actuators' colours are
BODY = "#8a8a8a"
AROUND = 0.12  # of the shape's size, by which a surface is drawn beyond it
CELLS = 36  # of the net, along the region that is drawn
LARGEST = 1.5  # cells, that a triangle may be long
MOST = 200_000  # triangles; long thin ones would become too many
NEAR, FAR = to_rgb("#bfe3d6"), to_rgb(TOP)


def placed(surface: Skin, goals: Goals | None, points: Array) -> Skin:
    """Return a skin where it is compared, given the goals' vertices (V, 3) mm of its last frame."""
    if goals is None or goals.pose is None:
        return surface
    return replace(surface, vertices=goals.place(points)(surface.vertices))


def region(skins: Sequence[Skin]) -> Array:
    """Return the box (2, 3) mm in which surfaces are drawn, around the last frames of skins."""
    every = np.concatenate([surface.vertices[-1] for surface in skins])
    low, high = every.min(axis=0), every.max(axis=0)
    margin = AROUND * float(np.linalg.norm(high - low))
    return np.stack([low - margin, high + margin])


def extents(goals: Goals, box: Array, camera: Camera) -> tuple[Array, Array]:
    """Return the lower left and upper right corner (2,) of what is drawn of goals, mm."""
    points = [goals.targets]
    for shape, _ in _shapes(goals):
        drawn = _net(shape, box)
        points.append(drawn.points if isinstance(drawn, Curve) else drawn.reshape(-1, 3))
    every = np.concatenate(points)
    if not len(every):  # nothing but relations: what is drawn of them lies at the shape
        every = box
    seen = camera.see(every)[:, :2]
    return seen.min(axis=0), seen.max(axis=0)


def draw_sets(ax: Axes, goals: Goals, box: Array, camera: Camera) -> None:
    """Draw the surfaces, curves and planes of goals, and bodies, lightly beneath the shape."""
    for shape, body in _shapes(goals):
        drawn = _net(shape, box)
        colour = BODY if body else TARGET
        if isinstance(drawn, Curve):
            line = camera.see(drawn.points)[:, :2]
            ax.plot(*line.T, color=colour, lw=1.1, zorder=4, clip_on=False)
        elif len(drawn):
            _draw_net(ax, drawn, colour, camera)


def draw_goals(
    ax: Axes, goals: Goals, points: Array, camera: Camera, size: float = 5.0
) -> list[Any]:
    """Draw targets, and lines to where their vertices are (V, 3); return what was drawn."""
    drawn: list[Any] = []
    for part, at in goals.slices():
        lines = part.wanted.lines(goals.placed(points)[at])
        if not len(lines):
            continue
        seen = camera.see(lines)[..., :2]
        if isinstance(part.wanted, AtPoints):
            drawn += _draw_points(ax, seen, size)
        elif isinstance(part.wanted, OnSet):
            away = np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1)
            drawn += _draw_feet(ax, seen, away / max(float(away.max()), 1e-9), size)
        else:
            drawn += [ax.plot(*line.T, color=TARGET, lw=1.4, zorder=6)[0] for line in seen]
    return drawn


def _draw_points(ax: Axes, seen: Array, size: float) -> list[Any]:
    drawn: list[Any] = []
    for line in seen:
        drawn += ax.plot(*line.T, color=TARGET, lw=1.1, zorder=5)
    ring: dict[str, Any] = {"ls": "none", "marker": "o", "color": TARGET, "clip_on": False}
    there = seen[:, 1]
    drawn += ax.plot(*there.T, ms=size, mfc="none", mew=1.0, zorder=6, **ring)
    drawn += ax.plot(*there.T, ms=0.28 * size, mew=0, zorder=6, **ring)
    return drawn


def _draw_feet(ax: Axes, seen: Array, share: Array, size: float) -> list[Any]:
    """Draw lines (K, 2, 2) to the closest points, and those as dots, by their share of the most."""
    shades = np.array(NEAR) + share[:, None] * (np.array(FAR) - NEAR)
    lines = LineCollection(list(seen), colors=shades, linewidths=1.4, zorder=5)
    ax.add_collection(lines, autolim=False)
    dots = ax.scatter(
        seen[:, 1, 0],
        seen[:, 1, 1],
        s=(0.75 * size) ** 2,
        c=shades,
        edgecolors=TARGET,
        linewidths=0.7,
        zorder=6,
        clip_on=False,
    )
    return [lines, dots]


def _shapes(goals: Goals) -> list[tuple[Surface | Curve | Plane, bool]]:
    """Return the sets of goals, each once, and whether it is a body."""
    found: dict[int, tuple[Any, bool]] = {}
    for part in goals.parts:
        if isinstance(part.wanted, OnSet):
            found[id(part.wanted.set)] = part.wanted.set, False
        elif isinstance(part.wanted, ClearOf):
            found[id(part.wanted.surface)] = part.wanted.surface, True
    return list(found.values())


def _net(shape: Surface | Curve | Plane, box: Array) -> Any:
    """Return what is drawn of a set within a box (2, 3): polygons (K, 3 or 4, 3), or the curve."""
    if isinstance(shape, Curve):
        return shape
    size = float(np.linalg.norm(box[1] - box[0]))
    if isinstance(shape, Plane):
        return _of_plane(shape, box.mean(axis=0), size / 2)
    return _coarse(shape, box, size / CELLS)


def _of_plane(plane: Plane, middle: Array, reach: float) -> Array:
    centre = plane.closest(middle[None])[0][0]
    u = np.cross(plane.normal, np.eye(3)[np.abs(plane.normal).argmin()])
    u /= np.linalg.norm(u)
    v = np.cross(plane.normal, u)
    t = np.linspace(-reach, reach, 9) * 0.7
    grid = centre + t[:, None, None] * u + t[None, :, None] * v
    corners = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    return np.stack(corners, axis=2).reshape(-1, 4, 3)


def _coarse(surface: Surface, box: Array, cell: float) -> Array:
    """Return triangles (K, 3, 3) of a surface in a box, the vertices of a cell as one."""
    every = surface.vertices[surface.faces]
    large = _longest(every) > LARGEST * cell
    middles = every.mean(axis=1)
    inside = ((middles >= box[0]) & (middles <= box[1])).all(axis=1)
    used, index = np.unique(surface.faces[inside & ~large], return_inverse=True)
    split = _split(every[large], box, LARGEST * cell).reshape(-1, 3)
    index = np.concatenate([index.ravel(), len(used) + np.arange(len(split))])
    places = np.concatenate([surface.vertices[used], split])
    _, of = np.unique(np.floor(places / cell).astype(np.int64), axis=0, return_inverse=True)
    of = of.ravel()
    count = np.bincount(of)
    means = np.stack([np.bincount(of, column) / count for column in places.T], axis=1)
    corners = of[index.reshape(-1, 3)]
    a, b, c = corners.T
    corners = corners[(a != b) & (b != c) & (c != a)]
    _, first = np.unique(np.sort(corners, axis=1), axis=0, return_index=True)
    triangles: Array = means[corners[first]]
    return triangles


def _split(triangles: Array, box: Array, longest: float) -> Array:
    """Return the parts (N, 3, 3) of large triangles (K, 3, 3) that are in a box, in small ones."""
    done = [np.zeros((0, 3, 3))]
    while 0 < len(triangles) < MOST:
        touching = (triangles.max(axis=1) >= box[0]) & (triangles.min(axis=1) <= box[1])
        triangles = triangles[touching.all(axis=1)]
        small = _longest(triangles) <= longest
        done.append(triangles[small])
        a, b, c = np.moveaxis(triangles[~small], 1, 0)
        ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
        parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        triangles = np.concatenate([np.stack(part, axis=1) for part in parts])
    return np.concatenate(done)


def _longest(triangles: Array) -> Array:
    """Return the longest sides (K,) of triangles (K, 3, 3)."""
    sides: Array = np.linalg.norm(np.roll(triangles, 1, axis=1) - triangles, axis=2).max(axis=1)
    return sides


def _draw_net(ax: Axes, polygons: Array, colour: str, camera: Camera) -> None:
    seen = camera.see(polygons)
    order = np.argsort(seen[..., 2].mean(axis=1))
    across = np.cross(polygons[:, 1] - polygons[:, 0], polygons[:, 2] - polygons[:, 0])
    normals = across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-12)
    normals *= np.where(normals @ camera.axes[2] < 0, -1, 1)[:, None]
    light = camera.light(normals)[:, None]
    fill = (1 - 0.22 * (1 - np.array(to_rgb(colour)))) * (0.55 + 0.45 * light)
    net = PolyCollection(
        [seen[k, :, :2] for k in order],
        facecolors=fill[order],
        edgecolors=(*to_rgb(colour), 0.22),
        linewidths=0.25,
        zorder=1.5,
    )
    ax.add_collection(net, autolim=False)

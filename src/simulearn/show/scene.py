"""Parts in their places and the obstacles around them, as one surface that moves."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from simulearn.assembly import Assembled
from simulearn.rigid import Place
from simulearn.show import style
from simulearn.show.camera import Camera
from simulearn.show.moving import vertices_at
from simulearn.show.solids import solid
from simulearn.simulate import Result, Skin, skin

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

SPACING = 4.0  # mm, length of the quadrilaterals along a beam
MANY = 30_000  # quadrilaterals that are painted in a moment; of more, each is longer
MARGIN = 0.35  # of what the parts cover, as far as obstacles are seen


@dataclass(frozen=True, eq=False)
class Scene:
    """A surface of parts and obstacles.

    Attributes:
        parts: which part, its surface, and its place.
        begins: of each part's vertices in the whole, and where the obstacles' begin.
        surface: the whole, in the last frame of all parts.
        rgb: (Q, 3) colours of its quadrilaterals.
        box: corners (2, 2) of what is seen: all parts at all times, and obstacles near them, mm.
        camera: where the viewer is.
    """

    parts: Sequence[tuple[int, Skin, Place]]
    begins: list[int]
    surface: Skin
    rgb: Array
    box: tuple[Array, Array]
    camera: Camera

    def at(self, frames: Array, shifts: Array) -> Array:
        """Return the vertices (V, 3) mm of the whole.

        Args:
            frames: (P,) of the parts.
            shifts: (P, 3) of the parts from their places, mm.
        """
        now = self.surface.vertices[0].copy()
        for (k, surface, place), begin in zip(self.parts, self.begins, strict=False):
            moved = place(vertices_at(surface, float(frames[k]))) + shifts[k]
            now[begin : begin + len(moved)] = moved
        return now


def scene(
    parts: Sequence[tuple[int, Result, Place]],
    obstacles: Mapping[str, Any],
    camera: Camera,
    moments: Sequence[tuple[Array, Array]] = (),
) -> Scene:
    """Return the scene of parts and obstacles.

    Args:
        parts: which part, its result and its place.
        obstacles: surfaces in their places, by their names.
        camera: where the viewer is.
        moments: frames (P,) and shifts (P, 3) mm of the parts that are to be seen besides the end.
    """
    results = {id(result): result for _, result, _ in parts}
    skins = {key: skin(result, SPACING) for key, result in results.items()}
    total = sum(len(skins[id(result)].quads) for _, result, _ in parts)
    if total > MANY:
        longer = SPACING * total / MANY
        skins = {key: skin(result, longer) for key, result in results.items()}
    placed = [(k, skins[id(result)], place) for k, result, place in parts]
    shapes = [_still(surface, place(surface.vertices[-1])) for _, surface, place in placed]
    colours = [
        style.colours(s.ratio, s.joint, result.grid.fixed)
        for (_, s, _), (_, result, _) in zip(placed, parts, strict=True)
    ]
    begins = np.cumsum([0, *(shape.vertices.shape[1] for shape in shapes)]).tolist()
    made = Scene(placed, begins, _joined(shapes), np.concatenate(colours), _nothing(), camera)
    low, high = _box([made.surface.vertices[0], *(made.at(*m) for m in moments)], camera)
    if not obstacles:
        return Scene(placed, begins, made.surface, made.rgb, (low, high), camera)
    rim = MARGIN * float(max(high - low))
    solids = [solid(o.vertices, o.faces, max(rim / 15, SPACING)) for o in obstacles.values()]
    solids = [_inside(one, low - rim, high + rim, camera) for one in solids]
    around = [
        _box([one.vertices[0][one.quads].reshape(-1, 3)], camera)
        for one in solids
        if len(one.quads)
    ]
    low = np.min([low, *(np.maximum(a, low - rim) for a, _ in around)], axis=0)
    high = np.max([high, *(np.minimum(b, high + rim) for _, b in around)], axis=0)
    wood = np.tile(to_rgb(style.SOLID), (sum(len(one.quads) for one in solids), 1))
    whole = _joined([made.surface, *solids])
    return Scene(placed, begins, whole, np.concatenate([made.rgb, wood]), (low, high), camera)


def scene_of(
    assembled: Assembled, camera: Camera, moments: Sequence[tuple[Array, Array]] = ()
) -> Scene:
    """Return the scene of an assembly; see `scene`."""
    parts = [(k, result, part.place) for k, part, result in assembled.present]
    return scene(parts, assembled.obstacles, camera, moments)


def _still(surface: Skin, vertices: Array) -> Skin:
    return Skin(vertices[None], surface.quads, surface.ratio, surface.joint, surface.sharp)


def _joined(skins: Sequence[Skin]) -> Skin:
    """Return surfaces of one frame as one."""
    begins = np.cumsum([0, *(one.vertices.shape[1] for one in skins)])
    return Skin(
        vertices=np.concatenate([one.vertices for one in skins], axis=1),
        quads=np.concatenate([s.quads + k for s, k in zip(skins, begins, strict=False)]),
        ratio=np.concatenate([one.ratio for one in skins]),
        joint=np.concatenate([one.joint for one in skins]),
        sharp=np.concatenate([one.sharp for one in skins]),
    )


def _inside(surface: Skin, low: Array, high: Array, camera: Camera) -> Skin:
    """Return those triangles of a solid that lie within a part (2,) of the picture."""
    seen = camera.see(surface.vertices[0])[surface.quads, :2]
    inside = ((seen > low) & (seen < high)).all(axis=(1, 2))
    return Skin(
        surface.vertices,
        surface.quads[inside],
        surface.ratio[inside],
        surface.joint[inside],
        surface.sharp[inside],
    )


def _box(shapes: Sequence[Array], camera: Camera) -> tuple[Array, Array]:
    seen = [camera.see(points)[:, :2] for points in shapes]
    low: Array = np.min([points.min(axis=0) for points in seen], axis=0)
    high: Array = np.max([points.max(axis=0) for points in seen], axis=0)
    return low, high


def _nothing() -> tuple[Array, Array]:
    return np.zeros(2), np.zeros(2)

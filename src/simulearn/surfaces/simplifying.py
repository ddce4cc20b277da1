"""Surfaces with fewer triangles: vertices of one cell of a lattice become one.

The one vertex lies where the squared distances to the planes of the triangles that met in the cell
are least, so flat parts stay flat, edges stay sharp and rims stay where they are. Sources:
Lindstrom, Out-of-core simplification of large polygonal models, SIGGRAPH 2000; the distances:
Garland and Heckbert, Surface simplification using quadric error metrics, SIGGRAPH 1997.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.surfaces.mending import mended
from simulearn.surfaces.surface import Surface

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

FEW = 1e-3  # of the greatest curvature, below which a direction has none and the mean place is kept
HALVINGS = 9  # of the range in which the number of cells is looked for


def simplified(surface: Surface, most: int) -> tuple[Surface, float]:
    """Return a surface of few triangles, and how far the two are apart (mm).

    Args:
        surface: with any number of triangles; it is returned itself where it has few.
        most: triangles.

    Raises:
        InputError: nothing is left of it with so few.
    """
    if len(surface.faces) <= most:
        return surface, 0.0
    low, high = 1, 4 * round(float(np.sqrt(most)))  # cells along the longest side
    best: tuple[Array, Indices] | None = None
    for _ in range(HALVINGS):
        cells = (low + high + 1) // 2
        tried = _clustered(surface, cells)
        if len(tried[1]) <= most:
            low, best = cells, tried
        else:
            high = cells - 1
        if low >= high:
            break
    if best is None or not len(best[1]):
        text = f"has {len(surface.faces):,} triangles, and nothing is left of it with {most:,}"
        raise InputError(text, "surface-many", "surface")
    vertices, faces, _ = mended(*best)
    made = replace(surface, vertices=vertices, faces=faces)
    apart = max(
        float(made.distance(surface.vertices).max()), float(surface.distance(vertices).max())
    )
    return made, apart


def _clustered(surface: Surface, cells: int) -> tuple[Array, Indices]:
    """Return vertices and faces, with so many cells along the longest side."""
    vertices, faces = surface.vertices, surface.faces
    low, high = surface.box
    size = float((high - low).max()) / cells
    place = np.floor((vertices - low) / size).astype(np.int64)
    _, cell = np.unique(place @ [1, 1 << 20, 1 << 40], return_inverse=True)
    count = int(cell.max()) + 1
    sums = np.stack([np.bincount(cell, x, count) for x in vertices.T], axis=1)
    mean: Array = sums / np.bincount(cell, minlength=count)[:, None]
    points = mean + _towards_planes(surface, cell, mean, size)
    kept = cell[faces]
    a, b, c = kept.T
    kept = kept[(a != b) & (b != c) & (c != a)]
    _, first = np.unique(np.sort(kept, axis=1), axis=0, return_index=True)
    return points, kept[np.sort(first)]


def _towards_planes(surface: Surface, cell: Indices, mean: Array, size: float) -> Array:
    """Return by how much (C, 3) the one vertex of each cell is away from the mean of all."""
    normals, anchors, corners = _planes(surface)
    A = np.zeros((len(mean), 3, 3))
    b = np.zeros((len(mean), 3))
    for corner in corners.T:
        at = cell[corner]
        off = np.einsum("tk,tk->t", normals, anchors - mean[at])
        np.add.at(A, at, normals[:, :, None] * normals[:, None, :])
        np.add.at(b, at, normals * off[:, None])
    values, axes = np.linalg.eigh(A)
    steep = values > FEW * values[:, -1:]
    share = np.where(steep, 1 / np.where(steep, values, 1.0), 0.0)
    by: Array = np.einsum("cij,cj,ckj,ck->ci", axes, share, axes, b)
    return np.where(np.abs(by).max(axis=1, keepdims=True) < size, by, 0.0)


def _planes(surface: Surface) -> tuple[Array, Array, Indices]:
    """Return planes: normals (P, 3) as long as they count, points on them, vertices (P, 3) of them.

    They are those of the triangles, and across them through the edges of rims.
    """
    vertices, faces = surface.vertices, surface.faces
    first, second, third = np.moveaxis(vertices[faces], 1, 0)
    across = np.cross(second - first, third - first)
    weight = np.linalg.norm(across, axis=1, keepdims=True)
    ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    of = np.tile(np.arange(len(faces)), 3)
    key = ends.min(axis=1) * len(vertices) + ends.max(axis=1)
    _, index, many = np.unique(key, return_index=True, return_counts=True)
    rim = index[many == 1]
    along = vertices[ends[rim, 1]] - vertices[ends[rim, 0]]
    upright = np.cross(along, surface.normals[of[rim]])
    return (
        np.concatenate([across / np.sqrt(np.maximum(weight, 1e-300)), upright]),
        np.concatenate([first, vertices[ends[rim, 0]]]),
        np.concatenate([faces, np.c_[ends[rim], ends[rim, :1]]]),
    )

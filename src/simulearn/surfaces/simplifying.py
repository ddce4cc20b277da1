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
    best: tuple[Indices, Indices] | None = None
    while low < high or best is None:
        cells = (low + high + 1) // 2
        tried = _clustered(surface, cells)
        if 0 < len(tried[1]) <= most:
            low, best = cells, tried
        elif low == high:
            text = f"has {len(surface.faces):,} triangles, and nothing is left of it with {most:,}"
            raise InputError(text, "surface-many", "surface")
        else:
            high = cells - 1
    cell, faces = best
    vertices, faces, _ = mended(_middles(surface, cell, low), faces)
    made = replace(surface, vertices=vertices, faces=faces)
    apart = max(
        float(made.distance(surface.vertices).max()), float(surface.distance(vertices).max())
    )
    return made, apart


def _clustered(surface: Surface, cells: int) -> tuple[Indices, Indices]:
    """Return the cell (V,) of each vertex, and the faces (T, 3) among cells.

    Args:
        surface: of V vertices.
        cells: along the longest side.
    """
    place = np.floor((surface.vertices - surface.box[0]) / _size(surface, cells)).astype(np.int64)
    _, cell = np.unique(place @ [1, 1 << 20, 1 << 40], return_inverse=True)
    kept = cell[surface.faces]
    a, b, c = kept.T
    kept = kept[(a != b) & (b != c) & (c != a)]
    count = int(cell.max()) + 1
    low, middle, high = np.sort(kept, axis=1).T
    _, first = np.unique((low * count + middle) * count + high, return_index=True)
    return cell, kept[np.sort(first)]


def _size(surface: Surface, cells: int) -> float:
    return float(np.diff(surface.box, axis=0).max()) / cells


def _middles(surface: Surface, cell: Indices, cells: int) -> Array:
    """Return the one vertex (C, 3) of each cell, nearest to the planes that meet there."""
    count = int(cell.max()) + 1

    def total(at: Indices, values: Array) -> Array:
        flat = values.reshape(len(values), -1).T
        sums = np.asarray([np.bincount(at, x, count) for x in flat], np.float64)
        return sums.T.reshape(count, *values.shape[1:])

    mean = total(cell, surface.vertices) / np.bincount(cell)[:, None]
    normals, anchors, corners = _planes(surface)
    A, b = np.zeros((count, 3, 3)), np.zeros((count, 3))
    for corner in corners.T:
        at = cell[corner]
        off = np.einsum("tk,tk->t", normals, anchors - mean[at])
        A += total(at, normals[:, :, None] * normals[:, None, :])
        b += total(at, normals * off[:, None])
    values, axes = np.linalg.eigh(A)
    steep = values > FEW * values[:, -1:]
    share = np.where(steep, 1 / np.where(steep, values, 1.0), 0.0)
    by: Array = np.einsum("cij,cj,ckj,ck->ci", axes, share, axes, b)
    near = np.abs(by).max(axis=1, keepdims=True) < _size(surface, cells)
    return mean + np.where(near, by, 0.0)


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

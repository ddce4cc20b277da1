"""A chart of a triangle mesh: an open patch with four corners, or a tube.

Both parameters are harmonic. Those of a patch go evenly along its four sides. Those of a tube go
from one rim to the other, and once around it: a cut from rim to rim tells which triangles lie
beyond a full turn, but the parameters do not see it. Cotangent weights are kept positive, so that
no triangle of a patch is turned over (Tutte 1963; Floater, "One-to-one piecewise linear mappings",
2003).
"""

from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components, dijkstra
from scipy.sparse.linalg import splu

from simulearn.errors import InputError
from simulearn.surfaces import Surface
from simulearn.tile.charts import Chart

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

LEAST = 1e-3  # of a cotangent weight
ALONG_RIM = 1e3  # times the length of an edge, so that a cut leaves a rim at once
STEP = 0.01  # of a parameter, over which directions are taken
HINT = "cut it in a modelling program, or draw a quad mesh with a quad for each module"


def unrolled(surface: Surface) -> Chart:
    """Return the chart of a surface; u is the longer way over a patch, or goes around a tube.

    Raises:
        InputError: it is neither a patch with one rim nor a tube with two.
    """
    faces = _one_part(surface)
    rims, euler = _rims(faces)
    if len(rims) not in (1, 2):
        what = "is closed and has no rim" if not rims else f"has {len(rims)} rims"
        text = f"the surface {what}; a patch with one or a tube with two can be tiled. Else {HINT}"
        raise InputError(text, "surface-rims", "surface")
    corners = surface.vertices[faces]
    if euler != 2 - len(rims):
        text = f"the surface has a handle; a patch or a tube can be tiled. Else {HINT}"
        raise InputError(text, "surface-rims", "surface")
    uv = _patch(surface.vertices, faces, rims[0]) if len(rims) == 1 else None
    if uv is None:
        uv = _tube(surface.vertices, faces, *rims)
    return _chart(corners, uv, closed=len(rims) == 2)


def _chart(corners: Array, uv: Array, closed: bool) -> Chart:
    """Return the chart of triangles (T, 3, 3) mm with parameters (T, 3, 2)."""
    if closed:  # the same triangles a turn before and after
        uv = np.concatenate([uv + np.array([k, 0.0]) for k in (-1, 0, 1)])
        corners = np.concatenate([corners] * 3)
    flat = np.concatenate([uv, np.zeros((*uv.shape[:2], 1))], axis=-1)
    sheet = Surface(flat.reshape(-1, 3), np.arange(3 * len(flat)).reshape(-1, 3))
    a = flat[:, 0, :2]
    sides = np.stack([flat[:, 1, :2] - a, flat[:, 2, :2] - a], axis=-1)
    inverse = np.linalg.pinv(sides)

    def at(u: Array, v: Array) -> Array:
        u = u - np.floor(u) if closed else u
        places, _, face = sheet.closest(np.stack([u, v, np.zeros_like(u)], axis=1))
        p, q = np.einsum("nij,nj->in", inverse[face], places[:, :2] - a[face])
        own = corners[face]
        weights = np.stack([1 - p - q, p, q], axis=1)
        points: Array = np.einsum("nk,nkc->nc", weights, own)
        return points

    return Chart(at, (closed, False), STEP)


def _one_part(surface: Surface) -> Indices:
    """Return the faces, all of which belong together."""
    count = len(surface.vertices)
    a, b = surface.faces[:, [0, 1, 2]].ravel(), surface.faces[:, [1, 2, 0]].ravel()
    links = coo_array((np.ones(len(a)), (a, b)), shape=(count, count))
    _, part = connected_components(links, directed=False)
    sizes = np.bincount(part[surface.faces[:, 0]], minlength=part.max() + 1)
    if np.count_nonzero(sizes) > 1:
        text = f"the surface is in {np.count_nonzero(sizes)} pieces; one of them can be tiled"
        raise InputError(text, "surface-pieces", "surface")
    return surface.faces


def _rims(faces: Indices) -> tuple[list[Indices], int]:
    """Return the rims as loops of vertices, along their faces, and Euler's characteristic.

    Raises:
        InputError: faces meet oddly.
    """
    a, b = faces[:, [0, 1, 2]].ravel(), faces[:, [1, 2, 0]].ravel()
    key = np.minimum(a, b) * (int(faces.max()) + 1) + np.maximum(a, b)
    edges, edge, many = np.unique(key, return_inverse=True, return_counts=True)
    if (np.abs(np.bincount(edge, np.where(a < b, 1, -1))) != (many == 1)).any():
        text = f"three faces meet at an edge of the surface, or one is turned over; {HINT}"
        raise InputError(text, "surface-rims", "surface")
    open_ = many[edge] == 1
    after = dict(zip(a[open_].tolist(), b[open_].tolist(), strict=True))
    if len(after) < np.count_nonzero(open_):
        raise InputError(f"two rims of the surface touch; {HINT}", "surface-rims", "surface")
    rims = []
    while after:
        start, now = next(iter(after.items()))
        loop = [start]
        del after[start]
        while now != start:
            loop.append(now)
            now = after.pop(now)
        rims.append(np.array(loop))
    return rims, len(np.unique(faces)) - len(edges) + len(faces)


def _patch(vertices: Array, faces: Indices, rim: Indices) -> Array:
    """Return the parameters (T, 3, 2) of a patch with one rim."""
    loop = vertices[rim]
    turns = _corners(loop)
    # The first side is a long one, the one that runs most along +x or, else, +y.
    best = max(range(4), key=lambda k: _liking(loop, turns, k))
    turns = np.roll(turns, -best)
    rim, turns = np.roll(rim, -turns[0]), (turns - turns[0]) % len(rim)
    square = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1], [0, 0]])
    fixed = np.zeros((len(rim), 2))
    ends = [*turns, len(rim)]
    for k in range(4):
        side = np.arange(ends[k], ends[k + 1] + 1)
        line = vertices[rim[side % len(rim)]]
        share = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1)))
        share /= share[-1]
        places = square[k] + share[:, None] * (square[k + 1] - square[k])
        fixed[side[:-1]] = places[:-1]
    return _harmonic(_weights(vertices, faces), rim, fixed)[faces]


def _corners(loop: Array) -> Indices:
    """Return the four points of a rim (N, 3) that are nearest to the corners of a rectangle."""
    middle = loop.mean(axis=0)
    axes = np.linalg.svd(loop - middle, full_matrices=False)[2][:2]
    flat = (loop - middle) @ axes.T
    box = shapely.minimum_rotated_rectangle(shapely.MultiPoint(flat))
    corners = shapely.get_coordinates(box)[:4]
    if len(corners) < 4:
        raise InputError(f"the surface's rim is a line; {HINT}", "surface-rims", "surface")
    away = np.linalg.norm(flat[:, None] - corners[None], axis=-1)
    found = np.sort(away.argmin(axis=0))
    if len(np.unique(found)) < 4:
        text = f"the surface's rim has no four corners; {HINT}"
        raise InputError(text, "surface-rims", "surface")
    return found


def _liking(loop: Array, turns: Indices, k: int) -> tuple[bool, float]:
    """Return how well a side begins the parameters: a longer pair of sides, along +x or +y."""
    ends = loop[turns]
    sides = np.roll(ends, -1, axis=0) - ends
    length = np.linalg.norm(sides, axis=1)
    longer = length[k] + length[(k + 2) % 4] >= length[(k + 1) % 4] + length[(k + 3) % 4] - 1e-6
    return bool(longer), float(sides[k] @ [1.0, 0.5, 0.25])


def _tube(vertices: Array, faces: Indices, one: Indices, other: Indices) -> Array:
    """Return the parameters (T, 3, 2) of a tube between two rims."""
    ends = vertices[one].mean(axis=0), vertices[other].mean(axis=0)
    if (ends[1] - ends[0]) @ [0.25, 0.5, 1.0] < 0:  # from below to above
        one, other = other, one
    weights = _weights(vertices, faces)
    rims = np.concatenate([one, other])
    v = _harmonic(weights, rims, np.r_[np.zeros(len(one)), np.ones(len(other))])
    beyond = _beyond(vertices, faces, one, other)
    u = _around(vertices, faces, beyond, int(one[0]))
    return np.stack([u[faces] + beyond, v[faces]], axis=-1)


def _beyond(vertices: Array, faces: Indices, one: Indices, other: Indices) -> Array:
    """Return which corners (T, 3) lie at the end of a turn: 1.0, else 0.0; a cut from rim to rim.

    Seen from outside with the second rim above, the left side of the cut is the end of a turn.
    """
    start, end = np.array([0, 1, 2]), np.array([1, 2, 0])
    a, b = faces[:, start].ravel(), faces[:, end].ravel()
    size = np.linalg.norm(vertices[b] - vertices[a], axis=1)
    count = len(vertices)
    on_rim = np.zeros(count, dtype=bool)
    on_rim[one] = on_rim[other] = True
    size = size * np.where(on_rim[a] & on_rim[b], ALONG_RIM, 1.0)
    graph = csr_array((np.r_[size, size], (np.r_[a, b], np.r_[b, a])), shape=(count, count))
    away, before = dijkstra(graph, indices=int(one[0]), return_predecessors=True)
    path = [int(other[away[other].argmin()])]
    while path[-1] != one[0]:
        path.append(int(before[path[-1]]))
    path = path[::-1]
    cut = set(pairwise(path))
    # Corners of one vertex are joined where their faces share an edge that is not cut.
    owner = {(int(p), int(q)): k for k, (p, q) in enumerate(zip(a, b, strict=True))}
    rows, columns = [], []
    for (p, q), k in owner.items():
        m = owner.get((q, p))
        if m is None or (p, q) in cut or (q, p) in cut:
            continue
        here, there = 3 * (k // 3), 3 * (m // 3)
        rows += [here + start[k % 3], here + end[k % 3]]
        columns += [there + end[m % 3], there + start[m % 3]]
    joined = coo_array((np.ones(len(rows)), (rows, columns)), shape=(faces.size, faces.size))
    _, part = connected_components(joined, directed=False)
    left = set()
    for p, q in cut:
        k = owner[p, q]  # of the face to the left
        left |= {part[3 * (k // 3) + start[k % 3]], part[3 * (k // 3) + end[k % 3]]}
    mask: Array = np.isin(part, list(left)).astype(float).reshape(-1, 3)
    return mask


def _around(vertices: Array, faces: Indices, beyond: Array, pinned: int) -> Array:
    """Return the harmonic parameter (V,) that grows by 1 around a tube."""
    cotangents = _cotangents(vertices, faces)
    n = len(vertices)
    rows, columns, values, right = [], [], [], np.zeros(n)
    for k in range(3):
        i, j = faces[:, (k + 1) % 3], faces[:, (k + 2) % 3]
        w, jump = cotangents[:, k], beyond[:, (k + 1) % 3] - beyond[:, (k + 2) % 3]
        rows += [i, j, i, j]
        columns += [i, j, j, i]
        values += [w, w, -w, -w]
        np.add.at(right, i, -w * jump)
        np.add.at(right, j, w * jump)
    matrix = coo_array(
        (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=(n, n)
    ).tocsr()
    return _solved(matrix, right, np.array([pinned]), np.zeros(1))


def _weights(vertices: Array, faces: Indices) -> csr_array:
    """Return the Laplacian (V, V) of a mesh with cotangent weights, kept positive."""
    cotangents, n = _cotangents(vertices, faces), len(vertices)
    rows, columns, values = [], [], []
    for k in range(3):
        i, j, w = faces[:, (k + 1) % 3], faces[:, (k + 2) % 3], cotangents[:, k]
        rows += [i, j, i, j]
        columns += [i, j, j, i]
        values += [w, w, -w, -w]
    return coo_array(
        (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=(n, n)
    ).tocsr()


def _cotangents(vertices: Array, faces: Indices) -> Array:
    """Return half the cotangents (T, 3) of the angles, at least LEAST."""
    found = np.empty(faces.shape)
    for k in range(3):
        here = vertices[faces[:, k]]
        a, b = vertices[faces[:, (k + 1) % 3]] - here, vertices[faces[:, (k + 2) % 3]] - here
        across = np.linalg.norm(np.cross(a, b), axis=1)
        found[:, k] = (a * b).sum(axis=1) / np.maximum(across, 1e-300)
    return np.clip(found / 2, LEAST, 1 / LEAST)


def _harmonic(weights: csr_array, fixed: Indices, values: Array) -> Array:
    """Return the harmonic functions (V, ...) with given values at some vertices."""
    return _solved(weights, np.zeros((weights.shape[0], *values.shape[1:])), fixed, values)


def _solved(matrix: csr_array, right: Array, fixed: Indices, values: Array) -> Array:
    """Return the solution (V, ...) of a symmetric system with some values given.

    A vertex that no face has keeps 0.
    """
    x = np.zeros_like(right)
    x[fixed] = values
    free = matrix.diagonal() > 0
    free[fixed] = False
    inner = np.flatnonzero(free)
    if len(inner):
        rest = right[inner] - matrix[inner] @ x
        # Symmetric and positive definite: it needs no pivots, and an order that keeps it sparse.
        factor = splu(
            matrix[inner][:, inner].tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
        x[inner] = factor.solve(rest)
    return x

"""Quad meshes that a person drew: one module for each quad.

Between its corners the surface is smooth: edges are cubic with their ends in the tangent planes of
the vertices (PN patches: Vlachos et al., "Curved PN triangles", 2001), and a quad is the Coons
patch of its four edges. Neighbours share an edge, so they share its joints.
"""

from collections import deque

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from simulearn.errors import InputError, Message
from simulearn.surfaces import Surface
from simulearn.tile.patches import MOST, Cells, Tiling

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

FINE = 12  # pieces of a side, of the triangles that stand for a quad


def from_quads(vertices: Array, quads: Indices, cells: Cells = (2, 2)) -> Tiling:
    """Return the tiling of a quad mesh.

    Args:
        vertices: (V, 3) mm.
        quads: (M, 4) corners in their order around.
        cells: of each module.

    Raises:
        InputError: there are too many quads, one is folded, or they have one side only.
    """
    warnings = []
    _, first = np.unique(np.sort(quads, axis=1), axis=0, return_index=True)
    if len(first) < len(quads):
        text = f"{len(quads) - len(first)} quads were there more than once; one of each is kept"
        warnings.append(Message("quads-twice", "surface", text))
        quads = quads[np.sort(first)]
    if not 1 <= len(quads) <= MOST:
        text = f"there are {len(quads)} quads, each a module; 1 to {MOST} can be tiled"
        raise InputError(text, "modules", "modules")
    _convex(vertices, quads)
    quads, turned = _alike_turned(quads)
    pieces = _pieces(quads)
    normals = vertex_normals(vertices, quads)
    joints = _Joints(vertices, normals, quads, cells)
    if pieces > 1:
        text = f"the quads are in {pieces} pieces without a common edge, and fit each for itself"
        warnings.append(Message("quads-pieces", "surface", text))
    if turned:
        text = f"{turned} quads were turned round, so that all have the same side outside"
        warnings.append(Message("quads-turned", "surface", text))
    return Tiling(
        np.array(joints.points),
        np.array(joints.normals),
        joints.modules,
        cells,
        tuple(f"q{k + 1}" for k in range(len(quads))),
        joints.surface(),
        tuple(warnings),
        drawn=True,
    )


def _convex(vertices: Array, quads: Indices) -> None:
    """Raise InputError where a quad is none that a module can have the form of."""
    for k, quad in enumerate(quads.tolist()):
        name = f"quad {k + 1}"
        if len(set(quad)) < 4:
            text = f"{name} has two corners at one place; a module has four sides"
            raise InputError(text, "quad-folded", name)
        sides = np.roll(vertices[quad], -1, axis=0) - vertices[quad]
        turns = np.cross(np.roll(sides, 1, axis=0), sides)
        if (turns @ turns.T < 0).any():
            text = f"{name} crosses itself or is bent inwards; its corners go around convexly"
            raise InputError(text, "quad-folded", name)


def vertex_normals(vertices: Array, quads: Indices) -> Array:
    """Return unit normals (V, 3): the mean of the quads around, by their areas.

    Raises:
        InputError: a quad has no area.
    """
    a, b, c, d = (vertices[quads[:, k]] for k in range(4))
    across = np.cross(c - a, d - b)
    size = np.linalg.norm(across, axis=1)
    if (size < 1e-9 * max(float(size.max()), 1e-300)).any():
        k = int(size.argmin())
        raise InputError(f"quad {k + 1} has no area", "quad-folded", f"quad {k + 1}")
    normals = np.zeros_like(vertices)
    np.add.at(normals, quads.ravel(), np.repeat(across, 4, axis=0))
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    unit: Array = normals / np.where(length == 0, 1.0, length)
    return unit


class _Joints:
    """The joints of all quads, each once."""

    def __init__(self, vertices: Array, normals: Array, quads: Indices, cells: Cells) -> None:
        self._vertices, self._vertex_normals, self._quads = vertices, normals, quads
        self.points: list[Array] = []
        self.normals: list[Array] = []
        known: dict[tuple[int, ...], int] = {}
        nx, ny = cells
        for number, (a, b, c, d) in enumerate(quads.tolist()):
            for u, v, on in ((a, b, nx), (b, c, ny), (d, c, nx), (a, d, ny)):
                both = known.setdefault((min(u, v), max(u, v)), on)
                if both != on:
                    text = f"quad {number + 1} meets another with {on} beams at {both}"
                    hint = "; cells along both directions must be the same in this mesh"
                    raise InputError(text + hint, "quad-cells", "cells")
        known.clear()
        modules = []
        for number, quad in enumerate(quads.tolist()):
            places, normal = self._patch(number, nx, ny)
            row = []
            for k in range((nx + 1) * (ny + 1)):
                key = _key(quad, k % (nx + 1), k // (nx + 1), nx, ny, number)
                if key not in known:
                    known[key] = len(self.points)
                    self.points.append(places[k])
                    self.normals.append(normal[k])
                row.append(known[key])
            modules.append(row)
        self.modules = np.array(modules)

    def _patch(self, number: int, nx: int, ny: int) -> tuple[Array, Array]:
        """Return places and normals ((nx + 1) (ny + 1), 3) over a quad."""
        a, b, c, d = self._quads[number]
        u, v = (line.ravel() for line in np.meshgrid(*(np.linspace(0, 1, n + 1) for n in (nx, ny))))
        low, high = self._edge(a, b, u), self._edge(d, c, u)
        left, right = self._edge(a, d, v), self._edge(b, c, v)
        p, n = self._vertices, self._vertex_normals
        u, v = u[:, None], v[:, None]

        def bilinear(values: Array) -> Array:
            bottom = (1 - u) * values[a] + u * values[b]
            return (1 - v) * bottom + v * ((1 - u) * values[d] + u * values[c])

        places = (1 - v) * low + v * high + (1 - u) * left + u * right - bilinear(p)
        normal = bilinear(n)
        return places, normal / np.linalg.norm(normal, axis=1, keepdims=True)

    def _edge(self, a: int, b: int, t: Array) -> Array:
        """Return points (N, 3) on an edge, at t (N,) from one vertex to the other."""
        p, n, s = self._vertices, self._vertex_normals, t[:, None]
        along = p[b] - p[a]
        out, into = (along - (along @ n[k]) * n[k] for k in (a, b))
        points: Array = (
            (1 + 2 * s) * (1 - s) ** 2 * p[a]
            + s * (1 - s) ** 2 * out
            + s**2 * (3 - 2 * s) * p[b]
            + s**2 * (s - 1) * into
        )
        return points

    def surface(self) -> Surface:
        """Return the quads as triangles."""
        k = np.arange((FINE + 1) ** 2).reshape(FINE + 1, FINE + 1)
        a, b, c, d = k[:-1, :-1].ravel(), k[:-1, 1:].ravel(), k[1:, 1:].ravel(), k[1:, :-1].ravel()
        faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
        patches = [self._patch(number, FINE, FINE)[0] for number in range(len(self._quads))]
        return Surface(
            np.concatenate(patches),
            np.concatenate([faces + m * (FINE + 1) ** 2 for m in range(len(patches))]),
        )


def _key(quad: list[int], i: int, j: int, nx: int, ny: int, number: int) -> tuple[int, ...]:
    """Return what names a joint: its vertex, its place on an edge, or its quad."""
    a, b, c, d = quad
    corner = {(0, 0): a, (nx, 0): b, (nx, ny): c, (0, ny): d}.get((i, j))
    if corner is not None:
        return (corner,)
    for on, start, end, at, count in (
        (j == 0, a, b, i, nx),
        (j == ny, d, c, i, nx),
        (i == 0, a, d, j, ny),
        (i == nx, b, c, j, ny),
    ):
        if on:
            return (start, end, at) if start < end else (end, start, count - at)
    return (-1, number, i, j)


def _pieces(quads: Indices) -> int:
    """Return in how many parts without a common edge the quads are."""
    count = len(quads)
    edges = np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    edge = np.unique(edges, axis=0, return_inverse=True)[1].ravel()
    joined = coo_array((np.ones(4 * count), (np.repeat(np.arange(count), 4), count + edge)),
                       shape=(count + int(edge.max()) + 1,) * 2)  # fmt: skip
    return int(connected_components(joined, directed=False)[0])


def _alike_turned(quads: Indices) -> tuple[Indices, int]:
    """Return quads that all have the same side outside, and how many were turned for it.

    Raises:
        InputError: they have one side only.
    """
    edges: dict[tuple[int, int], list[tuple[int, bool]]] = {}
    for k, quad in enumerate(quads.tolist()):
        for a, b in zip(quad, quad[1:] + quad[:1], strict=True):
            edges.setdefault((min(a, b), max(a, b)), []).append((k, a < b))
    beside: list[list[tuple[int, bool]]] = [[] for _ in quads]
    for both in edges.values():
        if len(both) == 2:
            (k, one), (m, other) = both
            beside[k].append((m, one == other))
            beside[m].append((k, one == other))
    turned = np.full(len(quads), -1)
    for first in range(len(quads)):
        if turned[first] >= 0:
            continue
        turned[first], queue, part = 0, deque([first]), [first]
        while queue:
            k = queue.popleft()
            for m, against in beside[k]:
                if turned[m] < 0:
                    turned[m] = turned[k] ^ int(against)
                    queue.append(m)
                    part.append(m)
                elif turned[m] != turned[k] ^ int(against):
                    text = "the quads have one side only, as a Moebius strip; cut them somewhere"
                    raise InputError(text, "quads-one-sided", "surface")
        if 2 * turned[part].sum() > len(part):
            turned[part] = 1 - turned[part]
    # The first corner stays where it is, so that a module keeps its directions.
    flipped = quads[:, [0, 3, 2, 1]]
    return np.where(turned[:, None] == 1, flipped, quads), int(turned.sum())

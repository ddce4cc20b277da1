"""Triangles of a file, mended: what cannot be used is left out, flipped ones are turned.

Which faces are turned is found without walking: each face is there twice, as it is and turned. Two
that meet at an edge are joined as they are if they run along it in opposite directions, else each
with the other one turned. Faces that belong together are then the connected parts.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from simulearn.errors import InputError, Message
from simulearn.surfaces.surface import Surface
from simulearn.surfaces.tree import Tree

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Mask = NDArray[np.bool_]

FLAT = 1e-12  # of the squared size of the surface; a triangle of less area has no direction
SEAM = 1e-7  # of the size; vertices of two edges that are nearer are one
FARTHEST = 1e9  # mm or what the unit of the file is
TURNED_MOST = 200  # bodies that are looked at one by one
SHOWN = 50  # places of one kind


@dataclass(frozen=True, eq=False)
class Mend:
    """Something that was done to triangles, or is odd about them.

    Attributes:
        code: short name of it.
        message: for people.
        places: (K, 3) where, in the unit of the file; none where there is no place.
    """

    code: str
    message: str
    places: Array


def mended_surface(vertices: NDArray[Any], faces: NDArray[Any]) -> Surface:
    """Return the surface of vertices (V, 3) and faces (T, 3); raises as `mended` does."""
    vertices, faces, mends = mended(vertices, faces)
    said = tuple(Message(mend.code, "surface", mend.message) for mend in mends)
    return Surface(vertices, faces, said, {mend.code: mend.places for mend in mends})


def mended(vertices: NDArray[Any], faces: NDArray[Any]) -> tuple[Array, Indices, list[Mend]]:
    """Return vertices (V, 3) and faces (T, 3) that can be used, and what was done to them.

    Vertices at the same place become one.

    Raises:
        InputError: there is nothing that can be used.
    """
    mends: list[Mend] = []
    vertices = np.ascontiguousarray(vertices, np.float64)
    faces = np.ascontiguousarray(faces, np.int64)
    known = np.all((faces >= 0) & (faces < len(vertices)), axis=1)
    why = "name vertices that are not there"
    faces = _kept(faces, known, why, "surface-not-there", None, mends)
    there = np.all(np.abs(vertices) < FARTHEST, axis=1)  # False where it is NaN
    why = f"have corners that are no numbers below {FARTHEST:g}"
    faces = _kept(faces, there[faces].all(axis=1), why, "surface-not-finite", None, mends)
    vertices, faces = _merged(vertices, faces)
    corners = vertices[faces]
    double = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    size = np.ptp(vertices, axis=0) if len(vertices) else np.zeros(3)
    wide = double > FLAT * (size @ size)
    faces = _kept(faces, wide, "have no area", "surface-degenerate", vertices, mends)
    _, first = np.unique(_numbered(np.sort(faces, axis=1)), return_index=True)
    single = np.zeros(len(faces), bool)
    single[first] = True
    faces = _kept(faces, single, "are there more than once", "surface-duplicates", vertices, mends)
    faces = _sewn(vertices, faces)
    if not len(faces):
        why = f" ({mends[-1].message})" if mends else ""
        raise InputError(f"has no triangle that can be used{why}", "surface-empty", "surface")
    faces, pieces, piece = _turned(vertices, faces, mends)
    if pieces > 1:
        text = f"is in {pieces} separate pieces; at each point the nearest of them counts"
        firsts = np.unique(piece, return_index=True)[1]
        mends.append(Mend("surface-pieces", text, _middles(vertices, faces[firsts])))
    used, index = np.unique(faces, return_inverse=True)
    vertices, faces = vertices[used], index.reshape(-1, 3).astype(np.int64)
    mends += holes(vertices, faces)
    return vertices, faces, mends


def holes(vertices: Array, faces: Indices) -> list[Mend]:
    """Return a mend that says where holes are: open edges that go around less than the size."""
    ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    low, high = ends.min(axis=1), ends.max(axis=1)
    key, many = np.unique(low * len(vertices) + high, return_counts=True)
    a, b = np.divmod(key[many == 1], len(vertices))
    if not len(a):
        return []
    _, part = _parts(len(vertices), a, b)
    _, rim = np.unique(part[a], return_inverse=True)
    lengths = np.linalg.norm(vertices[a] - vertices[b], axis=1)
    around = np.bincount(rim, lengths)
    halfway = (vertices[a] + vertices[b]) / 2
    middles = np.stack([np.bincount(rim, lengths * x) / around for x in halfway.T], axis=1)
    small = around < np.linalg.norm(np.ptp(vertices, axis=0))
    if not small.any():
        return []
    count = int(small.sum())
    what = "a hole; over it" if count == 1 else f"{count} holes; over them"
    text = f"has {what} the nearest edge counts"
    return [Mend("surface-holes", text, middles[small][:SHOWN])]


def _kept(
    faces: Indices, keep: Mask, why: str, code: str, vertices: Array | None, mends: list[Mend]
) -> Indices:
    lost = int((~keep).sum())
    if lost:
        text = f"{lost:,} of {len(faces):,} triangles {why}; they are left out"
        places = np.zeros((0, 3)) if vertices is None else _middles(vertices, faces[~keep])
        mends.append(Mend(code, text, places))
    return faces[keep]


def _middles(vertices: Array, faces: Indices) -> Array:
    """Return the middles of some faces (T, 3)."""
    middles: Array = vertices[faces[:SHOWN]].mean(axis=1)
    return middles


def _merged(vertices: Array, faces: Indices) -> tuple[Array, Indices]:
    """Return vertices of which no two are at the same place, and the faces among them."""
    used, faces = np.unique(faces, return_inverse=True)
    faces, vertices = faces.reshape(-1, 3), vertices[used] + 0.0  # -0.0 is 0.0
    key = _numbered(vertices.view(np.int64))
    _, first, index = np.unique(key, return_index=True, return_inverse=True)
    alike = (vertices[first[index]] == vertices).all(axis=1)
    own = np.where(alike, first[index], np.arange(len(vertices)))
    return vertices, own[faces].astype(np.int64)


def _sewn(vertices: Array, faces: Indices) -> Indices:
    """Return the faces with vertices of open edges made one where they are as good as one.

    Patches that are computed one by one meet but for rounding.
    """
    ends = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    key, many = np.unique(ends[:, 0] * len(vertices) + ends[:, 1], return_counts=True)
    alone = key[many == 1]
    border = np.unique(np.concatenate([alone // len(vertices), alone % len(vertices)]))
    if not len(border):
        return faces
    places = vertices[border]
    pairs = KDTree(places).query_pairs(
        SEAM * float(np.linalg.norm(np.ptp(places, axis=0))), output_type="ndarray"
    )
    if not len(pairs):
        return faces
    _, part = _parts(len(border), *pairs.T)
    first = np.unique(part, return_index=True)[1]
    own = np.arange(len(vertices))
    own[border] = border[first[part]]
    faces = own[faces]
    a, b, c = faces.T
    return faces[(a != b) & (b != c) & (c != a)]


def _numbered(rows: Indices) -> Indices:
    """Return a number (N,) for rows (N, 3) of integers; that of others is another, almost surely.

    Source of the mixing: Steele, Lea, Flood, Fast splittable pseudorandom number generators, 2014.
    """
    mixed = np.zeros(len(rows), np.uint64)
    for column in rows.astype(np.int64).view(np.uint64).T:
        mixed += column + np.uint64(0x9E3779B97F4A7C15)
        mixed = (mixed ^ (mixed >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        mixed = (mixed ^ (mixed >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        mixed ^= mixed >> np.uint64(31)
    return mixed.view(np.int64)


def _turned(vertices: Array, faces: Indices, mends: list[Mend]) -> tuple[Indices, int, Indices]:
    """Return the faces, neighbours turned alike, bodies outwards; how many pieces, and whose."""
    count = len(faces)
    ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    of = np.tile(np.arange(count), 3)
    low, high = ends.min(axis=1), ends.max(axis=1)
    key = low * len(vertices) + high
    order = np.argsort(key, kind="stable")
    key, of, along = key[order], of[order], (ends[:, 0] < ends[:, 1])[order]
    begins = np.flatnonzero(np.r_[True, key[1:] != key[:-1]])
    many = np.diff(np.r_[begins, len(key)])
    two = begins[many == 2]
    a, b = of[two], of[two + 1]
    odd = along[two] == along[two + 1]
    pieces, piece = _parts(count, a, b)
    rows = np.concatenate([a, a + count])
    columns = np.concatenate([b + odd * count, b + ~odd * count])
    _, part = _parts(2 * count, rows, columns)
    first, second = part[:count], part[count:]
    if (first == second).any():
        text = "has only one side, as a Moebius strip; what is inside is not known"
        mends.append(Mend("surface-one-sided", text, np.zeros((0, 3))))
        return faces, pieces, piece
    # Of the two ways to turn a piece the one that turns fewer faces.
    turn = first > second
    share = np.bincount(piece, turn) / np.bincount(piece)
    turn ^= share[piece] > 0.5
    flipped = np.where(turn[:, None], faces[:, ::-1], faces)
    turn ^= _inwards(vertices, flipped, piece, pieces, bool((many == 2).all()))
    if turn.any():
        text = f"{int(turn.sum()):,} of {count:,} triangles faced the other way; they are turned"
        mends.append(Mend("surface-flipped", text, _middles(vertices, faces[turn])))
    return np.where(turn[:, None], faces[:, ::-1], faces), pieces, piece


def _inwards(vertices: Array, faces: Indices, piece: Indices, pieces: int, closed: bool) -> Mask:
    """Return which faces (T,) belong to closed bodies that are turned inside out.

    A body that is turned so within another one is a hollow of it, and right.
    """
    wrong = np.zeros(len(faces), bool)
    if not closed:
        return wrong
    corners = vertices[faces] - vertices[faces].mean(axis=(0, 1))
    a, b, c = np.moveaxis(corners, 1, 0)
    volume = np.bincount(piece, (a * np.cross(b, c)).sum(axis=1))
    for k in np.flatnonzero(volume < 0)[:TURNED_MOST]:
        mine = piece == k
        others = vertices[faces[~mine & (volume[piece] > 0)]]
        place = vertices[faces[mine][0, :1]]
        hollow = len(others) and Tree.of(others).windings(place)[0] > 0
        wrong |= mine & (not hollow)
    return wrong


def _parts(count: int, a: Indices, b: Indices) -> tuple[int, Indices]:
    """Return how many connected parts things joined in pairs have, and that of each (count,)."""
    joined = coo_array((np.ones(len(a), bool), (a, b)), shape=(count, count))
    number, part = connected_components(joined, directed=False)
    return int(number), part

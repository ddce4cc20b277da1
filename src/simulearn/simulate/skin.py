"""The surface of a morphing grid, for whoever draws or exports it.

Beams are strips of short quadrilaterals: bottom, top, and the two sides, which are split at the
mid-plane because only one half carries the actuator. Along a beam the four long edges follow the
nodes of the solid mesh where the engine has one, else the parabola through the three sections.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from simulearn.simulate.result import Result

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Around a section, counter-clockwise seen against the beam's direction: right-bottom, left-bottom,
# left-middle, left-top, right-top, right-middle; as weights of the four corners.
RING = np.array(
    [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0.5, 0, 0.5], [0, 0, 0, 1], [0, 0, 1, 0], [0.5, 0, 0.5, 0]]
)
HALF = np.array([-1, -1, 1, 1, 1, -1])  # of the strip between ring points k and k + 1


SLIVER = 1e-3  # mm, the least length of a quadrilateral along a beam
SEAM = (2, 5)  # ring points on the mid-plane, where the surface has no edge


@dataclass(frozen=True, eq=False)
class Skin:
    """The outer surface of a grid in all frames: quadrilaterals, corners counter-clockwise.

    Vertices are shared along a strip and not across its edges, so that normals averaged over a
    vertex are smooth along a beam and sharp at its edges.

    Attributes:
        vertices: (F, V, 3) mm.
        quads: (Q, 4) vertex indices, seen from outside counter-clockwise.
        ratio: (Q,) signed ratio of the actuator the quadrilateral belongs to, 0 outside of any.
        joint: (Q,) the joint the quadrilateral belongs to, -1 on beams.
        sharp: (Q, 4) whether the edge from corner k to k + 1 is an edge of the printed body.
    """

    vertices: Array
    quads: Indices
    ratio: Array
    joint: Indices
    sharp: NDArray[np.bool_]


def skin(result: Result, spacing: float = 2.5) -> Skin:
    """Return the surface of a result.

    Args:
        result: the result.
        spacing: length of the quadrilaterals along a beam, mm, at most.

    Returns:
        The surface; the hidden faces between beams and joints are left out.
    """
    patches: list[_Patch] = []
    for b in range(len(result.grid.beams)):
        patches += _beam(result, b, spacing)
    for j in range(len(result.grid.joints)):
        patches += _joint(result, j)

    rows = [patch.rows for patch in patches]
    starts = np.cumsum([0] + [2 * r.shape[1] for r in rows])
    counts = [r.shape[1] - 1 for r in rows]
    return Skin(
        vertices=np.concatenate([r.reshape(len(r), -1, 3) for r in rows], axis=1),
        quads=np.concatenate(
            [
                start + 2 * np.arange(count)[:, None] + np.array([0, 1, 3, 2])
                for start, count in zip(starts, counts, strict=False)
            ]
        ),
        ratio=np.repeat([patch.ratio for patch in patches], counts),
        joint=np.repeat([patch.joint for patch in patches], counts),
        sharp=np.concatenate([np.broadcast_to(p.sharp, (p.rows.shape[1] - 1, 4)) for p in patches]),
    )


@dataclass(frozen=True, eq=False)
class _Patch:
    """A strip of quadrilaterals: rows (F, n, 2, 3) of pairs of vertices."""

    rows: Array
    sharp: list[bool] | NDArray[np.bool_]  # (4,) or one per quadrilateral (n - 1, 4)
    ratio: float = 0.0
    joint: int = -1


def edges(result: Result, beam: int, t: Array) -> Array:
    """Return the four long edges of a beam at positions t in [0, 1]: (F, len(t), 4, 3) mm."""
    sections = result.beams[:, beam]
    if result.solid is not None and result.displacements is not None:
        return np.stack([_along_nodes(result, beam, c, t) for c in range(4)], axis=2)
    weights = np.array([2 * (t - 0.5) * (t - 1), 4 * t * (1 - t), 2 * t * (t - 0.5)])
    return np.einsum("sn,fscx->fncx", weights, sections)


def _along_nodes(result: Result, beam: int, corner: int, t: Array) -> Array:
    """Return one long edge of a beam through the solid's nodes on it: (F, len(t), 3)."""
    from scipy.interpolate import CubicSpline

    assert result.solid is not None
    assert result.displacements is not None
    solid = result.solid
    own = np.unique(solid.bricks[solid.parts[:, 0] == beam])
    nodes = solid.nodes[own]
    ends = solid.nodes[solid.beams[beam][[0, 2], corner]]
    along = ends[1] - ends[0]
    place = (nodes - ends[0]) @ along / (along @ along)
    off = np.linalg.norm(nodes - ends[0] - place[:, None] * along, axis=1)
    on = np.flatnonzero((off < 1e-6) & (place > -1e-9) & (place < 1 + 1e-9))
    on = on[np.argsort(place[on])]
    curves = nodes[on] + result.displacements[:, own[on]]
    return np.asarray(CubicSpline(place[on], curves, axis=1)(t))


def _beam(result: Result, b: int, spacing: float) -> list[_Patch]:
    ratio = float(result.grid.actuators[b])
    middle = result.beams[0, b].mean(axis=1)
    length = float(np.linalg.norm(middle[2] - middle[0]))
    rest = max(0.0, (1 - abs(ratio)) / 2)
    rest = rest if rest * length > SLIVER else 0.0
    stops = np.unique([0, rest, 1 - rest, 1])
    patches = []
    for a, z in pairwise(stops):
        n = max(1, int(np.ceil((z - a) * length / spacing)))
        n += n % 2 if a < 0.5 < z else 0  # the middle section's corners are vertices
        t = np.linspace(a, z, 1 + n)
        ring = np.einsum("rc,fncx->fnrx", RING, edges(result, b, t))
        active = ratio != 0 and abs(a + z - 1) < abs(ratio)  # the run whose centre is inside
        for k in range(6):
            other = (k + 1) % 6
            sharp = [False, other not in SEAM, False, k not in SEAM]
            tone = ratio if active and HALF[k] * ratio > 0 else 0.0
            patches.append(_Patch(ring[:, :, [k, other]], sharp, tone))
    return patches


def _joint(result: Result, j: int) -> list[_Patch]:
    corners = result.joints[:, j]
    bottom, top = corners[:, :4], corners[:, 4:]
    middle = (bottom + top) / 2
    free = _free_sides(result, j)
    rim = [k in free for k in range(4)]
    patches = [
        _Patch(np.stack([top[:, [0, 1]], top[:, [3, 2]]], axis=1), rim, joint=j),
        _Patch(np.stack([bottom[:, [1, 0]], bottom[:, [2, 3]]], axis=1), _turned(rim), joint=j),
    ]
    for k in free:
        pair = [k, (k + 1) % 4]
        # A vertical edge shows where the next side is free too.
        ends = [rim[(k + 1) % 4], rim[(k - 1) % 4]]
        sharp = np.array([[True, ends[0], False, ends[1]], [False, ends[0], True, ends[1]]])
        rows = np.stack([a[:, pair] for a in (bottom, middle, top)], axis=1)
        patches.append(_Patch(rows, sharp, joint=j))
    return patches


def _turned(rim: list[bool]) -> list[bool]:
    """Return which edges of the bottom, whose corners run 1, 0, 3, 2, are on the rim."""
    return [rim[0], rim[3], rim[2], rim[1]]


def _free_sides(result: Result, j: int) -> list[int]:
    """Return the sides of a joint that meet no beam: 0 .. 3, side k from corner k to k + 1."""
    corners = result.joints[0, j]
    mids = np.array([corners[[k, (k + 1) % 4, k + 4, (k + 1) % 4 + 4]].mean(0) for k in range(4)])
    taken = set()
    for b, e in zip(*np.nonzero(result.grid.beams == j), strict=True):
        end = result.beams[0, b, 2 * e].mean(axis=0)
        taken.add(int(np.linalg.norm(mids - end, axis=1).argmin()))
    return [k for k in range(4) if k not in taken]

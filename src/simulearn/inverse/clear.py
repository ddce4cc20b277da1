"""Keeping away: beams of a grid from a body, or from each other.

The course of a beam is the parabola through the centres of its three sections, and the beam is as
thick about it as its section's diagonal. How deep it is, at the deepest, in what it shall not
touch, clearance added, is what is left to do.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace

import numpy as np
from numpy.typing import NDArray

from simulearn.inverse.kinds import Wanted
from simulearn.inverse.vertex import Vertex
from simulearn.surfaces import Surface

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

BALLS = 9  # along a beam
PIECES = 4  # of a course, taken as straight
AT_ONCE = 50_000  # pairs of beams that are compared at once
PAIRS = 2_000_000  # of which it is seen at once whether they are near


def _course(count: int) -> Array:
    """Return the shares (count, 3) of three sections in places along a parabola through them."""
    t = np.linspace(0.0, 1.0, count)
    return np.stack([(1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1)], axis=1)


COURSE, NODES = _course(BALLS), _course(PIECES + 1)


def courses(beams: int) -> tuple[Vertex, ...]:
    """Return the vertices that the courses of so many beams go by."""
    return tuple(Vertex("beam", b, None, k) for b in range(beams) for k in range(3))


def _balls(points: Array) -> Array:
    """Return the balls' centres (..., B, BALLS, 3) of sections' centres (..., 3 B, 3)."""
    sections = points.reshape(*points.shape[:-2], -1, 3, 3)
    return np.einsum("ks,...bsc->...bkc", COURSE, sections)


@dataclass(frozen=True, eq=False)
class ClearOf(Wanted):
    """Beams are to stay outside of a body, or on their side of a sheet.

    Attributes:
        surface: of the body; where it is not closed, both sides of it are kept clear.
        clearance: mm, that is to be left between.
        radius: of a ball, mm.
        kind: its name.
    """

    surface: Surface
    clearance: float
    radius: float
    kind: str = "away from a body"

    def names(self, vertices: Sequence[Vertex]) -> tuple[str, ...]:
        """Return what it is about."""
        return ("all beams",)

    def away(self, points: Array) -> Array:
        """Return how deep the deepest ball of each beam is: (T, 1, B)."""
        return self._deep(_balls(points))[0].max(axis=-1)[:, None]

    def pulled(self, points: Array, pull: Array) -> Array:
        """Return the derivative by the sections of each beam."""
        balls = _balls(points)
        deep, outwards = self._deep(balls[None])
        k = deep[0].argmax(axis=-1)
        beam = np.arange(len(k))
        active = np.where(deep[0][beam, k] > 0, -pull[0], 0.0)
        by = active[:, None] * outwards[0][beam, k]
        return (COURSE[k][:, :, None] * by[:, None]).reshape(-1, 3)

    def lines(self, points: Array) -> Array:
        """Return lines along which beams are too deep."""
        balls = _balls(points)
        deep, outwards = self._deep(balls[None])
        k = deep[0].argmax(axis=-1)
        beam = np.arange(len(k))
        most = deep[0][beam, k]
        here = balls[beam, k]
        ends = np.stack([here, here + most[:, None] * outwards[0][beam, k]], axis=1)
        return ends[most > 0]

    def _deep(self, balls: Array) -> tuple[Array, Array]:
        """Return how deep balls (T, B, BALLS, 3) are, 0 outside, and unit vectors outwards."""
        places = balls.reshape(-1, 3)
        near, normals, _ = self.surface.closest(places)
        away = places - near
        distance = np.linalg.norm(away, axis=1)
        side = np.ones(len(places))
        if self.surface.closed:
            close = distance < 2 * self.surface.size
            side[close] = np.where(self.surface.inside(places[close]), -1.0, 1.0)
        outwards = np.where(
            distance[:, None] > 1e-9,
            side[:, None] * away / np.maximum(distance, 1e-9)[:, None],
            normals,
        )
        deep = np.maximum(self.clearance + self.radius - side * distance, 0.0)
        return deep.reshape(balls.shape[:-1]), outwards.reshape(balls.shape)


@dataclass(frozen=True, eq=False)
class Touch:
    """K pairs of beams that are too close, and where.

    Attributes:
        shape: (K,) which shape they are of.
        beams: (K, 2) which beams.
        deep: (K,) mm, by how much they are too close.
        shares: (K, 2, 3) of the three sections' centres in the closest points of both courses.
        apart: (K, 3) unit vectors from the second beam to the first.
    """

    shape: Indices
    beams: Indices
    deep: Array
    shares: Array
    apart: Array


@dataclass(frozen=True, eq=False)
class ClearOfItself(Wanted):
    """Beams that do not meet at a joint are to stay apart.

    Attributes:
        beams: (B, 2) their joints.
        clearance: mm, that is to be left between.
        radius: of a beam, mm.
        kind: its name.
        pairs: (P, 2) beams without a joint in common.
    """

    beams: Indices
    clearance: float
    radius: float
    kind: str = "away from itself"
    pairs: Indices = field(init=False)

    def __post_init__(self) -> None:
        """Find the pairs."""
        one, other = np.triu_indices(len(self.beams), 1)
        meet = (self.beams[one][:, :, None] == self.beams[other][:, None, :]).any(axis=(1, 2))
        object.__setattr__(self, "pairs", np.stack([one, other], axis=1)[~meet])

    def names(self, vertices: Sequence[Vertex]) -> tuple[str, ...]:
        """Return what it is about."""
        return ("all beams",)

    def away(self, points: Array) -> Array:
        """Return how deep each beam is in the one that it is deepest in: (T, 1, B)."""
        touch = self._touching(points)
        deep = np.zeros((len(points), len(self.beams)))
        for side in (0, 1):
            np.maximum.at(deep, (touch.shape, touch.beams[:, side]), touch.deep)
        return deep[:, None]

    def pulled(self, points: Array, pull: Array) -> Array:
        """Return the derivative by the sections of each beam."""
        touch = self._touching(points[None])
        slope = np.zeros((len(self.beams), 3, 3))
        deepest = {}
        for k in np.argsort(touch.deep):  # the deepest of each beam comes last
            deepest.update({int(beam): int(k) for beam in touch.beams[k]})
        for beam, k in deepest.items():
            for side, sign in ((0, -1.0), (1, 1.0)):
                by = sign * pull[0, beam] * touch.apart[k]
                slope[touch.beams[k, side]] += touch.shares[k, side][:, None] * by
        return slope.reshape(-1, 3)

    def lines(self, points: Array) -> Array:
        """Return lines between beams that are too close."""
        touch = self._touching(points[None])
        sections = points.reshape(-1, 3, 3)[touch.beams]
        return np.einsum("kes,kesc->kec", touch.shares, sections)

    def _touching(self, points: Array) -> Touch:
        """Return the pairs that are too close, of sections' centres (T, 3 B, 3)."""
        near = self.clearance + 2 * self.radius
        few = max(1, PAIRS // max(len(self.pairs), 1))
        parts = [self._of_shapes(points[k : k + few], k, near) for k in range(0, len(points), few)]
        return _joined(parts)

    def _of_shapes(self, points: Array, first: int, near: float) -> Touch:
        """Return the pairs of some shapes, whose numbers begin with the first."""
        nodes = np.einsum("ks,tbsc->tbkc", NODES, points.reshape(len(points), -1, 3, 3))
        middle = nodes.mean(axis=2)
        reach = np.linalg.norm(nodes - middle[:, :, None], axis=-1).max(axis=2)
        one, other = self.pairs.T
        gap = np.linalg.norm(middle[:, one] - middle[:, other], axis=-1)
        shape, pair = np.nonzero(gap < reach[:, one] + reach[:, other] + near)
        touch = _joined(
            [
                self._of_pairs(nodes, shape[k : k + AT_ONCE], pair[k : k + AT_ONCE], near)
                for k in range(0, max(len(shape), 1), AT_ONCE)
            ]
        )
        return replace(touch, shape=touch.shape + first)

    def _of_pairs(self, nodes: Array, shape: Indices, pair: Indices, near: float) -> Touch:
        beams = self.pairs[pair]
        a, b = nodes[shape, beams[:, 0]], nodes[shape, beams[:, 1]]
        s, t = _closest(
            a[:, :-1, None], a[:, 1:, None], b[:, None, :-1], b[:, None, 1:]
        )  # (K, PIECES, PIECES)
        here = a[:, :-1, None] + s[..., None] * (a[:, 1:] - a[:, :-1])[:, :, None]
        there = b[:, None, :-1] + t[..., None] * (b[:, 1:] - b[:, :-1])[:, None]
        between = (here - there).reshape(len(pair), -1, 3)
        length = np.linalg.norm(between, axis=-1)
        row, least = np.arange(len(pair)), length.argmin(axis=1)
        k, m = least // PIECES, least % PIECES
        distance = length[row, least]
        shares = np.stack([_at(k, s[row, k, m]), _at(m, t[row, k, m])], axis=1)
        apart = between[row, least] / np.maximum(distance, 1e-9)[:, None]
        touch = distance < near
        every = (shape, beams, near - distance, shares, apart)
        return Touch(*(part[touch] for part in every))


def _joined(parts: Sequence[Touch]) -> Touch:
    names = [one.name for one in fields(Touch)]
    return Touch(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


def _at(piece: Indices, share: Array) -> Array:
    """Return the shares (K, 3) of sections in places along pieces (K,)."""
    return (1 - share)[:, None] * NODES[piece] + share[:, None] * NODES[piece + 1]


def _closest(a: Array, b: Array, c: Array, d: Array) -> tuple[Array, Array]:
    """Return where segments a to b and c to d (..., 3) are closest: shares (...) of either.

    Source: Ericson, Real-Time Collision Detection, 2005, 5.1.9.
    """
    u, v, w = b - a, d - c, a - c
    uu, vv, uv = (u * u).sum(-1), (v * v).sum(-1), (u * v).sum(-1)
    uw, vw = (u * w).sum(-1), (v * w).sum(-1)
    uu, vv = np.maximum(uu, 1e-12), np.maximum(vv, 1e-12)
    across = uu * vv - uv * uv
    skew = across > 1e-9 * uu * vv  # others are parallel
    s = np.where(skew, np.clip((uv * vw - uw * vv) / np.where(skew, across, 1.0), 0, 1), 0.0)
    t = np.clip((uv * s + vw) / vv, 0, 1)
    return np.clip((uv * t - uw) / uu, 0, 1), t

"""Filling a quadrilateral by strokes that turn at its sides, without gaps and without overlap.

Rows tile the region, as many as make their width nearest to that of a line. Where the sides are not
parallel a row is wider at one end, and its bead with it. A stroke ends half a row before the side,
and the step to the next one runs along the side. That step is as long as what the stroke was
shortened by, so length times width is the region's area, however oblique its sides are.

     ____________________
    |  ________________  |   row 3       then each stroke is lengthened at both ends by the
    | |  ______________| |   row 2       overlap, which bonds the region to its neighbour
    | | |______________  |   row 1
    | |________________| |   row 0

Strokes across a beam run square to it. A beam's end is often oblique; there they turn little by
little until they are parallel to it, no faster than a bead can be drawn wider on one side.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from simulearn.fabricate.regions import Region
from simulearn.fabricate.toolpath import PASSIVE

Array = NDArray[np.float64]
# How much wider and narrower than the middle of its stroke a bead may become by turning.
SPREAD = 0.25
# A stroke is cut into pieces that differ in width by at most this share of it.
STEP = 0.1
MOST_PIECES = 12
SAMPLES = 257  # places along a beam where the lean of strokes is computed
# A region whose rows would be narrower or wider than so many lines is cut in two across its
# strokes, unless they are too short (mm) for that.
NARROWEST, WIDEST = 0.55, 1.5
SHORTEST_PIECE = 1.5
SHORTEST = 0.05  # mm; a stroke is at least as long


@dataclass(frozen=True, eq=False)
class Strokes:
    """Rows that are printed in one go.

    Attributes:
        ends: (n, 2, 2) [left, right] x (x, y) of each row, in order, mm.
        widths: (n, 2) of each row at its left and right end, mm.
    """

    ends: Array
    widths: Array

    def path(self, variant: int) -> tuple[Array, Array]:
        """Return the points (p, 2) and widths (p - 1,) of one of four variants.

        Variant 0 begins at the left of the first row, variant 1 at its right; variants 2 and 3 are
        those backwards.
        """
        ends, widths = self.ends.copy(), self.widths.copy()
        turned = slice(1 - variant % 2, None, 2)
        ends[turned], widths[turned] = ends[turned, ::-1], widths[turned, ::-1]
        change = np.abs(widths[:, 1] - widths[:, 0]) / widths.mean(axis=1)
        # A little less, so that rounding does not decide between two numbers of pieces.
        pieces = np.clip(np.ceil(change / STEP - 1e-6), 1, MOST_PIECES).astype(int)
        # Row k has pieces[k] + 1 points, and a width after each: the last is that of the turn.
        row = np.repeat(np.arange(len(pieces)), pieces + 1)
        count = np.arange(len(row)) - np.repeat(np.cumsum(pieces + 1) - pieces - 1, pieces + 1)
        t = (count / pieces[row])[:, None]
        path = ends[row, 0] * (1 - t) + ends[row, 1] * t
        middle = (count + 0.5) / pieces[row]
        width = widths[row, 0] * (1 - middle) + widths[row, 1] * middle
        width[count == pieces[row]] = np.append((widths[:-1, 1] + widths[1:, 0]) / 2, 0.0)
        width = width[:-1]
        return (path[::-1], width[::-1]) if variant >= 2 else (path, width)

    def tips(self) -> tuple[Array, Array]:
        """Return where each variant begins and where it ends, (4, 2) mm each."""
        first, last = self.ends[0], self.ends[-1]
        if len(self.ends) % 2:
            last = last[::-1]
        return np.concatenate([first, last]), np.concatenate([last, first])


def fill(
    region: Region, line: float, overlap: float, shell: float, infill: float = 1.0
) -> list[Strokes]:
    """Return the strokes that fill a region, in more than one piece if its sides differ much.

    Args:
        region: what to fill.
        line: width that a row should have, mm.
        overlap: by how much strokes are lengthened at each end, mm.
        shell: width of the shell around the region's `keep_off`, mm.
        infill: share of the region that is filled.
    """
    left, right = _boundaries(region, line / infill)
    ends = np.stack([left[:-1] + left[1:], right[:-1] + right[1:]], axis=1) / 2
    along = ends[:, 1] - ends[:, 0]
    length = np.linalg.norm(along, axis=1)
    along = along / length[:, None]
    steps = np.stack([np.diff(left, axis=0), np.diff(right, axis=0)], axis=1)
    widths = np.abs(along[:, None, 0] * steps[..., 1] - along[:, None, 1] * steps[..., 0])
    odd = widths.min() < NARROWEST * line / infill or widths.max() > WIDEST * line / infill
    if odd and length.mean() > 2 * SHORTEST_PIECE:
        return [
            strokes
            for half in _halves(region)
            for strokes in fill(half, line, overlap, shell, infill)
        ]

    # From each end: half a step along the side, given up for the turn, less the overlap.
    reach = np.where(region.overlap, overlap, 0.0)
    inset = np.linalg.norm(steps, axis=2) / 2 - reach
    for corner in region.keep_off:
        inset = np.maximum(inset, _cleared(ends, along, corner, shell + line / 2 - overlap))
    inset *= np.minimum(1.0, (length - SHORTEST) / np.maximum(inset.sum(axis=1), 1e-9))[:, None]
    ends[:, 0] += inset[:, :1] * along
    ends[:, 1] -= inset[:, 1:] * along
    return [Strokes(ends, widths * infill)]


def _halves(region: Region) -> list[Region]:
    """Return a region cut in two across its strokes; at the cut only those of one half overlap."""
    a, b, c, d = region.corners
    first, last = (a + b) / 2, (c + d) / 2
    left, right = region.overlap
    return [
        replace(region, corners=np.array([a, first, last, d]), overlap=(left, True)),
        replace(region, corners=np.array([first, b, c, last]), overlap=(False, right)),
    ]


def _boundaries(region: Region, line: float) -> tuple[Array, Array]:
    """Return where the boundaries between rows meet the left and right side, (rows + 1, 2) each."""
    if region.role == PASSIVE:
        return _across(region.corners, line)
    a, b, c, d = region.corners
    u, v = c - a, d - b
    area = abs(u[0] * v[1] - u[1] * v[0]) / 2
    # The area over the mean length of a stroke.
    height = float(2 * area / (np.linalg.norm(b - a) + np.linalg.norm(c - d)))
    t = np.linspace(0, 1, max(1, round(height / line)) + 1)[:, None]
    return a + t * (d - a), b + t * (c - b)


def _across(corners: Array, line: float) -> tuple[Array, Array]:
    """Return the boundaries of rows across a beam, whose edges are the region's sides."""
    a, b, c, d = corners
    along = (d - a) + (c - b)
    along /= np.linalg.norm(along)
    square = np.array([-along[1], along[0]])
    half = float((b - a) @ square) / 2
    # How far the first and last edge lean: mm along the beam for each mm across it.
    first, last = float((b - a) @ along) / (2 * half), float((c - d) @ along) / (2 * half)
    length = float((c + d - a - b) @ along) / 2
    place = np.linspace(0, length, SAMPLES)
    lean = _lean(first, last, length, place, SPREAD / abs(half))
    # A row that leans is as wide as others if it takes more of the beam's length.
    share = 1 / np.hypot(1, lean)
    rows = np.append(0.0, np.cumsum((share[1:] + share[:-1]) / 2 * np.diff(place)))
    count = max(1, round(float(rows[-1]) / line))
    place = np.interp(np.linspace(0, rows[-1], count + 1), rows, place)
    lean = _lean(first, last, length, place, SPREAD / abs(half))
    middle = (a + b) / 2 + place[:, None] * along
    away = half * (square + lean[:, None] * along)
    return middle - away, middle + away


def _lean(first: float, last: float, length: float, place: Array, rate: float) -> Array:
    """Return how strokes lean at places along a beam: from `first` to `last`, least between.

    The lean changes by at most `rate` per mm, or as evenly as the length allows.
    """
    rate = max(rate, abs(last - first) / length)
    a, b = rate * place, rate * (length - place)
    return np.clip(0.0, np.maximum(first - a, last - b), np.minimum(first + a, last + b))


def _cleared(ends: Array, along: Array, point: Array, radius: float) -> Array:
    """Return how far (n, 2) rows must end before their ends to stay clear of a circle."""
    inset = np.zeros((len(ends), 2))
    for side, sign in ((0, 1.0), (1, -1.0)):
        apart = point - ends[:, side]
        forward = sign * np.sum(apart * along, axis=1)
        square = radius**2 - (np.sum(apart**2, axis=1) - forward**2)
        out = forward + np.sqrt(np.maximum(square, 0))
        near = (square > 0) & (np.abs(forward) < 2 * radius)
        inset[:, side] = np.where(near, out, 0)
    return inset

"""Boxes around bodies in each frame, and the pairs of bodies whose boxes ever meet.

A beam of three sections lies within these, the middle one moved along the axis, and the ends moved
along theirs, as a curve lies within its control polygon: these rows are its hull. A row is a centre
with half width and half thickness.
"""

from math import sqrt
from typing import Any, NamedTuple

import numpy as np

from simulearn.collisions.kernels.axis import ahead_of
from simulearn.collisions.kernels.vectors import cross, dot, minus, plus, section_frame, unit
from simulearn.native import inlined, native

Array = Any

ROWS = 7  # of the hull of a beam of three sections
STEEP = 0.3  # least cosine between a half's chord and the middle's direction


class Hulls(NamedTuple):
    """The hulls of beams in all frames.

    Attributes:
        rows: (F, B, R, 3, 3) from start to end.
        faces: (F, B, 2, 3) normals of both ends, from the joint into the beam.
        reach: (F, B) that no row reaches beyond from its centre, mm.
    """

    rows: Array
    faces: Array
    reach: Array


@inlined
def set_row(row: Array, centre: Any, left: Any, up: Any) -> None:
    """Set a row (3, 3) of a hull."""
    for i in range(3):
        row[0, i], row[1, i], row[2, i] = centre[i], left[i], up[i]


@inlined
def set_hull(sections: Array, skew: Array, hull: Array) -> None:
    """Set the rows (R, 3, 3), from start to end, between which a beam (S, 4, 3) lies."""
    if len(sections) != 3:
        for s in range(len(sections)):
            centre, left, up = section_frame(sections[s])
            set_row(hull[s], centre, left, up)
        return
    middle, left, up = section_frame(sections[1])
    ahead = ahead_of(left, up, skew[1])
    set_row(hull[3], middle, left, up)
    for side in range(2):
        sign = 2.0 * side - 1.0
        end, end_left, end_up = section_frame(sections[2 * side])
        away = minus(end, middle)
        square = dot(away, away)
        chord = sqrt(square)
        far = sign * square / (2 * max(sign * dot(away, ahead), STEEP * chord))
        back = plus(end, -sign * chord / 2, ahead_of(end_left, end_up, skew[2 * side]))
        set_row(hull[2 + 2 * side], plus(middle, far, ahead), left, up)
        set_row(hull[1 + 4 * side], back, end_left, end_up)
        set_row(hull[6 * side], end, end_left, end_up)


@inlined
def set_ends(rows: Array, faces: Array) -> float:
    """Set the normals (2, 3) of the ends of a hull (R, 3, 3), and return its reach."""
    many = len(rows)
    most = 0.0
    for r in range(many):
        square = 0.0
        for i in range(3):
            square += (abs(rows[r, 1, i]) + abs(rows[r, 2, i])) ** 2
        most = max(most, square)
    for end in range(2):
        n = unit(cross(rows[end * (many - 1), 1], rows[end * (many - 1), 2]))
        for i in range(3):
            faces[end, i] = n[i] if end == 0 else -n[i]
    return sqrt(most)


@inlined
def set_hull_box(hull: Array, box: Array) -> None:
    """Set low and high (6,) of a hull (R, 3, 3)."""
    for i in range(3):
        low, high = np.inf, -np.inf
        for r in range(len(hull)):
            reach = abs(hull[r, 1, i]) + abs(hull[r, 2, i])
            low, high = min(low, hull[r, 0, i] - reach), max(high, hull[r, 0, i] + reach)
        box[i], box[3 + i] = low, high


@native(entry=False, allocates=False)
def set_joint_box(corners: Array, box: Array) -> None:
    """Set low and high (6,) of a joint's corners (8, 3)."""
    for i in range(3):
        low, high = np.inf, -np.inf
        for c in range(8):
            low, high = min(low, corners[c, i]), max(high, corners[c, i])
        box[i], box[3 + i] = low, high


@native(entry=False, allocates=False)
def set_union(boxes: Array, union: Array) -> None:
    """Set the box (6,) around boxes (F, 6)."""
    for i in range(3):
        union[i], union[3 + i] = boxes[0, i], boxes[0, 3 + i]
    for f in range(1, len(boxes)):
        for i in range(3):
            union[i] = min(union[i], boxes[f, i])
            union[3 + i] = max(union[3 + i], boxes[f, 3 + i])


@inlined
def meet(a: Array, b: Array) -> bool:
    """Return whether two boxes (6,) overlap."""
    return (
        a[0] < b[3] and b[0] < a[3]
        and a[1] < b[4] and b[1] < a[4]
        and a[2] < b[5] and b[2] < a[5]
    )  # fmt: skip


@inlined
def meet_between(a: Array, b: Array, f: int, g: int) -> bool:
    """Return whether the boxes around two bodies' boxes (F, 6) in frames f and g overlap."""
    for i in range(3):
        if min(a[f, i], a[g, i]) >= max(b[f, 3 + i], b[g, 3 + i]):
            return False
        if min(b[f, i], b[g, i]) >= max(a[f, 3 + i], a[g, 3 + i]):
            return False
    return True


@native(entry=False, allocates=False)
def sort(boxes: Array, order: Array) -> None:
    """Sort bodies (n,) by where their boxes (n, 6) begin in x, by Shell's method."""
    step = len(order) // 2
    while step > 0:
        for k in range(step, len(order)):
            body, place = order[k], k
            while place >= step and boxes[order[place - step], 0] > boxes[body, 0]:
                order[place] = order[place - step]
                place -= step
            order[place] = body
        step = 1 if step == 2 else step * 5 // 11


@native(entry=False)
def swept_pairs(boxes: Array, group: Array, pairs: Array) -> int:
    """Set the pairs (N, 2) of bodies whose boxes (n, 6) overlap; return how many there are.

    Bodies are sorted by where they begin in x, and each is compared with those that begin before it
    ends. With groups (n,), where they differ, only pairs of two groups count. More pairs than there
    is room for are counted, but not set.
    """
    across = False
    for k in range(1, len(group)):
        across |= group[k] != group[0]
    order = np.arange(len(boxes))
    sort(boxes, order)
    count = 0
    for m in range(len(order)):
        a = order[m]
        for n in range(m + 1, len(order)):
            b = order[n]
            if boxes[b, 0] >= boxes[a, 3]:
                break
            if (across and group[a] == group[b]) or not meet(boxes[a], boxes[b]):
                continue
            if count < len(pairs):
                pairs[count, 0], pairs[count, 1] = min(a, b), max(a, b)
            count += 1
    return count

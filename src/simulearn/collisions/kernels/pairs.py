"""All frames of all pairs of bodies: the entry from Python.

Bodies are the beams, then the joints. What filters cannot tell apart is compared piece by piece in
both frames around. Between two frames corners move along straight lines; where a pair is free in
both, the time between is halved as long as the pieces move so far that they might meet in it.
"""

from typing import Any, NamedTuple

import numpy as np

from simulearn.collisions.kernels.axis import set_skew
from simulearn.collisions.kernels.boxes import (
    ROWS,
    Hulls,
    meet_between,
    set_ends,
    set_hull,
    set_hull_box,
    set_joint_box,
    set_union,
    swept_pairs,
)
from simulearn.collisions.kernels.neighbours import (
    STILL,
    beams_apart,
    common_joint,
    joint_apart,
    set_near,
)
from simulearn.collisions.kernels.pieces import count_of, make_pieces, set_beam, set_joint
from simulearn.collisions.kernels.separation import exact, separation
from simulearn.collisions.kernels.vectors import dot, minus
from simulearn.native import inlined, native

Array = Any

ALIKE = 0.01  # mm; of two places as deep, the one with the nearer centres is named
HALVINGS = 6  # of the time between two frames
FINE = 0.2  # mm that pieces move towards each other, below which time is not halved again


class Bends(NamedTuple):
    """What tells where beams of three sections are bent: ratios (B,), skews (B, 3, 2)."""

    ratios: Array
    skews: Array


@native(entry=False, allocates=False)
def is_left_out(pieces: Any, a: int, i: int, b: int, j: int, skip: Array) -> bool:
    """Return whether two pieces are both near the joint that their bodies have in common."""
    return (i < skip[0] or pieces.counts[a] - 1 - i < skip[1]) and (
        j < skip[2] or pieces.counts[b] - 1 - j < skip[3]
    )


@native(entry=False, allocates=False)
def gap(pieces: Any, a: int, b: int, skip: Array, place: Array) -> float:
    """Return how far two bodies are apart, at least; negative: the depth, and set its place.

    Args:
        pieces: of bodies.
        a: one of them.
        b: another.
        skip: (4,) how many of the first and last pieces of both are near a common joint.
        place: (3,) mm, is set.
    """
    least = nearest = np.inf
    for i in range(pieces.counts[a]):
        p = pieces.spheres[a, i]
        for j in range(pieces.counts[b]):
            q = pieces.spheres[b, j]
            x, y, z, r = p[0] - q[0], p[1] - q[1], p[2] - q[2], p[3] + q[3]
            square = x * x + y * y + z * z
            if square >= (r + max(least, 0.0)) ** 2 or is_left_out(pieces, a, i, b, j, skip):
                continue
            value = separation(pieces, a, i, b, j) if square < r * r else np.sqrt(square) - r
            if value < 0.0 and value < least + ALIKE:
                value = exact(pieces, a, i, b, j, value)
            as_deep = value < least + ALIKE and square < nearest
            if value < 0.0 and (value < least - ALIKE or as_deep):
                nearest = square
                for k in range(3):
                    place[k] = (p[k] + q[k]) / 2
            least = min(least, value)
    return least


@native(entry=False, allocates=False)
def turned(before: Array, after: Array, from_: Array, to: Array) -> float:
    """Return how far corners (8, 3) move, at most, besides their centre; mm."""
    most = 0.0
    for c in range(8):
        square = 0.0
        for k in range(3):
            square += (after[c, k] - to[k] - before[c, k] + from_[k]) ** 2
        most = max(most, square)
    return np.sqrt(most)


@native(entry=False, allocates=False)
def nearing(pieces: Any, a: int, b: int, a1: int, b1: int, skip: Array) -> float:
    """Return how far those pieces move against each other that may meet between two frames.

    Args:
        pieces: of bodies.
        a: one in the frame before.
        b: another.
        a1: the one in the frame after.
        b1: the other.
        skip: see `gap`.
    """
    most = 0.0
    for i in range(pieces.counts[a]):
        p, p1 = pieces.spheres[a, i], pieces.spheres[a1, i]
        for j in range(pieces.counts[b]):
            q, q1 = pieces.spheres[b, j], pieces.spheres[b1, j]
            r = max(p[3], p1[3]) + max(q[3], q1[3])
            away = minus(p, q)
            moved = minus(minus(p1, q1), away)
            square, toward = dot(moved, moved), dot(away, moved)
            t = min(max(-toward / square, 0.0), 1.0) if square > 0.0 else 0.0
            if dot(away, away) + 2 * t * toward + t * t * square >= r * r:
                continue
            if is_left_out(pieces, a, i, b, j, skip):
                continue
            first = turned(pieces.corners[a, i], pieces.corners[a1, i], p, p1)
            second = turned(pieces.corners[b, j], pieces.corners[b1, j], q, q1)
            most = max(most, np.sqrt(square) + first + second)
    return most


@native(entry=False, allocates=False)
def set_body(
    body: int, sections: Array, joints: Array, bends: Any, f: int, g: int, share: float,
    pieces: Any, slot: int,
) -> None:  # fmt: skip
    """Set the pieces of a body between frames f and g."""
    beams = sections.shape[1]
    if body < beams:
        ratio, skew = bends.ratios[body], bends.skews[body]
        set_beam(sections[f, body], sections[g, body], share, ratio, skew, pieces, slot)
    else:
        j = body - beams
        set_joint(joints[f, j], joints[g, j], share, pieces, slot)


@inlined
def free(
    a: int, b: int, joined: Any, hulls: Any, joints: Array, f: int, least: float, normal: Array
) -> bool:
    """Return whether a plane parts two joined bodies in a frame, and set its normal (3,)."""
    joint, i, j = joined
    if b < hulls.rows.shape[1]:
        return beams_apart(hulls, f, a, i, b, j, joints[f, joint], least, normal)
    return joint_apart(hulls, f, a, i, joints[f, joint], least, normal)


@native(entry=False, allocates=False)
def keep(row: Array, frame: int, share: float, first: int, depth: float, place: Array) -> None:
    """Put a moment into a pair's row if it is the deepest so far, and the first frame."""
    if row[5] < 0.0:
        row[5] = first
    if depth > row[6]:
        row[3], row[4], row[6] = frame, share, depth
        for k in range(3):
            row[7 + k] = place[k]


@native(entry=False)
def search(
    a: int, b: int, f: int, before: float, after: float, moved: float, sections: Array,
    joints: Array, bends: Any, skip: Array, least: float, pieces: Any, row: Array,
) -> None:  # fmt: skip
    """Look for a collision between frames f and f + 1, in both of which a pair is free."""
    slot = len(pieces.counts) - 2  # a number in the source would be a type of its own to Numba
    stack = np.empty((HALVINGS + 2, 4))
    place = np.empty(3)
    stack[0, 0], stack[0, 1], stack[0, 2], stack[0, 3] = 0.0, before, 1.0, after
    top = 0
    while top >= 0:
        t0, g0, t1, g1 = stack[top]
        top -= 1
        distance = moved * (t1 - t0)
        if (g0 + g1 - distance) / 2 > -least or distance < FINE or t1 - t0 < 1.5 / 2**HALVINGS:
            continue
        t = (t0 + t1) / 2
        set_body(a, sections, joints, bends, f, f + 1, t, pieces, slot)
        set_body(b, sections, joints, bends, f, f + 1, t, pieces, slot + 1)
        value = gap(pieces, slot, slot + 1, skip, place)
        if value < -least:
            keep(row, f, t, f + 1, -value, place)
        stack[top + 1, 0], stack[top + 1, 1] = t0, g0
        stack[top + 1, 2], stack[top + 1, 3] = t, value
        stack[top + 2, 0], stack[top + 2, 1] = t, value
        stack[top + 2, 2], stack[top + 2, 3] = t1, g1
        top += 2


@native(entry=False, allocates=False)
def set_joined(a: int, b: int, ends: Array, beams: int, near: Array, skip: Array) -> Any:
    """Set how many pieces of two bodies (4,) are near a joint that joins them.

    Returns:
        The joint, -1 if there is none, and which end of each beam is there.
    """
    for k in range(4):
        skip[k] = 0
    if b < beams:
        joint, i, j = common_joint(ends, a, b)
        if joint >= 0:
            skip[i], skip[2 + j] = near[a, i], near[b, j]
        return joint, i, j
    if a < beams:
        for e in range(2):
            if ends[a, e] == b - beams:
                skip[e], skip[2] = near[a, e], 1
                return b - beams, e, 0
    return -1, 0, 0


@native(entry=False, allocates=False)
def set_close(
    a: int, b: int, joined: Any, hulls: Any, joints: Array, boxes: Array, least: float,
    close: Array, normals: Array,
) -> bool:  # fmt: skip
    """Set between which frames (F,) and the next two bodies may meet; return whether anywhere.

    The normals (2, 3) are room for the planes of two frames.
    """
    frames = len(close)
    joint = joined[0]
    somewhere = was = apart = False
    for g in range(frames):
        if joint >= 0:
            was, apart = apart, free(a, b, joined, hulls, joints, g, least, normals[g % 2])
        if g == 0 and frames > 1:
            continue
        f = max(g - 1, 0)
        parted = apart and (frames == 1 or (was and dot(normals[0], normals[1]) > STILL))
        close[f] = not parted and meet_between(boxes[a], boxes[b], f, g)
        somewhere = somewhere or close[f]
    return somewhere


@native(entry=False)
def follow(
    a: int, b: int, sections: Array, joints: Array, bends: Any, close: Array, skip: Array,
    least: float, pieces: Any, row: Array,
) -> None:  # fmt: skip
    """Set the row of a pair: its deepest moment, and the first frame that shows a collision."""
    frames = len(close)
    place = np.empty(3)
    built, before = -1, 0.0
    row[5], row[6] = -1.0, 0.0
    for f in range(max(frames - 1, 1)):
        if not close[f]:
            continue
        for g in range(f, min(f + 2, frames)):
            slot = 2 * (g % 2)
            if g > built:
                set_body(a, sections, joints, bends, g, g, 0.0, pieces, slot)
                set_body(b, sections, joints, bends, g, g, 0.0, pieces, slot + 1)
                value = gap(pieces, slot, slot + 1, skip, place)
                if g > f and before >= -least and value >= -least:
                    other = 2 - slot
                    moved = nearing(pieces, other, other + 1, slot, slot + 1, skip)
                    search(a, b, f, before, value, moved, sections, joints, bends, skip, least,
                           pieces, row)  # fmt: skip
                if value < -least:
                    keep(row, g, 0.0, g, -value, place)
                built, before = g, value


@native()
def find_pairs(
    joints: Array, sections: Array, ends: Array, ratios: Array, group: Array, least: float,
    found: Array,
) -> int:  # fmt: skip
    """Set a row for each pair of bodies that collide; return how many there are.

    Args:
        joints: (T, F, J, 8, 3) mm, corners of the joints of T designs of one topology.
        sections: (T, F, B, S, 4, 3) mm, corners of the beams' sections.
        ends: (B, 2) joints of the beams.
        ratios: (T, B) of the actuators.
        group: (B + J,) of the bodies; with several, only pairs of different ones count.
        least: mm; what is not deeper is no collision.
        found: (N, 10) is set: design, bodies, frame, share, first frame, depth, place. More than
            there is room for are counted, but not set.
    """
    designs, frames, beams, given = sections.shape[:4]
    bodies = beams + joints.shape[2]
    rows = ROWS if given == 3 else given
    hulls = Hulls(
        np.empty((frames, beams, rows, 3, 3)), np.empty((frames, beams, 2, 3)),
        np.empty((frames, beams)),
    )  # fmt: skip
    boxes = np.empty((bodies, frames, 6))
    unions = np.empty((bodies, 6))
    skews = np.zeros((beams, 3, 2))
    near = np.zeros((beams, 2), np.int64)
    pairs = np.empty((8 * bodies, 2), np.int64)
    room = make_pieces(6, given)  # of two bodies in two frames, and between these
    row, skip, close = np.zeros(10), np.zeros(4, np.int64), np.zeros(frames, np.bool_)
    normals = np.zeros((2, 3))
    count = 0
    for t in range(designs):
        bends = Bends(ratios[t], skews)
        for b in range(beams):
            if given == 3:
                set_skew(sections[t, 0, b], skews[b])
            for f in range(frames):
                set_hull(sections[t, f, b], skews[b], hulls.rows[f, b])
                hulls.reach[f, b] = set_ends(hulls.rows[f, b], hulls.faces[f, b])
                set_hull_box(hulls.rows[f, b], boxes[b, f])
            set_union(boxes[b], unions[b])
            set_near(sections[t, 0, b], count_of(given), near[b])
        for j in range(beams, bodies):
            for f in range(frames):
                set_joint_box(joints[t, f, j - beams], boxes[j, f])
            set_union(boxes[j], unions[j])
        many = swept_pairs(unions, group, pairs)
        if many > len(pairs):
            pairs = np.empty((2 * many, 2), np.int64)
            many = swept_pairs(unions, group, pairs)
        for k in range(many):
            a, b = pairs[k]
            joined = set_joined(a, b, ends, beams, near, skip)
            if not set_close(a, b, joined, hulls, joints[t], boxes, least, close, normals):
                continue
            follow(a, b, sections[t], joints[t], bends, close, skip, least, room, row)
            if row[6] > 0.0:
                if count < len(found):
                    row[0], row[1], row[2] = t, a, b
                    for c in range(10):
                        found[count, c] = row[c]
                count += 1
    return count

"""The axis of a beam of which three sections are known, and the sections along it.

Each half of a beam is bent evenly where the actuator lies, from the middle on, and straight beyond.
So its axis is an arc and a tangent to it, in the plane of the middle's direction and the end. Both
are fixed by the middle section, the place of the end and the ratio of the actuator; the direction
of the end section is not used: it warps where the joint holds it.
"""

from math import atan2, cos, sin, sqrt
from typing import Any

from simulearn.collisions.kernels.vectors import (
    cross,
    dot,
    length,
    minus,
    plus,
    section_frame,
    unit,
)
from simulearn.native import native

Array = Any

PIECES = 20  # along a beam of three sections: chords stay within .1 mm of the tightest curl
STEPS = 6  # of Newton's method, at most
BENT = 3.0  # rad of a half, at most


@native(entry=False)
def reached(bend: float, share: float) -> Any:
    """Return where an axis of length 1 ends that bends over a share of it: along, across."""
    if abs(bend) < 1e-6:
        return 1.0, bend * (1.0 - share / 2)
    s, c = sin(bend), cos(bend)
    over = share / bend
    return over * s + (1.0 - share) * c, over * (1.0 - c) + (1.0 - share) * s


@native(entry=False)
def bend_of(along: float, across: float, share: float) -> float:
    """Return the bend (rad) of an axis whose end lies there; by Newton's method, from flat."""
    seen = atan2(across, along)
    bend = min(seen / (1.0 - share / 2), BENT)
    for _ in range(STEPS):
        x, y = reached(bend, share)
        off = atan2(y, x) - seen
        if abs(off) < 1e-5:
            break
        a, b = reached(bend + 1e-4, share)
        bend = min(max(bend - off * 1e-4 / (atan2(b, a) - seen - off), 0.0), BENT)
    return bend


@native(entry=False)
def set_skew(flat: Array, skew: Array) -> None:
    """Set half width and skew (3, 2) of a beam's sections (3, 4, 3) in the flat grid.

    The cuts between beams and joints are oblique where beams do not meet at right angles: the left
    side of a section lies further along the beam than its middle by the second number.
    """
    start, _, _ = section_frame(flat[0])
    end, _, _ = section_frame(flat[2])
    along = unit(minus(end, start))
    for s in range(3):
        _, left, _ = section_frame(flat[s])
        skew[s, 1] = dot(left, along)
        skew[s, 0] = length(plus(left, -skew[s, 1], along))


@native(entry=False)
def ahead_of(left: Any, up: Any, skew: Array) -> Any:
    """Return the direction of a beam at a section of these half sides, half width and skew."""
    normal, flank = unit(cross(left, up)), unit(left)
    a, b = skew[0], skew[1]
    return unit(plus((a * normal[0], a * normal[1], a * normal[2]), b, flank))


@native(entry=False)
def set_sections(three: Array, ratio: float, skew: Array, out: Array) -> None:
    """Set the sections (PIECES + 1, 4, 3) along a beam of three sections (3, 4, 3)."""
    middle, left, up = section_frame(three[1])
    ahead = ahead_of(left, up, skew[1])
    left = plus(left, -skew[1, 1], ahead)
    thick = length(up)
    half = PIECES // 2
    share = min(max(abs(ratio), 0.02), 1.0)
    for side in range(2):
        sign = 2.0 * side - 1.0
        end, end_left, end_up = section_frame(three[2 * side])
        to_end = minus(end, middle)
        along = sign * dot(to_end, ahead)
        off = plus(to_end, -sign * along, ahead)
        across = length(off)
        away = unit(off)
        bend = bend_of(along, across, share)
        x, y = reached(bend, share)
        size = sqrt((along * along + across * across) / (x * x + y * y))
        c, s = cos(bend), sin(bend)
        axis = plus((c * ahead[0], c * ahead[1], c * ahead[2]), sign * s, away)
        end_left = plus(end_left, -skew[2 * side, 1], axis)
        end_thick = length(end_up)
        for k in range(side, half + 1):
            t = k / half
            curved = min(t, share)
            angle = bend * curved / share
            x, y = reached(angle, 1.0)
            s, c = sin(angle), cos(angle)
            x, y = curved * x + (t - curved) * c, curved * y + (t - curved) * s
            centre = plus(plus(middle, sign * size * x, ahead), size * y, away)
            # The axis's direction, from the start of the beam to its end.
            axis = plus((c * ahead[0], c * ahead[1], c * ahead[2]), sign * s, away)
            flank = plus(left, t, minus(end_left, left))
            flank = unit(plus(flank, -dot(flank, axis), axis))
            top = cross(axis, flank)
            wide = skew[1, 0] + t * (skew[2 * side, 0] - skew[1, 0])
            oblique = skew[1, 1] + t * (skew[2 * side, 1] - skew[1, 1])
            to_side = plus((oblique * axis[0], oblique * axis[1], oblique * axis[2]), wide, flank)
            high = thick + t * (end_thick - thick)
            row = out[half + (k if side else -k)]
            for i in range(3):
                row[0, i] = centre[i] - to_side[i] - high * top[i]
                row[1, i] = centre[i] + to_side[i] - high * top[i]
                row[2, i] = centre[i] - to_side[i] + high * top[i]
                row[3, i] = centre[i] + to_side[i] + high * top[i]

"""The outlines of joints and beams in the plane.

A joint is a quadrilateral with one side for each of four directions. Where fewer than four beams
meet, the gaps between neighbouring beams are divided into equal parts, a part at a time where
the parts are largest, until there are four directions. The corner between two neighbouring
directions lies where the left edge of the first meets the right edge of the second. A beam runs
from the side of one joint to the side of another: its long edges lie half a width to either side
of its axis, its ends are oblique.
"""

from dataclasses import dataclass
from math import atan2, cos, degrees, pi, sin

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.grid.grid import Grid
from simulearn.material import Section

Point = tuple[float, float]
End = tuple[int, int]  # (beam, 0) is the start of a beam, (beam, 1) its end

# Angles closer than this are equal: far above rounding, far below what anyone draws (radians).
TIE = 1e-9
# Sharpest and bluntest corner of a joint that still makes sound bricks (degrees).
SHARPEST = 15.0
BLUNTEST = 180.0 - SHARPEST


@dataclass(frozen=True)
class Outline:
    """Corners of joints and beams in the plane, mm.

    Attributes:
        joints: (J, 4, 2) corners counter-clockwise, the first being the one with the smallest
            angle in [0, 2 pi) seen from the joint.
        sides: (B, 2) side of the start joint and of the end joint that the beam meets;
            side k of a joint runs from its corner k to its corner k + 1 (mod 4).
        beams: (B, 2, 2, 2) [start, end] x [right, left] x (x, y), where left is z x (start -> end).
    """

    joints: NDArray[np.float64]
    sides: NDArray[np.int64]
    beams: NDArray[np.float64]


@dataclass(frozen=True)
class JointOutline:
    """Corners of one joint.

    Attributes:
        corners: four (x, y), mm, in the order of `Outline.joints`.
        sides: the side that each beam end meets.
    """

    corners: list[Point]
    sides: dict[End, int]

    def face(self, end: End) -> tuple[Point, Point]:
        """Return the two corners (mm) that a beam end meets, right and left of the beam."""
        side = self.sides[end]
        a, b = self.corners[side], self.corners[(side + 1) % 4]
        # Looking outwards from a beam's end joint is looking back along the beam.
        return (b, a) if end[1] else (a, b)


def outline(grid: Grid, section: Section) -> Outline:
    """Return the outline of a grid whose beams have the given section.

    Args:
        grid: planar, one to four beams at each joint.
        section: its width is the beams' width, mm.

    Raises:
        InputError: a joint has no sound outline; the message names the joint.
    """
    joints = [joint_outline(grid, section, k, meeting) for k, meeting in enumerate(beams_at(grid))]
    ends = [
        [(joints[joint], (beam, end)) for end, joint in enumerate(pair)]
        for beam, pair in enumerate(grid.beams.tolist())
    ]
    return Outline(
        joints=np.array([joint.corners for joint in joints]).reshape(-1, 4, 2),
        sides=np.array(
            [[joint.sides[end] for joint, end in pair] for pair in ends], dtype=np.int64
        ).reshape(-1, 2),
        beams=np.array([[joint.face(end) for joint, end in pair] for pair in ends]).reshape(
            -1, 2, 2, 2
        ),
    )


def beams_at(grid: Grid) -> list[list[End]]:
    """Return for each joint the beams that meet there as (beam, end), end 0 being its start."""
    meeting: list[list[End]] = [[] for _ in grid.joints]
    for beam, ends in enumerate(grid.beams.tolist()):
        for end, joint in enumerate(ends):
            meeting[joint].append((beam, end))
    return meeting


def joint_outline(grid: Grid, section: Section, joint: int, meeting: list[End]) -> JointOutline:
    """Return the outline of one joint.

    Args:
        grid: the grid.
        section: section of its beams.
        joint: index of the joint.
        meeting: its beams, as `beams_at` gives them.

    Raises:
        InputError: no beam or more than four meet here, two leave in one direction, or the
            quadrilateral is not convex or too sharp.
    """
    if not 1 <= len(meeting) <= 4:
        raise InputError(f"joint {joint} has {len(meeting)} beams; a joint takes 2 to 4")
    x, y = grid.joints[joint].tolist()
    leaving = []
    for beam, end in meeting:
        other = int(grid.beams[beam, 1 - end])
        u, v = grid.joints[other].tolist()
        if u == x and v == y:
            raise InputError(f"joint {joint} lies where joint {other} lies; beam {beam} is a point")
        leaving.append((atan2(v - y, u - x), (beam, end)))
    leaving.sort()
    angles = [angle for angle, _ in leaving]
    gaps = [b - a for a, b in zip(angles, [*angles[1:], angles[0] + 2 * pi], strict=True)]
    beams = [beam for _, (beam, _) in leaving]
    for k, gap in enumerate(gaps):
        if gap < TIE:
            a, b = sorted((beams[k], beams[(k + 1) % len(beams)]))
            raise InputError(f"beams {a} and {b} leave joint {joint} in one direction")

    half = section.width / 2
    corners: list[Point] = []
    side: dict[End, int] = {}
    for (angle, leaves), gap, n in zip(leaving, gaps, _parts(gaps, beams), strict=True):
        side[leaves] = len(corners) - 1  # begins at the corner before
        for k in range(n):
            bisector = angle + gap / n * (k + 0.5)
            reach = half / sin(gap / n / 2)
            corners.append((reach * cos(bisector), reach * sin(bisector)))
    first = min(range(4), key=lambda k: (atan2(*corners[k][::-1]) + TIE) % (2 * pi))
    corners = corners[first:] + corners[:first]
    _check(joint, corners)
    return JointOutline(
        [(x + u, y + v) for u, v in corners],
        {end: (k - first) % 4 for end, k in side.items()},
    )


def _parts(gaps: list[float], beams: list[int]) -> list[int]:
    """Return into how many parts each gap is divided; `beams[k]` is the beam before gap k.

    Equal parts: the gap in fewer parts first, then the one between the beams first in number.
    Neither depends on how the grid is turned or mirrored.
    """
    parts = [1] * len(gaps)
    between = [sorted((b, beams[(k + 1) % len(beams)])) for k, b in enumerate(beams)]
    while sum(parts) < 4:
        largest = max(gap / n for gap, n in zip(gaps, parts, strict=True)) - TIE
        ties = [k for k, gap in enumerate(gaps) if gap / parts[k] >= largest]
        parts[min(ties, key=lambda k: (parts[k], between[k]))] += 1
    return parts


def _check(joint: int, corners: list[Point]) -> None:
    """Raise InputError unless the corners make a convex quadrilateral without sharp corners."""
    for k, (x, y) in enumerate(corners):
        (px, py), (nx, ny) = corners[k - 1], corners[(k + 1) % 4]
        back, on = (px - x, py - y), (nx - x, ny - y)
        inside = degrees(
            atan2(on[0] * back[1] - on[1] * back[0], on[0] * back[0] + on[1] * back[1])
        )
        if not SHARPEST <= inside <= BLUNTEST:
            raise InputError(
                f"joint {joint} has a corner of {inside % 360:.1f} degrees; its beams must leave "
                f"it so that each corner has {SHARPEST:g} to {BLUNTEST:g}"
            )

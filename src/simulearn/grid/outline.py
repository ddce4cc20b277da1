"""The outlines of joints and beams in the plane.

A joint is a quadrilateral; `grid.corners` says between which beams its corners lie. A corner lies
where the left edge of the beam before it meets the right edge of the beam after it. A beam runs
from the side of one joint to the side of another: its long edges lie half a width to either side
of its axis, its ends are oblique.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.grid.corners import (
    NEXT,
    CornerTopology,
    Indices,
    Numbers,
    corner_topology,
    corners,
    directions,
    halves_at_joints,
)
from simulearn.grid.grid import Grid
from simulearn.material import Section

__all__ = ["CornerTopology", "Outline", "Outlines", "corner_topology", "outline", "outlines"]

# Sharpest and bluntest corner of a joint that still makes sound bricks (degrees).
SHARPEST = 15.0
BLUNTEST = 180.0 - SHARPEST

LAST = np.array([3, 0, 1, 2])


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

    joints: Numbers
    sides: Indices
    beams: Numbers


@dataclass(frozen=True)
class Outlines:
    """The outlines of T designs of one topology, sound or not.

    Attributes:
        joints: (T, J, 4, 2) mm, corners as in `Outline`.
        sides: (T, B, 2) as in `Outline`.
        beams: (T, B, 2, 2, 2) mm, as in `Outline`.
        sound: (T, J) whether a joint has an outline; elsewhere the numbers mean nothing.
        ends: (B, 2) joint indices.
        meeting: (J, 4) the first four half-beams at each joint; -1 fills up.
        valence: (J,) number of half-beams at each joint.
        points: (T, J, 4) whether a half-beam of `meeting` has no length.
        order: (T, J, 4) half-beams at each joint, by rising angle; -1 fills up.
        ties: (T, J, 4) whether a half-beam of `order` leaves in the direction of the next one.
        inside: (T, J, 4) degrees, angles at the corners.
    """

    joints: Numbers
    sides: Indices
    beams: Numbers
    sound: NDArray[np.bool_]
    ends: Indices
    meeting: Indices
    valence: Indices
    points: NDArray[np.bool_]
    order: Indices
    ties: NDArray[np.bool_]
    inside: Numbers

    def fault(self, design: int, joint: int) -> str:
        """Return why a joint of a design has no outline."""
        beams = len(self.ends)
        valence = int(self.valence[joint])
        if not 1 <= valence <= 4:
            return f"joint {joint} has {valence} beams; a joint takes 2 to 4"
        if (points := self.points[design, joint]).any():
            end, beam = divmod(int(self.meeting[joint, points.argmax()]), beams)
            other = self.ends[beam, 1 - end]
            return f"joint {joint} lies where joint {other} lies; beam {beam} is a point"
        if (ties := self.ties[design, joint]).any():
            slot = int(ties.argmax())
            two = self.order[design, joint, [slot, (slot + 1) % valence]] % beams
            return f"beams {min(two)} and {max(two)} leave joint {joint} in one direction"
        inside = self.inside[design, joint]
        return (
            f"joint {joint} has a corner of {inside[_unsound(inside).argmax()] % 360:.1f} "
            f"degrees; its beams must leave it so that each corner has "
            f"{SHARPEST:g} to {BLUNTEST:g}"
        )


def outline(grid: Grid, section: Section) -> Outline:
    """Return the outline of a grid whose beams have the given section.

    Args:
        grid: planar, one to four beams at each joint.
        section: its width is the beams' width, mm.

    Raises:
        InputError: a joint has no sound outline; the message names the joint.
    """
    one = outlines(grid.beams, grid.joints[None], section.width)
    if not one.sound.all():
        joint = int(one.sound[0].argmin())
        raise InputError(one.fault(0, joint), "joint-outline", f"joint {joint}")
    return Outline(one.joints[0], one.sides[0], one.beams[0])


def outlines(
    beams: Indices, joints: Numbers, width: float, stay: NDArray[np.bool_] | None = None
) -> Outlines:
    """Return the outlines of designs of one topology; `Outlines.sound` says where there are none.

    Args:
        beams: (B, 2) joint indices, start and end.
        joints: (T, J, 2) mm.
        width: width of the beams, mm.
        stay: (B,) the beams that count, all unless given; the numbers of the others mean nothing.
    """
    trials, count = joints.shape[:2]
    meeting, valence = halves_at_joints(beams, count, stay)
    direction = directions(beams, joints)
    at = corners(meeting, valence, direction, len(beams))
    with np.errstate(divide="ignore", invalid="ignore"):  # where two beams leave in one direction
        reach = width / 2 / np.sin(at.opening / 2)
        corner = np.stack([reach * np.cos(at.bisector), reach * np.sin(at.bisector)], axis=-1)
        back, on = corner[:, :, LAST] - corner, corner[:, :, NEXT] - corner
        turn = on[..., 0] * back[..., 1] - on[..., 1] * back[..., 0]
        inside = np.degrees(np.arctan2(turn, (on * back).sum(axis=-1)))
        corner += joints[:, :, None]
    point = np.zeros((trials, 2 * len(beams) + 1), bool)
    point[:, :-1] = (direction == 0).all(axis=-1)
    points = point[:, meeting]
    many = (valence < 1) | (valence > 4)
    sound = ~(many | (points | at.ties | _unsound(inside)).any(axis=-1))

    sides = np.moveaxis(at.topology.side, 1, 2)
    first = (np.arange(trials)[:, None, None] * count + beams) * 4
    places = corner.reshape(-1, 2)
    faces = np.stack([places[first + sides], places[first + NEXT[sides]]], axis=3)
    # Right and left as the half-beam leaves its joint; at a beam's end that looks back along it.
    faces[:, :, 1] = faces[:, :, 1, ::-1]
    return Outlines(
        joints=corner,
        sides=sides,
        beams=faces,
        sound=sound,
        ends=beams,
        meeting=meeting,
        valence=valence,
        points=points,
        order=at.order,
        ties=at.ties,
        inside=inside,
    )


def _unsound(inside: Numbers) -> NDArray[np.bool_]:
    """Return which angles (degrees) at corners are too sharp, too blunt or no numbers."""
    return ~((inside >= SHARPEST) & (inside <= BLUNTEST))

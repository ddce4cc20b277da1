"""The outlines of joints and beams in the plane.

A joint is a quadrilateral; the rule in `grid.corners` gives the beams before and after each of its
corners. A corner lies where the left edge of the first meets the right edge of the second. A beam
runs from the side of one joint to the side of another: its long edges lie half a width to either
side of its axis, its ends are oblique.
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
# A beam's corners from the side that it meets, [start, end] x [right, left]: a half-beam leaves
# with the side's first corner to its right; at a beam's end that looks back along the beam.
FACES = np.array([[0, 1], [1, 0]])


@dataclass(frozen=True)
class Outline:
    """Corners of joints and beams in the plane, mm.

    Attributes:
        joints: (J, 4, 2) corners counter-clockwise, the first being the one with the smallest
            angle in [0, 2 pi) from the joint.
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
        corner = reach * np.exp(1j * at.bisector)  # x + i y, from the joint
        turn = (corner[..., LAST] - corner) * np.conj(corner[..., NEXT] - corner)
        inside = np.degrees(np.arctan2(turn.imag, turn.real))
    place = corner.view(np.float64).reshape(trials, count, 4, 2) + joints[:, :, None]
    point = np.zeros((trials, 2 * len(beams) + 1), bool)
    np.equal(direction, 0, out=point[:, :-1])
    points = point[:, meeting]
    sound = ~(points | at.ties | _unsound(inside)).any(axis=-1)
    sound &= (valence > 0) & (valence < 5)

    sides = at.topology.side.swapaxes(1, 2)
    joint = np.arange(0, trials * count, count)[:, None, None] + beams
    faces = (sides[..., None] + FACES) % 4 + 4 * joint[..., None]
    return Outlines(
        joints=place,
        sides=sides,
        beams=place.reshape(-1, 2).take(faces, axis=0),
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

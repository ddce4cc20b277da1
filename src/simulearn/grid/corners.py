"""Which corner of a joint lies between which half-beams: the rule, for many designs at once.

A joint is a quadrilateral with one side for each of four directions. Where fewer than four beams
meet, the gaps between neighbouring beams are divided into equal parts, a part at a time where
the parts are largest, until there are four directions. A corner bisects each part.

A half-beam has the number h = end * B + beam, where end 0 is the start of a beam and B is the
number of beams.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError

Numbers = NDArray[np.float64]
Indices = NDArray[np.int64]
Vectors = NDArray[np.complex128]  # of the plane, x + i y

# Angles closer than this are equal: far above rounding, far below what anyone draws (radians).
TIE = 1e-9
TURN = 2 * np.pi
CORNER = np.arange(4)
NEXT = np.array([1, 2, 3, 0])
NEXT_NUMBER = np.arange(1, 5)
LAST = np.iinfo(np.int64).max


class CornerTopology(NamedTuple):
    """Which corner of a joint lies between which half-beams, for T designs of one topology.

    Attributes:
        before: (T, J, 4) half-beam before each corner, counter-clockwise.
        after: (T, J, 4) half-beam after it.
        parts: (T, J, 4) number of parts into which the gap between the two is divided.
        part: (T, J, 4) number of the part, from 0, that the corner bisects.
        side: (T, 2, B) side of its joint from which each half-beam leaves; side k runs from
            corner k to corner k + 1 (mod 4).
    """

    before: Indices
    after: Indices
    parts: Indices
    part: Indices
    side: Indices


class Corners(NamedTuple):
    """The four corners of each joint, for T designs of one topology.

    Attributes:
        topology: the half-beams between which they lie.
        bisector: (T, J, 4) radians, direction from the joint to the corner.
        opening: (T, J, 4) radians, angle of the part that the corner bisects.
        order: (T, J, 4) half-beams at each joint, by rising angle; -1 fills up.
        ties: (T, J, 4) whether a half-beam of `order` leaves in the direction of the next one.
    """

    topology: CornerTopology
    bisector: Numbers
    opening: Numbers
    order: Indices
    ties: NDArray[np.bool_]


def corner_topology(beams: Indices, joints: Numbers) -> CornerTopology:
    """Return between which half-beams the corners of the joints lie.

    Args:
        beams: (B, 2) joint indices, start and end.
        joints: (T, J, 2) mm, joints of T designs; one to four beams meet at each.

    Raises:
        InputError: no beam or more than four meet at a joint.
    """
    meeting, valence = halves_at_joints(beams, joints.shape[1])
    if len(wrong := np.flatnonzero((valence < 1) | (valence > 4))):
        raise InputError(
            f"joint {wrong[0]} has {valence[wrong[0]]} beams; a joint takes 1 to 4",
            "joint-valence",
            f"joint {wrong[0]}",
        )
    return corners(meeting, valence, directions(beams, joints), len(beams)).topology


def halves_at_joints(
    beams: Indices, joints: int, stay: NDArray[np.bool_] | None = None
) -> tuple[Indices, Indices]:
    """Return the first four half-beams (J, 4) at each joint, and how many meet there (J,).

    Args:
        beams: (B, 2) joint indices.
        joints: J.
        stay: (B,) the beams that count; all unless given.

    Returns:
        The half-beams by rising number, where -1 fills up, and their count.
    """
    at = beams.T.ravel()
    half = np.arange(len(at)) if stay is None else np.flatnonzero(np.tile(stay, 2))
    half = half[at[half].argsort(kind="stable")]
    at = at[half]
    valence = np.bincount(at, minlength=joints)
    rank = np.arange(len(at)) - (valence.cumsum() - valence)[at]
    meeting = np.full((joints, 4), -1)
    four = rank < 4
    meeting[at[four], rank[four]] = half[four]
    return meeting, valence


def directions(beams: Indices, joints: Numbers) -> Vectors:
    """Return the vectors (T, 2 B), mm, from the joint of each half-beam to the other one.

    Args:
        beams: (B, 2) joint indices.
        joints: (T, J, 2) mm.

    Returns:
        Complex numbers x + i y.
    """
    place = np.ascontiguousarray(joints).view(np.complex128)[..., 0]
    start, end = place.take(beams.T, axis=1).swapaxes(0, 1)
    # Both are differences, since the negative of 0.0 has another angle.
    return np.concatenate([end - start, start - end], axis=1)


def corners(meeting: Indices, valence: Indices, direction: Vectors, beams: int) -> Corners:
    """Return the corners of all joints.

    Args:
        meeting: (J, 4) half-beams at each joint, as `halves_at_joints` gives them.
        valence: (J,) how many they are. Where they are none or more than four, the corners of
            that joint mean nothing.
        direction: (T, 2 B) mm, as `directions` gives them.
        beams: B.
    """
    trials, count = len(direction), len(meeting)
    valence = valence.clip(1, 4)[:, None]
    empty = valence <= CORNER
    row = np.arange(0, trials * count * 4, 4).reshape(trials, count, 1)

    # One more, in the place -1, stands for no half-beam: it comes last in every order.
    angles = np.full((trials, 2 * beams + 1), np.inf)
    np.arctan2(direction.imag, direction.real, out=angles[:, :-1])
    angle = angles[:, meeting]  # (T, J, 4)
    by_angle = angle.argsort(axis=2, kind="stable")
    order = meeting.take(by_angle + row[0])
    angle = np.where(order < 0, 0.0, angle.take(by_angle + row))
    following = np.where(valence > NEXT, NEXT, 0) + row  # the first follows the last
    after = order.take(following)
    gap = angle.take(following) - angle
    gap += TURN * (valence == NEXT_NUMBER)
    parts = _parts(np.where(empty, -1.0, gap), order, after, valence, beams)

    behind = parts.cumsum(axis=2)
    # Index of the beam before each corner.
    before = (behind[:, :, None] <= CORNER[:, None]).sum(axis=3) + row
    divided = parts.take(before)
    part = CORNER - behind.take(before) + divided
    opening = gap.take(before) / divided
    bisector = angle.take(before) + opening * (part + 0.5)
    first = ((bisector + TIE) % TURN).argmin(axis=2)[..., None]
    rolled = (CORNER + first) % 4 + row
    before = before.take(rolled)
    side = np.zeros((trials, 2 * beams + 1), np.int64)
    side[np.arange(trials)[:, None, None], order] = (behind - parts - 1 - first) % 4
    topology = CornerTopology(
        before=order.take(before),
        after=after.take(before),
        parts=divided.take(rolled),
        part=part.take(rolled),
        side=side[:, :-1].reshape(trials, 2, beams),
    )
    ties = (gap < TIE) & ~empty
    return Corners(topology, bisector.take(rolled), opening.take(rolled), order, ties)


def _parts(gap: Numbers, order: Indices, after: Indices, valence: Indices, beams: int) -> Indices:
    """Return into how many parts (T, J, 4) each gap is divided, four in all at each joint.

    Equal parts: the gap in fewer parts first, then the one between the beams first in number.
    Neither depends on how the grid is turned or mirrored.

    Args:
        gap: (T, J, 4) radians, from each beam to the next; -1 fills up.
        order: (T, J, 4) half-beams before the gaps.
        after: (T, J, 4) half-beams after them.
        valence: (J, 1) number of gaps, 1 to 4.
        beams: B.
    """
    parts = np.ones(gap.shape, np.int64)
    least = valence.min(initial=4)
    if least < 4:
        two = order % max(beams, 1), after % max(beams, 1)
        between = np.minimum(*two) * beams + np.maximum(*two)
    for total in range(least, 4):
        each = gap / parts
        ties = each >= each.max(axis=2, keepdims=True) - TIE
        rank = np.where(ties, parts * beams**2 + between, LAST)
        chosen = rank.argmin(axis=2)[..., None] == CORNER
        parts += chosen & (valence <= total)
    return np.where(gap < 0, 0, parts)

"""The rules of a design as numbers, for many designs of one topology at once.

`grid.validation` writes the messages. Each rule is in one place, so that a grid is valid among a
hundred exactly if it is valid alone.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.grid.cleaning import kept
from simulearn.grid.grid import Grid
from simulearn.grid.outline import Outlines, outlines
from simulearn.grid.overlap import overlaps
from simulearn.grid.size import impossible
from simulearn.grid.structure import FARTHEST, structure_errors
from simulearn.material import Material
from simulearn.material.material import Limits

Numbers = NDArray[np.float64]
Indices = NDArray[np.int64]
Mask = NDArray[np.bool_]

# Lengths this close are equal, so that a length at its limit passes whatever rounding did (mm).
ROUNDING = 1e-6
# Joints closer than this are at one place (mm).
ONE_PLACE = 1e-3
# The shorter long edge of a beam must leave something between its joints (mm).
SHORTEST_EDGE = 1.0
# A projection on which the joints of drawn grids hardly ever coincide.
ASLANT = np.array([np.cos(1.0), np.sin(1.0)])


@dataclass(frozen=True)
class TrainingRange:
    """The grids that a learned model was trained on, each as (least, most), mm.

    Attributes:
        dimension: largest distance from the fixed joint to another joint.
        beam_length: length of a beam between the centres of its joints.
        thickness: of the section that these lengths belong to, in which they count.
    """

    dimension: tuple[float, float]
    beam_length: tuple[float, float]
    thickness: float = 4.0

    def of(self, material: Material) -> "TrainingRange":
        """Return the lengths for the section of a material."""
        ratio = material.section.thickness / self.thickness
        if ratio == 1:
            return self
        low, high = self.dimension
        short, long = self.beam_length
        return TrainingRange(
            (ratio * low, ratio * high), (ratio * short, ratio * long), material.section.thickness
        )


@dataclass(frozen=True)
class Connections:
    """What of the rules depends on the beams and the fixed joint alone.

    Attributes:
        joints: (J,) whether a joint stays when dangling beams are taken off.
        beams: (B,) whether a beam stays.
        parts: the sets of joints that beams connect, the fixed joint's first.
        sound: whether some beams stay, the fixed joint with them, and all is one part.
    """

    joints: Mask
    beams: Mask
    parts: list[set[int]]
    sound: bool


@dataclass(frozen=True)
class Lengths:
    """The lengths of beams of T designs, mm; (T, B) each.

    Attributes:
        full: from the centre of one joint to that of the other.
        net: between the sides of the joints, along the axis.
        edge: the shorter of the two long edges.
    """

    full: Numbers
    net: Numbers
    edge: Numbers


def connections(grid: Grid) -> Connections:
    """Return which beams and joints of a grid stay and which are connected."""
    joints, beams = kept(grid.beams, len(grid.joints))
    parts = _parts(grid)
    sound = bool(beams.any() and joints[grid.fixed] and len(parts) == 1)
    return Connections(joints, beams, parts, sound)


def _parts(grid: Grid) -> list[set[int]]:
    """Return the sets of joints that beams connect, the fixed joint's first."""
    parent = list(range(len(grid.joints)))

    def root(k: int) -> int:
        while parent[k] != k:
            parent[k] = k = parent[parent[k]]
        return k

    pairs = grid.beams.tolist()
    for i, j in pairs:
        parent[root(j)] = root(i)
    parts: dict[int, set[int]] = {}
    for pair in pairs:
        parts.setdefault(root(pair[0]), set()).update(pair)
    return sorted(parts.values(), key=lambda part: (grid.fixed not in part, min(part)))


def coincident(joints: Numbers, most: int) -> Indices:
    """Return the pairs of joints at one place.

    Args:
        joints: (T, J, 2) mm.
        most: after so many pairs of one design, no more of it are sought.

    Returns:
        (pairs, 3) design, joint, joint of higher number; in rising order.
    """
    along = joints @ ASLANT
    order = along.argsort(axis=1)
    rows = np.arange(len(joints))
    along = along[rows[:, None], order]
    pairs = [np.zeros((0, 3), np.int64)]
    count = np.zeros(len(joints), np.int64)
    # Joints at one place are near on the projection: compare each with the next, the next but one
    # and so on, until none is near.
    for step in range(1, joints.shape[1]):
        near = along[rows, step:] - along[rows, :-step] < ONE_PLACE
        some = near.any(axis=1) & (count[rows] < most)
        if not some.any():
            break
        rows, near = rows[some], near[some]
        row, k = np.nonzero(near)
        design = rows[row]
        two = np.sort(np.stack([order[design, k], order[design, k + step]], axis=1), axis=1)
        apart = joints[design, two[:, 0]] - joints[design, two[:, 1]]
        close = np.hypot(*apart.T) < ONE_PLACE
        pairs.append(np.column_stack([design, two])[close])
        count += np.bincount(design[close], minlength=len(count))
    rising = np.concatenate(pairs)
    return rising[np.lexsort(rising.T[::-1])]


def lengths(beams: Indices, joints: Numbers, shape: Outlines) -> Lengths:
    """Return the lengths of the beams of designs; they mean nothing where an end has no outline.

    Args:
        beams: (B, 2) joint indices.
        joints: (T, J, 2) mm.
        shape: outlines of the same designs.
    """
    along = joints[:, beams[:, 1]] - joints[:, beams[:, 0]]
    full = np.hypot(along[..., 0], along[..., 1])
    with np.errstate(divide="ignore", invalid="ignore"):
        edges = (shape.beams[:, :, 1] - shape.beams[:, :, 0]) @ along[..., None]
        right, left = np.moveaxis(edges[..., 0], 2, 0) / full
    # The middle of a joint's side lies on the axis.
    return Lengths(full, (right + left) / 2, np.minimum(right, left))


def too_short(actuators: Numbers, net: Numbers, limits: Limits) -> Mask:
    """Return which actuators are shorter than they may be, and not 0.

    Args:
        actuators: (T, B) signed ratios.
        net: (T, B) mm, net lengths of the beams.
        limits: its least length of an actuator counts.
    """
    ratio = abs(actuators)
    with np.errstate(invalid="ignore"):  # of beams without an outline
        length = ratio * net
    return (ratio > 0) & (length < limits.actuator_length - ROUNDING)


def usual_length(limits: Limits, training: TrainingRange | None) -> tuple[float, float]:
    """Return the least and most usual length of a beam between the centres of its joints, mm.

    Args:
        limits: the material's.
        training: the grids that the model that will answer was trained on; its lengths replace
            the material's.
    """
    return training.beam_length if training else (0.0, limits.beam_length)


def unusual(
    measured: Lengths, limits: Limits, training: TrainingRange | None
) -> tuple[Mask, Mask, Mask]:
    """Return which beams (T, B) are long, which are short and which have a short net length.

    Args:
        measured: lengths of the beams.
        limits: the material's.
        training: the grids that the model that will answer was trained on; its lengths replace
            the material's.
    """
    least, most = usual_length(limits, training)
    return (
        measured.full > most + ROUNDING,
        measured.full < least - ROUNDING,
        measured.net < limits.beam_net_length - ROUNDING,
    )


def outside(dimension: Numbers, training: TrainingRange) -> Mask:
    """Return which dimensions lie outside those of the training.

    Args:
        dimension: mm, largest distance from the fixed joint to another joint.
        training: the grids that a model was trained on.
    """
    least, most = training.dimension
    return ~((dimension >= least - ROUNDING) & (dimension <= most + ROUNDING))


def collisions(shape: Outlines, roomy: Mask, most: int | None = None) -> Indices:
    """Return the pairs of parts of an outline that overlap.

    Args:
        shape: outlines of T designs.
        roomy: (T, B) the beams that count: with outlines at both ends, and room between them.
        most: stop after so many pairs.

    Returns:
        (pairs, 3) design, part, part of higher number; parts are the J joints, then the B beams.
    """
    trials, joints = shape.sound.shape
    there = np.concatenate([shape.sound, roomy], axis=1)
    # Counter-clockwise: start right, end right, end left, start left.
    around = shape.beams[:, :, [0, 1, 1, 0], [0, 0, 1, 1]]
    design, part = np.nonzero(there)
    pieces = np.concatenate([shape.joints, around], axis=1)[there]
    # Seen from a joint, each beam that meets there lies in the wedge between the two corners of
    # its side, beyond that side: parts that have a joint in common do not overlap.
    ends = np.concatenate([np.arange(joints)[:, None].repeat(2, axis=1), shape.ends])[part]
    ends += (design * joints)[:, None]
    two = overlaps(pieces, ends=ends, groups=design if trials > 1 else None, most=most)
    return np.column_stack([design[two[:, 0]], part[two]])


@dataclass(frozen=True)
class Checks:
    """The validity of T designs of one topology.

    Attributes:
        valid: (T,) whether a design has no error.
        usual: (T,) whether it has no warning either.
        net_lengths: (T, B) mm, of the beams; they mean nothing where a design is not valid.
    """

    valid: Mask
    usual: Mask
    net_lengths: Numbers


def check_designs(
    beams: Indices,
    fixed: int,
    joints: Numbers,
    actuators: Numbers,
    material: Material,
    limits: Limits | None = None,
    training: TrainingRange | None = None,
) -> Checks:
    """Return which designs of one topology are valid; the rules are those of `validate`.

    Args:
        beams: (B, 2) joint indices.
        fixed: index of the fixed joint.
        joints: (T, J, 2) mm.
        actuators: (T, B) signed ratios.
        material: the material system, for section and limits.
        limits: other limits than the material's.
        training: the grids that the model that will answer was trained on.

    Raises:
        InputError: the beams or the fixed joint name joints that do not exist, or two beams join
            the same joints.
    """
    limits = limits or material.limits
    like = Grid(np.zeros(joints.shape[1:]), beams, np.zeros(len(beams)), fixed)
    for wrong in structure_errors(like):
        raise InputError(wrong.message, wrong.code, wrong.where)
    at = connections(like)
    shape = outlines(like.beams, joints, material.section.width, at.beams)
    measured = lengths(like.beams, joints, shape)
    crowded = measured.edge < SHORTEST_EDGE
    wrong_beams = crowded | too_short(actuators, measured.net, limits)
    valid: Mask = np.full(len(joints), at.sound)
    valid &= (
        (abs(joints) <= FARTHEST).all(axis=(1, 2))
        & (abs(actuators) <= 1).all(axis=1)
        & (shape.sound | ~at.joints).all(axis=1)
        & ~(wrong_beams & at.beams).any(axis=1)
    )
    valid &= ~impossible(measured.full, material)
    valid[coincident(joints, most=1)[:, 0]] = False
    valid[collisions(shape, at.beams & valid[:, None])[:, 0]] = False

    usual = valid & (at.joints.all() and at.beams.all())
    usual &= ~np.any(unusual(measured, limits, training), axis=(0, 2))
    if training is not None:
        away = joints[:, at.joints] - joints[:, fixed, None]
        usual &= ~outside(np.hypot(away[..., 0], away[..., 1]).max(axis=1, initial=0.0), training)
    return Checks(valid, usual, measured.net)

"""Joints and the beams between them, before they are a grid; what dangles and what is needless."""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from simulearn.drawings.pieces import simplified
from simulearn.grid.cleaning import kept

Numbers = NDArray[np.float64]
Indices = NDArray[np.int64]
Mask = NDArray[np.bool_]

# A dangling beam shorter than this part of the usual one is a stub, left by drawing past a joint.
# A joint on a straight stretch that would leave so short a beam was not meant as one.
SHORT = 1 / 3
# A point so near to the straight line is no bend, as a part of the tolerance.
STRAIGHT = 0.25
# Places are rounded to nanometres, which takes off what rounding left.
DIGITS = 6


@dataclass(frozen=True, eq=False)
class Net:
    """Joints and beams.

    Attributes:
        joints: (J, 2) mm.
        beams: (B, 2) joint indices, start and end as drawn.
        line: (B,) number of the line that draws each.
        ratio: (B,) of its actuator.
        meant: (J,) whether a joint was drawn as one: ends of different lines, a point of a curve.
    """

    joints: Numbers
    beams: Indices
    line: Indices
    ratio: Numbers
    meant: Mask

    @classmethod
    def empty(cls) -> "Net":
        """Return a net of nothing."""
        none = np.zeros(0, np.int64)
        return cls(np.zeros((0, 2)), none.reshape(0, 2), none, np.zeros(0), np.zeros(0, bool))

    @property
    def lengths(self) -> Numbers:
        """(B,) lengths of the beams, mm."""
        return np.hypot(*(self.joints[self.beams[:, 1]] - self.joints[self.beams[:, 0]]).T)

    def with_beams(self, stay: Mask) -> "Net":
        """Return the net with some of its beams (B,); joints keep their numbers."""
        return replace(self, beams=self.beams[stay], line=self.line[stay], ratio=self.ratio[stay])


def numbered(net: Net, tolerance: float) -> Net:
    """Return a net with joints numbered row by row from the lower left, without unused ones.

    Args:
        net: joints and beams.
        tolerance: joints whose heights round to the same multiple of it are in one row, mm.
    """
    used = np.unique(net.beams)
    x, y = net.joints[used].T
    order = used[np.lexsort((y, x.round(6), (y / tolerance).round()))]
    number = np.zeros(len(net.joints), np.int64)
    number[order] = np.arange(len(order))
    joints = net.joints[order].round(DIGITS) + 0.0  # no -0.0
    return replace(net, joints=joints, beams=number[net.beams], meant=net.meant[order])


def without_dangling(net: Net, stubs: bool = True, leaves: bool = True) -> tuple[Net, Mask, Mask]:
    """Return a net without the beams that close no loop; which were stubs (B,), which not (B,).

    A net without any loop is returned as it is.

    Args:
        net: joints and beams.
        stubs: whether dangling beams go that are far shorter than the usual beam.
        leaves: whether longer ones go.
    """
    none = np.zeros(len(net.beams), bool)
    _, stay = kept(net.beams, len(net.joints))
    if stay.all() or not stay.any():
        return net, none, none
    length = net.lengths
    short = length < SHORT * np.median(length[stay])
    if not (stubs and leaves):
        may, stay = np.where(short, stubs, leaves), ~none
        while True:
            valence = np.bincount(net.beams[stay].ravel(), minlength=len(net.joints))
            tip = stay & may & (valence[net.beams] == 1).any(axis=1)
            if not tip.any():
                break
            stay &= ~tip
    return net.with_beams(stay), ~stay & short, ~stay & ~short


def without_needless(net: Net, tolerance: float) -> tuple[Net, Numbers]:
    """Return a net without joints in straight beams that were not meant, and their places (n, 2).

    Args:
        net: joints and beams.
        tolerance: mm; a quarter of it is no bend.
    """
    loose = _loose(net, STRAIGHT * tolerance)
    if not loose.any():
        return net, np.zeros((0, 2))
    gone = np.zeros(len(net.joints), bool)
    drop = np.zeros(len(net.beams), bool)
    beams = net.beams.copy()
    for chain, along in _chains(net.beams, loose):
        stay = simplified(net.joints[chain], STRAIGHT * tolerance)
        corners = np.flatnonzero(stay).tolist()
        gone[np.array(chain)[~stay]] = True
        for begin, end in pairwise(corners):
            if end - begin > 1:
                parts = along[begin:end]
                drop[parts[1:]] = True
                # It runs as the first of its parts did.
                forth = net.beams[parts[0], 0] == chain[begin]
                pair = (chain[begin], chain[end])
                beams[parts[0]] = pair if forth else pair[::-1]
    # Two straight ways between the same joints would be one beam.
    if len(np.unique(np.sort(beams[~drop], axis=1), axis=0)) < np.count_nonzero(~drop):
        return net, np.zeros((0, 2))
    return replace(net, beams=beams).with_beams(~drop), net.joints[gone]


def _loose(net: Net, least: float) -> Mask:
    """Return which joints (J,) may go: between two beams in line that were drawn as one."""
    two = np.bincount(net.beams.ravel(), minlength=len(net.joints)) == 2
    order = np.argsort(net.beams.ravel(), kind="stable")
    joint = net.beams.ravel()[order]
    at = order[two[joint]].reshape(-1, 2)  # the two ends at each joint between two beams
    beam, far = at // 2, net.beams.ravel()[at ^ 1]
    k = joint[two[joint]][::2]
    length = net.lengths
    short = (length[beam] < SHORT * np.median(length)).any(axis=1) if len(length) else two[:0]
    alike = net.ratio[beam[:, 0]] == net.ratio[beam[:, 1]]
    one, other = net.joints[far[:, 0]] - net.joints[k], net.joints[far[:, 1]] - net.joints[k]
    chord = other - one
    size = np.maximum(np.hypot(*chord.T), 1e-300)
    off = abs(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]) / size
    between = (one * other).sum(axis=1) < 0
    loose = np.zeros(len(net.joints), bool)
    loose[k] = alike & between & (off <= least) & (short | ~net.meant[k])
    return loose


def _chains(beams: Indices, loose: Mask) -> list[tuple[list[int], list[int]]]:
    """Return the ways through loose joints: their joints, with one at either end, and beams."""
    at: dict[int, list[int]] = {}
    for b, pair in enumerate(beams.tolist()):
        for joint in pair:
            if loose[joint]:
                at.setdefault(joint, []).append(b)
    ends, seen, chains = beams.tolist(), set[int](), []
    for b, (i, j) in enumerate(ends):
        for start, joint in ((i, j), (j, i)):
            if b in seen or loose[start] or not loose[joint]:
                continue
            chain, along = [start, joint], [b]
            while loose[chain[-1]]:
                first, second = at[chain[-1]]
                along.append(second if first == along[-1] else first)
                one, other = ends[along[-1]]
                chain.append(other if one == chain[-1] else one)
            seen.update(along)
            chains.append((chain, along))
    return chains

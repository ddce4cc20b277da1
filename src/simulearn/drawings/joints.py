"""Where the joints lie: at the crossing of the axes that meet there.

Each run that passes a node has a straight axis. The joint is the point with the least sum of
squared distances to these axes, each weighted by the length of its run, since a long run fixes its
axis best; what dangles has no say. Along directions that the axes leave open, as where all are
nearly parallel, the joint lies at the mean of the places where the runs are nearest to it.
"""

import numpy as np
import shapely
from numpy.typing import NDArray

from simulearn.drawings.meetings import Stations, merged
from simulearn.drawings.parts import parts
from simulearn.grid.cleaning import kept

Numbers = NDArray[np.float64]

# Two axes of equal weight that meet under less than about 5 degrees leave their crossing open.
OPEN = 0.002
# Ends so near to each other coincide, as a part of the tolerance.
ROUNDING = 1e-4
# A crossing further from where the runs end than so many tolerances is none of this joint.
FARTHEST = 3.0


def placed(ends: Numbers, at: Stations, tolerance: float) -> tuple[Stations, Numbers]:
    """Return the stations and their joints (J, 2) mm, by the numbers of the nodes.

    Joints nearer to each other than the tolerance become one.

    Args:
        ends: (R, 2, 2) mm, the runs.
        at: their stations.
        tolerance: mm.
    """
    while True:
        joints = _crossings(ends, at, tolerance)
        tree = shapely.STRtree(shapely.points(joints))
        a, b = tree.query(shapely.points(joints), "dwithin", tolerance)
        two = a < b
        if not two.any():
            return at, joints
        node = parts(len(joints), a[two], b[two])
        at = merged(at.run, node[at.node], at.place, at.start, at.end)


def _crossings(ends: Numbers, at: Stations, tolerance: float) -> Numbers:
    """Return the joints (J, 2) mm of nodes."""
    count = int(at.node.max()) + 1

    def total(values: Numbers) -> Numbers:
        return np.asarray(np.bincount(at.node, values, count), np.float64)

    vector = ends[:, 1] - ends[:, 0]
    length = np.hypot(*vector.T)
    say = _say(at, length, count)
    along = (vector / length[:, None])[at.run]
    length = length[at.run]
    points = ends[at.run, 0] + np.clip(at.place, 0, length)[:, None] * along
    mean = np.stack([total(say * points[:, k]) for k in (0, 1)], axis=1) / total(say)[:, None]
    normal = np.stack([-along[:, 1], along[:, 0]], axis=1)
    off = (normal * (points - mean[at.node])).sum(axis=1)
    weight = say * length / total(say * length)[at.node]
    xx, xy, yy = (total(weight * normal[:, i] * normal[:, j]) for i, j in ((0, 0), (0, 1), (1, 1)))
    right = np.stack([total(weight * normal[:, k] * off) for k in (0, 1)], axis=1)
    # The sum of the two eigenvalues is 1.
    half = np.hypot(xx - yy, 2 * xy) / 2
    angle = np.arctan2(2 * xy, xx - yy) / 2
    first = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    second = np.stack([-first[:, 1], first[:, 0]], axis=1)
    move = first * ((first * right).sum(axis=1) / (0.5 + half))[:, None]
    small = np.maximum(0.5 - half, 1e-300)
    other = second * np.where(small > OPEN, (second * right).sum(axis=1) / small, 0)[:, None]
    move += np.where((np.hypot(*other.T) <= FARTHEST * tolerance)[:, None], other, 0)
    # Where all ends coincide but for rounding, they are the joint.
    spread = np.zeros(count)
    np.maximum.at(spread, at.node, say * np.hypot(*(points - mean[at.node]).T))
    return mean + np.where((spread > ROUNDING * tolerance)[:, None], move, 0)


def _say(at: Stations, length: Numbers, count: int) -> Numbers:
    """Return for each station 1 where its run has a beam there that is part of a loop, else 0.

    At nodes without such a beam all stations count.

    Args:
        at: stations of the runs.
        length: (R,) of the runs, mm.
        count: of the nodes.
    """
    step = np.flatnonzero(at.run[1:] == at.run[:-1])
    # Two runs between the same nodes are no loop: the longer one is the beam.
    step = step[np.argsort(-length[at.run[step]], kind="stable")]
    beams = np.sort(np.stack([at.node[step], at.node[step + 1]], axis=1), axis=1)
    _, first = np.unique(beams, axis=0, return_index=True)
    step, beams = step[first], beams[first]
    _, stay = kept(beams, count)
    say = np.zeros(len(at.run))
    say[step[stay]] = say[step[stay] + 1] = 1
    say[np.bincount(at.node, say, count)[at.node] == 0] = 1
    return say

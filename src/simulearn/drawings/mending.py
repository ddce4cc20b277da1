"""From lines in the plane to a net of joints and beams, one step after the other.

Pieces, without crumbs. Pieces on each other become runs. Runs that meet share nodes. Joints lie at
the crossing of the runs' axes. Beams lead from joint to joint. What dangles goes, and so does a
joint that is only a point in a straight beam.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from simulearn.drawings.beams import net_of
from simulearn.drawings.doubles import united
from simulearn.drawings.found import found
from simulearn.drawings.joints import placed
from simulearn.drawings.meetings import stations
from simulearn.drawings.net import Net, numbered, without_dangling, without_needless
from simulearn.drawings.pieces import EXACT, neighbours, pieces_of

Numbers = NDArray[np.float64]
Mask = NDArray[np.bool_]

# What is done to a drawing, by code, in the order in which it is reported.
MENDS = (
    "plane",
    "flattened",
    "crumb",
    "double",
    "overlap",
    "gap",
    "overshoot",
    "t-touch",
    "crossing",
    "stub",
    "leaf",
    "straight",
)


@dataclass(frozen=True, eq=False)
class Mended:
    """A net and what was done to get it.

    Attributes:
        net: joints and beams; each joint has a beam.
        places: by code of `MENDS`, (n, 2) mm; only what was done.
        mixed: (n, 2) mm, the middles of beams drawn with several actuators.
    """

    net: Net
    places: dict[str, Numbers]
    mixed: Numbers


def mended(
    lines: Sequence[Numbers],
    ratios: Numbers,
    meant: Mask,
    tolerance: float,
    without: Collection[str] = (),
) -> Mended:
    """Return the net that lines draw; it has no beams if all lines are crumbs.

    Args:
        lines: polylines, each (n, 2) mm.
        ratios: (L,) of the actuators that they stand for.
        meant: (L,) whether all their points are meant, as those of a curve made of chords.
        tolerance: mm.
        without: codes of `MENDS` that are not done.

    Raises:
        InputError: the lines touch at too many places.
    """
    pieces = pieces_of(lines, tolerance, "straight" not in without)
    places = {"crumb": pieces.crumbs}
    if len(pieces.ends):
        pairs = neighbours(pieces.ends, 2 * tolerance)
        runs = united(pieces.ends, pairs, tolerance, "overlap" not in without)
        places |= {"double": runs.double, "overlap": runs.overlap}
        if len(runs.ends) < len(pieces.ends):
            pairs = neighbours(runs.ends, 2 * tolerance)
        at = stations(runs.ends, pairs, tolerance, without)
        as_drawn = {"gap", "overshoot"} & set(without)
        near = EXACT * tolerance if as_drawn else tolerance
        at, joints = placed(runs.ends, at, near)
        places |= (marks := found(runs.ends, at, joints, tolerance))
        places["crumb"] = np.concatenate([pieces.crumbs, marks["crumb"]])
        net, mixed = net_of(pieces, runs, at, joints, ratios, meant)
    else:
        net, mixed = Net.empty(), np.zeros((0, 2))
    whole = net
    net, stubs, leaves = without_dangling(net, "stub" not in without, "leaf" not in without)
    middle = whole.joints[whole.beams].mean(axis=1)
    places |= {"stub": middle[stubs], "leaf": middle[leaves]}
    if "straight" not in without:
        net, needless = without_needless(net, tolerance)
        alone = _alone(pieces.needless, net.joints[np.unique(net.beams)], tolerance)
        places["straight"] = np.concatenate([pieces.needless[alone], needless])
    for code in ("gap", "overshoot", "t-touch", "crossing"):  # some joints went again
        spots = places.get(code, pieces.crumbs[:0])
        places[code] = spots[~_alone(spots, net.joints[np.unique(net.beams)], tolerance)]
    done = {code: places[code] for code in MENDS if len(places.get(code, ()))}
    return Mended(numbered(net, tolerance), done, mixed)


def _alone(points: Numbers, joints: Numbers, tolerance: float) -> Mask:
    """Return which points (n, 2) have no joint near them."""
    alone = np.ones(len(points), bool)
    tree = shapely.STRtree(shapely.points(joints))
    alone[tree.query(shapely.points(points), "dwithin", tolerance)[0]] = False
    return alone

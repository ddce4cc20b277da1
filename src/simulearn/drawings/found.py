"""What was found where runs meet: gaps, overshoots, touches and crossings without a joint."""

import numpy as np
from numpy.typing import NDArray

from simulearn.drawings.meetings import Stations
from simulearn.drawings.pieces import EXACT
from simulearn.grid.sketch import cross

Numbers = NDArray[np.float64]


def found(ends: Numbers, at: Stations, joints: Numbers, tolerance: float) -> dict[str, Numbers]:
    """Return the joints (n, 2) mm at which something was mended, by the code of the mend.

    Args:
        ends: (R, 2, 2) mm, the runs.
        at: their stations.
        joints: (J, 2) mm, by the numbers of the nodes.
        tolerance: mm; a hundredth of it is nothing.
    """
    exact = EXACT * tolerance
    start, vector = ends[at.run, 0], (ends[:, 1] - ends[:, 0])[at.run]
    length = np.hypot(*vector.T)
    along = vector / length[:, None]
    apart = joints[at.node] - start
    place, aside = (apart * along).sum(axis=1), cross(along, apart)
    past = np.maximum(np.where(at.start, place, -np.inf), np.where(at.end, length - place, -np.inf))
    short = np.maximum(
        np.where(at.start, -place, -np.inf), np.where(at.end, place - length, -np.inf)
    )
    one_end = at.start ^ at.end
    shared = np.bincount(at.node, minlength=len(joints)) > 1
    through = np.bincount(at.node, at.inner, len(joints)).round().astype(int)

    def some(which: NDArray[np.bool_]) -> NDArray[np.bool_]:
        return shared & (np.bincount(at.node, one_end & which, len(joints)) > 0)

    marks = {
        "gap": some((short > exact) | (abs(aside) > exact)),
        "overshoot": some(past > exact),
        "t-touch": shared & (through == 1),
        "crossing": shared & (through > 1),
        "crumb": np.bincount(at.node, at.start & at.end, len(joints)) > 0,
    }
    return {code: joints[mark] for code, mark in marks.items()}

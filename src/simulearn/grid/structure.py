"""What must hold before a grid has a shape at all: numbers in range, indices that exist.

The file reader and validation both use these rules; the messages name the file's keys, which are
those of a grid in memory, too.
"""

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import Message
from simulearn.grid.grid import Grid
from simulearn.grid.size import unit_remark

# Far beyond any printer; keeps squares and products of coordinates from overflowing (mm).
FARTHEST = 1e5
# Far beyond any print. So many take at most half a second and 200 MB to validate.
MOST_JOINTS = 20_000
MOST_BEAMS = 2 * MOST_JOINTS  # no more than four meet at a joint


def structure_errors(grid: Grid) -> list[Message]:
    """Return what is wrong with the numbers and indices of a grid, in the order of its keys."""
    joints, beams, actuators = len(grid.joints), len(grid.beams), len(grid.actuators)
    for count, most, name in ((joints, MOST_JOINTS, "joints"), (beams, MOST_BEAMS, "beams")):
        if count > most:
            text = f"the grid has {count} {name}; at most {most} can be computed"
            return [Message("too-large", "grid", text)]
    errors = []
    if actuators != beams:
        text = f"actuators has {actuators} ratios for {beams} beams; there is one for each beam"
        errors.append(Message("actuator-count", "grid", text))
    far = np.flatnonzero((abs(grid.joints) > FARTHEST).any(axis=1)).tolist()
    for k in far:
        text = f"coordinates lie within {FARTHEST:g} mm of the origin{unit_remark(grid)}"
        place = f"joints[{k}] is {grid.joints[k].tolist()}"
        errors.append(Message("joint-place", f"joint {k}", f"{place}; {text}"))
    errors += _beam_errors(grid)
    for k in np.flatnonzero(abs(grid.actuators) > 1).tolist():
        text = f"actuators[{k}] is {grid.actuators[k]:g}; a ratio lies in [-1, 1]"
        errors.append(Message("actuator-ratio", f"beam {k}", text))
    if not 0 <= grid.fixed < joints:
        text = f"fixed is {grid.fixed}; joints are numbered 0 to {joints - 1}"
        errors.append(Message("fixed-index", "grid", text))
    return errors


def _beam_errors(grid: Grid) -> list[Message]:
    """Return the errors of beams: joints that do not exist, one joint twice, two beams twice."""
    joints = len(grid.joints)
    low, high = grid.beams.min(axis=1), grid.beams.max(axis=1)
    outside, loop = (low < 0) | (high >= joints), low == high
    key = np.where(outside | loop, -1 - np.arange(len(low)), low * joints + high)
    rising = np.sort(key)
    if not len(rising) or (rising[0] >= 0 and (rising[1:] > rising[:-1]).all()):
        return []
    _, first, pair = np.unique(key, return_index=True, return_inverse=True)
    hint = _hint(low, high, joints)
    first = first[pair]  # the first beam between the same two joints
    wrong = np.flatnonzero((key < 0) | (first != np.arange(len(first))))
    errors = []
    for k, (i, j) in zip(wrong.tolist(), grid.beams[wrong].tolist(), strict=True):
        if outside[k]:
            code, text = "beam-index", f"joints are numbered 0 to {joints - 1}{hint}"
        elif loop[k]:
            code, text = "beam-to-itself", "a beam joins two different joints"
        else:
            code, text = "beam-duplicate", f"beam {first[k]} joins the same two joints"
        errors.append(Message(code, f"beam {k}", f"beams[{k}] is [{i}, {j}]; {text}"))
    return errors


def _hint(low: NDArray[np.int64], high: NDArray[np.int64], joints: int) -> str:
    """Return what to do where the joints' numbers begin and end one too high."""
    from_one = low.min() >= 1 and high.max() == joints
    return "; these count from 1: subtract 1 from every index" if from_one else ""

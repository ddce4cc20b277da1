"""Where straight runs meet: each reaches a tolerance beyond its ends.

So gaps close, and what lies within a tolerance of an end is at that end. A place where runs meet
is a node; a run passes its nodes in order of their stations, the places along it.
"""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.drawings.parts import parts
from simulearn.drawings.pieces import EXACT
from simulearn.grid.sketch import cross

Numbers = NDArray[np.float64]
Indices = NDArray[np.int64]
Mask = NDArray[np.bool_]

# Sines of the angles below which runs are parallel, and nearly so.
PARALLEL, SHALLOW = 1e-6, 0.02


@dataclass(frozen=True, eq=False)
class Stations:
    """The places of nodes along runs, by run and place; nodes are numbered from 0.

    Attributes:
        run: (S,) which run passes.
        node: (S,) which node; a run passes a node once.
        place: (S,) mm along the run from its start.
        start: (S,) whether the start of the run belongs to the node.
        end: (S,) whether the end of the run belongs to the node.
    """

    run: Indices
    node: Indices
    place: Numbers
    start: Mask
    end: Mask

    @property
    def inner(self) -> Mask:
        """(S,) whether the run passes through the node and goes on to both sides."""
        return ~(self.start | self.end)


def stations(
    ends: Numbers,
    pairs: tuple[Indices, Indices],
    tolerance: float,
    without: Collection[str] = (),
) -> Stations:
    """Return the stations of straight runs; each has one at either end.

    Args:
        ends: (R, 2, 2) mm.
        pairs: numbers of the runs within two tolerances of each other, lower first.
        tolerance: how far a run reaches beyond its ends, mm.
        without: of gap, overshoot, crossing and t-touch those that are left as drawn.
    """
    length = np.hypot(*(ends[:, 1] - ends[:, 0]).T)
    reach = EXACT * tolerance if "gap" in without else tolerance
    trim = EXACT * tolerance if "overshoot" in without else tolerance
    run, place = _meetings(ends, length, pairs, reach)
    through = (trim < place) & (place < length[run] - trim)
    keep = np.ones(run.shape[1], bool)
    if "crossing" in without:
        keep &= ~through.all(axis=0)
    if "t-touch" in without:
        keep &= through[0] == through[1]
    run, place = run[:, keep], place[:, keep]
    # Each run has a place at its start and one at its end, then those where it meets another.
    runs = np.arange(len(ends))
    meeting = np.arange(run.shape[1]) + 2 * len(ends)
    run = np.concatenate([runs, runs, *run])
    place = np.concatenate([np.zeros(len(ends)), length, *place])
    label = np.concatenate([runs, runs + len(ends), meeting, meeting])
    return _joined(run, place, label, len(ends), tolerance, trim)


def _joined(
    run: Indices, place: Numbers, label: Indices, runs: int, tolerance: float, trim: float
) -> Stations:
    """Return stations from places along runs; those near each other on a run are one node.

    Args:
        run: (n,) of each place.
        place: (n,) mm along it.
        label: (n,) equal for two places of one meeting; 0 to 2 runs - 1 are starts, then ends.
        runs: their number.
        tolerance: how near places are one, mm.
        trim: how near they are where one is the end of the run, mm.
    """
    order = np.lexsort((label, place, run))
    one, other = order[:-1], order[1:]
    at_end = (label[one] < 2 * runs) | (label[other] < 2 * runs)
    apart = place[other] - place[one]
    near = (run[one] == run[other]) & (apart <= np.where(at_end, trim, tolerance))
    near |= (run[one] == run[other]) & at_end & _beyond(place, label, one, other, runs)
    node = parts(int(label.max()) + 1, label[one[near]], label[other[near]])
    return merged(run, node[label], place, label < runs, (label >= runs) & (label < 2 * runs))


def _beyond(place: Numbers, label: Indices, one: Indices, other: Indices, runs: int) -> Mask:
    """Return whether of successive places one lies beyond the end of the run that the other is."""
    before: Mask = (label[other] < runs) & (place[one] < place[other])
    after: Mask = (label[one] >= runs) & (label[one] < 2 * runs) & (place[other] > place[one])
    return before | after


def merged(run: Indices, node: Indices, place: Numbers, start: Mask, end: Mask) -> Stations:
    """Return stations of which each run has one at a node: at the mean of its places there.

    Args:
        run: (n,) as in `Stations`, in any order.
        node: (n,) numbers of nodes, not necessarily all from 0.
        place: (n,) mm.
        start: (n,) whether it is the start of the run.
        end: (n,) whether it is the end of the run.
    """
    _, node = np.unique(node, return_inverse=True)
    key = run * (int(node.max()) + 1) + node
    _, first, group = np.unique(key, return_index=True, return_inverse=True)
    count = np.bincount(group)
    mean = np.bincount(group, place) / count
    starts = np.bincount(group, start) > 0
    stops = np.bincount(group, end) > 0
    order = np.lexsort((mean, run[first]))
    return Stations(run[first][order], node[first][order], mean[order], starts[order], stops[order])


def _meetings(
    ends: Numbers, length: Numbers, pairs: tuple[Indices, Indices], reach: float
) -> tuple[Indices, Numbers]:
    """Return where runs meet: the two runs (2, M), and the places along them (2, M) mm."""
    a, b = pairs
    along = (ends[:, 1] - ends[:, 0]) / length[:, None]
    apart = ends[b, 0] - ends[a, 0]
    turn = cross(along[a], along[b])
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        place = np.stack([cross(apart, along[b]), cross(apart, along[a])]) / turn
        run = np.stack([a, b])
        # Where nearly parallel runs follow each other, their crossing may be anywhere near the
        # ends; only one that is well within both is meant.
        inside = np.where(abs(turn) < SHALLOW, -reach, reach)
        meet = ((place >= -inside) & (place <= length[run] + inside)).all(axis=0)
        meet &= abs(turn) > PARALLEL
    runs, places = [run[:, meet]], [place[:, meet]]
    # Those whose axes cross elsewhere meet where an end of one lies on the other.
    for one, other in (run[:, ~meet], run[::-1, ~meet]):
        for end in (0, 1):
            point = ends[one, end]
            at = ((point - ends[other, 0]) * along[other]).sum(axis=1)
            at = np.clip(at, 0, length[other])
            near = np.hypot(*(point - ends[other, 0] - at[:, None] * along[other]).T) <= reach
            runs.append(np.stack([one, other])[:, near])
            places.append(np.stack([np.where(end, length[one], 0.0), at])[:, near])
    return np.concatenate(runs, axis=1), np.concatenate(places, axis=1)

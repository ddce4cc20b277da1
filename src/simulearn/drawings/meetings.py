"""Where straight runs meet: each reaches a tolerance beyond its ends.

So gaps close, and what lies within a tolerance of an end is at that end. A place where runs meet
is a node; a run passes its nodes in order of their stations, the places along it.
"""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from simulearn.drawings.pieces import EXACT

Numbers = NDArray[np.float64]
Indices = NDArray[np.int64]
Mask = NDArray[np.bool_]


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
    a, s, b, t = _meetings(ends, length, pairs, reach)
    through = [(trim < x) & (x < length[k] - trim) for k, x in ((a, s), (b, t))]
    keep = np.ones(len(a), bool)
    if "crossing" in without:
        keep &= ~(through[0] & through[1])
    if "t-touch" in without:
        keep &= through[0] == through[1]
    a, s, b, t = (x[keep] for x in (a, s, b, t))
    # Each run has a place at its start and one at its end, then those where it meets another.
    runs, meets = len(ends), np.arange(len(a)) + 2 * len(ends)
    run = np.concatenate([np.arange(runs), np.arange(runs), a, b])
    place = np.concatenate([np.zeros(runs), length, s, t])
    label = np.concatenate([np.arange(2 * runs), meets, meets])
    return _joined(run, place, label, runs, tolerance, trim)


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
    count = int(label.max()) + 1
    links = (np.ones(int(near.sum()), bool), (label[one[near]], label[other[near]]))
    _, node = connected_components(coo_array(links, shape=(count, count)), directed=False)
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
) -> tuple[Indices, Numbers, Indices, Numbers]:
    """Return where runs meet: run, place along it, other run, place along that."""
    a, b = pairs
    along = (ends[:, 1] - ends[:, 0]) / length[:, None]
    apart = ends[b, 0] - ends[a, 0]
    turn = cross(along[a], along[b])
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        s, t = cross(apart, along[b]) / turn, cross(apart, along[a]) / turn
        meet = (turn != 0) & (s >= -reach) & (t >= -reach)
        meet &= (s <= length[a] + reach) & (t <= length[b] + reach)
    found = [(a[meet], s[meet], b[meet], t[meet])]
    # Those whose axes cross elsewhere meet where an end of one lies on the other.
    rest_a, rest_b = a[~meet], b[~meet]
    for one, other in ((rest_a, rest_b), (rest_b, rest_a)):
        for end in (0, 1):
            point = ends[one, end]
            place = ((point - ends[other, 0]) * along[other]).sum(axis=1)
            place = np.clip(place, 0, length[other])
            on = ends[other, 0] + place[:, None] * along[other]
            near = np.hypot(*(point - on).T) <= reach
            at = np.where(end, length[one], 0.0)
            found.append((one[near], at[near], other[near], place[near]))
    return tuple(np.concatenate(parts) for parts in zip(*found, strict=True))  # type: ignore[return-value]


def cross(a: Numbers, b: Numbers) -> Numbers:
    """Return the cross products (n,) of vectors (n, 2) in the plane."""
    product: Numbers = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return product

"""Beams lead along runs from joint to joint; each knows the line that draws it and its actuator."""

import numpy as np
from numpy.typing import NDArray

from simulearn.drawings.doubles import Runs
from simulearn.drawings.meetings import Stations
from simulearn.drawings.net import Net
from simulearn.drawings.pieces import Pieces

Numbers = NDArray[np.float64]
Indices = NDArray[np.int64]
Mask = NDArray[np.bool_]

# A piece that covers less of a beam does not say what its actuator is.
COVERED = 0.1


def net_of(
    pieces: Pieces, runs: Runs, at: Stations, joints: Numbers, ratios: Numbers, meant: Mask
) -> tuple[Net, Numbers]:
    """Return the net of runs, and the middles (n, 2) mm of beams drawn with several actuators.

    Args:
        pieces: the straight pieces of lines.
        runs: the runs that they make.
        at: stations of the runs.
        joints: (J, 2) mm, by the numbers of the nodes.
        ratios: (L,) of the actuators that the lines stand for.
        meant: (L,) whether all points of a line are meant.
    """
    step = np.flatnonzero(at.run[1:] == at.run[:-1])
    beams = np.stack([at.node[step], at.node[step + 1]], axis=1)
    _, first = np.unique(np.sort(beams, axis=1), axis=0, return_index=True)
    step, beams = step[np.sort(first)], beams[np.sort(first)]
    line, mixed = _lines(pieces, runs, at, step, ratios)
    net = Net(joints, beams, line, ratios[line], _meant(pieces, runs, at, len(joints), meant))
    return net, joints[beams].mean(axis=1)[mixed]


def _lines(
    pieces: Pieces, runs: Runs, at: Stations, step: Indices, ratios: Numbers
) -> tuple[Indices, Mask]:
    """Return for each beam the line that draws it, and whether its lines have several actuators.

    Of several lines the one with an actuator counts, of these the one that covers most of the beam,
    of these the first.

    Args:
        pieces: the straight pieces of lines.
        runs: the runs that they make.
        at: stations of the runs.
        step: (B,) the station at which each beam begins; it ends at the next one.
        ratios: (L,) of the lines.
    """
    order = np.argsort(runs.run, kind="stable")
    bounds = np.searchsorted(runs.run[order], np.arange(len(runs.ends) + 1))
    run = at.run[step]
    line = pieces.line[order[bounds[run]]]
    mixed = np.zeros(len(step), bool)
    for k in np.flatnonzero(np.diff(bounds)[run] > 1).tolist():
        own = order[bounds[run[k]] : bounds[run[k] + 1]]
        start, end = runs.ends[run[k]]
        along = (end - start) / np.hypot(*(end - start))
        reach = np.sort((pieces.ends[own] - start) @ along, axis=1)
        low, high = at.place[step[k]], at.place[step[k] + 1]
        cover = np.minimum(reach[:, 1], high) - np.maximum(reach[:, 0], low)
        ratio = ratios[pieces.line[own]]
        real = cover > COVERED * (high - low)
        best = np.lexsort((-cover.round(6), ratio == 0, ~real))[0]
        line[k] = pieces.line[own[best]]
        mixed[k] = len(np.unique(ratio[real & (ratio != 0)])) > 1
    return line, mixed


def _meant(pieces: Pieces, runs: Runs, at: Stations, joints: int, meant: Mask) -> Mask:
    """Return which joints were drawn as such: where ends of different lines meet and none passes.

    Args:
        pieces: the straight pieces of lines.
        runs: the runs that they make.
        at: stations of the runs.
        joints: J.
        meant: (L,) whether all points of a line are meant.
    """
    line = np.full(len(runs.ends), len(meant))
    np.minimum.at(line, runs.run, pieces.line)
    least, most = np.full(joints, len(meant)), np.full(joints, -1)
    np.minimum.at(least, at.node, line[at.run])
    np.maximum.at(most, at.node, line[at.run])
    every = np.bincount(at.node, meant[line[at.run]], joints) > 0
    passed = np.bincount(at.node, at.inner, joints) > 0
    return every | ((least < most) & ~passed)

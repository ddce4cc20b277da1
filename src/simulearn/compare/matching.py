"""Which joints measured points are when nobody says it.

Three measured points that lie far apart are laid on every three simulated joints with about the
same distances; each such pose is scored by how near all points then are to joints, and the best
are refined by assigning each point a joint of its own. Symmetric grids have several equal answers.
"""

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.spatial.distance import cdist

from simulearn.compare.aligning import LEAST, MIRRORED, rigid, rms
from simulearn.compare.measurement import Indices, Numbers
from simulearn.rigid import fit_rotation

LIKE = 0.25  # by how much of the longer a distance may differ from the simulated one
REFINED = 40  # poses that are refined
TRIPLES = 60_000  # poses that are scored
EQUAL = 1.1  # times the best residual, and 0.05 mm more, is as good
FLOOR = 0.05


@dataclass(frozen=True, eq=False)
class Match:
    """An assignment of measured points to joints.

    Attributes:
        joints: (K,) joint of each point.
        residual: root of the mean squared distance, mm.
        mirrored: whether the points are reflected for it.
    """

    joints: Indices
    residual: float
    mirrored: bool


def matches(measured: Numbers, simulated: Numbers) -> list[Match]:
    """Return the assignments that fit best: the first, and those that are as good.

    Args:
        measured: (K, 3) places of different joints.
        simulated: (J, 3) places of all joints, mm; J is at least K.
    """
    plain = _best(measured, simulated, mirror=False)
    if plain[0].residual > LEAST and len(measured) > 4:
        mirrored = _best(measured, simulated, mirror=True)
        if mirrored[0].residual * MIRRORED < plain[0].residual:
            plain = mirrored
    least = plain[0].residual
    return [one for one in plain if one.residual <= EQUAL * least + FLOOR]


def _best(measured: Numbers, simulated: Numbers, mirror: bool) -> list[Match]:
    points = measured * [-1.0, 1.0, 1.0] if mirror else measured
    best: dict[bytes, Match] = {}
    for seed in _seeds(points, simulated):
        joints = seed
        for _ in range(10):
            moved = rigid(points, simulated[joints])(points)
            _, after = linear_sum_assignment(cdist(moved, simulated) ** 2)
            if (after == joints).all():
                break
            joints = after
        residual = rms(rigid(points, simulated[joints])(points), simulated[joints])
        best[joints.tobytes()] = Match(joints, residual, mirror)
    return sorted(best.values(), key=_residual)


def _residual(match: Match) -> float:
    return match.residual


def _seeds(points: Numbers, simulated: Numbers) -> list[Indices]:
    """Return assignments to begin with, those of the best scored poses."""
    three = _wide(points)
    away, between = cdist(points[three], points[three]), cdist(simulated, simulated)
    a, b = np.nonzero(_like(away[0, 1], between))
    last = _like(away[0, 2], between)[a] & _like(away[1, 2], between)[b]
    pair, c = np.nonzero(last)
    triples = np.stack([a[pair], b[pair], c], axis=1)
    if not len(triples):
        triples = np.array(list(combinations(range(len(simulated)), 3)))
    if len(triples) > TRIPLES:
        triples = triples[np.random.default_rng(0).choice(len(triples), TRIPLES, replace=False)]
    middle = points[three].mean(axis=0)
    local = np.broadcast_to(points[three] - middle, (len(triples), 3, 3))
    scores = []
    turns, centres = fit_rotation(simulated[triples], local)
    for turn, centre in zip(turns, centres, strict=True):
        moved = (points - middle) @ turn.T + centre
        scores.append(np.sqrt(cdist(moved, simulated).min(axis=1)).sum())
    seeds: list[Indices] = []
    for k in np.argsort(scores, kind="stable")[: 4 * REFINED]:
        moved = (points - middle) @ turns[k].T + centres[k]
        _, joints = linear_sum_assignment(cdist(moved, simulated) ** 2)
        if not any((joints == other).all() for other in seeds):
            seeds.append(joints)
    return seeds[:REFINED]


def _wide(points: Numbers) -> list[int]:
    """Return three points that span the largest triangle from the two farthest ones."""
    away = cdist(points, points)
    i, j = divmod(int(away.argmax()), len(points))
    off = np.linalg.norm(np.cross(points - points[i], points[j] - points[i]), axis=1)
    return [i, j, int(off.argmax())]


def _like(length: float, others: Numbers) -> np.ndarray:
    return np.asarray(abs(others - length) <= LIKE * np.maximum(others, length))

"""Borders: where the modules' versions of a shared joint are, and where they better meet.

Each module is placed by the rigid motion that fits it best. A shared joint is then wanted in the
middle of where its modules have it, on the surface; modules are placed anew, and so on. Both steps
bring the versions closer in squares, and so does a search for the moved targets.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.rigid import Place
from simulearn.tile.alike import Member
from simulearn.tile.patches import Tiling

Array = NDArray[np.float64]

ROUNDS = 20  # of placing and moving, at most
STILL = 1e-3  # mm that targets move at the end
PRESS = 3.0  # by so much more counts a joint whose gap is as wide as is asked for
WEIGHT = 2.0  # of a shared joint in a search; of others 1


@dataclass(frozen=True, eq=False)
class Fit:
    """Modules in their places.

    Attributes:
        places: M rigid motions.
        joints: (M, K, 3) mm, of each module.
        versions: (M, K, 3) mm, where each module has the points: its joints less the inset.
        targets: (N, 3) mm, where the points are wanted; shared ones have moved.
        gaps: (N,) mm, largest distance between two modules' versions; 0 where it is one's alone.
        away: (M, K) mm, how far joints are from their targets.
    """

    places: tuple[Place, ...]
    joints: Array
    versions: Array
    targets: Array
    gaps: Array
    away: Array

    @property
    def gap_mm(self) -> float:
        """The largest gap."""
        return float(self.gaps.max(initial=0.0))

    @property
    def error_mm(self) -> float:
        """Mean distance of joints from their targets."""
        return float(self.away.mean())


def fit(tiling: Tiling, members: Sequence[Member], shapes: Array, targets: Array) -> Fit:
    """Return the modules placed where they fit best, and the targets of shared joints moved.

    Args:
        tiling: the patches.
        members: how each is of its kind.
        shapes: (kinds, K, 3) mm, joints of the kinds' modules.
        targets: (N, 3) mm, to begin with.
    """
    own = np.array([member.shape(shapes[member.kind]) for member in members])
    targets = targets.copy()
    shared = tiling.shared
    for _ in range(ROUNDS):
        wanted = tiling.wanted(targets)
        places = tuple(Place.fitting(a, b) for a, b in zip(own, wanted, strict=True))
        joints = np.array([place(shape) for place, shape in zip(places, own, strict=True)])
        versions = joints - tiling.inset
        middle = _means(tiling, versions)[shared]
        moved = tiling.surface.closest(middle)[0]
        still = float(np.linalg.norm(moved - targets[shared], axis=1).max(initial=0.0)) < STILL
        targets[shared] = moved
        if still:
            break
    away = np.linalg.norm(versions - targets[tiling.modules], axis=-1)
    return Fit(places, joints, versions, targets, gaps(tiling, versions), away)


def gaps(tiling: Tiling, versions: Array) -> Array:
    """Return the largest distance (N,) mm between versions (M, K, 3) of each point."""
    largest = np.zeros(len(tiling.points))
    flat, of = versions.reshape(-1, 3), tiling.modules.ravel()
    order = np.argsort(of, kind="stable")
    for group in np.split(order, np.flatnonzero(np.diff(of[order])) + 1):
        if len(group) > 1:
            between = flat[group][:, None] - flat[group][None]
            largest[of[group[0]]] = np.linalg.norm(between, axis=-1).max()
    return largest


def weights(tiling: Tiling, members: Sequence[Member], kinds: int) -> Array:
    """Return how much each joint of each kind counts: (kinds, K)."""
    counts = np.ones((kinds, tiling.modules.shape[1]))
    for member, points in zip(members, tiling.modules, strict=True):
        own = np.where(tiling.shared[points], WEIGHT, 1.0)
        counts[member.kind, member.order] = np.maximum(counts[member.kind, member.order], own)
    return counts


def pressed(tiling: Tiling, members: Sequence[Member], weights: Array, wide: Array) -> Array:
    """Return weights (kinds, K) that count joints more, the wider their gaps are.

    Args:
        tiling: the patches.
        members: how each is of its kind.
        weights: (kinds, K) to begin with.
        wide: (N,) gaps over the one that is asked for.
    """
    most = np.zeros_like(weights)
    for member, points in zip(members, tiling.modules, strict=True):
        most[member.kind, member.order] = np.maximum(most[member.kind, member.order], wide[points])
    counts: Array = weights * (1 + PRESS * most**2)
    return counts


def _means(tiling: Tiling, versions: Array) -> Array:
    """Return the mean (N, 3) mm of the versions (M, K, 3) of each point."""
    sums = np.zeros_like(tiling.points)
    np.add.at(sums, tiling.modules.ravel(), versions.reshape(-1, 3))
    counts = np.bincount(tiling.modules.ravel(), minlength=len(sums))
    means: Array = sums / np.maximum(counts, 1)[:, None]
    return means

"""Where a scan lies, without any help: the poses that bring it onto the simulated surface.

Many poses are begun with (the principal axes of both, turned in steps, either side up), each is
improved by a few steps to nearest points (ICP: P. Besl, N. McKay, IEEE PAMI 14, 239, 1992), and the
better half goes on with more points. Distances count up to a limit only, in both directions: what
the scan lacks and what it has besides the grid weighs the same wherever the grid lies. A grid of
like cells also fits when shifted by a cell, so the best poses are tried with such shifts, too.
"""

from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy.spatial import KDTree

from simulearn.compare.aligning import MIRROR, Pose, rigid
from simulearn.compare.matching import EQUAL, FLOOR
from simulearn.compare.measurement import Numbers
from simulearn.errors import Cancel, stop_if

LIMIT = 12.0  # mm, a distance that counts in full
TURNS = 24  # about each axis
SAME = 6.0  # mm, by which poses differ that are not one
# Points, steps, how many poses go on, and mm between points; the shifted ones begin at the second.
ROUNDS = ((100, 6, 24, 5.0), (200, 10, 6, 5.0), (800, 15, 4, 2.0), (3000, 12, 4, 2.0))
SHIFTED = 2  # poses that are tried shifted, too


@dataclass(frozen=True, eq=False)
class Fit:
    """A pose of a scan.

    Attributes:
        pose: brings the scan onto the simulated shape.
        score: mean distance of either to the other, each up to LIMIT, mm.
    """

    pose: Pose
    score: float


def registered(
    scan: Numbers, surface: Numbers, beam: float, mirror: bool, cancel: Cancel | None = None
) -> list[Fit]:
    """Return the pose of a scan, and those that fit as well: distinct ones, the best first.

    Args:
        scan: (N, 3) mm.
        surface: (M, 3) points of the simulated surface, mm.
        beam: usual distance of neighbouring joints, mm.
        mirror: whether the scan is reflected.
        cancel: stops the search.

    Raises:
        CancelledError: the token was set.
    """
    scan = thinned(scan @ MIRROR if mirror else scan)
    fits = _fits(scan, surface, beam, cancel)
    if mirror:
        first = Pose(MIRROR, np.zeros(3))
        fits = [Fit(fit.pose.after(first), fit.score) for fit in fits]
    return [fit for fit in fits if fit.score <= EQUAL * fits[0].score + FLOOR]


def thinned(points: Numbers, cell: float = 2.0) -> Numbers:
    """Return the mean of the points in each cube that has any."""
    keys = np.floor(points / cell).astype(np.int64)
    keys -= keys.min(axis=0)
    _, at, counts = np.unique(
        np.ravel_multi_index(tuple(keys.T), tuple(keys.max(axis=0) + 1)),
        return_inverse=True,
        return_counts=True,
    )
    sums = np.stack([np.bincount(at, points[:, k]) for k in range(3)], axis=1)
    return np.asarray(sums / counts[:, None])


def _fits(scan: Numbers, surface: Numbers, beam: float, cancel: Cancel | None) -> list[Fit]:
    """Return distinct poses of a scan that is not mirrored, the best first."""
    searches = {cell: _Search(thinned(scan, cell), thinned(surface, cell)) for *_, cell in ROUNDS}
    fits = [Fit(pose, LIMIT) for pose in _starts(scan, surface)]
    for k, (count, steps, stay, cell) in enumerate(ROUNDS):
        tried = []
        for fit in fits:
            stop_if(cancel)
            tried.append(searches[cell].improved(fit.pose, count, steps))
        fits = distinct(tried, scan)
        if k == 1:
            shifted = _shifted(fits[:SHIFTED], surface, beam)
            fits += [searches[cell].improved(pose, count, steps) for pose in shifted]
            fits = distinct(fits, scan)
        fits = fits[:stay]
    return fits


def _starts(scan: Numbers, surface: Numbers) -> list[Pose]:
    """Return poses to begin with: principal axes on principal axes, turned."""
    middle, other = np.median(scan, axis=0), np.median(surface, axis=0)
    mine = np.linalg.svd(scan - scan.mean(axis=0), full_matrices=False)[2]
    theirs = np.linalg.svd(surface - surface.mean(axis=0), full_matrices=False)[2]
    angle = 2 * np.pi * np.arange(TURNS) / TURNS
    poses = []
    for axis, side, a in product(range(3), (1, -1), angle):
        frame = np.roll(mine, 2 - axis, axis=0)  # the normal of the grid comes last
        frame = frame * np.linalg.det(frame)
        c, s = np.cos(a), np.sin(a)
        turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ np.diag([1, side, side])
        whole = (theirs * np.linalg.det(theirs)).T @ turn @ frame
        poses.append(Pose(whole, other - whole @ middle))
    return poses


def _shifted(fits: list[Fit], surface: Numbers, beam: float) -> list[Pose]:
    """Return poses moved by a cell along the two long axes of the grid."""
    axes = np.linalg.svd(surface - surface.mean(axis=0), full_matrices=False)[2][:2]
    moves = [a * beam * axes[0] + b * beam * axes[1] for a, b in product((-1, 0, 1), repeat=2)]
    moves += [2**0.5 / 2 * beam * (a * axes[0] + b * axes[1]) for a, b in product((-1, 1), (-1, 1))]
    return [Pose(f.pose.turn, f.pose.shift + move) for f in fits for move in moves if move.any()]


def distinct(fits: list[Fit], scan: Numbers) -> list[Fit]:
    """Return fits, the best first, without those that bring the scan to about the same place."""
    few = scan[:: max(1, len(scan) // 50)]
    kept: list[tuple[Fit, Numbers]] = []
    for fit in sorted(fits, key=_score):
        moved = fit.pose(few)
        if all(np.linalg.norm(moved - other, axis=1).max() > SAME for _, other in kept):
            kept.append((fit, moved))
    return [fit for fit, _ in kept]


def _score(fit: Fit) -> float:
    return fit.score


class _Search:
    """Improves poses of a scan."""

    def __init__(self, scan: Numbers, surface: Numbers) -> None:
        rng = np.random.default_rng(0)
        self._scan, self._surface = rng.permutation(scan), rng.permutation(surface)
        self._of_scan, self._of_surface = KDTree(self._scan), KDTree(self._surface)

    def improved(self, pose: Pose, count: int, steps: int) -> Fit:
        """Return a pose after some steps with so many points, and its score with them."""
        scan, surface = self._scan[:count], self._surface[:count]
        limit = 3 * LIMIT
        for _ in range(steps):
            moved = pose(scan)
            away, near = self._of_surface.query(moved, distance_upper_bound=limit)
            back = (surface - pose.shift) @ pose.turn
            away2, near2 = self._of_scan.query(back, distance_upper_bound=limit)
            ours, theirs = np.isfinite(away), np.isfinite(away2)  # else none is so near
            if ours.sum() + theirs.sum() < 6:
                break
            here = np.concatenate([moved[ours], pose(self._scan[near2[theirs]])])
            there = np.concatenate([self._surface[near[ours]], surface[theirs]])
            pose = rigid(here, there).after(pose)
            limit = max(0.8 * limit, LIMIT / 2)
        away, _ = self._of_surface.query(pose(scan), distance_upper_bound=LIMIT)
        back = (surface - pose.shift) @ pose.turn
        away2, _ = self._of_scan.query(back, distance_upper_bound=LIMIT)
        score = np.minimum(away, LIMIT).mean() + np.minimum(away2, LIMIT).mean()
        return Fit(pose, float(score) / 2)

"""Patches that are alike: one module, designed once, fits them all.

A module fits a patch if a rigid motion (Kabsch) brings its joints to the patch's, in one of the
orders in which a lattice covers itself: four turns, and four more where the module is put in
upside down. Or its mirror image does: the grid mirrored in its plane, which gravity and the bath
treat alike, so that an actuator keeps its half.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from simulearn.grid import Grid
from simulearn.rigid import Place, fit_rotation

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

MIRROR = np.array([-1.0, 1.0, 1.0])  # of a module: x is turned round


@dataclass(frozen=True, eq=False)
class Member:
    """How a module of a kind lies in a patch.

    Attributes:
        kind: its number.
        order: (K,) the module's joint at each of the patch's points.
        mirrored: whether it is the kind's mirror image.
        away_mm: largest distance of a target from the kind's.
    """

    kind: int
    order: Indices
    mirrored: bool
    away_mm: float

    def shape(self, points: Array) -> Array:
        """Return a kind's points (K, 3) in the order of the patch, before it is placed."""
        own = points * MIRROR if self.mirrored else points
        return own[self.order]

    def targets(self, points: Array, like: Array) -> Array:
        """Return a patch's points (K, 3) in the order of the kind, laid over others (K, 3)."""
        own = np.empty_like(points)
        own[self.order] = points
        if self.mirrored:
            own = own * MIRROR
        return Place.fitting(own, like)(own)


def orders(grid: Grid) -> Indices:
    """Return the orders (S, K) in which a lattice covers itself, the plain one first."""
    middle = (grid.joints.max(axis=0) + grid.joints.min(axis=0)) / 2
    joints = grid.joints - middle
    found = []
    for flip in (np.eye(2), np.diag([-1.0, 1.0])):
        for quarter in range(4):
            c, s = (1, 0, -1, 0)[quarter], (0, 1, 0, -1)[quarter]
            moved = joints @ (np.array([[c, -s], [s, c]]) @ flip).T
            away = np.linalg.norm(moved[:, None] - joints[None], axis=-1)
            if away.min(axis=0).max() < 1e-9:
                found.append(away.argmin(axis=0))
    return np.array(found)


def alike(targets: Array, grid: Grid, tolerance: float) -> tuple[Array, tuple[Member, ...]]:
    """Return the kinds of patches and how each patch is of its kind.

    Args:
        targets: (M, K, 3) mm, of the patches.
        grid: the lattice whose joints they are.
        tolerance: largest distance (mm) between targets that are taken for the same.

    Returns:
        The targets (kinds, K, 3) mm of the kinds, the mean of their patches, and M members.
    """
    own = orders(grid)
    firsts: list[Array] = []
    members: list[Member] = []
    for points in targets:
        member = _member(points, firsts, own, tolerance)
        if member is None:
            member = Member(len(firsts), own[0], False, 0.0)
            firsts.append(points)
        members.append(member)
    kinds = averaged(targets, members, np.array(firsts))
    return kinds, tuple(
        replace(member, away_mm=float(_away(member.shape(kinds[member.kind]), points)))
        for member, points in zip(members, targets, strict=True)
    )


def averaged(targets: Array, members: Sequence[Member], like: Array) -> Array:
    """Return the mean targets (kinds, K, 3) of all patches of each kind.

    Args:
        targets: (M, K, 3) mm of the patches.
        members: how each is of its kind.
        like: (kinds, K, 3) mm, over which they are laid.
    """
    sums, counts = np.zeros_like(like), np.zeros(len(like))
    for points, member in zip(targets, members, strict=True):
        sums[member.kind] += member.targets(points, like[member.kind])
        counts[member.kind] += 1
    means: Array = sums / counts[:, None, None]
    return means


def _member(points: Array, kinds: Sequence[Array], own: Indices, tolerance: float) -> Member | None:
    """Return how a patch is of the first kind that it is alike; None if it is of none."""
    if not kinds:
        return None
    # As itself before mirrored, in the plain order before others, so that fewer prints differ.
    for mirrored in (False, True):
        shapes = np.array(kinds) * MIRROR if mirrored else np.array(kinds)
        laid = shapes[:, own]  # (kinds, S, K, 3)
        away = _away(laid, points)
        found = np.argwhere(away <= tolerance)
        if len(found):
            kind, order = found[0]
            return Member(int(kind), own[order], mirrored, float(away[kind, order]))
    return None


def _away(shapes: Array, points: Array) -> Array:
    """Return the largest distances (...) mm of rigidly fitted shapes (..., K, 3) from points."""
    local = shapes - shapes.mean(axis=-2, keepdims=True)
    turn, centre = fit_rotation(np.broadcast_to(points, shapes.shape), local)
    laid = np.einsum("...ij,...kj->...ki", turn, local) + centre[..., None, :]
    away: Array = np.linalg.norm(laid - points, axis=-1).max(axis=-1)
    return away

"""Lines that meet end to end, joined to polylines."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

Array = NDArray[np.float64]

NEAR = 1e-5  # of the size of all; ends that are nearer meet


def chained(lines: Sequence[Array]) -> list[Array]:
    """Return polylines (N, 3), N at least 2, of lines (M, 3) whose ends meet two by two.

    Where three or more ends meet, lines end. Points at one place become one.
    """
    parts = [part for part in (_distinct(line) for line in lines) if len(part) > 1]
    if not parts:
        return []
    size = float(np.linalg.norm(np.ptp(np.concatenate(parts), axis=0)))
    ends = np.array([part[k] for part in parts for k in (0, -1)])  # 2 p and 2 p + 1 are of part p
    meeting = KDTree(ends).query_ball_point(ends, NEAR * size)
    partner = [next((k for k in m if k != e), -1) if len(m) == 2 else -1
               for e, m in enumerate(meeting)]  # fmt: skip
    chains, used = [], [False] * len(parts)
    # Those with a free end first: what is left then are rings.
    for begin in sorted(range(len(ends)), key=lambda e: partner[e] >= 0):
        end, chain = begin, []
        while end >= 0 and not used[end // 2]:
            part = parts[end // 2]
            used[end // 2] = True
            chain.append(part[::-1] if end % 2 else part)
            end = partner[end ^ 1]
        if chain:
            chains.append(_distinct(np.concatenate(chain), NEAR * size))
    return chains


def _distinct(points: Array, near: float = 0.0) -> Array:
    """Return points (N, 3) without those that are where the one before is, or not finite."""
    points = points[np.isfinite(points).all(axis=1)]
    apart = np.linalg.norm(np.diff(points, axis=0), axis=1) > near
    return points[np.r_[True, apart]] if len(points) else points

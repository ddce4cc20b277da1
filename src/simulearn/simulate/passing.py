"""Beams that run through each other in the last frame: no engine knows of contact.

Two beams that share no joint do when their axes come nearer to each other than a beam is thick.
Axes are compared at points along them, so that a touch of less than that may go unseen.
"""

import numpy as np
import shapely
from numpy.typing import NDArray

from simulearn.errors import Message

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

NAMED = 5  # pairs
MANY = 300  # beams, of which all pairs of boxes are still quickly compared
AT_ONCE = 256  # pairs of axes that are compared together, which bounds the memory


def passing(sections: Array, ends: Indices, thickness: float) -> list[tuple[Message, ...]]:
    """Return for designs of one topology a warning where beams run through each other, or none.

    Args:
        sections: (T, B, 3, 4, 3) mm, corners of the beams' sections in one frame of each design.
        ends: (B, 2) joint indices of the beams.
        thickness: of the beams, mm.
    """
    start, middle, end = np.moveaxis(sections.mean(axis=3), 2, 0)
    curves = np.stack([start, 2 * middle - (start + end) / 2, end], axis=2)
    pairs = np.column_stack(np.triu_indices(len(ends), 1)) if len(ends) <= MANY else None
    messages: list[tuple[Message, ...]] = []
    for curve in curves:  # the control points (B, 3, 3) of the parabolas that the axes are
        low, high = curve.min(axis=1) - thickness / 2, curve.max(axis=1) + thickness / 2
        near = _near(low, high, pairs)
        near = near[(ends[near[:, 0], :, None] != ends[near[:, 1], None]).all(axis=(1, 2))]
        messages.append(_said(_close(curve, near, thickness)))
    return messages


def _near(low: Array, high: Array, pairs: Indices | None) -> Indices:
    """Return those of the pairs of beams (N, 2), or of all, whose boxes (B, 3) overlap."""
    if pairs is None:
        tree = shapely.STRtree(shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1]))
        pairs = tree.query(tree.geometries).T
        pairs = pairs[pairs[:, 0] < pairs[:, 1]]
    a, b = pairs.T
    return pairs[((low[a] < high[b]) & (low[b] < high[a])).all(axis=1)]


def _close(curve: Array, pairs: Indices, near: float) -> list[tuple[int, int]]:
    """Return the pairs of beams whose axes come nearer than `near` mm, at points along them."""
    if not len(pairs):
        return []
    longest = np.linalg.norm(np.diff(curve, axis=1), axis=2).sum(axis=1).max()
    t = np.linspace(0, 1, 2 + int(2 * longest / near))
    axes = np.einsum("kn,bkc->bnc", np.array([(1 - t) ** 2, 2 * t * (1 - t), t**2]), curve)
    found: list[tuple[int, int]] = []
    for some in (pairs[k : k + AT_ONCE] for k in range(0, len(pairs), AT_ONCE)):
        away = axes[some[:, 0], :, None] - axes[some[:, 1], None]
        close = (away**2).sum(axis=-1).min(axis=(1, 2)) < near**2
        found += [(int(i), int(j)) for i, j in some[close]]
    return found


def _said(pairs: list[tuple[int, int]]) -> tuple[Message, ...]:
    if not pairs:
        return ()
    named = ", ".join(f"{a} and {b}" for a, b in pairs[:NAMED])
    more = f" and {len(pairs) - NAMED} more pairs" if len(pairs) > NAMED else ""
    text = (
        f"in the last frame beams run through each other ({named}{more}): contact is not "
        "simulated, so a print would come to another shape"
    )
    return (Message("beams-pass", f"beam {pairs[0][0]}", text),)

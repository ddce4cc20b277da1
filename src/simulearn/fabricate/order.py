"""The order in which the beads of a layer are printed, and where each of them begins.

A bead can begin at several places: strokes at any of their four ends, a ring at any corner. Where
it begins and ends a little too much or too little plastic is left, and strokes that begin at
another end turn at other places. So a bead begins at one of the places where it has begun least
often in the layers below; of all these, always the nearest is next.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def nearest_first(
    begins: Sequence[Array],
    ends: Sequence[Array],
    here: Array,
    used: Sequence[NDArray[np.int64]],
) -> list[tuple[int, int]]:
    """Return (bead, variant) in printing order.

    Args:
        begins: for each bead, where its variants begin, (v, 2) mm.
        ends: where they end, (v, 2) mm.
        here: (2,) where the nozzle is.
        used: how often each variant has been printed, (v,); those chosen are counted in it.
    """
    if not begins:
        return []
    starts, stops = np.concatenate(begins), np.concatenate(ends)
    bead = np.repeat(np.arange(len(begins)), [len(b) for b in begins])
    variant = np.concatenate([np.arange(len(b)) for b in begins])
    left = np.concatenate([counts == counts.min() for counts in used])
    order = []
    for _ in begins:
        away = np.sum((starts - here) ** 2, axis=1).round(6)  # ties are ties on every machine
        k = int(np.argmin(np.where(left, away, np.inf)))
        order.append((int(bead[k]), int(variant[k])))
        used[bead[k]][variant[k]] += 1
        here = stops[k]
        left &= bead != bead[k]
    return order

"""The order in which the beads of a layer are printed: always the nearest of those left.

A bead has several variants: strokes begin at any of their four ends, a ring at any corner.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def nearest_first(
    begins: Sequence[Array], ends: Sequence[Array], here: Array
) -> list[tuple[int, int]]:
    """Return (bead, variant) in printing order.

    Args:
        begins: for each bead, where its variants begin, (v, 2) mm.
        ends: where they end, (v, 2) mm.
        here: (2,) where the nozzle is.
    """
    if not begins:
        return []
    starts, stops = np.concatenate(begins), np.concatenate(ends)
    counts = [len(b) for b in begins]
    bead = np.repeat(np.arange(len(begins)), counts)
    variant = np.concatenate([np.arange(n) for n in counts])
    left = np.ones(len(bead), dtype=bool)
    order = []
    for _ in begins:
        away = np.sum((starts - here) ** 2, axis=1).round(6)  # ties are ties on every machine
        k = int(np.argmin(np.where(left, away, np.inf)))
        order.append((int(bead[k]), int(variant[k])))
        here = stops[k]
        left &= bead != bead[k]
    return order

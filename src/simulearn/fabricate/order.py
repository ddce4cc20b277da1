"""The order in which the beads of a layer are printed, and where each of them begins.

A bead can begin at several places: strokes at any of their four ends, a ring at any corner. Where
it begins and ends a little too much or too little plastic is left, and strokes that begin at
another end turn at other places. So a bead begins at one of the places where it has begun least
often in the layers below. Of all these the nearest is always next; that leaves some beads for late,
so each is then moved to where it makes the travels shortest (Or, 1976: "or-opt" of tours, with one
bead at a time).
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Places = NDArray[np.complex128]  # x + i y
Order = list[tuple[int, int]]
DIGITS = 6  # of a travel, mm: ties are ties on every machine


def printing_order(
    begins: Sequence[Array],
    ends: Sequence[Array],
    here: Array,
    used: Sequence[NDArray[np.int64]],
) -> Order:
    """Return (bead, variant) in printing order.

    Args:
        begins: for each bead, where its variants begin, (v, 2) mm.
        ends: where they end, (v, 2) mm.
        here: (2,) where the nozzle is.
        used: how often each variant has been printed, (v,); those chosen are counted in it.
    """
    allowed = [np.flatnonzero(counts == counts.min()) for counts in used]
    first = [_complex(b[k]) for b, k in zip(begins, allowed, strict=True)]
    last = [_complex(e[k]) for e, k in zip(ends, allowed, strict=True)]
    start = complex(*here)
    order = _shortened(_nearest_first(first, last, start), first, last, start)
    result = [(bead, int(allowed[bead][k])) for bead, k in order]
    for bead, variant in result:
        used[bead][variant] += 1
    return result


def _nearest_first(first: list[Places], last: list[Places], here: complex) -> Order:
    """Return an order in which always the nearest bead is next."""
    if not first:
        return []
    starts, stops = np.concatenate(first), np.concatenate(last)
    bead = np.repeat(np.arange(len(first)), [len(p) for p in first])
    variant = np.concatenate([np.arange(len(p)) for p in first])
    left = np.ones(len(bead), dtype=bool)
    order = []
    for _ in first:
        away = np.abs(starts - here).round(DIGITS)
        k = int(np.argmin(np.where(left, away, np.inf)))
        order.append((int(bead[k]), int(variant[k])))
        here = stops[k]
        left &= bead != bead[k]
    return order


def _shortened(order: Order, first: list[Places], last: list[Places], here: complex) -> Order:
    """Return an order with each bead, one after the other, moved to where it costs least travel."""
    beads = np.array([bead for bead, _ in order])
    variants = np.array([k for _, k in order])
    starts = np.array([first[bead][k] for bead, k in order])
    stops = np.array([last[bead][k] for bead, k in order])
    for bead in range(len(order)):
        p = int(np.argmax(beads == bead))
        others = np.delete(starts, p)
        before = np.append(here, np.delete(stops, p))
        joins = np.append(np.abs(others - before[:-1]), 0.0)  # travels without this bead
        cost = np.abs(before - first[bead][:, None])
        cost[:, :-1] += np.abs(others - last[bead][:, None])
        cost = (cost - joins).round(DIGITS)
        k, to = divmod(int(np.argmin(cost)), len(before))
        if cost[k, to] < cost[variants[p], p]:
            beads = np.insert(np.delete(beads, p), to, bead)
            variants = np.insert(np.delete(variants, p), to, k)
            starts = np.insert(others, to, first[bead][k])
            stops = np.insert(before[1:], to, last[bead][k])
    return list(zip(beads.tolist(), variants.tolist(), strict=True))


def _complex(places: Array) -> Places:
    return np.ascontiguousarray(places[:, 0] + 1j * places[:, 1])

"""Where an edge lies between two brightnesses, to a small part of a pixel.

Across an edge the light is sampled on a line: the edge is where it has come half the way from what
it is a little inside to what it is a little outside. Both are taken close to the edge, so that a
shadow beside it or a slowly changing light shift nothing.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

STEPS_IN_PIXEL = 4


def edge_offsets(
    picture: NDArray[np.float32],
    points: Array,
    normals: Array,
    reach: float,
    near: float,
    far: float,
    contrast: float,
) -> tuple[Array, Array]:
    """Return how far an edge is from points near it, along their normals.

    Args:
        picture: (H, W) light.
        points: (N, 2) pixels.
        normals: (N, 2) outwards, of length 1.
        reach: how far from the points the edge is looked for, pixels.
        near: from where on the light inside and outside is taken, pixels from the edge.
        far: to where it is taken.
        contrast: least difference between inside and outside.

    Returns:
        Offsets (N,) in pixels, outwards, NaN where there is no edge; and over how many pixels the
        light changes from a fifth to four fifths (N,).
    """
    import cv2

    count = int(np.ceil((reach + far) * STEPS_IN_PIXEL))
    steps = np.arange(-count, count + 1) / STEPS_IN_PIXEL
    at = points[:, None] + normals[:, None] * steps[:, None]
    light = cv2.remap(
        picture,
        at[..., 0].astype(np.float32),
        at[..., 1].astype(np.float32),
        cv2.INTER_CUBIC,
        borderMode=cv2.BORDER_REPLICATE,
    ).astype(float)
    offsets = np.zeros(len(points))
    width = np.full(len(points), np.nan)
    for _ in range(3):  # inside and outside move with the edge
        away = steps - offsets[:, None]
        inside = _mean(light, (away <= -near) & (away >= -far))
        outside = _mean(light, (away >= near) & (away <= far))
        step = outside - inside
        share = (light - inside[:, None]) / np.where(np.abs(step) < contrast, np.nan, step)[:, None]
        offsets = _crossing(share, steps, np.nan_to_num(offsets), reach, 0.5)
    low = _crossing(share, steps, np.nan_to_num(offsets), reach, 0.2)
    high = _crossing(share, steps, np.nan_to_num(offsets), reach, 0.8)
    width = np.abs(high - low)
    return offsets, width


def _mean(light: Array, chosen: NDArray[np.bool_]) -> Array:
    return np.asarray((light * chosen).sum(axis=1) / np.maximum(chosen.sum(axis=1), 1))


def _crossing(share: Array, steps: Array, around: Array, reach: float, level: float) -> Array:
    """Return where the share (N, S) rises through a level, nearest to `around` (N,); else NaN."""
    with np.errstate(invalid="ignore"):
        rises = (share[:, :-1] < level) & (share[:, 1:] >= level)
        part = (level - share[:, :-1]) / np.where(rises, share[:, 1:] - share[:, :-1], 1)
        at = steps[:-1] + part * (steps[1] - steps[0])
    away = np.where(rises & (np.abs(at) <= reach), np.abs(at - around[:, None]), np.inf)
    best = np.argmin(away, axis=1)
    rows = np.arange(len(share))
    return np.where(np.isfinite(away[rows, best]), at[rows, best], np.nan)

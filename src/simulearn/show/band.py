"""The band that prints of one design fill: where nine of ten centre lines of each beam pass.

The band is of the picture: at each place along a beam the lines of all prints are taken across the
mean line as it is seen, and the band reaches from their 5th to their 95th percentile.
"""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from numpy.typing import NDArray

from simulearn.palette import BAND
from simulearn.show.camera import Camera
from simulearn.simulate.spread import RANGE, Spread

Array = NDArray[np.float64]
PLACES = 13  # along a beam
FILL, EDGE = 0.35, 0.9  # opacity, points


def draw_band(ax: Axes, spread: Spread, camera: Camera) -> None:
    """Draw the band of each beam over what is drawn already; nothing for a spread of a file."""
    shapes = bands(spread, camera)
    if not len(shapes):
        return
    draw: Any = ax.add_collection
    draw(PolyCollection(list(shapes), facecolors=BAND, alpha=FILL, linewidths=0, zorder=3))
    rims = np.concatenate([shapes[:, :PLACES], shapes[:, PLACES:]])
    draw(PolyCollection(list(rims), closed=False, facecolors="none", edgecolors=BAND,
                        linewidths=EDGE, zorder=3.1))  # fmt: skip


def bands(spread: Spread, camera: Camera) -> Array:
    """Return the outline (B, 2 PLACES, 2) of each beam's band, mm to the right and up."""
    if spread.lines is None:
        return np.empty((0, 2 * PLACES, 2))
    t = np.linspace(0, 1, PLACES)
    # The parabola through the three sections, as a skin without a mesh has it.
    weights = np.array([2 * (t - 0.5) * (t - 1), 4 * t * (1 - t), 2 * t * (t - 0.5)])
    lines = camera.see(np.einsum("sn,tbsx->tbnx", weights, spread.lines))[..., :2]
    mean = lines.mean(axis=0)
    along = np.gradient(mean, axis=1)
    across = np.stack([-along[..., 1], along[..., 0]], axis=-1)
    across /= np.maximum(np.linalg.norm(across, axis=-1, keepdims=True), 1e-9)
    away = np.einsum("tbnx,bnx->tbn", lines - mean, across)
    low, high = np.percentile(away, RANGE, axis=0)
    one, other = (mean + side[..., None] * across for side in (low, high))
    return np.concatenate([one, other[:, ::-1]], axis=1)

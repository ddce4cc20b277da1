"""Where stress is sampled in a beam, and how it is read from the integration points.

The points are those of the paper's graph features: sections at either end of the beam and at
either side of its middle, half an element of 1.8 mm inside; four corners, one row inside the shell
of an 8 x 4 section. Stress there is the trilinear function through the eight integration points
of the same material around it.
"""

import numpy as np
from numpy.typing import NDArray

from simulearn.grid.sampled import INSIDE
from simulearn.material import Section

Array = NDArray[np.float64]

ACROSS = 1.5 / 8  # of the width from the edge
DEEP = 0.5 / 4  # of the thickness from the surface


def sampling(
    along: Array, lengths: Array, across: Array, layers: int, points: Array, section: Section
) -> tuple[NDArray[np.int64], Array]:
    """Return the integration points and weights of the stress samples.

    Args:
        along: (B, slabs + 1) places of the slabs' faces, 0 to 1.
        lengths: (B,) of the beams, mm.
        across: (strips + 1,) breaks across the section, 0 to 1.
        layers: bricks through each half.
        points: (3, Q) integration points in the unit brick.
        section: of the beams.

    Returns:
        (B, 4, 4, 8) points, counted from the first of the first beam's bricks, and weights.
    """
    beams, slabs = along.shape[0], along.shape[1] - 1
    strips, high = len(across) - 1, 2 * layers
    shell = section.shell / section.width
    x, y, z = (np.unique(p.round(12)) for p in points)
    half = slabs // 2

    step = np.minimum(INSIDE / lengths, (along[:, 1] - along[:, 0]))
    slab = np.array([0, half - 1, half, slabs - 1])
    place = np.stack(
        [along[:, 0] + step, along[:, half] - step, along[:, half] + step, along[:, -1] - step],
        axis=1,
    )
    local = (place - along[:, slab]) / (along[:, slab + 1] - along[:, slab])
    in_x = _linear(x[[0, -1]], local)  # (B, 4, 2)

    core = (
        np.flatnonzero(np.diff(across) > 0)[[0, -1]] if strips == 1 else np.array([1, strips - 2])
    )
    number, weight = [], []
    for corner in range(4):
        left, top = corner % 2, corner // 2
        strip = core[left]
        low, width = across[strip], across[strip + 1] - across[strip]
        inner = np.flatnonzero(abs(low + width * y - 0.5) < 0.5 - shell)[[0, -1]]
        in_y = _linear(low + width * y[inner], np.array(1 - ACROSS if left else ACROSS))
        depth = (1 - DEEP if top else DEEP) * high
        layer = int(np.clip(np.floor(depth), 0, high - 1))
        in_z = _linear(z[[0, -1]], np.array(depth - layer))
        brick = ((np.arange(beams)[:, None] * slabs + slab) * strips + strip) * high + layer
        q = (np.array([0, len(x) - 1])[:, None, None] * len(y) + inner[:, None]) * len(
            z
        ) + np.array([0, len(z) - 1])
        number.append(brick[..., None] * points.shape[1] + q.reshape(-1))
        weight.append((in_x[..., :, None, None] * in_y[:, None] * in_z).reshape(beams, 4, 8))
    return np.stack(number, axis=2), np.stack(weight, axis=2)


def _linear(nodes: Array, at: Array) -> Array:
    """Return the weights (..., 2) of linear interpolation between two nodes."""
    t = (at - nodes[0]) / (nodes[1] - nodes[0])
    return np.stack([1 - t, t], axis=-1)

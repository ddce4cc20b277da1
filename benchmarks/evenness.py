"""How evenly a print lays its plastic: deposited volume over volume of the solid, place by place.

Each piece of a bead is spread over its rectangle; the layers are added up on a raster. What counts
is the mean over a small circle, since a molten bead gives way to its neighbours.
"""

from collections import Counter
from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.signal import fftconvolve

from simulearn.fabricate import Bead, Job, Layer
from simulearn.fabricate.regions import footprint
from simulearn.fabricate.toolpath import BRIM, SHELL, SKIRT
from simulearn.grid import outline

Array = NDArray[np.float64]
PIXEL = 0.1  # mm
SAMPLE = 0.05  # mm, at most, between the points that stand for a bead


def area_of(job: Job) -> shapely.Geometry:
    """Return the outlines of all grids of a print."""
    section = job.material.section
    return shapely.union_all([footprint(outline(grid, section)) for grid in job.grids])


def local_mass(job: Job, layers: Sequence[Layer], circle: float) -> Array:
    """Return the mass (1: solid) within circles that lie inside the outline, one for each pixel.

    Args:
        job: the print.
        layers: those to add up.
        circle: its diameter, mm.
    """
    area = area_of(job)
    low, high = np.reshape(shapely.bounds(area), (2, 2))
    low, high = low - 2.0, high + 2.0
    size = np.ceil((high - low)[::-1] / PIXEL).astype(int)
    volume = np.zeros(size)
    for layer in layers:
        beads = [bead for bead in layer.beads if bead.role not in (SKIRT, BRIM)]
        volume += _deposit(beads, low, size) * layer.height
    solid = sum(layer.height for layer in layers) * PIXEL**2

    reach = round(circle / 2 / PIXEL)
    y, x = np.mgrid[-reach : reach + 1, -reach : reach + 1]
    disc = (np.hypot(x, y) <= circle / 2 / PIXEL).astype(float)
    mean = fftconvolve(volume / solid, disc / disc.sum(), mode="same")
    rows, columns = np.mgrid[: size[0], : size[1]] + 0.5
    inner = shapely.buffer(area, -circle / 2)
    shapely.prepare(inner)
    inside = shapely.contains_xy(inner, low[0] + columns * PIXEL, low[1] + rows * PIXEL)
    result: Array = mean[inside]
    return result


def _deposit(beads: list[Bead], low: Array, size: NDArray[np.int64]) -> Array:
    """Return the volume of beads of height 1 in each pixel."""
    begin = np.concatenate([bead.points[:-1] for bead in beads])
    along = np.concatenate([np.diff(bead.points, axis=0) for bead in beads])
    length = np.linalg.norm(along, axis=1)
    width = np.concatenate([bead.widths for bead in beads])
    section = np.concatenate([bead.section for bead in beads])
    across = np.stack([-along[:, 1], along[:, 0]], axis=1) * (width / length)[:, None]
    # So many points along and across each piece, in the middles of equal parts.
    n, m = np.ceil(length / SAMPLE).astype(int), np.ceil(width / SAMPLE).astype(int)
    piece = np.repeat(np.arange(len(n)), n * m)
    count = np.arange(len(piece)) - np.repeat(np.cumsum(n * m) - n * m, n * m)
    s = (count // m[piece] + 0.5) / n[piece]
    t = (count % m[piece] + 0.5) / m[piece] - 0.5
    points = begin[piece] + s[:, None] * along[piece] + t[:, None] * across[piece]
    pixel = ((points - low) / PIXEL).astype(int)
    volume = (length * section / (n * m))[piece]
    flat = np.bincount(pixel[:, 1] * size[1] + pixel[:, 0], volume, int(size.prod()))
    return flat.reshape(size)


def repeated(job: Job) -> list[Layer]:
    """Return the layers as if all of one half and parity began where the second of them does.

    The second, since the first layer of all has a flow of its own.
    """
    layers = list(job.path.layers)
    half = len(layers) // 2
    return [layers[k - k % half + 2 + (k % half) % 2] for k in range(len(layers))]


def most_seams(layers: Sequence[Layer]) -> int:
    """Return how many shells begin at the place where most do."""
    begins = [tuple(b.points[0]) for layer in layers for b in layer.beads if b.role == SHELL]
    return max(Counter(begins).values())

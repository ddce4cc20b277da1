"""The simulated shape as a scan is compared with it: points of its surface, and its stations.

A station is a place where the measured shape is looked for: each joint, and three places along each
beam. Its patch is the surface around it, by the distance on the flat grid, so that a joint's patch
has the ends of its beams, whose sides say where the joint is.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from simulearn.compare.measurement import Indices, Numbers
from simulearn.simulate import Result, skin
from simulearn.simulate.skin import edges

PLACES = np.array([0.25, 0.5, 0.75])  # of stations along a beam
DENSITY = 1.5  # points of the surface in a mm2


@dataclass(frozen=True, eq=False)
class Surface:
    """Points spread evenly over the simulated surface of the last frame.

    Attributes:
        points: (M, 3) mm.
        normals: (M, 3) of unit length, out of the body.
        flat: (M, 3) where they are on the flat grid, mm.
    """

    points: Numbers
    normals: Numbers
    flat: Numbers


@dataclass(frozen=True, eq=False)
class Stations:
    """Places of the simulated shape; the first J are the joints, then three of each beam in turn.

    Attributes:
        centres: (S, 3) mm, in the last frame.
        flat: (S, 3) on the flat grid, mm.
        along: (S, 3) direction of the beam in the last frame; 0 at joints.
        up: (S, 3) normal of the grid's middle surface in the last frame.
        links: (L, 2) stations that follow each other.
    """

    centres: Numbers
    flat: Numbers
    along: Numbers
    up: Numbers
    links: Indices


def surface_of(result: Result) -> Surface:
    """Return points of the surface of a result, the same each time."""
    shape = skin(result)
    flat, last = (shape.vertices[k][shape.quads] for k in (0, -1))  # (Q, 4, 3)
    across = np.cross(last[:, 2] - last[:, 0], last[:, 3] - last[:, 1])
    double = np.linalg.norm(across, axis=1)
    rng = np.random.default_rng(0)
    share = np.cumsum(double)
    count = int(DENSITY * share[-1] / 2)
    at = np.searchsorted(share, (np.arange(count) + rng.random(count)) / count * share[-1])
    at = np.minimum(at, len(double) - 1)
    u, v = rng.random((2, count, 1))
    weights = [(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v]

    def spread(corners: Numbers) -> Numbers:
        return np.asarray(sum(w * corners[at, k] for k, w in enumerate(weights)))

    return Surface(spread(last), across[at] / double[at, None], spread(flat))


def stations_of(result: Result) -> Stations:
    """Return the stations of a result."""
    grid = result.grid
    many, first = len(grid.joints), len(grid.joints)
    lower, upper = result.joints[-1, :, :4].mean(axis=1), result.joints[-1, :, 4:].mean(axis=1)
    centres, flat, up = [result.centres[-1]], [result.centres[0]], [upper - lower]
    along, links = [np.zeros((many, 3))], []
    step = 0.02
    for b, (start, end) in enumerate(grid.beams):
        places = np.concatenate([PLACES, PLACES - step, PLACES + step])
        corners = edges(result, b, places)  # (F, 9, 4, 3)
        middles = corners.mean(axis=2)
        flat.append(middles[0, :3])
        centres.append(middles[-1, :3])
        along.append(middles[-1, 6:] - middles[-1, 3:6])
        up.append(corners[-1, :3, 2:].mean(axis=1) - corners[-1, :3, :2].mean(axis=1))
        own = [start, *range(first, first + 3), end]
        links += list(pairwise(own))
        first += 3
    return Stations(
        np.concatenate(centres),
        np.concatenate(flat),
        _unit(np.concatenate(along)),
        _unit(np.concatenate(up)),
        np.array(links),
    )


def _unit(vectors: Numbers) -> Numbers:
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.asarray(vectors / np.where(length > 0, length, 1.0))

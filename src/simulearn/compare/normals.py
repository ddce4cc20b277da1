"""Normals of a cloud of points, which has none of its own.

A plane through its neighbours gives the normal of a point, but not which side is outside. A beam is
thin: the points within some mm of a place on it are mostly of its other faces, so their mean lies
inside. Where only one face was scanned it lies in the face, and the side stays unknown.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from simulearn.compare.measurement import Numbers
from simulearn.compare.registering import thinned

NEIGHBOURS = 12
AROUND = 6.0  # mm, less than the width of a beam and more than its thickness
SURE = 0.3  # mm that the mean of the points around lies inside, at least
CELL = 1.5  # mm between places whose surroundings are looked at
PART = 20_000  # points at a time


def estimated(points: Numbers, tree: KDTree) -> tuple[Numbers, NDArray[np.bool_]]:
    """Return the normals (N, 3) of a cloud, out of the body, and for which (N,) that is sure.

    Args:
        points: (N, 3) mm.
        tree: of the points.
    """
    normals = np.empty_like(points)
    for first in range(0, len(points), PART):
        part = slice(first, first + PART)
        _, near = tree.query(points[part], k=min(NEIGHBOURS, len(points)))
        off = points[near] - points[near].mean(axis=1, keepdims=True)
        normals[part] = np.linalg.eigh(np.swapaxes(off, 1, 2) @ off)[1][:, :, 0]
    places = thinned(points, CELL)
    of_places = KDTree(places)
    inside = np.array(
        [places[near].mean(axis=0) for near in of_places.query_ball_point(places, AROUND)]
    )
    out = ((points - inside[of_places.query(points)[1]]) * normals).sum(axis=1)
    return normals * np.where(out < 0, -1.0, 1.0)[:, None], abs(out) > SURE

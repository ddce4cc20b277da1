"""Where each station of the simulated shape is on the print, by its neighbourhood in the scan.

A print that curls by another amount lies on the simulated shape nowhere but in the middle, and the
nearest measured point is not the one that belongs to a place. So the patch of each station is
laid on the scan by itself, as a rigid body, beginning with the station that fits best; its
neighbours begin where it was found. Scanned points go to the nearest place on the patch whose
normal is theirs (Y. Chen, G. Medioni, Image and Vision Computing 10, 145, 1992), far ones count
less, and what the points do not say (along a beam) stays as the neighbour has it.
"""

import heapq
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

from simulearn.compare.measurement import Numbers, Scan
from simulearn.compare.normals import estimated
from simulearn.compare.simulated import Stations, Surface
from simulearn.errors import Cancel, stop_if

RADIUS = 10.0  # mm, of the scanned points around a station
PATCH = 15.0  # mm, of the surface around it
MOST_POINTS = 400  # of a station
FEWEST = 30
STEPS = 25
FAR = (6.0, 1.5)  # mm: points are dropped beyond this at first, and at last
ROBUST = 0.4  # mm, from which a distance counts less
STIFF = (4.0, 0.15)  # mm and rad by which a station may lie off its neighbour's
ALONG = 0.4  # mm, the same along a beam
TURNED = 3.0  # mm that a normal turned by a radian counts
NEAR = 1.0  # mm within which a part of a patch is seen
SEEN = 0.2  # of a patch, at least
ROUGH = 0.8  # mm, residual of a station that is found, at most
GUESSED = 3  # stations in a row that may be missing


@dataclass(frozen=True, eq=False)
class Found:
    """Where stations are.

    Attributes:
        turns: (S, 3, 3) rotation of each from the simulated shape.
        places: (S, 3) of their centres, mm.
        seen: (S,) whether they were found.
        residual: (S,) mm, root mean square of the distances of points from the patch.
        count: (S,) points on the patch.
    """

    turns: Numbers
    places: Numbers
    seen: np.ndarray
    residual: Numbers
    count: np.ndarray


def fitted(scan: Scan, surface: Surface, stations: Stations, cancel: Cancel | None = None) -> Found:
    """Return where the stations are in a scan that lies about on the simulated shape.

    Args:
        scan: in mm, brought onto the simulated shape.
        surface: the simulated shape.
        stations: its stations.
        cancel: stops the work.

    Raises:
        CancelledError: the token was set.
    """
    fit = _Fitting(scan, surface, stations)
    count = len(stations.centres)
    neighbours: list[list[int]] = [[] for _ in range(count)]
    for a, b in stations.links:
        neighbours[a].append(int(b))
        neighbours[b].append(int(a))
    turns, places = np.tile(np.eye(3), (count, 1, 1)), stations.centres.copy()
    seen, done = np.zeros(count, bool), np.zeros(count, bool)
    residual, many = np.full(count, np.nan), np.zeros(count, np.int64)
    first = int(np.argmin([fit.unlike(s) for s in range(count)]))
    # Those next to what fits best come first; after missing ones, later.
    queue: list[tuple[float, int, int, int]] = [(0.0, first, -1, 0)]
    while queue:
        stop_if(cancel)
        _, s, parent, guesses = heapq.heappop(queue)
        if done[s]:
            continue
        turn, place = np.eye(3), stations.centres[s]
        if parent >= 0:
            turn = turns[parent]
            place = places[parent] + turn @ (stations.centres[s] - stations.centres[parent])
        patch = fit.laid(s, turn, place)
        if patch is None and guesses >= GUESSED:
            continue
        done[s] = patch is not None
        seen[s] = patch is not None
        if patch is None:
            turns[s], places[s] = turn, place
            done[s] = True
            guesses, cost = guesses + 1, 10.0 * (guesses + 1)
        else:
            turns[s], places[s], residual[s], many[s] = patch
            guesses, cost = 0, residual[s]
        for other in neighbours[s]:
            if not done[other] or not seen[other]:
                done[other] = False
                heapq.heappush(queue, (cost, other, s, guesses))
    return Found(turns, places, seen, residual, many)


class _Fitting:
    """Lays patches on a scan."""

    def __init__(self, scan: Scan, surface: Surface, stations: Stations) -> None:
        self._points = scan.points
        self._tree = KDTree(scan.points)
        if scan.normals is None:
            self._normals, self._sure = estimated(scan.points, self._tree)
        else:
            self._normals, self._sure = scan.normals, np.ones(len(scan.points), bool)
        self._surface, self._stations = surface, stations
        flat = KDTree(surface.flat)
        self._patches = [np.array(p) for p in flat.query_ball_point(stations.flat, PATCH)]
        self._rng = np.random.default_rng(0)

    def unlike(self, s: int) -> float:
        """Return how far a station's patch is from the scan as it lies, mm."""
        points = self._surface.points[self._patches[s][::10]]
        away, _ = self._tree.query(points, distance_upper_bound=10.0)
        return float(np.minimum(away, 10.0).mean())

    def laid(
        self, s: int, turn: Numbers, place: Numbers
    ) -> tuple[Numbers, Numbers, float, int] | None:
        """Return the rotation and place of a station, its residual and points; None if missing.

        Args:
            s: the station.
            turn: (3, 3) its rotation where its neighbour is right.
            place: (3,) its place then.
        """
        centre, patch = self._stations.centres[s], self._patches[s]
        local = self._surface.points[patch] - centre
        normals = self._surface.normals[patch]
        tree = KDTree(np.hstack([local, TURNED * normals]))
        prior = self._prior(s)
        begun, at = turn, place
        moved = np.zeros(6)  # mm and rad away from the neighbour's
        for step in range(STEPS):
            near = self._around(at)
            if len(near) < FEWEST:
                return None
            ours = (self._points[near] - at) @ turn
            normals_here = self._normals[near] @ turn
            away, index, own = self._nearest(tree, ours, normals_here, self._sure[near])
            far = FAR[0] + (FAR[1] - FAR[0]) * min(1.0, 2 * step / STEPS)
            off = ((ours - local[index]) * own).sum(axis=1)
            keep = away < far + TURNED
            if keep.sum() < FEWEST:
                return None
            w = 1 / (1 + (off[keep] / ROBUST) ** 2)
            # A small turn t about the centre and a move m shift a plane by n . (m + t x p).
            rows = np.hstack([own[keep], np.cross(local[index[keep]], own[keep])])
            scale = 1 / ROBUST**2
            left = scale * (rows * w[:, None]).T @ rows + prior
            right = scale * (rows * w[:, None]).T @ off[keep] - prior @ moved
            change = np.linalg.solve(left, right)
            at = at + turn @ change[:3]
            turn = turn @ Rotation.from_rotvec(change[3:]).as_matrix()
            moved = np.concatenate(
                [begun.T @ (at - place), Rotation.from_matrix(begun.T @ turn).as_rotvec()]
            )
            if step > STEPS // 2 and abs(change).max() < 1e-3:
                break
        return self._judged(s, turn, at, off[keep], local)

    def _judged(
        self, s: int, turn: Numbers, at: Numbers, off: Numbers, local: Numbers
    ) -> tuple[Numbers, Numbers, float, int] | None:
        close = abs(off) < 3 * ROBUST
        if close.sum() < FEWEST:
            return None
        residual = float(np.sqrt((off[close] ** 2).mean()))
        near = local[np.linalg.norm(local, axis=1) < RADIUS] @ turn.T + at
        away, _ = self._tree.query(near, distance_upper_bound=NEAR)
        if residual > ROUGH or close.mean() < 0.5 or np.isfinite(away).mean() < SEEN:
            return None
        return turn, at, residual, int(close.sum())

    def _around(self, at: Numbers) -> np.ndarray:
        near = np.array(self._tree.query_ball_point(at, RADIUS))
        if len(near) > MOST_POINTS:
            near = near[:: len(near) // MOST_POINTS]
        return near

    def _nearest(
        self, tree: KDTree, points: Numbers, normals: Numbers, sure: NDArray[np.bool_]
    ) -> tuple[Numbers, np.ndarray, Numbers]:
        """Return distances, places on the patch, and the patch's normals there."""
        away, index = tree.query(np.hstack([points, TURNED * normals]))
        if not sure.all():
            turned = np.hstack([points, -TURNED * normals])[~sure]
            other, second = tree.query(turned)
            index[~sure] = np.where(other < away[~sure], second, index[~sure])
            away[~sure] = np.minimum(away[~sure], other)
        return away, index, np.asarray(tree.data[index, 3:] / TURNED)

    def _prior(self, s: int) -> Numbers:
        """Return what holds a station to its neighbour: (6, 6), of moves and turns."""
        along = self._stations.along[s]
        hold = np.eye(3) / STIFF[0] ** 2 + np.outer(along, along) / ALONG**2
        prior = np.zeros((6, 6))
        prior[:3, :3] = hold
        prior[3:, 3:] = np.eye(3) / STIFF[1] ** 2
        return prior

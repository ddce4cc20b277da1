"""How far a print is from its simulation, joint by joint and beam by beam.

What is compared is in one frame: that of the simulation, after the rigid motion that brings the
measured joints nearest to the simulated ones in the mean of squares.
"""

from dataclasses import dataclass

import numpy as np

from simulearn.compare.measurement import Numbers
from simulearn.rigid import fit_rotation


@dataclass(frozen=True, eq=False)
class Deviation:
    """What was measured beside what was simulated, mm, +z up; NaN where nothing was measured.

    Attributes:
        joints: (J, 3) measured places of the joints.
        simulated: (J, 3) simulated ones.
        stations: (B, 3, 3) measured places along each beam, at a quarter, half and three quarters.
        expected: (B, 3, 3) simulated ones.
        beams: (B, 2) mean and largest distance of the beam's measured centre line.
        curvature: (B, 2) measured and simulated, 1/mm, + curls up.
    """

    joints: Numbers
    simulated: Numbers
    stations: Numbers
    expected: Numbers
    beams: Numbers
    curvature: Numbers

    @property
    def moves(self) -> Numbers:
        """(J, 3) from the simulated to the measured place of each joint."""
        return self.joints - self.simulated

    @property
    def distances(self) -> Numbers:
        """(J,) of the joints."""
        return np.asarray(np.linalg.norm(self.moves, axis=1))

    @property
    def mean(self) -> float:
        """Mean distance of the joints."""
        return float(np.nanmean(self.distances))

    @property
    def worst(self) -> int:
        """The joint that is farthest off."""
        return int(np.nanargmax(self.distances))

    @property
    def measured(self) -> np.ndarray:
        """(J,) whether a joint was measured."""
        return np.asarray(np.isfinite(self.joints).all(axis=1))


def deviation_of(
    joints: Numbers,
    simulated: Numbers,
    ends: np.ndarray,
    stations: Numbers,
    expected: Numbers,
    along: Numbers,
    up: Numbers,
) -> Deviation:
    """Return the deviation of joints and beams.

    Args:
        joints: (J, 3) measured places, NaN where there is none, in the frame of the simulation.
        simulated: (J, 3) simulated places.
        ends: (B, 2) joints of the beams.
        stations: (B, 3, 3) measured places along the beams, NaN where there is none.
        expected: (B, 3, 3) simulated places.
        along: (B, 3, 3) direction of the beam there.
        up: (B, 3, 3) normal of the grid there.
    """
    off = stations - expected
    # Where a bar is along itself no scan says.
    across = np.linalg.norm(off - (off * along).sum(axis=2, keepdims=True) * along, axis=2)
    at_ends = np.linalg.norm(joints - simulated, axis=1)[ends]
    every = np.concatenate([across, at_ends], axis=1)
    none = np.isnan(every).all(axis=1)
    every[none] = 0.0  # so that means of nothing make no noise
    beams = np.stack([np.nanmean(every, axis=1), np.nanmax(every, axis=1)], axis=1)
    beams[none] = np.nan
    curvature = np.stack(
        [curvature_of(places, up[:, 1]) for places in (stations, expected)], axis=1
    )
    return Deviation(joints, simulated, stations, expected, beams, curvature)


def curvature_of(places: Numbers, up: Numbers) -> Numbers:
    """Return the curvature (B,) of beams through three places (B, 3, 3), + towards up (B, 3).

    Of the circle through a chord c with a sagitta s: 8 s / (c^2 + 4 s^2).
    """
    chord = places[:, 2] - places[:, 0]
    sagitta = (places[:, 0] + places[:, 2]) / 2 - places[:, 1]
    s = np.linalg.norm(sagitta, axis=1) * np.sign((sagitta * up).sum(axis=1))
    return np.asarray(8 * s / ((chord**2).sum(axis=1) + 4 * s**2))


def without_motion(rows: Numbers, places: Numbers) -> Numbers:
    """Return displacements (..., 3 K) without what a small rigid motion of places (K, 3) does."""
    count = len(places)
    local = places - places.mean(axis=0)
    motions = np.zeros((6, count, 3))
    for k in range(3):
        motions[k, :, k] = 1.0
        motions[3 + k] = np.cross(np.eye(3)[k], local)
    basis, size, _ = np.linalg.svd(motions.reshape(6, -1).T, full_matrices=False)
    basis = basis[:, size > 1e-9 * size[0]]
    return np.asarray(rows - (rows @ basis) @ basis.T)


def brought(measured: Numbers, simulated: Numbers) -> Numbers:
    """Return measured places (K, 3) after the motion that brings them nearest to simulated ones."""
    middle = measured.mean(axis=0)
    turn, centre = fit_rotation(simulated, measured - middle)
    return np.asarray((measured - middle) @ turn.T + centre)

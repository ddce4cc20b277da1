"""The rigid motion that brings measured places of joints nearest to the simulated ones.

A print lies anywhere, so only what no motion removes is a deviation. A mirrored measurement (a
scanner's or a program's axes exchanged) is found by allowing reflections, and taken only where it
fits far better.
"""

from dataclasses import dataclass

import numpy as np

from simulearn.compare.measurement import Numbers
from simulearn.errors import Message
from simulearn.rigid import fit_rotation

MIRRORED = 2.0  # times as near must a mirrored measurement be
LEAST = 0.5  # mm, below which nobody asks whether it is mirrored
MIRROR = np.diag([-1.0, 1.0, 1.0])


@dataclass(frozen=True, eq=False)
class Pose:
    """A rigid motion of a measurement, perhaps after a reflection: p -> turn p + shift.

    Attributes:
        turn: (3, 3) of determinant 1, or -1 for a reflection.
        shift: (3,) mm.
    """

    turn: Numbers
    shift: Numbers

    def __call__(self, points: Numbers) -> Numbers:
        """Return points (..., 3) where the motion brings them."""
        return points @ self.turn.T + self.shift

    def after(self, first: "Pose") -> "Pose":
        """Return the motion that is another one first and then this."""
        return Pose(self.turn @ first.turn, self(first.shift))

    @property
    def mirrored(self) -> bool:
        """Whether it reflects."""
        return bool(np.linalg.det(self.turn) < 0)


IDENTITY = Pose(np.eye(3), np.zeros(3))


def rigid(measured: Numbers, simulated: Numbers, mirror: bool = False) -> Pose:
    """Return the motion that brings measured points (K, 3) nearest to simulated ones (K, 3)."""
    points = measured @ MIRROR if mirror else measured
    middle = points.mean(axis=0)
    turn, centre = fit_rotation(simulated, points - middle)
    pose = Pose(turn, centre - turn @ middle)
    return pose.after(Pose(MIRROR, np.zeros(3))) if mirror else pose


def rms(measured: Numbers, simulated: Numbers) -> float:
    """Return the root of the mean squared distance of points (K, 3)."""
    return float(np.sqrt(((measured - simulated) ** 2).sum(axis=-1).mean()))


def spread(points: Numbers) -> float:
    """Return the extent of points across the line that fits them best, mm: 0 on a line."""
    return float(np.linalg.svd(points - points.mean(axis=0), compute_uv=False)[1])


def aligned(measured: Numbers, simulated: Numbers) -> Pose:
    """Return the motion for named joints, with a reflection where that fits far better."""
    plain, mirrored = (rigid(measured, simulated, mirror) for mirror in (False, True))
    off, other = (rms(pose(measured), simulated) for pose in (plain, mirrored))
    return mirrored if off > LEAST and other * MIRRORED < off and len(measured) > 4 else plain


def ambiguous(count: int, what: str) -> Message:
    """Return the warning about several poses or assignments that fit equally well."""
    text = (
        f"{count} {what} fit equally well, since the grid is about symmetric; the first is taken, "
        "and numbers may be exchanged: name the joints in a table to be sure"
    )
    return Message("pose-ambiguous", "measurement", text)


def mirrored() -> Message:
    """Return the warning about a measurement that fits mirrored only."""
    text = (
        "the measurement fits far better mirrored, as where two axes were exchanged; it is "
        "compared mirrored"
    )
    return Message("pose-mirrored", "measurement", text)

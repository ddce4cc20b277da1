"""Rigid motions, and those that fit points best."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]


def fit_rotation(
    points: NDArray[np.floating], local: NDArray[np.floating]
) -> tuple[Numbers, Numbers]:
    """Return the rotations R (..., 3, 3) and centres (..., 3) that bring bodies nearest to points.

    Args:
        points: (..., N, 3) in space.
        local: (..., N, 3) in the body, about the centre of its points.

    Returns:
        Rotations and centres such that R @ local + centre is nearest to the points in the mean of
        squares.

    Source: W. Kabsch, Acta Cryst. A32, 922 (1976).
    """
    points = np.asarray(points, np.float64)
    centre = points.mean(axis=-2)
    product = np.swapaxes(points - centre[..., None, :], -1, -2) @ local
    u, _, v = np.linalg.svd(product)
    sign = np.ones(product.shape[:-1])
    sign[..., 2] = np.sign(np.linalg.det(u @ v))
    return (u * sign[..., None, :]) @ v, centre


def _no_turn() -> Numbers:
    return np.eye(3)


def _no_shift() -> Numbers:
    return np.zeros(3)


@dataclass(frozen=True, eq=False)
class Place:
    """A rigid motion of a part to its place: p -> turn p + shift; by default none.

    Attributes:
        turn: (3, 3) rotation.
        shift: (3,) mm.
    """

    turn: Numbers = field(default_factory=_no_turn)
    shift: Numbers = field(default_factory=_no_shift)

    def __call__(self, points: Numbers) -> Numbers:
        """Return points (..., 3) mm in their place."""
        return points @ self.turn.T + self.shift

    def after(self, first: "Place") -> "Place":
        """Return the motion that is this one after another."""
        return Place(self.turn @ first.turn, self(first.shift))

    @property
    def back(self) -> "Place":
        """The motion from the place back."""
        return Place(self.turn.T, -self.turn.T @ self.shift)

    @classmethod
    def fitting(cls, points: Numbers, targets: Numbers) -> "Place":
        """Return the motion that brings points (N, 3) closest to targets (N, 3), in squares."""
        middle, wanted = points.mean(axis=0), targets.mean(axis=0)
        turn, _ = fit_rotation(targets, points - middle)
        return cls(turn, wanted - turn @ middle)

    @classmethod
    def about_z(cls, degrees: float) -> "Place":
        """Return the turn about the z axis."""
        c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
        return cls(np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]]))

"""Rigid motions that fit points best."""

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

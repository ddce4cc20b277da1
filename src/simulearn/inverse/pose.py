"""The rigid motion after which goals are met best, where a shape may be placed anywhere.

Least squares over the motion alone, by Gauss-Newton with damping: for each design of a batch the
residuals change with six small motions. The search for a design then sees the residuals after the
best motion (variable projection: Golub and Pereyra, SIAM J. Numer. Anal. 10, 413, 1973).
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from simulearn.rigid import Place

Array = NDArray[np.float64]
Residual = Callable[[Array], Array]  # points (T, V, 3) mm -> (T, N) mm

ITERATIONS = 20
STEP = 1e-3  # mm, of the motions from which derivatives are taken
DONE = 1e-5  # mm, a motion that changes nothing
DAMPING = (1e-6, 0.3)  # of the mean curvature: as good as none, and where that does not go down


def fitted(
    points: Array, residual: Residual, turn: Array, shift: Array, most: int = ITERATIONS
) -> tuple[Array, Array]:
    """Return the best motions of shapes: rotations (T, 3, 3) and shifts (T, 3) mm.

    Args:
        points: (T, V, 3) mm.
        residual: of points.
        turn: (T, 3, 3) to begin with.
        shift: (T, 3) mm.
        most: iterations.
    """
    turn, shift = turn.copy(), shift.copy()
    going = np.flatnonzero(np.isfinite(points).all(axis=(1, 2)))
    size = np.maximum(np.linalg.norm(np.ptp(points, axis=1), axis=-1), 1.0)
    now = moved(points, turn, shift)
    r = residual(now)
    for _ in range(most):
        if not len(going):
            break
        here, reach = now[going], size[going, None, None]
        middle = here.mean(axis=1, keepdims=True)
        tries = []
        for k in range(6):
            by = np.zeros(3)
            by[k % 3] = STEP
            tries.append(here + by if k < 3 else here + np.cross(by, here - middle) / reach)
        many = residual(np.concatenate(tries)).reshape(6, len(going), -1)
        J = np.moveaxis(many - r[going], 0, -1) / STEP
        JtJ, Jtr = np.einsum("tnk,tnm->tkm", J, J), np.einsum("tnk,tn->tk", J, r[going])
        trace = np.trace(JtJ, axis1=1, axis2=2)[:, None, None] / 6 + 1e-12
        left = np.ones(len(going), bool)
        ended = np.ones(len(going), bool)
        for damping in DAMPING:
            step = -np.linalg.solve(JtJ + damping * trace * np.eye(6), Jtr[..., None])[..., 0]
            turned = _rotation(step[:, 3:] / reach[:, 0])
            placed = np.einsum("tij,tvj->tvi", turned, here - middle) + middle + step[:, None, :3]
            after = residual(placed)
            better = left & ((after**2).sum(axis=1) < (r[going] ** 2).sum(axis=1))
            at = going[better]
            turn[at] = turned[better] @ turn[at]
            offset = (shift[at] - middle[better, 0])[..., None]
            shift[at] = (turned[better] @ offset)[..., 0] + middle[better, 0] + step[better, :3]
            now[at], r[at] = placed[better], after[better]
            ended[better] = np.abs(step[better]).max(axis=1) < DONE
            left &= ~better
            if not left.any():
                break
        going = going[~ended]
    return turn, shift


def moved(points: Array, turn: Array, shift: Array) -> Array:
    """Return points (T, V, 3) after motions (T, 3, 3), (T, 3)."""
    return np.einsum("tij,tvj->tvi", turn, points) + shift[:, None]


def starts(points: Array, anchors: Array, normals: Array) -> list[Place]:
    """Return motions to try: a shape laid on places of a surface, turned in each of 16 ways.

    Args:
        points: (V, 3) mm of the shape.
        anchors: (K, 3) mm, where its middle comes to.
        normals: (K, 3) that its z axis comes to, from either side.
    """
    middle = points.mean(axis=0)
    places = [Place()]
    for anchor, normal in zip(anchors, normals, strict=True):
        for z in (normal, -normal):
            helper = np.eye(3)[np.abs(z).argmin()]
            x = np.cross(helper, z)
            x /= np.linalg.norm(x)
            base = np.stack([x, np.cross(z, x), z], axis=1)
            for k in range(8):
                turn = base @ Place.about_z(45.0 * k).turn
                places.append(Place(turn, anchor - turn @ middle))
    return places


def _rotation(vectors: Array) -> Array:
    """Return the rotations (T, 3, 3) by rotation vectors (T, 3). Source: Rodrigues, 1840."""
    angle = np.linalg.norm(vectors, axis=1)[:, None, None]
    x, y, z = vectors.T
    o = np.zeros_like(x)
    K = np.stack([o, -z, y, z, o, -x, -y, x, o], axis=-1).reshape(-1, 3, 3)
    once, twice = np.sinc(angle / np.pi), 0.5 * np.sinc(angle / (2 * np.pi)) ** 2
    return np.eye(3) + once * K + twice * K @ K

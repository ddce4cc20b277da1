"""The 20-node brick of CalculiX in the numbering of ours.

Both number the same nodes and integration points differently. Instead of a table, each describes
its own by local coordinates on the unit brick, and equal coordinates are the same node.
"""

import numpy as np
from numpy.typing import NDArray
from skfem import ElementHexS2

from simulearn.errors import ComputationError, InputError

Array = NDArray[np.float64]


def _nodes() -> Array:
    """Return the (20, 3) local nodes as CalculiX numbers them: corners, then middles of edges."""
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    bottom, top = (np.c_[square, np.full(4, z)] for z in (0, 1))
    rings = [(side + np.roll(side, -1, axis=0)) / 2 for side in (bottom, top)]
    return np.vstack([bottom, top, *rings, (bottom + top) / 2])


# Node k of a CalculiX brick is node ORDER[k] of ours.
ORDER = np.array(
    [int(np.flatnonzero((ElementHexS2.doflocs == node).all(axis=1))[0]) for node in _nodes()]
)

# The eight points of the reduced rule as CalculiX numbers them, the first coordinate fastest.
_GAUSS = (1 + np.array([-1, 1]) / np.sqrt(3)) / 2
POINTS: Array = np.stack(np.meshgrid(_GAUSS, _GAUSS, _GAUSS, indexing="ij"), axis=-1)
POINTS = POINTS.transpose(2, 1, 0, 3).reshape(8, 3)


def matching(points: Array) -> NDArray[np.int64]:
    """Return which of CalculiX's integration points each of ours is (Q,).

    Args:
        points: (3, Q) integration points in the unit brick.

    Raises:
        InputError: they are not those of the reduced rule.
    """
    apart = np.linalg.norm(POINTS[:, :, None] - points, axis=1)
    order = apart.argmin(axis=0)
    if len(order) != len(POINTS) or apart.min(axis=0).max() > 1e-6:
        raise InputError(
            f"CalculiX integrates a brick at {len(POINTS)} points and not at these "
            f"{points.shape[1]}: mesh shells and core as bricks of their own"
        )
    return order


def bricks(nodes: Array, ours: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the (E, 20) nodes of bricks in CalculiX's order.

    Args:
        nodes: (N, 3) positions.
        ours: (E, 20) node indices in the order of scikit-fem's `ElementHexS2`.

    Raises:
        ComputationError: a brick is inside out.
    """
    theirs = ours[:, ORDER]
    corner, x, y, z = (nodes[theirs[:, k]] for k in (0, 1, 3, 4))
    volume = np.einsum("ei,ei->e", np.cross(x - corner, y - corner), z - corner)
    if (volume <= 0).any():
        raise ComputationError(f"brick {np.argmin(volume)} is inside out; CalculiX would refuse it")
    return theirs

"""The solid model of a grid: nodes, 20-node bricks, and how each material point grows.

Every solver of the solid (ours, CalculiX) reads this and nothing else of the grid.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Solid:
    """A flat grid as a solid, mm and MPa; the fixed joint is the origin, z = 0 the mid-plane.

    Attributes:
        nodes: (N, 3) positions.
        bricks: (E, 20) node indices, numbered as in scikit-fem's `ElementHexS2`.
        parts: (E, 2) what a brick belongs to: (beam, slab along it), or (-1, joint).
        slabs: number of slabs along each beam.
        points: (3, Q) integration points of a beam's unit brick (along, across, up).
        weights: (Q,) their weights, adding to one.
        joint_points: (3, Q) the same for a joint's brick, alike in both directions of the plane.
        joint_weights: (Q,) their weights.
        angle: (E,) direction of the printing frame's first axis (along the beam) from +x, radians.
        growth: (E, Q, 3) released strains along, across and in thickness, in the printing frame,
            when all is released: F_g = I + s diag(growth).
        stress: (E, Q, 3) printed-in normal stresses in the same frame.
        fixed: (K,) nodes that are held (see `Grid.support`).
        joints: (J, 8) nodes at the joints' corners, in the order of `Result.joints`.
        beams: (B, 3, 4) nodes at the beams' sections, in the order of `Result.beams`.
        samples: (B, 4, 4, 8) integration points around the stress samples, counted from the
            first of the first beam's bricks.
        shares: (B, 4, 4, 8) their weights.
    """

    nodes: NDArray[np.float64]
    bricks: NDArray[np.int64]
    parts: NDArray[np.int64]
    slabs: int
    points: NDArray[np.float64]
    weights: NDArray[np.float64]
    joint_points: NDArray[np.float64]
    joint_weights: NDArray[np.float64]
    angle: NDArray[np.float64]
    growth: NDArray[np.float64]
    stress: NDArray[np.float64]
    fixed: NDArray[np.int64]
    joints: NDArray[np.int64]
    beams: NDArray[np.int64]
    samples: NDArray[np.int64]
    shares: NDArray[np.float64]

"""The solid model of a grid: nodes, 20-node bricks, and how each material point grows.

Every solver of the solid (ours, CalculiX) reads this and nothing else of the grid.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Solid:
    """A grid as a solid, mm; the fixed joint's centre is the origin, z = 0 its mid-plane.

    Attributes:
        nodes: (N, 3) positions of the nodes in the flat grid.
        bricks: (E, 20) node indices, numbered as in scikit-fem's `ElementHexS2`.
        angle: (E,) direction of printing frame 1 (along the beam) from +x, radians.
        growth: (E, Q, 3) released strains along, across and in thickness in that frame, at the
            Q integration points, at full release: F_g = I + s diag(growth).
        stress: (E, Q, 3) printed-in normal stresses in the same frame, MPa.
        fixed: (K,) indices of the nodes that are held (lower half of the fixed joint).
        joints: (J, 8) nodes of the joints' corners, in the order of `Result.joints`.
        beams: (B, 3, 4) nodes of the beams' sections, in the order of `Result.beams`.
    """

    nodes: NDArray[np.float64]
    bricks: NDArray[np.int64]
    angle: NDArray[np.float64]
    growth: NDArray[np.float64]
    stress: NDArray[np.float64]
    fixed: NDArray[np.int64]
    joints: NDArray[np.int64]
    beams: NDArray[np.int64]

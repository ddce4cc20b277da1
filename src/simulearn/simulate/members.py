"""The last frame of one grid in many materials at once: for calibration, comparison and scatter.

A print differs from the material's figures, and its beams from each other. So each of T prints has
a material of its own and, where wanted, a factor on the released strain of each beam.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import ComputationError
from simulearn.grid import Grid
from simulearn.material import Material

Numbers = NDArray[np.float64]


class Prints(NamedTuple):
    """The last frame of T prints of one grid; mm, +z up, the fixed joint at the origin.

    Attributes:
        joints: (T, J, 8, 3) corners of the joints.
        sections: (T, B, 3, 4, 3) corners of the beams' sections at start, middle and end.
        converged: (T,) whether there is an answer; what there is none of is NaN.
    """

    joints: Numbers
    sections: Numbers
    converged: NDArray[np.bool_]

    @property
    def centres(self) -> Numbers:
        """(T, J, 3) centres of the joints."""
        return np.asarray(self.joints.mean(axis=2))


def last_frames(
    grid: Grid, materials: Sequence[Material], factors: Numbers | None = None
) -> Prints:
    """Return the last frame of a grid in each of T materials; open grids, as strips, too.

    Args:
        grid: a sound grid; it is not cleaned, so that single beams have an answer.
        materials: of the prints; all have the same section.
        factors: (T, B) by which the released strains of beams differ from the material's.
    """
    from simulearn.fea import simulate_grid

    count, many = len(materials), len(grid.beams)
    joints: Any = np.full((count, len(grid.joints), 8, 3), np.nan)
    sections: Any = np.full((count, many, 3, 4, 3), np.nan)
    for t, material in enumerate(materials):
        try:
            trial = simulate_grid(grid, material, factors=None if factors is None else factors[t])
        except ComputationError:
            continue
        joints[t], sections[t] = trial.joints[-1], trial.beams[-1]
    return Prints(joints, sections, np.isfinite(joints).all(axis=(1, 2, 3)))

"""The last frame of one grid in many materials at once: for calibration, comparison and scatter.

A print differs from the material's figures, and its beams from each other. So each of T prints has
a material of its own and, where wanted, a factor on the released strain of each beam.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulearn.grid import Grid
from simulearn.learn.common.bundle import bundle_of
from simulearn.learn.common.model import Designs, last_frame
from simulearn.material import Material
from simulearn.simulate.learned import Learned

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
    grid: Grid,
    materials: Sequence[Material],
    factors: Numbers | None = None,
    model: str = "default",
) -> Prints:
    """Return the last frame of a grid in each of T materials; open grids, as strips, too.

    Args:
        grid: a sound grid; it is not cleaned, so that single beams have an answer.
        materials: of the prints.
        factors: (T, B) by which the released strains of beams differ from the material's.
        model: the learned model that answers, by name or folder.

    Raises:
        InputError: a material is too far outside what the model has learnt.
    """
    engine = Learned(bundle_of(model))
    for material in {material.digest: material for material in materials}.values():
        engine.require(material)
    grid = grid.centred
    count = len(materials)
    designs = Designs(
        grid.beams,
        grid.fixed,
        np.tile(grid.joints, (count, 1, 1)),
        np.tile(grid.actuators, (count, 1)),
        materials[0],
        grid.material,
        tuple(materials),
        factors,
    )
    last = last_frame(engine.bundle.model, designs)
    return Prints(last.joints, last.sections, last.converged)

"""Grids as a learned model takes them: many of one topology in arrays."""

from collections.abc import Sequence

import numpy as np

from simulearn.grid import Grid
from simulearn.learn.common.model import Designs
from simulearn.material import Material


def designs_of(grids: Sequence[Grid], material: Material) -> Designs:
    """Return grids of one topology as designs of a material."""
    return Designs(
        beams=grids[0].beams,
        fixed=grids[0].fixed,
        flat=np.stack([grid.joints for grid in grids]),
        actuators=np.stack([grid.actuators for grid in grids]),
        material=material,
    )

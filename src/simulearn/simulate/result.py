"""The Result of simulating a grid, the same for every engine."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from simulearn.grid import Grid

if TYPE_CHECKING:  # so that reading a result does not load a solver
    from simulearn.fea import Solid

FRAMES = 12  # flat, ten of residual-stress release, one after creep


@dataclass(frozen=True, eq=False)
class Result:
    """The twelve frames of a morphing grid; mm, MPa, +z up.

    Attributes:
        grid: the design, as simulated.
        engine: name of the engine that answered.
        joints: (12, J, 8, 3) corners of the joints: bottom counter-clockwise seen from +z, then
            top in the same order, the first being the one with the smallest angle in [0, 2 pi).
        beams: (12, B, 3, 4, 3) sections start, middle, end; corners right-bottom, left-bottom,
            right-top, left-top, where left is z x (start -> end).
        stress: (12, B, 4, 4, 6) sections start, before and after the middle, end; the four
            corners; components 11 22 33 12 13 23 in global axes. None where an engine has none.
        seconds: time the simulation took.
        record: what the engine tells about its work, for example iterations per frame.
        solid: the solid mesh, where the engine has one.
        displacements: (12, N, 3) of the solid's nodes from the flat grid.
    """

    grid: Grid
    engine: str
    joints: NDArray[np.float64]
    beams: NDArray[np.float64]
    stress: NDArray[np.float64] | None
    seconds: float
    record: dict[str, Any] = field(default_factory=dict)
    solid: Solid | None = None
    displacements: NDArray[np.float64] | None = None

    @property
    def centres(self) -> NDArray[np.float64]:
        """(12, J, 3) centres of the joints: the mean of their eight corners."""
        return self.joints.mean(axis=2)

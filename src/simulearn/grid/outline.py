"""The outlines of joints and beams in the plane (to be written)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.grid.grid import Grid
from simulearn.material import Section


@dataclass(frozen=True)
class Outline:
    """Corners of joints and beams in the plane, mm.

    Attributes:
        joints: (J, 4, 2) corners counter-clockwise, the first being the one with the smallest
            angle in [0, 2 pi) seen from the joint.
        sides: (B, 2) side of the start joint and of the end joint that the beam meets;
            side k of a joint runs from its corner k to its corner k + 1 (mod 4).
        beams: (B, 2, 2, 2) [start, end] x [right, left] x (x, y), where left is z x (start -> end).
    """

    joints: NDArray[np.float64]
    sides: NDArray[np.int64]
    beams: NDArray[np.float64]


def outline(grid: Grid, section: Section) -> Outline:
    """Return the outline of a grid whose beams have the given section."""
    raise NotImplementedError

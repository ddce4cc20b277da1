"""Finite elements: the truth that everything else learns from."""

from simulearn.fea.equilibrium import Control
from simulearn.fea.mesh import COARSE, THREE_ACROSS, Layout, mesh
from simulearn.fea.solid import Solid
from simulearn.fea.trial import FRAMES, Trial, simulate_grid

__all__ = [
    "COARSE",
    "FRAMES",
    "THREE_ACROSS",
    "Control",
    "Layout",
    "Solid",
    "Trial",
    "mesh",
    "simulate_grid",
]

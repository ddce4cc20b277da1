"""Finite elements: the reference that everything else learns from."""

from simulearn.fea.layout import COARSE, FINE, THREE_ACROSS, Layout
from simulearn.fea.mesh import mesh
from simulearn.fea.problem import Control
from simulearn.fea.solid import Solid
from simulearn.fea.trial import Trial, simulate_grid
from simulearn.schedule import FRAMES

__all__ = [
    "COARSE",
    "FINE",
    "FRAMES",
    "THREE_ACROSS",
    "Control",
    "Layout",
    "Solid",
    "Trial",
    "mesh",
    "simulate_grid",
]

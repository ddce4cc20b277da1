"""The grid that a designer draws: its type, outline, rules, file and library."""

from simulearn.grid.grid import Grid
from simulearn.grid.outline import Outline, outline

__all__ = ["Grid", "Outline", "outline"]

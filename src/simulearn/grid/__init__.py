"""The grid that a designer draws: its type, outline, rules, file and library."""

from simulearn.errors import Message
from simulearn.grid.checks import Checks, TrainingRange, check_designs
from simulearn.grid.cleaning import clean
from simulearn.grid.designs import Rules, draw, draw_valid
from simulearn.grid.grid import Grid, Support
from simulearn.grid.gridfile import grid_from_dict, grid_to_dict, read_grid, write_grid
from simulearn.grid.kinds import KindDesign, Kinds, draw_kind
from simulearn.grid.lattice import drop_beams, lattice
from simulearn.grid.library import library, make
from simulearn.grid.outline import CornerTopology, Outline, corner_topology, outline
from simulearn.grid.sketch import sketch
from simulearn.grid.validation import Validation, errors_of, validate

__all__ = [
    "Checks",
    "CornerTopology",
    "Grid",
    "KindDesign",
    "Kinds",
    "Message",
    "Outline",
    "Rules",
    "Support",
    "TrainingRange",
    "Validation",
    "check_designs",
    "clean",
    "corner_topology",
    "draw",
    "draw_kind",
    "draw_valid",
    "drop_beams",
    "errors_of",
    "grid_from_dict",
    "grid_to_dict",
    "lattice",
    "library",
    "make",
    "outline",
    "read_grid",
    "sketch",
    "validate",
    "write_grid",
]

"""Several grids put together: where each is, in which order they morph, what touches."""

from simulearn.assembly.assembled import (
    Assembled,
    checked,
    simulate_assembly,
    simulated,
)
from simulearn.assembly.assembly import Assembly, Obstacle, Part, Step
from simulearn.assembly.assemblyfile import (
    assembly_from_dict,
    assembly_to_dict,
    read_assembly,
    write_assembly,
)
from simulearn.assembly.checking import PartCollision
from simulearn.assembly.resultfile import assembled_to_dict, write_assembled_json

__all__ = [
    "Assembled",
    "Assembly",
    "Obstacle",
    "Part",
    "PartCollision",
    "Step",
    "assembled_to_dict",
    "assembly_from_dict",
    "assembly_to_dict",
    "checked",
    "read_assembly",
    "simulate_assembly",
    "simulated",
    "write_assembled_json",
    "write_assembly",
]

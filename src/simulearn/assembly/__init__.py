"""Several grids put together: where each is, in which order they morph, what touches."""

from simulearn.assembly.assembly import Assembly, Obstacle, Part, Step
from simulearn.assembly.assemblyfile import (
    assembly_from_dict,
    assembly_to_dict,
    read_assembly,
    write_assembly,
)

__all__ = [
    "Assembly",
    "Obstacle",
    "Part",
    "Step",
    "assembly_from_dict",
    "assembly_to_dict",
    "read_assembly",
    "write_assembly",
]

"""Files of other programs: surfaces, morphing ones, solids, Rhino's, and tables."""

from simulearn.interop.morphing import write_morph
from simulearn.interop.surface import write_surface
from simulearn.interop.table import write_csv
from simulearn.interop.threedm import write_3dm, write_job_3dm
from simulearn.interop.vtk import write_pvd, write_vtu

__all__ = [
    "write_3dm",
    "write_csv",
    "write_job_3dm",
    "write_morph",
    "write_pvd",
    "write_surface",
    "write_vtu",
]

"""Files of other programs: surfaces (GLB, STL) and solids (VTK)."""

from simulearn.interop.surface import write_surface
from simulearn.interop.vtk import write_pvd, write_vtu

__all__ = ["write_pvd", "write_surface", "write_vtu"]

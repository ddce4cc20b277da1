"""Surfaces and curves that shapes are compared with: reading, mending, closest points."""

from simulearn.surfaces.curve import Curve
from simulearn.surfaces.heights import surface_of_heights
from simulearn.surfaces.mending import mended
from simulearn.surfaces.plane import Plane
from simulearn.surfaces.reading import read_curve, read_surface
from simulearn.surfaces.surface import Surface

__all__ = [
    "Curve",
    "Plane",
    "Surface",
    "mended",
    "read_curve",
    "read_surface",
    "surface_of_heights",
]

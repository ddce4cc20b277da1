"""Surfaces and curves that shapes are compared with: reading, mending, closest points."""

from simulearn.surfaces.curve import Curve
from simulearn.surfaces.heights import surface_of_heights
from simulearn.surfaces.mending import mended, mended_surface
from simulearn.surfaces.plane import Plane
from simulearn.surfaces.reading import read_curve, read_surface, surface_in
from simulearn.surfaces.simplifying import simplified
from simulearn.surfaces.surface import Surface

__all__ = [
    "Curve",
    "Plane",
    "Surface",
    "mended",
    "mended_surface",
    "read_curve",
    "read_surface",
    "simplified",
    "surface_in",
    "surface_of_heights",
]

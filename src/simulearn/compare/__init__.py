"""A print measured beside its simulation."""

from simulearn.compare.comparing import Comparison, compare
from simulearn.compare.measurement import JointPlaces, Measurement, Scan
from simulearn.compare.reading import read_measurement

__all__ = ["Comparison", "JointPlaces", "Measurement", "Scan", "compare", "read_measurement"]

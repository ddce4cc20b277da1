"""CalculiX as an engine and a judge: the same solid in another program."""

from simulearn.fea.calculix.run import CalculixFrames, calculix
from simulearn.fea.calculix.trial import simulate_grid

__all__ = ["CalculixFrames", "calculix", "simulate_grid"]

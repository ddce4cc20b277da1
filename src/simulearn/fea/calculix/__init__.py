"""CalculiX as an engine and a judge: the same solid in another program."""

from simulearn.fea.calculix.brick import POINTS
from simulearn.fea.calculix.deck import write_deck
from simulearn.fea.calculix.run import CalculixFrames, calculix

__all__ = ["POINTS", "CalculixFrames", "calculix", "write_deck"]

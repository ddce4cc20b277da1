"""Finite elements: the truth that everything else learns from."""

from simulearn.fea.solid import Solid

__all__ = ["Solid"]

"""SVG: what is seen of a drawing, as lines and curves with y up."""

from simulearn.drawings.svg.reader import read_svg

__all__ = ["read_svg"]

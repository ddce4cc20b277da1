"""Parts that meet while a grid morphs: which, in which frame, how deep.

Beams are rows of short boxes along their axis, joints are prisms of eight corners. Engines know no
contact: what is found here says from which frame on their shape is not that of a print.
"""

from simulearn.collisions.between import Body, against, between
from simulearn.collisions.collision import Collision
from simulearn.collisions.find import find, find_all

__all__ = ["Body", "Collision", "against", "between", "find", "find_all"]

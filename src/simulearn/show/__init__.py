"""Pictures of grids: flat, deformed, and morphing."""

from simulearn.show.camera import Camera
from simulearn.show.deformed import deformed
from simulearn.show.flat import flat

__all__ = ["Camera", "deformed", "flat"]

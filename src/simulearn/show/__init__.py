"""Pictures of grids: flat, deformed, both, and morphing."""

from simulearn.show.animation import animate
from simulearn.show.camera import Camera
from simulearn.show.combined import combined
from simulearn.show.deformed import deformed
from simulearn.show.flat import flat

__all__ = ["Camera", "animate", "combined", "deformed", "flat"]

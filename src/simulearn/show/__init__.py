"""Pictures of grids, flat, deformed and morphing."""

from simulearn.show.animation import save_animation
from simulearn.show.camera import Camera
from simulearn.show.deformed import deformed
from simulearn.show.figure import figure, save_figure
from simulearn.show.flat import flat

__all__ = ["Camera", "deformed", "figure", "flat", "save_animation", "save_figure"]

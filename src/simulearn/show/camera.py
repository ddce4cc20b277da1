"""An orthographic view: lengths along the picture plane are true, so a scale bar holds."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Camera:
    """Where the viewer is, from the grid, in degrees.

    Attributes:
        azimuth: from +x, about z.
        elevation: above the plane of the flat grid.
    """

    azimuth: float = -62.0
    elevation: float = 27.0

    @property
    def axes(self) -> Array:
        """(3, 3) unit vectors: to the picture's right, up, and towards the viewer."""
        a, e = np.radians([self.azimuth, self.elevation])
        right = np.array([-np.sin(a), np.cos(a), 0.0])
        towards = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
        return np.stack([right, np.cross(towards, right), towards])

    def see(self, points: Array) -> Array:
        """Return points (..., 3) mm as right, up, towards the viewer (..., 3) mm."""
        return points @ self.axes.T

    def light(self, normals: Array) -> Array:
        """Return the brightness (Q,) of faces with unit normals (Q, 3): Lambert, two lamps."""
        right, up, towards = self.axes
        key = -0.45 * right + 0.35 * up + 0.35 * towards + np.array([0, 0, 0.75])
        fill = 0.8 * right + 0.6 * towards

        def lamp(towards: Array) -> Array:
            return np.clip(normals @ (towards / np.linalg.norm(towards)), 0, None)

        return np.minimum(0.46 + 0.5 * lamp(key) + 0.16 * lamp(fill), 1.0)

"""Lines in any plane of space, seen in that plane.

The plane is the one nearest to all points by least squares. Seen from above where it is at most 45
degrees steep: x of the grid then points along x as nearly as the plane allows. A steeper plane is
seen from the front (along y), or from the right where it faces that way: x of the grid is then
level and its y points up.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError

Numbers = NDArray[np.float64]

# Below this the normal of a plane has no part along an axis.
NO_PART = 0.01
STEEP = np.sqrt(0.5)


@dataclass(frozen=True, eq=False)
class Plane:
    """Points as seen in the plane nearest to them.

    Attributes:
        points: (n, 2) in the unit of the input.
        turned: whether it is another plane than that of x and y, or one parallel to it.
        off: largest distance of a point from the plane.
        worst: number of the point that is so far.
    """

    points: Numbers
    turned: bool
    off: float
    worst: int


def in_plane(points: Numbers, level: float) -> Plane:
    """Return points as seen in the plane nearest to them.

    Args:
        points: (n, 3), n at least 1.
        level: points whose heights z differ by less are seen from above as they are.
    """
    middle = (points[:, 2].min() + points[:, 2].max()) / 2
    height = abs(points[:, 2] - middle)
    if height.max() <= level / 2:
        worst = int(np.argmax(height))
        return Plane(points[:, :2], False, float(height[worst]), worst)
    apart = points - points.mean(axis=0)
    size, axes = np.linalg.eigh(apart.T @ apart)
    if size[1] <= 1e-18 * size[2]:  # one straight line: of its planes the least steep
        flat = np.cross([0.0, 0.0, 1.0], axes[:, 2])
        normal = np.cross(axes[:, 2], flat) if flat.any() else np.array([0.0, -1.0, 0.0])
    else:
        normal = axes[:, 0]
    normal = _towards_the_viewer(normal / np.linalg.norm(normal))
    off = abs(apart @ normal)
    worst = int(np.argmax(off))
    x, y = axes_of(normal)
    seen = np.stack([points @ x, points @ y], axis=1)
    return Plane(seen, True, float(off[worst]), worst)


def flattened(points: Numbers, tolerance: float) -> Plane:
    """Return points (n, 3) mm as seen in their plane.

    Args:
        points: n at least 1.
        tolerance: largest distance of a point from the plane, mm.

    Raises:
        InputError: they do not lie in one plane.
    """
    plane = in_plane(points, tolerance)
    if plane.off > tolerance:
        place = ", ".join(f"{value:.6g}" for value in points[plane.worst])
        text = (
            f"the lines do not lie in one plane: at [{place}] mm one is {plane.off:.3g} mm away "
            "from the plane nearest to all; a grid is flat"
        )
        raise InputError(text, "not-flat", f"[{place}]")
    return plane


def _towards_the_viewer(normal: Numbers) -> Numbers:
    """Return a normal or its opposite: upwards, else to the front, else to the right."""
    for part, sign in ((2, 1), (1, -1), (0, 1)):
        if abs(normal[part]) > NO_PART:
            return normal * (sign * np.sign(normal[part]))
    return normal


def axes_of(normal: Numbers) -> tuple[Numbers, Numbers]:
    """Return the axes x and y (3,) of a plane as its viewer sees them.

    Args:
        normal: (3,) of length 1, towards the viewer.
    """
    if normal[2] >= STEEP:
        x = np.array([1.0, 0.0, 0.0]) - normal[0] * normal
    else:
        x = np.cross([0.0, 0.0, 1.0], normal)
    x /= np.linalg.norm(x)
    return x, np.cross(normal, x)

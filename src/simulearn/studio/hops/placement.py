"""Where a grid lies in a model: its unit, its plane, and the way there and back."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.drawings.cad_units import rhino_unit
from simulearn.drawings.drawing import Unit
from simulearn.drawings.plane import flattened
from simulearn.errors import InputError, Message
from simulearn.grid.structure import FARTHEST

Points = NDArray[np.float64]

TOLERANCE = 1.0  # mm that lines may be off their plane
NAMELESS = ("None", "Unset", "CustomUnits")


@dataclass(frozen=True, eq=False)
class Placement:
    """The unit of a model and the plane of a grid in it.

    Attributes:
        unit: of the model.
        origin: (3,) of the plane, in the model's unit.
        axes: (3, 3) rows x, y, z of the plane, each of length 1; z is the upper side.
    """

    unit: Unit
    origin: Points
    axes: Points

    def inside(self, points: Points) -> Points:
        """Return points (n, 3) of the model in the plane's axes, mm."""
        return self.unit.mm * ((points - self.origin) @ self.axes.T)

    def outside(self, points: Points) -> Points:
        """Return points (..., 3) of the plane, mm, in the model."""
        return self.origin + points / self.unit.mm @ self.axes

    def length(self, mm: float) -> float:
        """Return a length in the model's unit."""
        return mm / self.unit.mm


def unit_of(modelunits: str | None) -> tuple[Unit, list[Message]]:
    """Return the unit of a model by its name in Rhino, and messages about it.

    Raises:
        InputError: Rhino has no such unit, or no length of a beam can be given in it.
    """
    if not modelunits or modelunits in NAMELESS:
        what = f"the model's units are {modelunits}" if modelunits else "the request has no units"
        text = f"{what}; millimetres are taken"
        return Unit(1.0, "mm", what), [Message("unit", "modelunits", text)]
    found = rhino_unit(modelunits, f"the model's units are {modelunits}")
    if found is None:
        text = f'the model\'s units are "{modelunits[:40]}"; use Millimeters, Inches or alike'
        raise InputError(text, "unit-unknown", "modelunits")
    return found, []


def placement_of(points: Points, unit: Unit) -> tuple[Placement, list[Message]]:
    """Return the plane of all points (n, 3) of a drawing, and messages about it.

    Raises:
        InputError: they do not lie in one plane.
    """
    seen = flattened(unit.mm * points, TOLERANCE)
    if not seen.turned:
        low, high = points.min(axis=0), points.max(axis=0)
        far = np.abs(unit.mm * points[:, :2]).max() > FARTHEST
        origin = np.array([*(low[:2] if far else (0.0, 0.0)), (low[2] + high[2]) / 2])
        return Placement(unit, origin, np.eye(3)), []
    middle = points.mean(axis=0)
    x, y = _axes(unit.mm * (points - middle), seen.points - seen.points.mean(axis=0))
    z = np.cross(x, y)
    text = (
        "the curves do not lie level; they are taken in their own plane, whose upper side faces "
        f"({z[0]:.3g}, {z[1]:.3g}, {z[2]:.3g})"
    )
    return Placement(unit, middle, np.array([x, y, z])), [Message("plane", "Curves", text)]


def _axes(points: Points, seen: Points) -> tuple[Points, Points]:
    """Return the axes x and y of a plane from points (n, 3) and how they are seen in it (n, 2)."""
    x, y = np.linalg.lstsq(points, seen, rcond=1e-6)[0].T
    if np.linalg.norm(np.cross(x, y)) > 0.5:
        return x, y
    # All points lie in one line, so that only their part along it is known.
    along = max((x, y), key=lambda axis: float(np.linalg.norm(axis)))
    along = along / np.linalg.norm(along)
    normal = np.cross(along, np.cross([0.0, 0.0, 1.0], along))
    across = np.cross(normal if normal.any() else [0.0, -1.0, 0.0], along)
    across /= np.linalg.norm(across)
    first, second = x @ along, y @ along
    return first * along - second * across, second * along + first * across

"""What was measured on a print: places of joints, or points of its surface."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import Message

Numbers = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class JointPlaces:
    """Measured places of joints.

    Attributes:
        places: (K, 3) in the unit of the file, or mm.
        numbers: (K,) which joints they are; None where nobody says so.
        unit: mm that the unit of the file is; None where the file does not say it.
        messages: what is to be known about what was read.
    """

    places: Numbers
    numbers: Indices | None = None
    unit: float | None = None
    messages: tuple[Message, ...] = ()

    @property
    def extent(self) -> float:
        """Size of what was measured: see `size`."""
        return size(self.places)

    def scaled(self, mm: float) -> "JointPlaces":
        """Return the same in mm, of which the unit of the places has so many."""
        return replace(self, places=self.places * mm, unit=1.0)


@dataclass(frozen=True, eq=False)
class Scan:
    """Points of the surface of a print.

    Attributes:
        points: (N, 3) in the unit of the file, or mm.
        normals: (N, 3) of unit length, out of the body; None where they are not known.
        unit: mm that the unit of the file is; None where the file does not say it.
        messages: what is to be known about what was read.
    """

    points: Numbers
    normals: Numbers | None = None
    unit: float | None = None
    messages: tuple[Message, ...] = ()

    @property
    def extent(self) -> float:
        """Size of what was measured: see `size`."""
        return size(self.points)

    def scaled(self, mm: float) -> "Scan":
        """Return the same in mm, of which the unit of the points has so many."""
        return replace(self, points=self.points * mm, unit=1.0)

    def only(self, keep: NDArray[np.bool_] | Indices) -> "Scan":
        """Return a part of the points."""
        normals = None if self.normals is None else self.normals[keep]
        return replace(self, points=self.points[keep], normals=normals)


Measurement = JointPlaces | Scan


def size(points: Numbers) -> float:
    """Return the diagonal of the box around points (N, 3), a few of them left out at each end."""
    low, high = np.quantile(points, [0.005, 0.995], axis=0) if len(points) > 200 else (
        points.min(axis=0), points.max(axis=0)
    )  # fmt: skip
    return float(np.linalg.norm(high - low))

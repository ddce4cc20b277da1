"""What a collision is, and how arrays of corners go to the kernels and rows come back."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

LEAST = 0.1  # mm; what overlaps less is a touch
ROOM = 32  # pairs for which there is room at first
ROW = 10


@dataclass(frozen=True)
class Collision:
    """Two parts that run through each other, at their worst moment.

    Attributes:
        parts: both of them, as "beam 3", "joint 7" or "obstacle".
        frame: the worst frame, or the one before the worst moment.
        share: of the time to the next frame at which the worst moment is; 0 in a frame.
        first: the first frame after contact has begun: from there on a print has another shape.
        depth_mm: the length of the shortest move across both beams that would separate them, the
            most over the short pieces that beams are compared by.
        place: mm, about the middle of where they overlap.
        bodies: which bodies of an assembly the parts belong to.
    """

    parts: tuple[str, str]
    frame: int
    share: float
    first: int
    depth_mm: float
    place: tuple[float, float, float]
    bodies: tuple[int, int] = (0, 0)

    @property
    def beams(self) -> tuple[int, ...]:
        """The beams among the parts."""
        return tuple(int(part.split()[1]) for part in self.parts if part.startswith("beam"))


def deepest_first(collisions: Iterable[Collision]) -> tuple[Collision, ...]:
    """Return collisions in their order."""
    return tuple(sorted(collisions, key=_shallowness))


def collision_of(
    row: Sequence[float], parts: tuple[str, str], bodies: tuple[int, int]
) -> Collision:
    """Return the collision of a kernel's row (10,) and of the names that its numbers stand for."""
    return Collision(
        parts=parts,
        frame=int(row[3]),
        share=float(row[4]),
        first=int(row[5]),
        depth_mm=float(row[6]),
        place=(float(row[7]), float(row[8]), float(row[9])),
        bodies=bodies,
    )


def rows_of(kernel: Callable[[Array], int]) -> Array:
    """Return all rows that a kernel sets in an array, which it may find too small."""
    room = ROOM
    while True:
        found = np.empty((room, ROW))
        count = kernel(found)
        if count <= room:
            return found[:count]
        room = count


def numbers(array: Array) -> Array:
    """Return an array as kernels take it."""
    return np.ascontiguousarray(array, np.float64)


def part_name(part: int, beams: int) -> str:
    """Return the name of a part: the beams come first, then the joints."""
    return f"beam {part}" if part < beams else f"joint {part - beams}"


def _shallowness(collision: Collision) -> float:
    return -collision.depth_mm

"""Where a joint is missing: beams cross, or a joint lies on a beam that passes it."""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from simulearn.grid.grid import Grid


@dataclass(frozen=True)
class MissingJoint:
    """A place where beams meet and no joint holds them together.

    Attributes:
        place: x, y in mm.
        beams: the two that cross, or the one that a joint lies on.
        joint: the joint that lies on a beam; None where two beams cross.
    """

    place: tuple[float, float]
    beams: tuple[int, ...]
    joint: int | None = None

    @property
    def text(self) -> str:
        """What is wrong and what to do, for people."""
        at = f"({self.place[0]:.4g}, {self.place[1]:.4g}) mm"
        if self.joint is None:
            a, b = self.beams
            return (
                f"beam {a} and beam {b} cross at {at}, where a joint is missing: "
                "add one and end both beams there"
            )
        (beam,) = self.beams
        return (
            f"joint {self.joint} lies on beam {beam} at {at}, which does not end there, so a joint "
            "is missing: divide the beam in two that end there"
        )


def missing_joints(grid: Grid, width: float, most: int = 1000) -> list[MissingJoint]:
    """Return where a grid lacks joints, those on beams first.

    Args:
        grid: no two of its joints are at one place.
        width: of the beams, mm; a joint within half of it from an axis lies on the beam.
        most: no more are returned.
    """
    axes = shapely.linestrings(grid.joints[grid.beams])
    tree = shapely.STRtree(axes)
    used = np.unique(grid.beams)
    points = shapely.points(grid.joints[used])
    k, beam = tree.query(points, predicate="dwithin", distance=width / 2)
    joint = used[k]
    start, end = grid.joints[grid.beams[beam]].swapaxes(0, 1)
    length = np.hypot(*(end - start).T)
    along = ((grid.joints[joint] - start) * (end - start)).sum(axis=1) / np.maximum(length, 1e-9)
    # Near an end it is that joint which is too close.
    on = (along > width / 2) & (along < length - width / 2)
    on &= (joint[:, None] != grid.beams[beam]).all(axis=1)
    joint, beam = joint[on], beam[on]
    found = [
        MissingJoint(_place(grid.joints[j]), (b,), j)
        for j, b in zip(joint[:most].tolist(), beam[:most].tolist(), strict=True)
    ]
    lying = set(zip(joint.tolist(), beam.tolist(), strict=True))
    for a, b in tree.query(axes, predicate="crosses").T.tolist():
        if a > b or len(found) >= most:
            continue
        ends = [(int(j), b) for j in grid.beams[a]] + [(int(j), a) for j in grid.beams[b]]
        if not lying.intersection(ends):
            point = shapely.intersection(axes[a], axes[b])
            found.append(MissingJoint(_place(np.array([point.x, point.y])), (a, b)))
    return found


def _place(xy: NDArray[np.float64]) -> tuple[float, float]:
    x, y = (np.round(xy, 6) + 0.0).tolist()
    return x, y

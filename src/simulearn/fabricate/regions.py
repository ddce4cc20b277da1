"""What is printed where: a grid cut into regions, each filled by strokes from side to side.

Shell beads follow the outline of the grid. What they leave is cut along the joints' sides and the
actuators' ends into quadrilaterals. How one is filled depends on the half and on whether a layer's
number is even.

half          beam                              joint
active        along its actuator, across rest   from side to side, the two pairs in turn
passive       across                            the same
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray

from simulearn.fabricate.toolpath import ACTIVE, JOINT, PASSIVE
from simulearn.grid import Grid, Outline, outline
from simulearn.material import Section

Array = NDArray[np.float64]
# Segments of a quarter circle where a shell turns about an inner corner; a chord of six strays
# by less than one per cent of the radius.
QUARTER = 6
TINY = 1e-6  # mm; corners that rounding makes are cleared


@dataclass(frozen=True, eq=False)
class Region:
    """A quadrilateral that is filled by strokes from its left to its right side.

    Attributes:
        role: active, passive or joint.
        part: "beam 3" or "joint 0".
        corners: (4, 2) mm: first left, first right, last right, last left. Rows follow one another
            from the first edge to the last.
        keep_off: (k, 2) points around which shells turn, mm.
        overlap: whether strokes reach beyond the left and beyond the right side.
    """

    role: str
    part: str
    corners: Array
    keep_off: Array
    overlap: tuple[bool, bool] = (True, True)


class Plan:
    """A grid from above, ready to be cut into layers.

    Args:
        grid: a valid design without dangling beams, where it lies on the bed.
        section: of its beams.
        line: width of a row, mm.
        shells: number of shell rows.
    """

    def __init__(self, grid: Grid, section: Section, line: float, shells: int) -> None:
        self.grid = grid
        self.line, self.shells = line, shells
        self.shape: Outline = outline(grid, section)
        # How much of a beam's or a joint's width the shells take at each side.
        self._margin = shells * line / section.width

    @cached_property
    def union(self) -> shapely.Geometry:
        """The outline of the grid, with its cells as holes."""
        return footprint(self.shape)

    def rings(self) -> list[Array]:
        """Return the closed paths (n, 2) of the shell rows, outermost first."""
        return [
            shapely.get_coordinates(ring)
            for k in range(self.shells)
            for polygon in shapely.get_parts(
                shapely.buffer(self.union, -(k + 0.5) * self.line, quad_segs=QUARTER)
            )
            for ring in shapely.get_rings(polygon)
        ]

    def beam(self, b: int, active: bool) -> list[Region]:
        """Return what fills a beam on a half where its actuator is, or where it is not."""
        first, last = self.shape.beams[b]  # [right, left]
        ratio = abs(float(self.grid.actuators[b])) if active else 0.0
        regions = []
        for role, start, end in self._cuts(b, ratio):
            ends = []
            for t in (start, end):
                right, left = (1 - t) * first + t * last
                inwards = self._margin * (left - right)
                ends.append((right + inwards, left - inwards))
            (a, d), (b_, c) = ends
            corners = [a, b_, c, d] if role == ACTIVE else [a, d, c, b_]
            regions.append(Region(role, f"beam {b}", np.array(corners), np.empty((0, 2))))
        return regions

    def joint(self, j: int, top: bool, odd: bool) -> Region:
        """Return what fills a joint: strokes between one pair of sides on layers of a parity.

        At a side where the strokes of an actuator end these reach into the joint; the joint's do
        not reach out as well.
        """
        outer = self.shape.joints[j]
        corners = _moved_in(outer, np.where(self._free[j], self.shells * self.line, 0.0))
        left, right = (3 + odd) % 4, (1 + odd) % 4
        met = self._met[int(top), j]
        return Region(
            JOINT,
            f"joint {j}",
            np.roll(corners, -int(odd), axis=0),
            outer,
            (not met[left], not met[right]),
        )

    def _cuts(self, b: int, ratio: float) -> list[tuple[str, float, float]]:
        first, last = self.shape.beams[b]
        net = float(np.linalg.norm((last - first).mean(axis=0)))
        return _cuts(ratio, self.line / 2 / net)

    @cached_property
    def _free(self) -> NDArray[np.bool_]:
        """(J, 4) whether a side of a joint meets no beam."""
        free = np.ones((len(self.grid.joints), 4), dtype=bool)
        free[self.grid.beams.ravel(), self.shape.sides.ravel()] = False
        return free

    @cached_property
    def _met(self) -> NDArray[np.bool_]:
        """(2, J, 4) whether an actuator is printed to a side of a joint, at the bottom and top."""
        met = np.zeros((2, len(self.grid.joints), 4), dtype=bool)
        for b, ratio in enumerate(self.grid.actuators.tolist()):
            if self._cuts(b, abs(ratio))[0][0] == ACTIVE:
                met[int(ratio > 0), self.grid.beams[b], self.shape.sides[b]] = True
        return met


def footprint(shape: Outline) -> shapely.Geometry:
    """Return the area that a grid covers, with its cells as holes."""
    quads = [*shape.joints, *shape.beams[:, [0, 1, 1, 0], [0, 0, 1, 1]]]
    return shapely.simplify(shapely.union_all(shapely.polygons(quads)), TINY)


def _moved_in(corners: Array, by: Array) -> Array:
    """Return a quadrilateral (4, 2) with its sides moved inwards by (4,) mm."""
    along = np.roll(corners, -1, axis=0) - corners
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    inwards = np.stack([-along[:, 1], along[:, 0]], axis=1)
    reach = np.sum(inwards * corners, axis=1) + by  # of each side's line
    # A corner lies on its own side and on the one before.
    sides = np.stack([np.roll(inwards, 1, axis=0), inwards], axis=1)
    moved: Array = np.linalg.solve(sides, np.stack([np.roll(reach, 1), reach], axis=1)[..., None])
    return moved[..., 0]


def _cuts(ratio: float, spare: float) -> list[tuple[str, float, float]]:
    """Return the roles along a beam, each with where it begins and ends, 0 to 1.

    An actuator lies in the middle, and the rest at either end is passive. A rest shorter than half
    a row takes no stroke; there the actuator is printed to the end of its beam.

    Args:
        ratio: length of the actuator over the net length of the beam.
        spare: half a row over the net length of the beam.
    """
    if not ratio:
        return [(PASSIVE, 0.0, 1.0)]
    if (1 - ratio) / 2 < spare:
        return [(ACTIVE, 0.0, 1.0)]
    low, high = (1 - ratio) / 2, (1 + ratio) / 2
    return [(PASSIVE, 0.0, low), (ACTIVE, low, high), (PASSIVE, high, 1.0)]

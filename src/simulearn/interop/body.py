"""The printed body of a grid as one closed surface, the same faces in all frames.

Neighbours share vertices by their place in the grid, not by their coordinates, so that the
surface is closed however the grid bends. The faces between joints and beams lie inside and are
left out.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.simulate import Result
from simulearn.simulate.skin import RING, edges

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

SPACING = 2.5  # mm along a beam, at most
# A joint's vertices: 4 corners below, 4 above, then 4 in the middle of its upright edges.
BELOW, ABOVE, MIDDLE, OF_JOINT = 0, 4, 8, 12
# The corners of a joint's side that a section's ring meets, in the ring's order: right-bottom,
# left-bottom, left-middle, left-top, right-top, right-middle. A side runs from corner k to k + 1;
# seen along the beam, the first is to the right at its start and to the left at its end.
RIGHT = np.array([True, False, False, False, True, True])
LEVEL = np.array([BELOW, BELOW, MIDDLE, ABOVE, ABOVE, MIDDLE])


@dataclass(frozen=True, eq=False)
class Body:
    """A closed surface of quadrilaterals, their corners counter-clockwise seen from outside.

    Attributes:
        vertices: (F, V, 3) mm.
        quads: (Q, 4) vertex indices.
        beam: (Q,) the beam that a face belongs to, -1 on joints.
        joint: (Q,) the joint that it belongs to, -1 on beams.
    """

    vertices: Array
    quads: Indices
    beam: Indices
    joint: Indices

    @property
    def triangles(self) -> Indices:
        """(2 Q, 3) the faces, each divided by its diagonal."""
        return triangles(self.quads)


def triangles(quads: Indices) -> Indices:
    """Return quadrilaterals (Q, 4) as triangles (2 Q, 3), two for each in their order."""
    return quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)


def body(result: Result, spacing: float = SPACING) -> Body:
    """Return the body of a result.

    Args:
        result: the result; a beam's end lies on the joint's side that it meets.
        spacing: length of the faces along a beam, mm, at most.
    """
    corners = result.joints
    upright = (corners[:, :, :4] + corners[:, :, 4:]) / 2
    places = [np.concatenate([corners, upright], axis=2).reshape(len(corners), -1, 3)]
    quads, beam = [], []
    sides = _sides(result)
    count = places[0].shape[1]
    for b, ends in enumerate(result.grid.beams):
        middles = result.beams[0, b].mean(axis=1)
        length = float(np.linalg.norm(middles[2] - middles[0]))
        n = 2 * max(1, int(np.ceil(length / spacing / 2)))  # even: the middle section is a ring
        ring = np.einsum("rc,fncx->fnrx", RING, edges(result, b, np.linspace(0, 1, n + 1)[1:-1]))
        places.append(ring.reshape(len(ring), -1, 3))
        inner = count + np.arange(6 * (n - 1)).reshape(-1, 6)
        count += inner.size
        first = OF_JOINT * ends[0] + LEVEL + (sides[b, 0] + ~RIGHT) % 4
        last = OF_JOINT * ends[1] + LEVEL + (sides[b, 1] + RIGHT) % 4
        rings = np.concatenate([first[None], inner, last[None]])
        after = np.roll(rings, -1, axis=1)
        faces = np.stack([rings[:-1], after[:-1], after[1:], rings[1:]], axis=-1).reshape(-1, 4)
        quads.append(faces)
        beam.append(np.full(len(faces), b))
    for j in range(len(result.grid.joints)):
        taken = sides[result.grid.beams == j]
        faces = OF_JOINT * j + _joint([k for k in range(4) if k not in taken])
        quads.append(faces)
        beam.append(np.full(len(faces), -1))
    joint = np.repeat(
        [*np.full(len(result.grid.beams), -1), *range(len(result.grid.joints))], [*map(len, quads)]
    )
    return Body(np.concatenate(places, axis=1), np.concatenate(quads), np.concatenate(beam), joint)


def _sides(result: Result) -> Indices:
    """Return the sides (B, 2) of its joints that each beam meets at its start and end."""
    flat = result.joints[0]
    middles = (flat + np.roll(flat.reshape(-1, 2, 4, 3), -1, axis=2).reshape(flat.shape)) / 2
    middles = middles.reshape(len(flat), 2, 4, 3).mean(axis=1)
    ends = result.beams[0][:, [0, 2]].mean(axis=2)
    away = np.linalg.norm(middles[result.grid.beams] - ends[:, :, None], axis=-1)
    return np.asarray(away.argmin(axis=-1))


def _joint(free: list[int]) -> Indices:
    """Return the faces of a joint with its free sides, vertices counted from its first."""
    faces = [[ABOVE, ABOVE + 1, ABOVE + 2, ABOVE + 3], [BELOW + 3, BELOW + 2, BELOW + 1, BELOW]]
    for k in free:
        after = (k + 1) % 4
        for low, high in ((BELOW, MIDDLE), (MIDDLE, ABOVE)):
            faces.append([low + k, low + after, high + after, high + k])
    return np.array(faces)

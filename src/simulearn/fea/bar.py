"""A single straight beam between two joints, for calibration and verification."""

import numpy as np
from numpy.typing import NDArray

from simulearn.fea.solid import Solid
from simulearn.fea.structure import structure_of
from simulearn.grid import Grid
from simulearn.material import Material

Array = NDArray[np.float64]


def bar(length: float, ratio: float, material: Material) -> Grid:
    """Return a beam of net length `length` (mm) along +x, its first joint fixed."""
    span = length + material.section.width
    return Grid(np.array([[0.0, 0.0], [span, 0.0]]), [[0, 1]], [ratio], 0, material.name)


def curvature(solid: Solid, displacements: Array, begin: float = 0.25, end: float = 0.75) -> float:
    """Return the curvature of the first beam's deformed centre line, deg/mm.

    It is the angle between the sections at two places along the beam over the arc between their
    centres, both measured on the deformed beam.

    Args:
        solid: a solid with a beam bending about y.
        displacements: (N, 3) mm.
        begin: where the measured part begins along the beam, 0 to 1.
        end: where it ends.
    """
    faces = structure_of(solid).faces[0]
    at = (solid.nodes + displacements)[faces]
    first, last = round(begin * solid.slabs), round(end * solid.slabs)
    high = solid.nodes[faces][..., 2] > 0
    low = solid.nodes[faces][..., 2] < 0
    up = np.stack(
        [p[h].mean(axis=0) - p[b].mean(axis=0) for p, h, b in zip(at, high, low, strict=True)]
    )
    turn = np.diff(np.unwrap(np.arctan2(-up[:, 0], up[:, 2])))[first:last]
    chord = np.linalg.norm(np.diff(at.mean(axis=1), axis=0), axis=1)[first:last]
    # A chord is shorter than its arc: sin(a) / a of it, with a half the angle.
    arc = chord / np.sinc(turn / 2 / np.pi)
    return float(np.degrees(turn.sum() / arc.sum()))

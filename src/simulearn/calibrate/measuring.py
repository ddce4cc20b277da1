"""What ruler and straight edge read off a simulated strip: chord and rise of its hollow side.

The tips are the middles of the edges of the two outer end faces, on the top or on the bottom. The
line between is known at its tips and at start, middle and end of each beam, and smooth between.
"""

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from simulearn.calibrate.form import StripRecord
from simulearn.grid import Grid
from simulearn.material import Material
from simulearn.simulate.members import Prints, last_frames

Numbers = NDArray[np.float64]
FINE = 16  # places between two known ones at which the rise is looked for
# Corners of a joint of a strip along +x, bottom; those of the top are four more.
HELD_FACE, FREE_FACE = [1, 2], [0, 3]


def simulated(
    record: StripRecord,
    materials: list[Material],
    rises: bool,
    stretch: float = 1.0,
    simulate: Callable[[Grid, list[Material]], Prints] = last_frames,
) -> Numbers:
    """Return chord and rise (T, 2), mm, of a strip in each of T materials of one section.

    Args:
        record: the strip.
        materials: of the prints.
        rises: whether it is hollow on top, where it is then measured, or else on the bottom.
        stretch: factor on the lengths of its beams.
        simulate: gives the last frames of a grid in materials.
    """
    grid = record.grid(stretch=stretch)
    x = grid.joints[:, 0]
    half = materials[0].section.width / 2
    return read_off(simulate(grid, materials), x, half, rises)


def read_off(prints: Prints, x: Numbers, half: float, rises: bool) -> Numbers:
    """Return chord and rise (T, 2), mm, of T prints of a strip along +x; NaN where there is none.

    Args:
        prints: their last frames.
        x: (J,) where the joints lie in the flat strip, mm.
        half: half the width of a joint, mm.
        rises: whether it is measured on top, else on the bottom.
    """
    up = 4 if rises else 0
    edge = [2, 3] if rises else [0, 1]  # of a beam's section
    first = prints.joints[:, 0, [k + up for k in HELD_FACE]].mean(axis=1)
    last = prints.joints[:, -1, [k + up for k in FREE_FACE]].mean(axis=1)
    inner = prints.sections[:, :, :, edge].mean(axis=3)  # (T, B, 3, 3)
    count = len(inner)
    line = np.concatenate([first[:, None], inner.reshape(count, -1, 3), last[:, None]], axis=1)
    flat = np.stack([x[:-1] + half, (x[:-1] + x[1:]) / 2, x[1:] - half], axis=1)
    at = np.concatenate([[x[0] - half], flat.ravel(), [x[-1] + half]])

    read: Any = np.full((count, 2), np.nan)
    there = prints.converged & np.isfinite(line).all(axis=(1, 2))
    if not there.any():
        return read
    bent = CubicSpline(at, line[there][..., [0, 2]], axis=1)
    dense = np.unique(np.concatenate([np.linspace(a, b, FINE) for a, b in pairwise(at.tolist())]))
    points = bent(dense)  # (T, M, 2)
    along = points[:, -1] - points[:, 0]
    chord = np.linalg.norm(along, axis=-1)
    from_tip = points - points[:, :1]
    # Positive where the strip runs below the line across its tips, so that its ends are up.
    gap = (along[:, None, 1] * from_tip[..., 0] - along[:, None, 0] * from_tip[..., 1]) / chord[
        :, None
    ]
    read[there, 0] = chord
    # By its amount: of a strip that is all but straight the sign is open.
    largest = np.abs(gap).argmax(axis=1)[:, None]
    read[there, 1] = np.take_along_axis(gap, largest, axis=1)[:, 0]
    return read

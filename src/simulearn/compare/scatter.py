"""How much prints of one design differ among themselves, which no simulation can foresee."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.distance import pdist

from simulearn.compare.deviation import brought
from simulearn.grid import Grid
from simulearn.material import Material

PUBLISHED = 0.0409  # of the diagonal span (Yang et al., SimuLearn, UIST 2020)
DRAWS = 8


@dataclass(frozen=True)
class Scatter:
    """How far the joints of a print are usually off those of the mean print.

    Attributes:
        mm: mean distance.
        words: where that is from.
    """

    mm: float
    words: str


def scatter_of(grid: Grid, material: Material) -> Scatter:
    """Return the scatter by the material where it says one, else the published one."""
    of = material.scatter
    if not (of.print or of.beam):
        span = float(pdist(grid.joints).max())
        return Scatter(PUBLISHED * span, f"published: {PUBLISHED:.2%} of the diagonal span")
    from simulearn.simulate.members import last_frames

    rng = np.random.default_rng(0)
    whole, each = rng.normal(size=(DRAWS, 1)), rng.normal(size=(DRAWS, len(grid.beams)))
    factors = np.maximum(1 + of.print * whole + of.beam * each, 0.05)
    prints = last_frames(
        grid, [material] * (DRAWS + 1), np.vstack([np.ones(len(grid.beams)), factors])
    )
    shapes = prints.centres[prints.converged]
    if len(shapes) < 3 or not prints.converged[0]:
        return Scatter(float("nan"), "not known: too few prints of this scatter have an answer")
    off = [np.linalg.norm(brought(p, shapes[0]) - shapes[0], axis=1).mean() for p in shapes[1:]]
    words = f"by the material: {of.print:.1%} from print to print, {of.beam:.1%} from beam to beam"
    return Scatter(float(np.mean(off)), words)

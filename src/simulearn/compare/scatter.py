"""How much prints of one design differ among themselves, which no simulation can foresee."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.distance import pdist

from simulearn.compare.deviation import brought
from simulearn.errors import Cancel
from simulearn.grid import Grid
from simulearn.material import Material
from simulearn.simulate.scatter import draw_prints, prints_source, simulate_prints

PUBLISHED = 0.0409  # of the diagonal span (Yang et al., SimuLearn, UIST 2020)
DRAWS = 8  # prints


@dataclass(frozen=True)
class Scatter:
    """How far the joints of a print are usually off those of the mean print.

    Attributes:
        mm: mean distance.
        words: where that is from.
    """

    mm: float
    words: str


def scatter_of(grid: Grid, material: Material, cancel: Cancel | None = None) -> Scatter:
    """Return the scatter by the material where it says one, else the published one.

    Raises:
        CancelledError: the token was set.
    """
    of = material.scatter
    if not (of.print or of.beam):
        span = float(pdist(grid.joints).max())
        return Scatter(PUBLISHED * span, f"published: {PUBLISHED:.2%} of the diagonal span")
    draw = draw_prints(material, len(grid.beams), DRAWS).with_nominal(material)
    prints = simulate_prints(grid, draw, prints_source(material), cancel=cancel)
    shapes = prints.centres[prints.converged]
    if len(shapes) < 3 or not prints.converged[0]:
        return Scatter(float("nan"), "not known: too few prints of this scatter have an answer")
    off = [np.linalg.norm(brought(p, shapes[0]) - shapes[0], axis=1).mean() for p in shapes[1:]]
    words = f"by the material: {of.print:.1%} from print to print, {of.beam:.1%} from beam to beam"
    return Scatter(float(np.mean(off)), words)

"""How each point of a grid was printed, and so what it does when the stress is released.

Printed plastic is stretched along its lines. Released, it shrinks by e along them and swells by
nu e across them and in thickness, as the release of a uniaxial stress does. The active half of
a beam is printed along the beam, the other half across it, the outermost row on either side
(the shell) along it on both halves, and joints alternate both directions layer by layer. A print
may curl of its own besides: its top shrinks more than its bottom, whatever the direction.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from simulearn.grid import Grid
from simulearn.material import Material

Array = NDArray[np.float64]

# Half a printed row of 0.9 mm: what is left of a beam beyond an actuator and shorter than this is
# not printed as a piece of its own.
SHORTEST_END = 0.45  # mm


def actuator_reaches_end(ratio: ArrayLike, length: ArrayLike) -> NDArray[np.bool_]:
    """Return whether actuators reach the ends of their beams, for all that depends on it.

    Args:
        ratio: signed ratios of actuator length to the beam's net length; actuators are centred.
        length: net lengths of the beams, mm.
    """
    rest = (1 - np.abs(ratio)) * np.asarray(length) / 2
    return np.asarray(rest < SHORTEST_END)


def printing(
    grid: Grid,
    material: Material,
    beam: NDArray[np.int64],
    along: Array,
    across: Array,
    up: Array,
    top: NDArray[np.bool_],
    factors: NDArray[np.float64] | None = None,
) -> tuple[Array, Array, Array]:
    """Return the printing frame, released strain and printed-in stress of E bricks.

    Args:
        grid: the design.
        material: its material system.
        beam: (E,) the beam of each brick, -1 in a joint.
        along: (E,) place along the beam, 0 to 1.
        across: (E, Q) places of the brick's integration points across the section, 0 to 1.
        up: (E, Q) their heights over the middle, in thicknesses.
        top: (E,) whether the brick lies in the top half.
        factors: (B,) by which the released strains of beams differ from the material's.

    Returns:
        angle (E,) of the beam from +x; strain (E, Q, 3) along, across and in thickness; printed-in
        stress (E, Q, 3) MPa in the same axes.
    """
    nu = material.law.poisson
    e = material.shrinkage
    kinds = ("joint", "shell", "active", "passive")
    strain = np.array(
        [
            np.array([nu - 1, nu - 1, 2 * nu]) * e.joint,
            np.array([-1, nu, nu]) * e.shell,
            np.array([-1, nu, nu]) * e.active,
            np.array([nu, -1, nu]) * e.passive,
        ]
    )
    stress = np.array([e.printed[kind] for kind in kinds])
    ratio = grid.actuators[beam]
    active = (abs(along - 0.5) < abs(ratio) / 2) & (np.where(top, 1, -1) == np.sign(ratio))
    shell = material.section.shell / material.section.width
    kind = np.where(abs(across - 0.5) > 0.5 - shell, kinds.index("shell"), -1)
    half = np.where(active, kinds.index("active"), kinds.index("passive"))
    kind = np.where(kind < 0, half[:, None], kind)
    kind[beam < 0] = kinds.index("joint")

    # What it curls by of its own, as the release of a stress that is equal in both directions.
    own = e.curl * up[..., None] * np.array([-1, -1, 2 * nu / (1 - nu)])
    start, end = grid.joints[grid.beams.T]
    angle = np.arctan2(*(end - start).T[::-1])
    growth = strain[kind] + own
    if factors is not None:
        growth *= np.where(beam < 0, 1.0, factors[beam])[:, None, None]
    return np.where(beam < 0, 0.0, angle[beam]), growth, stress[kind]

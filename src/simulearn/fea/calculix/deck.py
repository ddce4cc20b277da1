"""The parts of a CalculiX input deck that every analysis of a solid shares.

The syntax has limits: a number fills at most 20 characters and a line at most 132.
"""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from simulearn.fea.calculix.brick import bricks
from simulearn.fea.solid import Solid

Array = NDArray[np.float64]

# CalculiX stops at half a per cent of the mean force; so close, a slender grid is still moving.
# And the residual of slender, turning beams rises and falls before it converges. By default
# CalculiX calls that divergence after 4 iterations: let it go on (iterations I0, IR, IP, IC, IL,
# IG, IA of its manual).
CONTROLS = """*CONTROLS, PARAMETERS=FIELD
1e-5, 1e-3
*CONTROLS, PARAMETERS=TIME INCREMENTATION
12, 16, 9, 40, 10, 4, , 5
"""
# Whatever the frequency, the end of a step is written.
PRINT = """*NODE PRINT, NSET=NODES, FREQUENCY=9999
U
*EL PRINT, ELSET=BRICKS, FREQUENCY=9999, GLOBAL=YES
S
"""
END = "*END STEP\n"

# Gravity is given as an acceleration: a density of one makes it a body force.
DENSITY = "*DENSITY\n1.\n"


def begin(strained: bool) -> str:
    """Return the cards that begin a step.

    Args:
        strained: whether initial strains change in it. They act at once, so that shortening the
            increment would not help: it is one, or fails.
    """
    procedure = "*STATIC, DIRECT\n1., 1." if strained else "*STATIC\n1., 1., 1e-3, 1."
    return f"*STEP, NLGEOM, INC=200\n{procedure}\n{CONTROLS}"


def gravity(load: float) -> str:
    """Return the card of a body force towards -z, N/mm3 of the flat grid."""
    return f"*DLOAD\nBRICKS, GRAV, {numbers([load, 0, 0, -1])}\n" if load else ""


def mesh(solid: Solid) -> Iterable[str]:
    """Return the cards of nodes, bricks and held nodes.

    Raises:
        ComputationError: a brick is inside out.
    """
    yield "*NODE, NSET=NODES\n"
    for k, node in enumerate(solid.nodes, 1):
        yield f"{k}, {numbers(node)}\n"
    yield "*ELEMENT, TYPE=C3D20R, ELSET=BRICKS\n"
    for k, nodes in enumerate(bricks(solid.nodes, solid.bricks) + 1, 1):
        names = [str(n) for n in nodes]
        yield f"{k}, {', '.join(names[:10])},\n{', '.join(names[10:])}\n"
    yield "*NSET, NSET=FIXED\n"
    yield from (f"{k},\n" for k in solid.fixed + 1)
    yield "*BOUNDARY\nFIXED, 1, 3\n"


def elements(name: str, members: Iterable[int]) -> Iterable[str]:
    """Return the card of a set of bricks."""
    yield f"*ELSET, ELSET={name}\n"
    yield from (f"{member + 1},\n" for member in members)


def strains(strain: Array) -> Iterable[str]:
    """Return the lines of strains (E, 8, 6) at CalculiX's points, order 11 22 33 12 13 23."""
    for k, brick in enumerate(strain, 1):
        for q, point in enumerate(brick, 1):
            # Two digits less than elsewhere, for the sake of the line.
            yield f"{k}, {q}, {', '.join(f'{value:.11e}' for value in point)}\n"


def numbers(values: Iterable[float]) -> str:
    """Return numbers as a line holds them."""
    return ", ".join(f"{value:.13e}" for value in values)

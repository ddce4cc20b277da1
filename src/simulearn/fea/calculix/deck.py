"""The input deck of CalculiX for a solid that grows.

Everything that depends on the released fraction s is tabulated: a temperature equal to s picks
the elastic constants (there is no thermal expansion), and every step adds its share of the initial
strain. See `growth` for why.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from simulearn.fea.calculix import brick
from simulearn.fea.calculix.growth import initial_strain, orthotropic, uniform
from simulearn.fea.calculix.schedule import Step
from simulearn.fea.solid import Solid
from simulearn.material import ElasticData, MarlowData

Array = NDArray[np.float64]

# CalculiX stops at half a per cent of the mean force; so close, a slender grid is still moving.
FORCE, CHANGE = 1e-5, 1e-3
MOST_INCREMENTS = 200


def write_deck(
    path: Path, solid: Solid, law: ElasticData | MarlowData, steps: Sequence[Step]
) -> None:
    """Write the deck of a solid with the St Venant-Kirchhoff law and growth F_e = F F_g^-1.

    Args:
        path: the `.inp` file.
        solid: the solid; one growth in each brick.
        law: its modulus and Poisson ratio are used.
        steps: what to compute.

    Raises:
        InputError: growth varies inside a brick.
        ComputationError: a brick is inside out.
    """
    growth = uniform(solid)
    with path.open("w", encoding="ascii") as file:
        file.writelines(_mesh(solid))
        file.writelines(_material(solid.angle, growth, law, [step.release for step in steps]))
        file.writelines(_steps(solid.angle, growth, steps))


def _mesh(solid: Solid) -> Iterable[str]:
    yield "*NODE, NSET=NODES\n"
    for k, node in enumerate(solid.nodes, 1):
        yield f"{k}, {_numbers(node)}\n"
    yield "*ELEMENT, TYPE=C3D20R, ELSET=BRICKS\n"
    for k, nodes in enumerate(brick.bricks(solid.nodes, solid.bricks) + 1, 1):
        names = [str(n) for n in nodes]
        yield f"{k}, {', '.join(names[:10])},\n{', '.join(names[10:])}\n"
    yield "*NSET, NSET=FIXED\n"
    yield from (f"{k},\n" for k in solid.fixed + 1)
    yield "*BOUNDARY\nFIXED, 1, 3\n"


def _material(
    angle: Array, growth: Array, law: ElasticData | MarlowData, releases: Sequence[float]
) -> Iterable[str]:
    """One section for each pair of printing direction and growth, one material for each growth."""
    kinds, kind = np.unique(growth, axis=0, return_inverse=True)
    ways, way = np.unique(angle, return_inverse=True)
    for k, values in enumerate(kinds):
        yield f"*MATERIAL, NAME=GROWTH{k}\n*ELASTIC, TYPE=ORTHO\n"
        for s in sorted({0.0, *releases}):
            constants = orthotropic(law, values, s)
            yield f"{_numbers(constants[:8])},\n{_numbers([constants[8], s])}\n"
        # The load is given as an acceleration, so that a density of one makes it a body force.
        yield "*DENSITY\n1.\n"
    for k, turn in enumerate(ways):
        c, s = np.cos(turn), np.sin(turn)
        yield f"*ORIENTATION, NAME=WAY{k}\n{_numbers([c, s, 0, -s, c, 0])}\n"
    for k, w in np.unique(np.column_stack([kind.ravel(), way.ravel()]), axis=0):
        name = f"SET{k}X{w}"
        members = np.flatnonzero((kind.ravel() == k) & (way.ravel() == w)) + 1
        yield f"*ELSET, ELSET={name}\n"
        yield from (f"{member},\n" for member in members)
        yield f"*SOLID SECTION, ELSET={name}, MATERIAL=GROWTH{k}, ORIENTATION=WAY{w}\n"
    yield "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNODES, 0.\n"
    yield "*INITIAL CONDITIONS, TYPE=PLASTIC STRAIN\n"  # zeros that later increases add to
    yield from _strains(np.zeros((len(angle), 6)))


def _steps(angle: Array, growth: Array, steps: Sequence[Step]) -> Iterable[str]:
    before = Step(0.0, 0.0, 0)
    for step in steps:
        yield f"*STEP, NLGEOM, INC={MOST_INCREMENTS}\n*STATIC\n1., 1., 1e-4, 1.\n"
        yield f"*CONTROLS, PARAMETERS=FIELD\n{FORCE}, {CHANGE}\n"
        yield f"*TEMPERATURE\nNODES, {_numbers([step.release])}\n"
        if step.release != before.release:
            strain = [initial_strain(angle, growth, s) for s in (before.release, step.release)]
            yield "*INITIAL STRAIN INCREASE\n"
            yield from _strains(strain[1] - strain[0])
        if step.load:
            yield f"*DLOAD\nBRICKS, GRAV, {_numbers([step.load, 0, 0, -1])}\n"
        if step is steps[0]:  # kept in later steps; a step's end is always written
            yield "*NODE PRINT, NSET=NODES, FREQUENCY=9999\nU\n"
            yield "*EL PRINT, ELSET=BRICKS, FREQUENCY=9999, GLOBAL=YES\nS\n"
        yield "*END STEP\n"
        before = step


def _strains(strain: Array) -> Iterable[str]:
    """The same strain at every integration point of a brick."""
    for k, values in enumerate(strain, 1):
        # A line holds 132 characters, so two digits less than elsewhere.
        numbers = ", ".join(f"{value:.11e}" for value in values)
        yield from (f"{k}, {q}, {numbers}\n" for q in range(1, len(brick.POINTS) + 1))


def _numbers(values: Iterable[float]) -> str:
    return ", ".join(f"{value:.13e}" for value in values)  # a field holds 20 characters

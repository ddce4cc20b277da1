"""The St Venant-Kirchhoff law with growth: CalculiX has it, so one run computes all frames.

Everything that depends on the released fraction s is tabulated: a temperature equal to s picks
the elastic constants (there is no thermal expansion), and every step adds its share of the initial
strain. See `growth` for why.
"""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import ComputationError
from simulearn.fea.calculix import deck
from simulearn.fea.calculix.growth import initial_strain, orthotropic, uniform
from simulearn.fea.calculix.output import read_dat, read_sta
from simulearn.fea.calculix.process import Ccx
from simulearn.fea.calculix.schedule import Step
from simulearn.fea.calculix.state import Report, StepResult
from simulearn.fea.solid import Solid
from simulearn.material import ElasticData

Array = NDArray[np.float64]


def solve(
    ccx: Ccx, solid: Solid, law: ElasticData, steps: Sequence[Step], report: Report
) -> list[StepResult]:
    """Return the state at the end of each step.

    Args:
        ccx: CalculiX in its folder.
        solid: the solid; one growth in each brick.
        law: modulus and Poisson ratio of the St Venant-Kirchhoff law.
        steps: what to compute.
        report: called with each step that is done.

    Raises:
        InputError: growth varies inside a brick.
        NotConvergedError: a step did not converge; smaller ones may.
        ComputationError: CalculiX failed.
    """
    growth = uniform(solid)
    with ccx.path("inp").open("w", encoding="ascii") as file:
        file.writelines(deck.mesh(solid))
        file.writelines(_material(solid.angle, growth, law, [step.release for step in steps]))
        file.writelines(_steps(solid.angle, growth, steps))

    def watch() -> None:
        if done := read_sta(ccx.path("sta")):
            report(steps[: done[-1][0] - 1])  # the last one listed may still be under way

    ccx.run(watch)
    report(steps)
    moves, stresses = read_dat(ccx.path("dat"), len(solid.nodes), len(solid.bricks))
    if not len(moves) == len(stresses) == len(steps):
        raise ComputationError(f"CalculiX wrote {len(moves)} of {len(steps)} steps")
    counts = [0] * len(steps)
    for step, _, iterations in read_sta(ccx.path("sta")):
        counts[step - 1] += iterations
    return [StepResult(*values, runs=0) for values in zip(moves, stresses, counts, strict=True)]


def _material(
    angle: Array, growth: Array, law: ElasticData, releases: Sequence[float]
) -> Iterable[str]:
    """One section for each pair of printing direction and growth, one material for each growth."""
    kinds, kind = np.unique(growth, axis=0, return_inverse=True)
    directions, direction = np.unique(angle, return_inverse=True)
    for k, values in enumerate(kinds):
        yield f"*MATERIAL, NAME=GROWTH{k}\n*ELASTIC, TYPE=ORTHO\n"
        for s in sorted({0.0, *releases}):
            constants = orthotropic(law, values, s)
            yield f"{deck.numbers(constants[:8])},\n{deck.numbers([constants[8], s])}\n"
        yield deck.DENSITY
    for k, turn in enumerate(directions):
        c, s = np.cos(turn), np.sin(turn)
        yield f"*ORIENTATION, NAME=DIRECTION{k}\n{deck.numbers([c, s, 0, -s, c, 0])}\n"
    pairs, pair = np.unique(np.column_stack([kind.ravel(), direction]), axis=0, return_inverse=True)
    for k, (g, w) in enumerate(pairs):
        yield from deck.elements(f"SET{k}", np.flatnonzero(pair.ravel() == k))
        yield f"*SOLID SECTION, ELSET=SET{k}, MATERIAL=GROWTH{g}, ORIENTATION=DIRECTION{w}\n"
    yield "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNODES, 0.\n"
    yield "*INITIAL CONDITIONS, TYPE=PLASTIC STRAIN\n"  # zeros that later increases add to
    yield from deck.strains(np.zeros((len(angle), 8, 6)))


def _steps(angle: Array, growth: Array, steps: Sequence[Step]) -> Iterable[str]:
    before = 0.0
    for step in steps:
        yield deck.begin(strained=step.release != before)
        yield f"*TEMPERATURE\nNODES, {deck.numbers([step.release])}\n"
        if step.release != before:
            old, new = (initial_strain(angle, growth, s) for s in (before, step.release))
            yield "*INITIAL STRAIN INCREASE\n"
            yield from deck.strains(np.repeat((new - old)[:, None], 8, axis=1))
        yield deck.gravity(step.load)
        yield deck.PRINT if step is steps[0] else ""  # it is kept in later steps
        yield deck.END
        before = step.release

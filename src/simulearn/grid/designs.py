"""Random designs to learn from: a lattice with its joints moved about and actuators drawn.

The rules are those of the paper's authors; each is a parameter. A draw depends on the seed and
its number only, so that any design of a set can be drawn again alone and on any machine.
"""

from collections.abc import Callable
from itertools import pairwise
from math import cos, pi, sin, sqrt
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator, ConfigDict, Field
from pydantic.dataclasses import dataclass

from simulearn.errors import InputError
from simulearn.grid.cleaning import clean
from simulearn.grid.grid import Grid
from simulearn.grid.lattice import MOST_CELLS, drop_beams, lattice
from simulearn.grid.outline import outline
from simulearn.grid.validation import validate
from simulearn.material import Material, load_material

MOST_REDRAWS = 1000

Uniform = Callable[[], float]  # draws from [0, 1)


def _rising(values: tuple[float, ...]) -> tuple[float, ...]:
    if any(b < a for a, b in pairwise(values)):
        raise ValueError("the values must rise")
    return values


_Cells = Annotated[int, Field(ge=1, le=MOST_CELLS)]
_Length = Annotated[float, Field(gt=0, allow_inf_nan=False)]
_Distance = Annotated[float, Field(ge=0, allow_inf_nan=False)]
_Fraction = Annotated[float, Field(ge=0, le=1)]
_Ratio = Annotated[float, Field(gt=0, le=1)]
_Count = Annotated[int, Field(ge=0)]


@dataclass(frozen=True, config=ConfigDict(extra="forbid"))
class Rules:
    """How designs are drawn.

    Attributes:
        cells: number of cells along x and y.
        length: least and most reference length of the beams, mm.
        jitter: a joint moves by U(0, jitter) sqrt(U(0, 1)) mm at a uniform angle.
        inactive: probability that a beam has no actuator.
        ratios: the lengths that an actuator may have, rising; drawn evenly.
        top: probability that an actuator is in the top half.
        shortest: a shorter actuator is raised to the next of `ratios` that is not, mm.
        removed: least and most beams taken out, drawn evenly; what then dangles goes too.
        material: name of the material system.
    """

    cells: tuple[_Cells, _Cells] = (2, 2)
    length: Annotated[tuple[_Length, _Length], AfterValidator(_rising)] = (40.0, 75.0)
    jitter: _Distance = 30.0
    inactive: _Fraction = 0.33
    ratios: Annotated[tuple[_Ratio, ...], Field(min_length=1), AfterValidator(_rising)] = (
        0.25,
        0.5,
        0.75,
        1.0,
    )
    top: _Fraction = 0.5
    shortest: _Distance = 10.0
    removed: Annotated[tuple[_Count, _Count], AfterValidator(_rising)] = (0, 0)
    material: str = "pla-hot-water"


def draw(rules: Rules, seed: int, k: int, redraw: int = 0) -> Grid:
    """Return design k of a seed, valid or not, its fixed joint at the origin.

    Args:
        rules: how to draw.
        seed: names the set of designs.
        k: number of the design in the set.
        redraw: how often this design has been drawn before.
    """
    uniform = source(seed, k, redraw)
    least, most = rules.length
    plain = lattice(rules.cells, least + (most - least) * uniform(), rules.material)
    joints = plain.joints.copy()
    for joint in joints:
        radius = rules.jitter * uniform() * sqrt(uniform())
        angle = 2 * pi * uniform()
        joint += radius * cos(angle), radius * sin(angle)
    joints[plain.fixed] = 0.0
    # Sines differ in their last bit between machines; a nanometre hides it.
    joints = joints.round(6)

    ratios = drawn_ratios(rules, len(plain.beams), uniform)
    grid = Grid(joints, plain.beams, ratios, plain.fixed, rules.material)
    if rules.removed[1]:
        least, most = rules.removed
        count = least + int(uniform() * (most + 1 - least))
        order = np.argsort([uniform() for _ in ratios], kind="stable")
        grid = drop_beams(grid, order[:count].tolist())
        try:
            grid = clean(grid)[0]
        except InputError:
            return grid  # nothing sound is left
    return lengthened(grid, rules, load_material(rules.material))


def draw_valid(rules: Rules, seed: int, k: int) -> tuple[Grid, int]:
    """Return design k of a seed, drawn again until it is valid, and how often it was redrawn.

    Raises:
        InputError: the rules hardly ever give a valid design.
    """
    for redraw in range(MOST_REDRAWS + 1):
        grid = draw(rules, seed, k, redraw)
        report = validate(grid, load_material(rules.material))
        if report.valid:
            return grid, redraw
    raise InputError(
        f"the rules gave no valid design in {MOST_REDRAWS} redraws; of the last one, "
        f"{report.errors[0].message} ({rules})"
    )


def source(seed: int, k: int, redraw: int) -> Uniform:
    """Return what draws the numbers of design k from [0, 1)."""
    sequence = np.random.SeedSequence(seed, spawn_key=(k, redraw))
    # Uniform numbers in [0, 1) only: their bits are the same with every version of numpy.
    return np.random.Generator(np.random.Philox(sequence)).random


def drawn_ratios(rules: Rules, beams: int, uniform: Uniform) -> NDArray[np.float64]:
    """Return random signed ratios (beams,)."""
    ratios = np.zeros(beams)
    for beam in range(beams):
        active, size, half = uniform(), uniform(), uniform()
        if active >= rules.inactive:
            ratio = rules.ratios[int(size * len(rules.ratios))]
            ratios[beam] = ratio if half < rules.top else -ratio
    return ratios


def lengthened(grid: Grid, rules: Rules, material: Material) -> Grid:
    """Return the grid with actuators that are long enough; where none can be, without."""
    try:
        shape = outline(grid, material.section)
    except InputError:
        return grid  # no lengths to go by, and not valid anyhow
    # The middle of a joint's side lies on the axis.
    net = np.linalg.norm(np.diff(shape.beams.mean(axis=2), axis=1)[:, 0], axis=1)
    ratios = [
        next(
            (
                float(np.copysign(larger, ratio))
                for larger in sorted(rules.ratios)
                if larger >= abs(ratio) and larger * length >= rules.shortest
            ),
            0.0,
        )
        if ratio
        else 0.0
        for ratio, length in zip(grid.actuators, net, strict=True)
    ]
    return Grid(grid.joints, grid.beams, ratios, grid.fixed, grid.material)

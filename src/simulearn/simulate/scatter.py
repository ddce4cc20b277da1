"""How prints of one design differ: prints are drawn from the scatter of its material.

A print has a factor on all its released strains, its own curl included, and each of its beams one
more. Both are normal about 1 with the material's relative standard deviations, and cut at three of
them. A draw depends on the seed and its number only: the first prints of many are those of few.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr, ndtri

from simulearn.errors import Cancel, ComputationError, InputError, stop_if
from simulearn.grid import Grid
from simulearn.material import Material, Scatter, load_material
from simulearn.simulate.members import Prints
from simulearn.simulate.result import Result
from simulearn.simulate.simulator import Progress, Simulator
from simulearn.simulate.source import Source, source_of
from simulearn.simulate.spread import Spread

Numbers = NDArray[np.float64]

CUT = 3.0  # standard deviations
LAW = f"normal, cut at {CUT:g} standard deviations"
LEAST = 4  # prints that a spread needs


class Draw(NamedTuple):
    """T prints of a grid of B beams.

    Attributes:
        materials: of each print.
        factors: (T, B) by which the released strains of beams differ from those of their print.
    """

    materials: Sequence[Material]
    factors: Numbers

    def __len__(self) -> int:
        return len(self.materials)

    def with_nominal(self, material: Material) -> "Draw":
        """Return the same after one more print, the first, which is as the material says."""
        nominal = np.ones_like(self.factors[:1])
        return Draw([material, *self.materials], np.vstack([nominal, self.factors]))


def scattered(
    result: Result,
    count: int | None = None,
    seed: int = 0,
    engine: Simulator | None = None,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
) -> Result:
    """Return a result together with the spread of prints of its grid.

    Args:
        result: of any engine.
        count: of the prints, at least LEAST; as many as is quick if not given.
        seed: the same draws the same prints.
        engine: that gave the result; see `prints_source`.
        progress: called with the prints done and the prints in all.
        cancel: stops between prints.

    Raises:
        InputError: the material has no scatter.
        ComputationError: hardly any print has an answer.
        CancelledError: the token was set.
    """
    grid = result.grid
    material = load_material(grid.material)
    source = prints_source(material, engine)
    drawn = count or source.count
    draw = draw_prints(material, len(grid.beams), drawn, seed)
    prints = answered(simulate_prints(grid, draw, source, progress, cancel), drawn)
    spread = Spread.of(
        grid, prints, material.scatter, drawn=drawn, law=LAW, seed=seed, engine=source.engine,
        beyond=beyond_learnt(draw, source),
    )  # fmt: skip
    return replace(result, scatter=spread)


def prints_source(material: Material, engine: Simulator | None = None) -> Source:
    """Return who simulates the prints of a material; see `source_of`.

    Raises:
        InputError: the material has no scatter.
    """
    most = CUT * require_scatter(material).print
    ends = [material_of_print(material, max(1 + side * most, 0.0)) for side in (-1, 1)]
    return source_of([material, *ends], engine)


def require_scatter(material: Material) -> Scatter:
    """Return the scatter of a material.

    Raises:
        InputError: the material has none, so that nothing is known of how its prints differ.
    """
    scatter = material.scatter
    if scatter.print == 0 and scatter.beam == 0:
        raise InputError(
            f'the material "{material.name}" has no scatter, so that nothing is known of how its '
            "prints differ; calibrate it with several prints of one design, or set print and beam "
            "in the table [scatter] of its file (relative standard deviations)",
            "material-scatter",
            "material.scatter",
        )
    return scatter


def draw_prints(material: Material, beams: int, count: int, seed: int = 0) -> Draw:
    """Return random prints.

    Args:
        material: with its scatter.
        beams: of the grid.
        count: of the prints.
        seed: the same draws the same prints.
    """
    uniform = np.random.Generator(np.random.Philox(seed)).random((count, 1 + beams))
    return _draw(material, _cut_normal(uniform))


def even_prints(material: Material, beams: int, count: int, seed: int = 0) -> Draw:
    """Return few prints that stand for many: a Latin hypercube, for sums over prints.

    Each factor takes `count` values of the same share of its distribution, with mean 1 and the
    standard deviation of the material; which values meet in a print is drawn.

    Source: McKay, Beckman and Conover, Technometrics 21(2), 1979.

    Args:
        material: with its scatter.
        beams: of the grid.
        count: of the prints, at least two.
        seed: the same draws the same prints.
    """
    middles = np.tile((np.arange(count) + 0.5) / count, (1 + beams, 1))
    drawn = np.random.Generator(np.random.Philox(seed)).permuted(middles, axis=1).T
    normal = _cut_normal(drawn)
    return _draw(material, normal / normal.std(axis=0))


def simulate_prints(
    grid: Grid,
    draw: Draw,
    source: Source,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
) -> Prints:
    """Return the last frames of prints that were drawn.

    Args:
        grid: a sound grid, its fixed joint at the origin.
        draw: the prints.
        source: who simulates them.
        progress: called with the prints done and the prints in all.
        cancel: stops between prints.

    Raises:
        CancelledError: the token was set.
    """
    parts = []
    for first in range(0, len(draw), source.chunk):
        stop_if(cancel)
        some = slice(first, first + source.chunk)
        parts.append(source.frames(grid, draw.materials[some], draw.factors[some]))
        if progress is not None:
            progress(min(first + source.chunk, len(draw)), len(draw))
    joints, sections, converged = zip(*parts, strict=True)
    return Prints(np.concatenate(joints), np.concatenate(sections), np.concatenate(converged))


def beyond_learnt(draw: Draw, source: Source) -> int:
    """Return how many prints have a beam that curls more or less than any the model has learnt."""
    if source.learnt is None:
        return 0
    count = 0
    for material, factors in zip(draw.materials, draw.factors, strict=True):
        ends = (material_of_print(material, float(k)) for k in (factors.min(), factors.max()))
        count += any(source.learnt.beyond(end) for end in ends)
    return count


def answered(prints: Prints, drawn: int) -> Prints:
    """Return the prints that have an answer.

    Raises:
        ComputationError: they are too few to say how prints differ.
    """
    if prints.converged.sum() < min(LEAST, drawn):
        raise ComputationError(
            f"only {prints.converged.sum()} of {drawn} prints have an answer, too few to say how "
            "prints differ",
            "no-answer",
            "grid",
        )
    which = prints.converged
    return Prints(prints.joints[which], prints.sections[which], which[which])


def material_of_print(material: Material, factor: float) -> Material:
    """Return the material of a print whose released strains are so many times as large."""
    old = material.shrinkage
    changed = {name: getattr(old, name) * factor for name in ("active", "shell", "curl")}
    return material.model_copy(update={"shrinkage": old.model_copy(update=changed)})


def _cut_normal(uniform: Numbers) -> Numbers:
    """Return normal numbers, cut at CUT, of numbers uniform in [0, 1)."""
    low = ndtr(-CUT)
    return np.asarray(ndtri(low + (1 - 2 * low) * uniform))


def _draw(material: Material, normal: Numbers) -> Draw:
    """Return prints of normal numbers (T, 1 + B): of the print, and of each beam."""
    scatter = require_scatter(material)
    of_prints = 1 + scatter.print * normal[:, 0]
    factors = np.maximum(1 + scatter.beam * normal[:, 1:], 0.0)
    return Draw([material_of_print(material, max(k, 0.0)) for k in of_prints.tolist()], factors)

"""Which one change of the material would explain most of a deviation.

For each parameter the change of the shape is taken from finite differences, all materials in one
call. Rigid motions are projected out of it and of the deviation, since the pose of a print is free.
Least squares then give the best value, and the part of the squared deviation that it explains. The
shapes at those values are simulated, too, and a parabola through all of a parameter's shapes
mends what is not linear; the part that is reported is of a simulated shape.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from simulearn.compare.changes import Parameter, parameters, possible, steps
from simulearn.compare.deviation import Deviation, brought, without_motion
from simulearn.compare.measurement import Numbers
from simulearn.errors import Cancel, stop_if
from simulearn.grid import Grid
from simulearn.material import Material
from simulearn.simulate.source import source_of

ALIKE = 0.95  # cosine of changes of shape that cannot be told apart

Simulate = Callable[[Sequence[Material]], tuple[Numbers, NDArray[np.bool_]]]


@dataclass(frozen=True)
class Explanation:
    """What a change of one parameter explains.

    Attributes:
        name: of the parameter.
        value: the best one.
        nominal: that of the material.
        explained: part of the squared deviation that vanishes with it, 0 to 1.
        within: whether the value is within the family.
        words: the change for people.
        alike: names of parameters whose change of shape is about the same in this grid.
    """

    name: str
    value: float
    nominal: float
    explained: float
    within: bool
    words: str
    alike: tuple[str, ...] = ()


def simulated_by(grid: Grid) -> Simulate:
    """Return the function that simulates a grid in materials: joints and middles of beams.

    The learned model answers where it has learnt them, else finite elements do.
    """

    def simulate(materials: Sequence[Material]) -> tuple[Numbers, NDArray[np.bool_]]:
        alike = np.ones((len(materials), len(grid.beams)))
        prints = source_of(materials).frames(grid, materials, alike)
        places = np.concatenate([prints.centres, prints.sections[:, :, 1].mean(axis=2)], axis=1)
        return places, prints.converged

    return simulate


def explanations(
    deviation: Deviation,
    base: Material,
    simulate: Simulate,
    progress: Callable[[int, int], None] | None = None,
    cancel: Cancel | None = None,
) -> list[Explanation]:
    """Return what each parameter explains of a deviation, the best first.

    Args:
        deviation: of a print.
        base: the material of the simulation.
        simulate: gives places (T, J + B, 3) of joints and middles of beams in T materials, and
            whether (T,) they are known.
        progress: called with the calls done and all.
        cancel: stops the work between calls.

    Raises:
        CancelledError: the token was set.
    """
    every = parameters(base)
    measured = np.concatenate([deviation.joints, deviation.stations[:, 1]])
    shape = np.concatenate([deviation.simulated, deviation.expected[:, 1]])
    seen = np.isfinite(measured).all(axis=1)
    measured, shape = measured[seen], shape[seen]
    stop_if(cancel)
    tried = [(p, value) for p in every for value in steps(p, base)]
    materials = [base, *(p.apply(base, value) for p, value in tried)]
    places, known = simulate(materials)
    if progress is not None:
        progress(1, 3)
    if not known[0]:
        return []
    nominal = places[0, seen]
    curves = {
        p.name: _Curve(p, p.value(base), shape)
        for k, p in enumerate(every)
        if known[1 + 2 * k : 3 + 2 * k].all()
    }
    for k, (p, value) in enumerate(tried):
        if p.name in curves:
            curves[p.name].add(value, places[1 + k, seen] - nominal)
    for call in (2, 3):
        stop_if(cancel)
        wanted = [(curve, curve.best(measured)) for curve in curves.values()]
        places, known = simulate([base, *(c.parameter.apply(base, v) for c, v in wanted)])
        for k, (curve, value) in enumerate(wanted):
            if known[1 + k]:
                curve.add(value, places[1 + k, seen] - places[0, seen])
        if progress is not None:
            progress(call, 3)
    whole = ((brought(measured, shape) - shape) ** 2).sum()
    found = [_explained(curve, measured, float(whole), curves) for curve in curves.values()]
    return sorted(found, key=_least)


def _least(one: Explanation) -> float:
    return -one.explained


class _Curve:
    """The shapes of one parameter's values."""

    def __init__(self, parameter: Parameter, nominal: float, shape: Numbers) -> None:
        self.parameter, self.nominal, self._shape = parameter, nominal, shape
        self._values: list[float] = [nominal]
        self._moves: list[Numbers] = [np.zeros_like(shape)]

    def add(self, value: float, moves: Numbers) -> None:
        self._values.append(value)
        self._moves.append(moves)

    def slope(self) -> Numbers:
        """Return the change of shape per unit of the parameter, without rigid motions: (3 K,)."""
        a, b = self._values[1:3]
        slope = (self._moves[2] - self._moves[1]) / (b - a)
        return without_motion(slope.ravel(), self._shape)

    def at(self, value: float) -> Numbers:
        """Return the shape at a value, by the parabola through the three nearest known ones."""
        near = np.argsort([abs(v - value) for v in self._values], kind="stable")
        picked: list[int] = []
        for k in near:
            if all(abs(self._values[k] - self._values[j]) > 1e-9 for j in picked):
                picked.append(int(k))
        picked = picked[:3]
        x = [self._values[k] for k in picked]
        weights = [
            np.prod([(value - x[m]) / (x[k] - x[m]) for m in range(len(x)) if m != k])
            for k in range(len(x))
        ]
        moves = sum(w * self._moves[k] for w, k in zip(weights, picked, strict=True))
        return np.asarray(self._shape + moves)

    def left(self, value: float, measured: Numbers) -> float:
        """Return the squared deviation that is left at a value."""
        shape = self.at(value)
        return float(((brought(measured, shape) - shape) ** 2).sum())

    def best(self, measured: Numbers) -> float:
        """Return the value that leaves least, not far beyond what is known or is in the family."""
        slope = self.slope()
        deviation = without_motion(
            (brought(measured, self._shape) - self._shape).ravel(), self._shape
        )
        size = float(slope @ slope)
        guess = float(slope @ deviation) / size if size > 0 else 0.0
        low, high = self.parameter.range
        wide = high - low
        if len(self._values) > 3:  # a shape near the best one is known
            near = min(self._values, key=self._to(measured))
            reach = max(abs(near - self.nominal), self.parameter.step) / 2
            bounds = (near - reach, near + reach)
        else:
            aim = float(np.clip(self.nominal + guess, low - wide / 4, high + wide / 4))
            ends = sorted((self.nominal, aim + (aim - self.nominal) / 2))
            bounds = (ends[0] - 0.2 * self.parameter.step, ends[1] + 0.2 * self.parameter.step)
        edges = (low - wide / 4, high + wide / 4)  # shapes far beyond the family are not looked at
        least, most = (possible(self.parameter, float(np.clip(x, *edges))) for x in bounds)
        if most - least < 1e-9:
            return least
        found = minimize_scalar(
            self.left, bounds=(least, most), args=(measured,), method="bounded",
            options={"xatol": 1e-4 * wide},
        )  # fmt: skip
        return float(found.x)

    def simulated(self, measured: Numbers) -> tuple[float, float]:
        """Return the simulated value that leaves least, and what it leaves."""
        value = min(self._values, key=self._to(measured))
        return value, self.left(value, measured)

    def _to(self, measured: Numbers) -> Callable[[float], float]:
        def left(value: float) -> float:
            return self.left(value, measured)

        return left


def _explained(
    curve: _Curve, measured: Numbers, whole: float, curves: dict[str, _Curve]
) -> Explanation:
    value, left = curve.simulated(measured)
    low, high = curve.parameter.range
    slope = curve.slope()
    alike = []
    for name, other in curves.items():
        if other is not curve:
            theirs = other.slope()
            size = np.linalg.norm(slope) * np.linalg.norm(theirs)
            if size > 0 and abs(slope @ theirs) > ALIKE * size:
                alike.append(name)
    return Explanation(
        name=curve.parameter.name,
        value=value,
        nominal=curve.nominal,
        explained=max(0.0, 1 - left / whole) if whole > 0 else 0.0,
        within=bool(low - 1e-9 <= value <= high + 1e-9),
        words=curve.parameter.said(value),
        alike=tuple(alike),
    )

"""What a material's numbers make of all strips of a plate, and how that changes with them.

All members of the family that a derivative takes go to one call for each strip. How large the plate
was printed is a number of its own, determined by the lengths before the bath: beams are longer than
designed by one factor, near one, by which the strips' chords and rises change linearly.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from simulearn.calibrate.measuring import simulated
from simulearn.calibrate.parameters import Parameter, material_with
from simulearn.calibrate.strips import Strip
from simulearn.errors import Cancel, stop_if
from simulearn.material import Material

Numbers = NDArray[np.float64]
STRETCH = 0.01  # for the derivative by the size


class Model:
    """Chords and rises of strips as functions of a material's numbers.

    Args:
        strips: S strips.
        base: the base material with the section that was measured.
        parameters: P numbers.
        cancel: token that stops between two strips.
    """

    def __init__(
        self,
        strips: Sequence[Strip],
        base: Material,
        parameters: Sequence[Parameter],
        cancel: Cancel | None = None,
    ) -> None:
        self.strips, self.base, self.parameters = tuple(strips), base, tuple(parameters)
        self.cancel = cancel
        self.runs = 0  # prints that were simulated

    def values(self, members: Sequence[Numbers], stretch: float = 1.0) -> Numbers:
        """Return chords and rises (T, S, 2), mm, of T members (P,); NaN where there is none."""
        materials = [material_with(self.base, numbers) for numbers in members]
        found = []
        for strip in self.strips:
            stop_if(self.cancel)
            found.append(simulated(strip.record, materials, strip.rises, stretch))
        self.runs += len(materials) * len(self.strips)
        return np.stack(found, axis=1)

    def slopes(self, numbers: Numbers) -> tuple[Numbers, Numbers]:
        """Return values (S, 2) and derivatives (S, 2, P + 1), the last by the size, mm.

        Derivatives are those of a secant towards the middle of each number's range; what has no
        simulation there has none.
        """
        middles = [(one.low + one.high) / 2 for one in self.parameters]
        steps = np.array([one.step for one in self.parameters])
        steps = np.where(numbers > middles, -steps, steps)
        members = [numbers, *(numbers + np.diag(steps))]
        value, *others = self.values(members)
        stretched = self.values([numbers], 1 + STRETCH)[0]
        by_number = [(other - value) / step for other, step in zip(others, steps, strict=True)]
        slopes = np.stack([*by_number, (stretched - value) / STRETCH], axis=-1)
        return value, np.nan_to_num(slopes)

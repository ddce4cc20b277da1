"""What both ways of using CalculiX hand back."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.fea.calculix.schedule import Step

Report = Callable[[Sequence[Step]], None]  # called with the steps that are done


@dataclass(frozen=True, eq=False)
class StepResult:
    """The solid at the end of a step.

    Attributes:
        displacements: (N, 3) mm.
        stress: (E, 8, 6) Cauchy stress at CalculiX's points, MPa, global axes.
        iterations: spent on this step.
        runs: of CalculiX spent on this step; 0 where one run computes all steps.
    """

    displacements: NDArray[np.float64]
    stress: NDArray[np.float64]
    iterations: int
    runs: int

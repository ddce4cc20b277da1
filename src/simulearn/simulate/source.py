"""Who simulates prints: a learned model where it has learnt their materials, else finite elements.

A model answers hundreds of prints in a moment. Finite elements take any material and as long for a
print as for a design, so that there are fewer of them.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import ComputationError, InputError
from simulearn.grid import Grid
from simulearn.learn.equilibrium.learnt import Learnt
from simulearn.material import Material
from simulearn.simulate.learned import Learned
from simulearn.simulate.members import Prints, last_frames
from simulearn.simulate.simulator import Simulator

Numbers = NDArray[np.float64]


@dataclass(frozen=True)
class Source:
    """A simulator of prints.

    Attributes:
        engine: its name.
        frames: the last frames of a grid in T materials with factors (T, B), as `last_frames`.
        count: how many prints are simulated unless a number is given.
        chunk: how many at once, between two looks at progress and cancel.
        learnt: what the model has learnt of materials; None where every material has an answer.
    """

    engine: str
    frames: Callable[[Grid, Sequence[Material], Numbers], Prints]
    count: int
    chunk: int
    learnt: Learnt | None = None


def source_of(materials: Sequence[Material], engine: Simulator | None = None) -> Source:
    """Return who simulates prints.

    Args:
        materials: the farthest that occur.
        engine: that simulates the design; its model is taken where it has learnt the materials.
    """
    known = isinstance(engine, Learned) and hasattr(engine.bundle.model, "learnt")
    try:
        learned = engine if known and isinstance(engine, Learned) else Learned.of("default")
        for material in materials:
            learned.require(material)
    except InputError:  # the model has not learnt them, or there is none
        return BY_FEA
    frames = partial(last_frames, model=str(learned.bundle.path))
    model: Any = learned.bundle.model
    return Source(learned.name, frames, count=300, chunk=100, learnt=model.learnt)


def frames_by_fea(grid: Grid, materials: Sequence[Material], factors: Numbers) -> Prints:
    """Return the last frames of prints by finite elements; see `members.last_frames`."""
    from simulearn.fea import simulate_grid

    count = len(materials)
    joints: Any = np.full((count, len(grid.joints), 8, 3), np.nan)
    sections: Any = np.full((count, len(grid.beams), 3, 4, 3), np.nan)
    for t, material in enumerate(materials):
        try:
            trial = simulate_grid(grid, material, factors=factors[t])
        except ComputationError:
            continue
        joints[t], sections[t] = trial.joints[-1], trial.beams[-1]
    return Prints(joints, sections, np.isfinite(joints).all(axis=(1, 2, 3)))


BY_FEA = Source("fea", frames_by_fea, count=16, chunk=1)

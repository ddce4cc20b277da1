"""The engines by name, each loaded only when it is asked for.

An engine here is a function that simulates one grid; `Engine` adds what all have in common:
validation before, the Result after.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from simulearn.errors import InputError
from simulearn.grid import Grid, clean, validate
from simulearn.material import Material, load_material
from simulearn.simulate.result import FRAMES, Result
from simulearn.simulate.simulator import Progress, Simulator

Solver = Callable[..., Any]  # (grid, material, *, progress) -> simulearn.fea.Trial


@dataclass(frozen=True)
class Engine:
    """A Simulator made of a solver that computes one grid at a time.

    Attributes:
        name: name of the engine.
        solver: solves one valid grid: `solver(grid, material, progress=...) -> Trial`.
    """

    name: str
    solver: Solver

    def simulate(self, grids: Sequence[Grid], progress: Progress | None = None) -> list[Result]:
        """Return the results of the grids, in their order; see `Simulator.simulate`."""
        # All grids are checked before the first is computed, for computing takes long.
        checked = [checked_grid(grid) for grid in grids]
        return [self._one(k, len(checked), *pair, progress) for k, pair in enumerate(checked)]

    def _one(
        self, k: int, n: int, grid: Grid, material: Material, progress: Progress | None
    ) -> Result:
        def tell(frame: int, total: int) -> None:
            if progress is not None:
                progress(k * FRAMES + round(frame * FRAMES / total), n * FRAMES)

        trial = self.solver(grid, material, progress=tell)
        return Result(
            grid=grid,
            engine=self.name,
            joints=np.asarray(trial.joints),
            beams=np.asarray(trial.beams),
            stress=np.asarray(trial.stress),
            seconds=float(trial.seconds),
            record=dict(trial.record),
            solid=trial.solid,
            displacements=np.asarray(trial.displacements),
        )


def checked_grid(grid: Grid) -> tuple[Grid, Material]:
    """Return the grid without its dangling beams, its fixed joint at the origin, and its material.

    Raises:
        InputError: the grid does not validate.
    """
    material = load_material(grid.material)
    errors = validate(grid, material).errors
    if errors:
        more = f" (and {len(errors) - 1} more; `simulearn validate` shows all)"
        raise InputError(errors[0].message + (more if len(errors) > 1 else ""))
    return clean(grid)[0].centred, material


def _fea() -> Simulator:
    from simulearn.fea import simulate_grid

    return Engine("fea", simulate_grid)


def _calculix() -> Simulator:
    from simulearn.fea.calculix import simulate_grid

    return Engine("calculix", simulate_grid)


def _learned(model: Path | str = "default") -> Simulator:
    from simulearn.simulate.learned import Learned

    return Learned.of(model)


def _beams() -> Simulator:
    from simulearn.simulate.learned import Learned

    return replace(Learned.of("beams"), name="beams")


ENGINES: dict[str, Callable[[], Simulator]] = {
    "fea": _fea,
    "calculix": _calculix,
    "beams": _beams,
    "learned": _learned,
}


def engine(name: str = "fea", model: Path | str | None = None) -> Simulator:
    """Return the engine of a name.

    Args:
        name: one of ENGINES.
        model: for the engine "learned": a model's folder, or the name of one that comes with
            SimuLearn; by default the one called "default".

    Raises:
        InputError: no engine has that name, or what it needs is not installed; there is no such
            model, or the engine takes none.
    """
    if name not in ENGINES:
        raise InputError(f'engine "{name}" is not known; known are {", ".join(ENGINES)}')
    if model is None:
        return ENGINES[name]()
    if name != "learned":
        raise InputError(f'engine "{name}" takes no model; only "learned" does')
    return _learned(model)

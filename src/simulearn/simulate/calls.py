"""The calls for programs: validate and simulate grids, and get an engine ready beforehand."""

from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import overload

from simulearn.errors import Cancel
from simulearn.grid import Grid, Validation
from simulearn.grid import validate as validate_for
from simulearn.material import Material, load_material
from simulearn.simulate.engines import engine as engine_of
from simulearn.simulate.result import Outcome, Outcomes, Result, one
from simulearn.simulate.simulator import Progress, Simulator


def validate(grid: Grid, material: Material | None = None) -> Validation:
    """Return all errors and warnings about a design.

    Args:
        grid: the design.
        material: other than the grid's own.

    Raises:
        InputError: the grid's material is not known.
    """
    return validate_for(grid, material or load_material(grid.material))


@overload
def simulate(
    grids: Grid,
    engine: Simulator | str = "fea",
    model: Path | str | None = None,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
    mesh: str | None = None,
) -> Result: ...


@overload
def simulate(
    grids: Sequence[Grid],
    engine: Simulator | str = "fea",
    model: Path | str | None = None,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
    mesh: str | None = None,
) -> list[Outcome]: ...


def simulate(
    grids: Grid | Sequence[Grid],
    engine: Simulator | str = "fea",
    model: Path | str | None = None,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
    mesh: str | None = None,
) -> Result | list[Outcome]:
    """Return the result of a grid, or the outcomes of many in their order.

    Args:
        grids: one design, or several.
        engine: the simulator, or its name: "fea", "calculix", "beams" or "learned".
        model: for the engine "learned": a model's folder or name.
        progress: called with the frames done and the frames in all.
        cancel: stops the simulation.
        mesh: for the engine "fea": "default" or "fine".

    Raises:
        InputError: the one grid is not valid, or there is no such engine, model or mesh.
        ComputationError: the one grid is valid, but has no answer.
        CancelledError: the token was set.
    """
    simulator = engine_of(engine, model, mesh) if isinstance(engine, str) else engine
    if isinstance(grids, Grid):
        return one(simulator.simulate([grids], progress, cancel)[0])
    return Outcomes(simulator.simulate(list(grids), progress, cancel))


@cache
def warm(engine: str = "learned", model: Path | str | None = None) -> None:
    """Get an engine ready: its model is read and its kernels are compiled when this returns.

    The first time on a machine this takes some seconds, later a moment.

    Args:
        engine: its name.
        model: for the engine "learned".

    Raises:
        InputError: there is no such engine or model.
    """
    engine_of(engine, model).warm()

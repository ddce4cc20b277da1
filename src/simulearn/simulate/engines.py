"""The engines by name, each loaded only when it is needed.

An engine here is a function that simulates one grid; `Engine` adds what all have in common:
validation before, the outcome after, and many grids at once.
"""

import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from simulearn.errors import Cancel, ComputationError, InputError, stop_if
from simulearn.extras import require
from simulearn.files import cores
from simulearn.grid import Grid, make
from simulearn.simulate.checked import Checked, check_all
from simulearn.simulate.colliding import with_collisions
from simulearn.simulate.result import FRAMES, Failure, Outcome, Result, results
from simulearn.simulate.simulator import Progress, Simulator

Solver = Callable[..., Any]  # (grid, material, *, progress, cancel) -> simulearn.fea.Trial


class StreamingSimulator(Simulator, Protocol):
    """An engine that gives outcomes as they are computed."""

    def stream(
        self,
        grids: Sequence[Grid],
        progress: Progress | None = None,
        cancel: Cancel | None = None,
    ) -> Iterator[tuple[int, Outcome]]:
        """Yield (place in grids, outcome) as soon as each is known; see `Simulator.simulate`."""
        ...

    def warm(self) -> None:
        """Compile what the first simulation would wait for."""
        ...


@dataclass(frozen=True)
class Engine:
    """A Simulator made of a solver that computes one grid at a time.

    Attributes:
        name: name of the engine.
        solver: solves one valid grid: `solver(grid, material, progress=..., cancel=...) -> Trial`.
        workers: grids that are computed at the same time, each by a thread; None: one a core.
    """

    name: str
    solver: Solver
    workers: int | None = None

    def simulate(
        self,
        grids: Sequence[Grid],
        progress: Progress | None = None,
        cancel: Cancel | None = None,
    ) -> list[Outcome]:
        """Return the outcomes of the grids, in their order; see `Simulator.simulate`."""
        return in_order(self.stream(grids, progress, cancel), len(grids))

    def stream(
        self,
        grids: Sequence[Grid],
        progress: Progress | None = None,
        cancel: Cancel | None = None,
    ) -> Iterator[tuple[int, Outcome]]:
        """Yield (place in grids, outcome) as soon as each is known; see `Simulator.simulate`."""
        checked = dict(enumerate(check_all(grids)))
        valid = {k: one for k, one in checked.items() if isinstance(one, Checked)}
        frames = _Frames(progress, FRAMES * len(valid))
        yield from ((k, one) for k, one in checked.items() if isinstance(one, Failure))
        if len(valid) < 2 or self.workers == 1:
            for k, one in valid.items():
                stop_if(cancel)
                yield k, self._one(one, frames.of(k), cancel)
            return
        either = _Either(cancel)
        with ThreadPoolExecutor(min(self.workers or cores(), len(valid))) as pool:
            futures = {
                pool.submit(self._one, one, frames.of(k), either): k for k, one in valid.items()
            }
            try:
                for future in as_completed(futures):
                    yield futures[future], future.result()
            finally:  # whatever ends this early, as an interrupt, ends the others, too
                either.set()
                pool.shutdown(cancel_futures=True)

    def warm(self) -> None:
        """Compile what the first simulation would wait for."""
        results(self.simulate([make("flat", (1, 1), 50.0)]))

    def _one(self, one: Checked, progress: Progress, cancel: Cancel | None) -> Outcome:
        stop_if(cancel)
        try:
            trial = self.solver(one.grid, one.material, progress=progress, cancel=cancel)
        except (ComputationError, InputError) as error:
            return Failure.of(one.given, error, _likely(one))
        result = Result(
            grid=one.grid,
            engine=self.name,
            joints=np.asarray(trial.joints),
            beams=np.asarray(trial.beams),
            stress=np.asarray(trial.stress),
            seconds=float(trial.seconds),
            material=one.material.identity,
            stable=trial.stable,
            snaps=trial.snaps,
            warnings=(*one.warnings, *trial.warnings),
            record=dict(trial.record),
            solid=trial.solid,
            displacements=np.asarray(trial.displacements),
        )
        return with_collisions(result)


def in_order(outcomes: Iterator[tuple[int, Outcome]], count: int) -> list[Outcome]:
    """Return streamed outcomes in the order of their grids."""
    by_place = dict(outcomes)
    return [by_place[k] for k in range(count)]


def _likely(one: Checked) -> str:
    """Return what is unusual about a design, a likely reason why it has no answer."""
    if not one.warnings:
        return ""
    first, *others = one.warnings
    more = f" (and {len(others)} more warnings)" if others else ""
    return f"the design is unusual: {first.message}{more}"


class _Frames:
    """Adds up the frames of grids that are computed at the same time."""

    def __init__(self, progress: Progress | None, total: int) -> None:
        self._progress, self._total = progress, total
        self._done: dict[int, int] = {}
        self._lock = threading.Lock()

    def of(self, place: int) -> Progress:
        """Return the progress of one grid."""
        return partial(self._report, place)

    def _report(self, place: int, done: int, total: int) -> None:
        if self._progress is None:
            return
        with self._lock:
            self._done[place] = round(done * FRAMES / total)
            self._progress(sum(self._done.values()), self._total)


class _Either:
    """A token that is set here, or by whoever can cancel all of it."""

    def __init__(self, other: Cancel | None) -> None:
        self._own, self._other = threading.Event(), other

    def set(self) -> None:
        self._own.set()

    def is_set(self) -> bool:
        return self._own.is_set() or (self._other is not None and self._other.is_set())


def _cancelled_by_frame(simulate_grid: Solver) -> Solver:
    """Return a solver that obeys a token after each frame, of one that takes none."""

    def solver(grid: Grid, material: Any, *, progress: Progress, cancel: Cancel | None) -> Any:
        def after_frame(done: int, total: int) -> None:
            stop_if(cancel)
            progress(done, total)

        return simulate_grid(grid, material, progress=after_frame)

    return solver


def _fea(mesh: str = "default") -> StreamingSimulator:
    from simulearn.fea import simulate_grid
    from simulearn.fea.layout import MESHES

    return Engine("fea", partial(simulate_grid, layout=MESHES[mesh]))


def _calculix() -> StreamingSimulator:
    require("the engine calculix needs", "jax")
    from simulearn.fea.calculix import simulate_grid

    return Engine("calculix", _cancelled_by_frame(simulate_grid))


def _learned(model: Path | str = "default") -> StreamingSimulator:
    from simulearn.simulate.learned import Learned

    return Learned.of(model)


def _beams() -> StreamingSimulator:
    from simulearn.simulate.learned import Learned

    return replace(Learned.of("beams"), name="beams")


ENGINES: dict[str, Callable[[], StreamingSimulator]] = {
    "fea": _fea,
    "calculix": _calculix,
    "beams": _beams,
    "learned": _learned,
}

MESHES = ("default", "fine")  # of finite elements; see `simulearn.fea.layout`


def engine(
    name: str = "fea", model: Path | str | None = None, mesh: str | None = None
) -> StreamingSimulator:
    """Return the engine of a name.

    Args:
        name: one of ENGINES.
        model: for the engine "learned": a model's folder, or the name of one that comes with
            SimuLearn; by default the one called "default".
        mesh: for the engine "fea": one of MESHES.

    Raises:
        InputError: no engine has that name, or what it needs is not installed; there is no such
            model or mesh, or the engine takes none.
    """
    if name not in ENGINES:
        known = ", ".join(ENGINES)
        raise InputError(
            f'engine "{name}" is not known; known are {known}', "engine-unknown", "engine"
        )
    if mesh is not None and name != "fea":
        raise InputError(f'engine "{name}" takes no mesh; only "fea" does', "engine-mesh", "mesh")
    if mesh is not None and mesh not in MESHES:
        known = ", ".join(MESHES)
        raise InputError(f'mesh "{mesh}" is not known; known are {known}', "mesh-unknown", "mesh")
    if model is None:
        return ENGINES[name]() if mesh is None else _fea(mesh)
    if name != "learned":
        raise InputError(
            f'engine "{name}" takes no model; only "learned" does', "engine-model", "model"
        )
    return _learned(model)

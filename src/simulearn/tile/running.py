"""Tiling: every kind of module searched for, then shared borders brought together, in rounds.

Searches are jobs of their own, so they go to processes or to a cluster. Each answer is a file by
the name of its job, and what comes next follows from the answers alone: a run that was stopped
goes on by asking for the same jobs again.

FOLDER/work/KEY.json   the answer to a job
"""

import json
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from contextlib import AbstractContextManager
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from time import monotonic

import numpy as np
from numpy.typing import NDArray

from simulearn.dataset import local_workers
from simulearn.dataset.workers import Workers
from simulearn.errors import Cancel, ComputationError, InputError, Message, stop_if
from simulearn.files import cores, read_text, replacing
from simulearn.grid import Grid, TrainingRange, grid_from_dict
from simulearn.material import Material, load_material
from simulearn.rigid import Place
from simulearn.simulate import engine as engine_of
from simulearn.simulate.calls import warm
from simulearn.simulate.learned import Learned
from simulearn.tile.alike import Member, alike, averaged
from simulearn.tile.borders import Fit, fit, weights
from simulearn.tile.flatten import arcs
from simulearn.tile.patches import Tiling
from simulearn.tile.searching import ModuleAnswer, ModuleJob, run

Array = NDArray[np.float64]

LONGEST = 600.0  # s, after which a search is given up
TRIES = 3  # of a search whose worker dies
PATIENCE = 0.5  # s between two looks at the token and the clock
AHEAD = 2  # jobs given to each worker


@dataclass(frozen=True)
class Settings:
    """How a surface is tiled.

    Attributes:
        alike_mm: largest distance of targets of modules that are designed as one.
        gap_mm: largest gap between two modules, at which the rounds end.
        rounds: in which shared borders are brought together, at most.
        seconds: of all of it, at most; None: no limit. What was begun then ends.
        engine: "learned" or "beams".
        model: of the engine; None: its default.
        material: name or path.
        ratio: step of the actuators' ratios.
    """

    alike_mm: float = 0.25
    gap_mm: float = 1.0
    rounds: int = 3
    seconds: float | None = None
    engine: str = "learned"
    model: str | None = None
    material: str = "pla-hot-water"
    ratio: float = 0.05


@dataclass(frozen=True)
class Stage:
    """How far a tiling is.

    Attributes:
        round: 0 is the first search of every kind.
        done: searches of the round that are finished.
        total: searches of the round.
        gap_mm: largest gap after the last round; None before it.
        error_mm: mean distance of joints from their targets, likewise.
    """

    round: int
    done: int
    total: int
    gap_mm: float | None = None
    error_mm: float | None = None


@dataclass(frozen=True, eq=False)
class Tiled:
    """A surface that is tiled.

    Attributes:
        tiling: the patches.
        settings: how.
        members: how each module is of its kind.
        grids: of the kinds.
        answers: of the kinds.
        fit: the modules in their places.
        rounds: after each round the gap and the error, mm.
        seconds: of this run.
        searching: s of computing, of all searches, earlier runs included.
        warnings: what is to be known.
    """

    tiling: Tiling
    settings: Settings
    members: tuple[Member, ...]
    grids: tuple[Grid, ...]
    answers: tuple[ModuleAnswer, ...]
    fit: Fit
    rounds: tuple[tuple[float, float], ...]
    seconds: float
    searching: float
    warnings: tuple[Message, ...]

    @property
    def width(self) -> float:
        """Width of a beam, mm."""
        return load_material(self.settings.material).section.width

    @property
    def beams(self) -> Array:
        """(M, B, 3) mm, centres of the beams' middle sections in their places."""
        beams = []
        for member, place in zip(self.members, self.fit.places, strict=True):
            middle = np.array(self.answers[member.kind].beams)[:, 1]
            beams.append(place(middle * [-1, 1, 1] if member.mirrored else middle))
        return np.array(beams)


Progress = Callable[[Stage], None]


def tile(
    tiling: Tiling,
    settings: Settings = Settings(),
    folder: Path | str | None = None,
    workers: AbstractContextManager[Workers] | None = None,
    progress: Progress = lambda stage: None,
    cancel: Cancel | None = None,
) -> Tiled:
    """Return the modules that cover a surface.

    Args:
        tiling: the patches.
        settings: how.
        folder: where answers are kept, so that a run that was stopped goes on; None: nowhere.
        workers: who searches; by default a process for each core.
        progress: called after each search and each round.
        cancel: stops the tiling.

    Raises:
        InputError: the modules are of a wrong size, the engine or the material is not known.
        ComputationError: a module has no answer, or no worker can be started.
        CancelledError: it was stopped.
    """
    begun = monotonic()
    material = load_material(settings.material)
    engine = engine_of(settings.engine, settings.model)
    if not isinstance(engine, Learned):
        text = f'engine "{settings.engine}" is too slow to tile with; learned and beams are not'
        raise InputError(text, "engine-slow", "engine")
    engine.require(material)
    _fitting(tiling, engine.training.of(material))
    warm("fea")
    warm(settings.engine, settings.model)
    kinds, members = alike(tiling.targets, tiling.lattice, settings.alike_mm)
    until = np.inf if settings.seconds is None else begun + settings.seconds
    team = workers or local_workers(min(cores(), len(kinds)), LONGEST, run)
    with team as ready:
        asking = _Asking(ready, None if folder is None else Path(folder), progress, cancel, until)
        return _Rounds(tiling, settings, material, kinds, members, asking, begun).run()


class _Rounds:
    """The rounds of a tiling."""

    def __init__(
        self,
        tiling: Tiling,
        settings: Settings,
        material: Material,
        kinds: Array,
        members: tuple[Member, ...],
        asking: "_Asking",
        begun: float,
    ) -> None:
        self.tiling, self.settings, self.members = tiling, settings, members
        self.material, self.asking, self.begun = material, asking, begun
        self.weights = weights(tiling, members, len(kinds))
        firsts = [next(k for k, m in enumerate(members) if m.kind == n) for n in range(len(kinds))]
        self.normals = tiling.normals[tiling.modules[firsts]]
        self.searching = 0.0
        self.kinds = kinds

    def run(self) -> Tiled:
        answers = self._first()
        now = self._fit(answers, self.tiling.points)
        best, kept, history = now, answers, [(now.gap_mm, now.error_mm)]
        for number in range(1, self.settings.rounds + 1):
            self.asking.report(Stage(number - 1, 1, 1, now.gap_mm, now.error_mm))
            if now.gap_mm <= self.settings.gap_mm or monotonic() > self.asking.until:
                break
            answers, changed = self._again(number, answers, now)
            if not changed:
                break
            now = self._fit(answers, now.targets)
            history.append((now.gap_mm, now.error_mm))
            if now.gap_mm < best.gap_mm:
                best, kept = now, answers
        return self._tiled(best, kept, history)

    def _first(self) -> list[ModuleAnswer]:
        """Return the answers of the first search of every kind."""
        jobs = [self._job(k, targets, 1) for k, targets in enumerate(self.kinds)]
        found = self.asking.answers(0, jobs, final=True)
        for k, answer in enumerate(found):
            if answer is None or answer.grid is None:
                name = self.tiling.names[[m.kind for m in self.members].index(k)]
                why = "the time was over before it had an answer" if answer is None else answer.why
                raise ComputationError(
                    f"module {name}: {why}", "module-failed", name, hint="try smaller modules"
                )
            self.searching += answer.seconds
        return [answer for answer in found if answer is not None]

    def _again(
        self, number: int, answers: list[ModuleAnswer], now: Fit
    ) -> tuple[list[ModuleAnswer], bool]:
        """Return the answers after a search for moved targets, and whether one has changed."""
        wide = now.gaps > self.settings.gap_mm
        chosen = sorted(
            {
                member.kind
                for member, points in zip(self.members, self.tiling.modules, strict=True)
                if wide[points].any()
            }
        )
        targets = averaged(now.targets[self.tiling.modules], self.members, self.kinds)
        jobs = [self._job(k, targets[k], 0, answers[k]) for k in chosen]
        after, changed = list(answers), False
        for k, answer in zip(chosen, self.asking.answers(number, jobs), strict=True):
            if answer is None:
                continue
            self.searching += answer.seconds
            old = _away(answers[k], targets[k], self.weights[k])
            if answer.grid is not None and _away(answer, targets[k], self.weights[k]) < old:
                after[k], changed = answer, True
        return after, changed

    def _job(
        self, kind: int, targets: Array, corrections: int, before: ModuleAnswer | None = None
    ) -> ModuleJob:
        settings = self.settings
        return ModuleJob(
            targets=np.round(targets, 6).tolist(),
            normals=np.round(self.normals[kind], 9).tolist(),
            cells=self.tiling.cells,
            weights=self.weights[kind].tolist(),
            material=self.material.model_dump(mode="json"),
            engine=settings.engine,
            model=settings.model,
            ratio=settings.ratio,
            grid=None if before is None else before.grid,
            shift=None if before is None else before.shift,
            corrections=corrections,
        )

    def _fit(self, answers: Sequence[ModuleAnswer], targets: Array) -> Fit:
        shapes = np.array([answer.joints for answer in answers])
        return fit(self.tiling, self.members, shapes, targets)

    def _tiled(
        self, best: Fit, answers: Sequence[ModuleAnswer], history: list[tuple[float, float]]
    ) -> Tiled:
        settings, warnings = self.settings, list(self.tiling.warnings)
        unchecked = [k for k, answer in enumerate(answers) if not answer.checked]
        if unchecked:
            text = (
                f"finite elements have no answer for {len(unchecked)} of {len(answers)} kinds of "
                f"modules ({answers[unchecked[0]].why}): figures of these are by the engine"
            )
            warnings.append(Message("tile-unchecked", "modules", text))
        if best.gap_mm > settings.gap_mm:
            text = (
                f"the largest gap is {best.gap_mm:.2f} mm, above {settings.gap_mm:g} mm: more "
                "rounds or smaller modules may close it"
            )
            warnings.append(Message("tile-gap", "modules", text))
        grids = []
        for answer in answers:
            assert answer.grid is not None
            grid = grid_from_dict(answer.grid, materials={self.material.name: self.material})
            grids.append(replace(grid, material=settings.material))
        return Tiled(
            self.tiling,
            settings,
            self.members,
            tuple(grids),
            tuple(answers),
            best,
            tuple(history),
            monotonic() - self.begun,
            self.searching,
            tuple(warnings),
        )


class _Asking:
    """Who answers jobs: the folder, or workers whose answers are then kept there."""

    def __init__(
        self,
        workers: Workers,
        folder: Path | None,
        progress: Progress,
        cancel: Cancel | None,
        until: float,
    ) -> None:
        self.workers, self.report, self.cancel, self.until = workers, progress, cancel, until
        self.folder = None if folder is None else folder / "work"
        if self.folder is not None:
            try:
                self.folder.mkdir(parents=True, exist_ok=True)
            except OSError as error:
                raise InputError(f"{folder}: cannot be made ({error.strerror})") from error
            for half in self.folder.glob(".*.json"):
                half.unlink(missing_ok=True)

    def answers(
        self, number: int, jobs: Sequence[ModuleJob], final: bool = False
    ) -> list[ModuleAnswer | None]:
        """Return the answers to jobs, in their order; None where the time was over before.

        Args:
            number: of the round.
            jobs: what is wanted.
            final: whether nothing can be left out, so that the time does not count.
        """
        found = [self._kept(job) for job in jobs]
        waiting = [k for k, answer in enumerate(found) if answer is None]
        running: dict[Future[ModuleAnswer], tuple[int, int]] = {}
        self._said(number, found)
        try:
            while waiting or running:
                stop_if(self.cancel)
                if not final and monotonic() > self.until:
                    break
                while waiting and len(running) < AHEAD * max(self.workers.count(), 1):
                    k = waiting.pop(0)
                    running[self.workers.submit(jobs[k])] = k, 1
                finished, _ = wait(running, timeout=PATIENCE, return_when=FIRST_COMPLETED)
                if not finished:
                    self.workers.check()
                for future in finished:
                    k, tries = running.pop(future)
                    answer = _answer(future)
                    if answer is None and tries < TRIES:
                        running[self.workers.submit(jobs[k])] = k, tries + 1
                        continue
                    found[k] = answer or ModuleAnswer(None, why=f"its worker died, {TRIES} times")
                    self._keep(jobs[k], found[k])
                    self._said(number, found)
        finally:
            for future in running:
                future.cancel()
        return found

    def _said(self, number: int, found: Sequence[ModuleAnswer | None]) -> None:
        done = sum(answer is not None for answer in found)
        self.report(Stage(number, done, len(found)))

    def _kept(self, job: ModuleJob) -> ModuleAnswer | None:
        """Return the answer that an earlier run kept; None if there is none, or a torn file."""
        if self.folder is None:
            return None
        try:
            return ModuleAnswer(**json.loads(read_text(self.folder / f"{job.key}.json")))
        except (InputError, ValueError, TypeError, RecursionError):
            return None

    def _keep(self, job: ModuleJob, answer: ModuleAnswer | None) -> None:
        """Keep an answer; what failed is tried again another time."""
        if self.folder is None or answer is None or answer.grid is None:
            return
        with replacing(self.folder / f"{job.key}.json") as temporary:
            temporary.write_text(json.dumps(asdict(answer)) + "\n", "utf-8")


def _answer(future: "Future[ModuleAnswer]") -> ModuleAnswer | None:
    """Return the answer; None if the worker died."""
    try:
        return future.result()
    except TimeoutError:
        return ModuleAnswer(None, why="took too long and was given up")
    except Exception:
        return None


def _away(answer: ModuleAnswer, targets: Array, counts: Array) -> float:
    """Return the weighted mean square (mm2) of joints from targets (K, 3) in the best place."""
    joints = np.array(answer.joints)
    square = ((Place.fitting(joints, targets)(joints) - targets) ** 2).sum(axis=1)
    return float(square @ counts / counts.sum())


def _fitting(tiling: Tiling, training: TrainingRange) -> None:
    """Raise InputError where modules are of a size that the material has not been learnt in."""
    lengths = arcs(tiling.targets, tiling.normals[tiling.modules], tiling.lattice.beams)
    least, most = training.beam_length
    short, long = float(lengths.min()), float(lengths.max())
    if least <= short and long <= most:
        return
    wrong = long if long > most else short
    name = tiling.names[int(np.argwhere((lengths == wrong).any(axis=1))[0, 0])]
    text = (
        f"module {name} has a beam of {wrong:.0f} mm; beams of {least:g} to {most:g} mm are learnt"
    )
    if long / short > most / least:
        text += ". Modules differ too much: draw a quad mesh whose quads are of one size"
    else:
        factor = np.sqrt(least / short * most / long)
        size = factor * float(lengths.mean()) * float(np.mean(tiling.cells))
        text += f". Modules of about {size:.0f} mm (--size {size:.0f}) are right here"
    raise InputError(text, "module-size", name)

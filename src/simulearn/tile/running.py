"""Tiling: every kind of module searched for, then shared borders brought together, in rounds.

Searches are jobs of their own, so they go to processes or to a cluster. Each answer is a file by
the name of its job, and what comes next follows from the answers alone: a run that was stopped
goes on from the answers that are there.
"""

from collections.abc import Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from pathlib import Path
from time import monotonic

import numpy as np
from numpy.typing import NDArray

from simulearn.dataset import local_workers
from simulearn.dataset.workers import Workers
from simulearn.errors import Cancel, ComputationError, InputError, Message
from simulearn.files import cores
from simulearn.grid import TrainingRange, grid_from_dict
from simulearn.material import Material, load_material
from simulearn.rigid import Place
from simulearn.simulate import engine as engine_of
from simulearn.simulate.calls import warm
from simulearn.simulate.learned import Learned
from simulearn.tile.alike import Member, alike, averaged
from simulearn.tile.borders import Fit, fit, pressed, weights
from simulearn.tile.flatten import arcs
from simulearn.tile.inset import with_inset
from simulearn.tile.jobs import Jobs
from simulearn.tile.patches import Tiling
from simulearn.tile.searching import ModuleAnswer, ModuleJob, run
from simulearn.tile.tiled import DEFAULT, Progress, Settings, Stage, Tiled

Array = NDArray[np.float64]

LONGEST = 600.0  # s, after which a search is given up


def tile(
    tiling: Tiling,
    settings: Settings = DEFAULT,
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
    if settings.inset_mm is None:
        settings = replace(settings, inset_mm=material.section.width / 2)
    tiling = with_inset(tiling, settings.inset_mm or 0.0)
    _fitting(tiling, engine.training.of(material))
    warm("fea")
    warm(settings.engine, settings.model)
    kinds, members = alike(tiling.targets, tiling.lattice, settings.alike_mm)
    until = np.inf if settings.seconds is None else begun + settings.seconds
    team = workers or local_workers(min(cores(), len(kinds)), LONGEST, run)
    with team as ready:
        jobs = Jobs(ready, None if folder is None else Path(folder), progress, cancel, until)
        return _Rounds(tiling, settings, material, kinds, members, jobs, begun).run()


class _Rounds:
    """The rounds of a tiling."""

    def __init__(
        self,
        tiling: Tiling,
        settings: Settings,
        material: Material,
        kinds: Array,
        members: tuple[Member, ...],
        jobs: Jobs,
        begun: float,
    ) -> None:
        self.tiling, self.settings, self.members = tiling, settings, members
        self.material, self.jobs, self.begun = material, jobs, begun
        self.weights = weights(tiling, members, len(kinds))
        firsts = [next(k for k, m in enumerate(members) if m.kind == n) for n in range(len(kinds))]
        self.normals = tiling.target_normals[firsts]
        self.searching = 0.0
        self.kinds = kinds

    def run(self) -> Tiled:
        answers = self._first()
        now = self._fit(answers, self.tiling.points)
        best, kept, history = now, answers, [(now.gap_mm, now.error_mm)]
        self.jobs.report(Stage(0, 1, 1, now.gap_mm, now.error_mm))
        for number in range(1, self.settings.rounds + 1):
            if now.gap_mm <= self.settings.gap_mm or monotonic() > self.jobs.until:
                break
            answers, changed = self._again(number, answers, now)
            if not changed:
                break
            now = self._fit(answers, now.targets)
            history.append((now.gap_mm, now.error_mm))
            self.jobs.report(Stage(number, 1, 1, now.gap_mm, now.error_mm))
            if now.gap_mm < best.gap_mm:
                best, kept = now, answers
        return self._tiled(best, kept, history)

    def _first(self) -> list[ModuleAnswer]:
        """Return the answers of the first search of every kind."""
        jobs = [self._job(k, t, self.weights[k], 1) for k, t in enumerate(self.kinds)]
        found = self.jobs.answers(0, jobs, final=True)
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
        targets = averaged(self.tiling.wanted(now.targets), self.members, self.kinds)
        counts = pressed(self.tiling, self.members, self.weights, now.gaps / self.settings.gap_mm)
        jobs = [self._job(k, targets[k], counts[k], 0, answers[k]) for k in chosen]
        after, changed = list(answers), False
        for k, answer in zip(chosen, self.jobs.answers(number, jobs), strict=True):
            if answer is None:
                continue
            self.searching += answer.seconds
            old = _away(answers[k], targets[k], counts[k])
            if answer.grid is not None and _away(answer, targets[k], counts[k]) < old:
                after[k], changed = answer, True
        return after, changed

    def _job(
        self,
        kind: int,
        targets: Array,
        counts: Array,
        corrections: int,
        before: ModuleAnswer | None = None,
    ) -> ModuleJob:
        settings = self.settings
        return ModuleJob(
            targets=np.round(targets, 6).tolist(),
            normals=np.round(self.normals[kind], 9).tolist(),
            cells=self.tiling.cells,
            weights=np.round(counts, 6).tolist(),
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


def _away(answer: ModuleAnswer, targets: Array, counts: Array) -> float:
    """Return the weighted mean square (mm2) of joints from targets (K, 3) in the best place."""
    joints = np.array(answer.joints)
    square = ((Place.fitting(joints, targets)(joints) - targets) ** 2).sum(axis=1)
    return float(square @ counts / counts.sum())


def _fitting(tiling: Tiling, training: TrainingRange) -> None:
    """Raise InputError where modules are of a size that the material has not been learnt in."""
    lengths = arcs(tiling.targets, tiling.target_normals, tiling.lattice.beams)
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
        other = f"--size {size:.0f}"
        option = "draw quads of that size, or give --cells" if tiling.drawn else other
        text += f". Modules of about {size:.0f} mm are right here: {option}"
    raise InputError(text, "module-size", name)

"""The engine `learned`: a trained model answers, many grids of one topology in one call."""

import time
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from simulearn.collisions import Collision, find_all
from simulearn.errors import Cancel, InputError, Message, stop_if
from simulearn.grid import Grid, TrainingRange, make
from simulearn.learn.common.bundle import Bundle, bundle_of
from simulearn.learn.common.model import Frames, last_frame
from simulearn.material import Material
from simulearn.schedule import FRAMES, Snap
from simulearn.simulate.checked import Checked, check_all
from simulearn.simulate.colliding import collision_warnings
from simulearn.simulate.designs import designs_of
from simulearn.simulate.engines import in_order
from simulearn.simulate.preparing import prepare
from simulearn.simulate.result import Failure, Outcome, Result
from simulearn.simulate.simulator import Progress

BATCH = 256  # designs in one call of the model, so that memory stays bounded
HINT = "finite elements may have an answer"
MATERIAL_HINT = "simulate by finite elements, or train a model for this material"


@dataclass(frozen=True)
class Learned:
    """A Simulator whose answers come from a learned model.

    Attributes:
        bundle: the model and what is known of it.
        name: of the engine.
    """

    bundle: Bundle
    name: str = "learned"

    @classmethod
    def of(cls, model: Path | str) -> "Learned":
        """Return the engine of a model's folder or name, its weights loaded.

        Raises:
            InputError: there is no such model, or it is damaged.
        """
        bundle = bundle_of(model)
        return cls(_loaded(bundle.path.resolve(), bundle.identity.digest))

    @property
    def training(self) -> TrainingRange:
        """The sizes of the designs that the model has learnt."""
        return self.bundle.card.range

    @property
    def material(self) -> Material:
        """The material system that the model has learnt."""
        return self.bundle.card.material

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
        """Yield (place in grids, outcome) after each batch; see `Simulator.simulate`."""
        groups: dict[Any, list[tuple[int, Checked]]] = defaultdict(list)
        for k, checked in enumerate(check_all(grids, self.training)):
            if isinstance(checked, Failure):
                yield k, checked
            elif wrong := self._not_learnt(checked.material):
                yield k, Failure.of(checked.given, wrong, MATERIAL_HINT)
            else:
                grid = checked.grid
                topology = len(grid.joints), grid.fixed, grid.beams.tobytes()
                groups[topology, checked.material.digest].append((k, checked))
        done, total = 0, sum(map(len, groups.values()))
        for members in groups.values():
            for first in range(0, len(members), BATCH):
                batch = members[first : first + BATCH]
                stop_if(cancel)
                yield from self._answers(batch)
                done += len(batch)
                if progress is not None:
                    progress(FRAMES * done, FRAMES * total)

    def warm(self) -> None:
        """Compile what the first simulation would wait for, of one design and of many."""
        prepare(self.bundle.model)
        small = make("flat", (1, 1), 50.0)
        for count in (1, 4):
            designs = designs_of([small] * count, self.material)
            frames = self.bundle.model.rollout(designs)
            find_all(frames.joints, frames.sections, designs.beams, designs.actuators)
            last_frame(self.bundle.model, designs)

    def _answers(self, batch: Sequence[tuple[int, Checked]]) -> Iterator[tuple[int, Outcome]]:
        """Yield the outcomes of designs of one topology."""
        prepare(self.bundle.model)
        begun = time.perf_counter()
        designs = designs_of([one.grid for _, one in batch], batch[0][1].material)
        frames = self.bundle.model.rollout(designs)
        seconds = (time.perf_counter() - begun) / len(batch)
        collisions = find_all(frames.joints, frames.sections, designs.beams, designs.actuators)
        for t, (k, one) in enumerate(batch):
            yield k, self._outcome(one, frames, t, seconds, collisions[t])

    def _outcome(
        self,
        one: Checked,
        frames: Frames,
        t: int,
        seconds: float,
        collisions: tuple[Collision, ...],
    ) -> Outcome:
        joints, sections = frames.joints[t], frames.sections[t]
        if not (frames.converged[t] and np.isfinite(joints).all() and np.isfinite(sections).all()):
            message = f'the model "{self.bundle.card.name}" has no answer for this grid'
            return Failure(one.given, "no-answer", "grid", message, HINT)
        snaps = () if frames.snaps is None else tuple(frames.snaps[t])
        # The bound was fitted to designs that do not snap.
        bound = None if snaps or frames.bound_mm is None else float(frames.bound_mm[t])
        return Result(
            grid=one.grid,
            engine=self.name,
            joints=joints,
            beams=sections,
            stress=None if frames.stress is None else frames.stress[t],
            seconds=seconds,
            material=one.material.identity,
            model=self.bundle.identity,
            stable=frames.stable is None or bool(frames.stable[t]),
            bound_mm=bound,
            snaps=snaps,
            warnings=(
                *one.warnings,
                *self._beyond_family(one.material),
                *_left_balance(frames, t),
                *_after_snap(snaps),
                *_beyond(bound, one.grid),
                *collision_warnings(collisions, bound),
            ),
            collisions=collisions,
            record={"kind": self.bundle.card.kind},
        )

    def require(self, material: Material) -> None:
        """Raise InputError where a material is not the one that the model has learnt."""
        if wrong := self._not_learnt(material):
            raise wrong

    def remark(self, material: Material) -> Message | None:
        """Return why a material has no answer, or that it is outside what was learnt; else None."""
        if wrong := self._not_learnt(material):
            return Message(wrong.code, wrong.where, str(wrong))
        return next(self._beyond_family(material), None)

    def _not_learnt(self, material: Material) -> InputError | None:
        learnt = self.material
        if material.physics == learnt.physics:  # whatever it is called
            return None
        family = getattr(self.bundle.model, "learnt", None)
        why = "" if family is None else family.wrong(material, learnt)
        if why is None:
            return None
        text = (
            f"material is {material.identity}; "
            f'the model "{self.bundle.card.name}" has learnt {learnt.identity}'
        )
        if why:
            text += f" and others like it, but {why}"
        return InputError(text, "material-not-learnt", "material")

    def _beyond_family(self, material: Material) -> Iterator[Message]:
        """Yield a warning where a material is outside what was learnt."""
        family = getattr(self.bundle.model, "learnt", None)
        remark = None if family is None else family.remark(material)
        if remark is not None:
            yield Message(
                "material-beyond",
                "material",
                f"the material is outside what the model has learnt ({remark}): its error bound is "
                "wider, and less sure",
            )


@lru_cache(maxsize=8)
def _loaded(path: Path, digest: str) -> Bundle:
    """Return a folder's bundle with its weights in memory; the same one (digest) is read once."""
    bundle = bundle_of(path)
    bundle.model  # noqa: B018  (reads the weights, or raises)
    return bundle


def _left_balance(frames: Frames, t: int) -> Iterator[Message]:
    """Yield a warning where a design has left an unstable balance."""
    if frames.left_balance is not None and frames.left_balance[t]:
        yield Message(
            "unstable-balance",
            "grid",
            "the grid stood on an unstable balance and left it along its softest mode; the "
            "mirrored shape is as likely",
        )


def _after_snap(snaps: Sequence[Snap]) -> Iterator[Message]:
    """Yield a warning where a design snaps: the error of the shape after it is not estimated."""
    if snaps:
        yield Message(
            "bound-after-snap",
            "grid",
            "the grid snaps, and how far off the shape after a snap may be is not estimated; "
            "simulate it by finite elements",
        )


def _beyond(bound: float | None, grid: Grid) -> Iterator[Message]:
    """Yield a warning where the estimated error is so large that the shape says nothing."""
    if bound is not None and bound > grid.dimension / 2:
        yield Message(
            "bound-wide",
            "grid",
            "the grid is so unlike those that the model has learnt that its shape cannot be "
            "trusted; simulate it by finite elements",
        )

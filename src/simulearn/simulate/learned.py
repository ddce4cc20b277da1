"""The engine `learned`: a trained model answers, many grids of one topology in one call."""

import time
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from simulearn.errors import ComputationError, InputError
from simulearn.grid import Grid, TrainingRange
from simulearn.learn.common.bundle import Bundle, bundle_of
from simulearn.learn.common.model import Designs, Frames
from simulearn.material import load_material
from simulearn.simulate.engines import checked_grid
from simulearn.simulate.result import FRAMES, Result
from simulearn.simulate.simulator import Progress


@dataclass(frozen=True)
class Learned:
    """A Simulator that asks a learned model.

    Attributes:
        bundle: the model and what is known of it.
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
        bundle.model  # noqa: B018  (what is wrong with it is told now)
        return cls(bundle)

    @property
    def training(self) -> TrainingRange:
        """What the model has seen in training; `validate` warns of grids outside."""
        return self.bundle.card.range

    def simulate(self, grids: Sequence[Grid], progress: Progress | None = None) -> list[Result]:
        """Return the results of the grids, in their order; see `Simulator.simulate`."""
        checked = [checked_grid(grid)[0] for grid in grids]
        card, groups = self.bundle.card, defaultdict(list)
        for k, grid in enumerate(checked):
            material = load_material(grid.material)
            if material.physics != card.material.physics:
                raise InputError(
                    f'material is {material.identity}; the model "{card.name}" has learnt '
                    f"{card.material.identity}"
                )
            groups[len(grid.joints), grid.fixed, grid.beams.tobytes()].append(k)
        results: dict[int, Result] = {}
        for members in groups.values():
            begun = time.perf_counter()
            frames = self.bundle.model.rollout(_designs([checked[k] for k in members]))
            seconds = (time.perf_counter() - begun) / len(members)
            for t, k in enumerate(members):
                results[k] = self._result(checked[k], frames, t, seconds)
                if progress is not None:
                    progress(FRAMES * len(results), FRAMES * len(checked))
        return [results[k] for k in range(len(checked))]

    def _result(self, grid: Grid, frames: Frames, t: int, seconds: float) -> Result:
        card = self.bundle.card
        joints, sections = frames.joints[t], frames.sections[t]
        if not (frames.converged[t] and np.isfinite(joints).all() and np.isfinite(sections).all()):
            raise ComputationError(
                f'the model "{card.name}" has no answer for this grid; ask --engine fea'
            )
        record: dict[str, Any] = {"model": card.name, "kind": card.kind}
        if frames.bound_mm is not None:
            record["bound_mm"] = float(frames.bound_mm[t])
        return Result(
            grid=grid,
            engine=self.name,
            joints=joints,
            beams=sections,
            stress=None if frames.stress is None else frames.stress[t],
            seconds=seconds,
            record=record,
        )


def _designs(grids: Sequence[Grid]) -> Designs:
    """Return grids of one topology as designs."""
    return Designs(
        beams=grids[0].beams,
        fixed=grids[0].fixed,
        flat=np.stack([grid.joints for grid in grids]),
        actuators=np.stack([grid.actuators for grid in grids]),
        material=load_material(grids[0].material),
        reference=grids[0].material,
    )

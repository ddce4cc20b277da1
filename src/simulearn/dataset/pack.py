"""Packing a generated folder into one HDF5 file; the schema is in `docs/data-format.md`.

The file depends on the trials only: not on the order in which they were computed, how often the
run was interrupted, or how long it took.
"""

import json
from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from simulearn.dataset.config import Config
from simulearn.dataset.generate import Folder
from simulearn.dataset.packed import SCHEMA, digest
from simulearn.dataset.trial import SOLVER_VERSION, StoredTrial, TrialJob, is_whole, read_trial
from simulearn.errors import InputError
from simulearn.files import replacing
from simulearn.grid import Grid, KindDesign

POSITION = 0.005  # mm
STRESS = 1e-5  # MPa; more where the largest stress needs it
LARGEST = 2**15 - 1

UNITS = {
    "beams": "joint indices; beam, (start, end)",
    "flat": "mm; trial, joint, xy",
    "actuators": "signed ratio, + top; trial, beam",
    "numbers": "of the trial in the set; trial",
    "test": "1 if kept for testing; trial",
    "records": "JSON, the solver's record; trial",
    "materials": "JSON, the material system; trial",
    "kinds": "name of the kind of grid; trial",
    "joints_first": "step mm; trial, joint, corner, xyz; frame 0",
    "joints_increments": "step mm; trial, frame 1 to 11, joint, corner, xyz; from the last frame",
    "sections_first": "step mm; trial, beam, section, corner, xyz; frame 0",
    "sections_increments": "step mm; trial, frame 1 to 11, beam, section, corner, xyz",
    "stress": "step MPa; trial, frame, beam, section, corner, component (11 22 33 12 13 23)",
}


@dataclass(frozen=True)
class _Member:
    k: int
    design: KindDesign
    trial: StoredTrial

    @property
    def grid(self) -> Grid:
        return self.design.grid


def pack(
    folder: Path | str,
    output: Path | str,
    partial: bool = False,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> int:
    """Pack a folder and return how many trials the file holds.

    Args:
        folder: that `generate` filled.
        output: the HDF5 file.
        partial: pack what is there, though the run is not finished.
        progress: called with (trials read, trials in all).

    Raises:
        InputError: it is no such folder, it is not complete, or a trial cannot be read.
    """
    source = Folder(folder)
    config = source.config
    groups: dict[tuple[Any, ...], list[_Member]] = defaultdict(list)
    failures: list[tuple[int, str]] = []
    redraws = missing = 0
    for k in range(config.trials):
        progress(k, config.trials)
        design = config.design(k)
        grid = design.grid
        redraws += design.redraws
        key = TrialJob.of(design, config).key
        if is_whole(source.trial(key)):
            member = _Member(k, design, read_trial(source.trial(key)))
            groups[len(grid.joints), grid.fixed, tuple(grid.beams.ravel().tolist())].append(member)
        elif (why := source.why(key)) is not None:
            failures.append((k, why))
        else:
            missing += 1
    if missing and not partial:
        raise InputError(
            f"{folder}: {missing} of {config.trials} trials are not there yet, or are torn; "
            "generate them first, or pack only what is there"
        )
    if not groups:
        raise InputError(f"{folder}: holds no trial yet")
    progress(config.trials, config.trials)
    with replacing(output) as temporary, h5py.File(temporary, "w") as file:
        _describe(file, config, failures, redraws)
        for number, members in enumerate(groups.values()):
            _write(file.create_group(f"topologies/{number:04d}"), config, members)
        file.attrs["sha256"] = digest(file)
    return sum(map(len, groups.values()))


def _describe(
    file: h5py.File, config: Config, failures: list[tuple[int, str]], redraws: int
) -> None:
    file.attrs["schema"] = SCHEMA
    file.attrs["solver_version"] = SOLVER_VERSION
    file.attrs["config"] = config.model_dump_json()
    file.attrs["material"] = config.material.model_dump_json()
    file.attrs["failures"] = json.dumps(failures)
    file.attrs["redraws"] = redraws


def _write(group: h5py.Group, config: Config, members: Sequence[_Member]) -> None:
    group.attrs["fixed"] = members[0].grid.fixed
    group.attrs["material"] = config.rules.material
    put = _Writer(group)
    put("beams", members[0].grid.beams.astype(np.int32))
    put("flat", np.stack([m.grid.joints for m in members]))
    put("actuators", np.stack([m.grid.actuators for m in members]))
    put("numbers", np.array([m.k for m in members], np.int32))
    put("test", np.array([config.is_test(m.k) for m in members], np.uint8))
    records = [json.dumps(m.trial.record, sort_keys=True) for m in members]
    put("records", np.array(records, dtype=h5py.string_dtype()))
    if config.kinds is not None:
        materials = [m.design.material.model_dump_json() for m in members]
        put("materials", np.array(materials, dtype=h5py.string_dtype()))
        put("kinds", np.array([m.design.kind for m in members], dtype=h5py.string_dtype()))
    put.positions("joints", [m.trial.joints for m in members])
    put.positions("sections", [m.trial.beams for m in members])
    put.stress([m.trial.stress for m in members])


@dataclass(frozen=True)
class _Writer:
    group: h5py.Group

    def __call__(self, name: str, values: NDArray[Any], step: float | None = None) -> None:
        many = values.ndim > 2
        options = {"compression": "gzip", "compression_opts": 6, "shuffle": True} if many else {}
        if many:  # chunks of a few trials: quick to read whole, and any trial alone
            options["chunks"] = (min(len(values), 16), *values.shape[1:])
        item = self.group.create_dataset(name, data=values, track_times=False, **options)
        item.attrs["axes"] = UNITS[name]
        if step is not None:
            item.attrs["step"] = step

    def positions(self, name: str, trials: Sequence[NDArray[np.float32]]) -> None:
        """Write positions as whole steps: the first frame, then the increments."""
        steps = np.rint(np.stack(trials).astype(np.float64) / POSITION).astype(np.int32)
        moves = np.diff(steps, axis=1)
        # A large grid may hang down by more than 16 bits hold (164 mm) in its first frame.
        fits = abs(moves).max(initial=0) <= LARGEST
        self(f"{name}_first", steps[:, 0], POSITION)
        self(f"{name}_increments", moves.astype(np.int16 if fits else np.int32), POSITION)

    def stress(self, trials: Sequence[NDArray[np.float32]]) -> None:
        """Write stresses as whole steps."""
        values = np.stack(trials).astype(np.float64)
        step = max(STRESS, float(abs(values).max()) / LARGEST)
        self("stress", np.rint(values / step).astype(np.int16), step)

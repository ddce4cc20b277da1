"""One trial of a data set: the job of computing it, its key, and its file.

The key is a hash of everything that the outcome depends on: design, material, solver settings and
the version of the solver. The file holds arrays of single precision (a hundred millimetres to
less than 1e-5 mm).
"""

import hashlib
import io
import json
import zipfile
import zlib
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from simulearn.dataset.config import Config, Solver
from simulearn.errors import ComputationError, InputError
from simulearn.grid import Grid, KindDesign, grid_from_dict, grid_to_dict
from simulearn.material import Material

# Raise it when the solver answers differently, so that older trials are not taken for new ones.
SOLVER_VERSION = 2

Array = NDArray[np.float32]


@dataclass(frozen=True)
class TrialJob:
    """What a worker computes, in plain data that travels to other machines.

    Attributes:
        grid: the design, as in a grid file.
        material: the material system.
        solver: mesh and convergence settings.
    """

    grid: dict[str, Any]
    material: dict[str, Any]
    solver: dict[str, Any]

    @classmethod
    def of(cls, design: KindDesign, config: Config) -> "TrialJob":
        """Return the job of a design."""
        return cls(
            grid_to_dict(design.grid),
            design.material.model_dump(mode="json"),
            config.solver.model_dump(mode="json"),
        )

    @property
    def key(self) -> str:
        """The name under which the outcome is kept."""
        contents = {"version": SOLVER_VERSION, **asdict(self)}
        text = json.dumps(contents, sort_keys=True, separators=(",", ":"))
        return hashlib.sha256(text.encode()).hexdigest()[:32]


@dataclass(frozen=True)
class TrialOutcome:
    """The outcome of a job.

    Attributes:
        outcome: "done", or why there is no result: "failed" (the solver finds none, and would
            not another time) or "broken" (anything else).
        content: of the trial's file.
        reason: why there is none.
        seconds: time the solver took.
    """

    outcome: Literal["done", "failed", "broken"]
    content: bytes = b""
    reason: str = ""
    seconds: float = 0.0


@dataclass(frozen=True, eq=False)
class StoredTrial:
    """A trial read from its file; shapes and units as in `fea.Trial`."""

    grid: Grid
    joints: Array
    beams: Array
    stress: Array
    record: dict[str, Any]
    seconds: float


def run(job: TrialJob) -> TrialOutcome:
    """Simulate a design; whatever goes wrong is an outcome, too."""
    from simulearn.fea import simulate_grid

    try:
        grid, solver = grid_from_dict(job.grid, paths=True), Solver.model_validate(job.solver)
        material = Material.model_validate(job.material)
        trial = simulate_grid(grid, material, solver.layout, solver.control)
    except (ComputationError, InputError) as error:
        return TrialOutcome("failed", reason=str(error))
    except Exception as error:
        return TrialOutcome("broken", reason=f"{type(error).__name__}: {error}")
    arrays = {name: getattr(trial, name) for name in ("joints", "beams", "stress")}
    if not all(np.isfinite(array).all() for array in arrays.values()):
        return TrialOutcome("failed", reason="the result is not finite")
    buffer = io.BytesIO()
    np.savez_compressed(
        buffer,
        grid=json.dumps(job.grid),
        record=json.dumps(trial.record),
        seconds=trial.seconds,
        **{name: array.astype(np.float32) for name, array in arrays.items()},
    )
    return TrialOutcome("done", buffer.getvalue(), seconds=trial.seconds)


def is_whole(path: Path) -> bool:
    """Return whether a trial's file is there and complete, by the checksums that it holds."""
    try:
        with zipfile.ZipFile(path) as file:
            return bool(file.namelist()) and file.testzip() is None
    except (OSError, ValueError, EOFError, zipfile.BadZipFile, zlib.error):
        return False


def read_trial(path: Path) -> StoredTrial:
    """Read a trial from its file.

    Raises:
        InputError: it is not such a file.
    """
    try:
        # Opened here, since NumPy leaves a broken file open.
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
            return StoredTrial(
                grid_from_dict(json.loads(file["grid"].item()), paths=True),
                file["joints"],
                file["beams"],
                file["stress"],
                json.loads(file["record"].item()),
                float(file["seconds"]),
            )
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile, zlib.error) as error:
        raise InputError(f"{path}: is not a trial; generate the set again") from error

"""A packed data set: one HDF5 file. The schema is in `docs/data-format.md`.

Trials of one topology lie together, so that they are read as whole arrays. Positions are counted
in steps of a few micrometres: those of the first frame, then the increments from frame to frame,
which fit 16 bits unless a grid hangs down by more than 164 mm at once.
"""

import hashlib
import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import h5py
import numpy as np
from numpy.typing import NDArray

from simulearn.dataset.config import Config, config_of
from simulearn.errors import InputError
from simulearn.fea import COARSE
from simulearn.grid import Grid
from simulearn.material import Material

SCHEMA = "simulearn.dataset/1"

Array = NDArray[np.float32]
Split = Literal["train", "test"]


@dataclass(frozen=True, eq=False)
class Batch:
    """Trials of one topology, T of them; mm, MPa, +z up, the fixed joint at the origin.

    Attributes:
        beams: (B, 2) joint indices, start and end.
        fixed: index of the fixed joint.
        flat: (T, J, 2) float64 joints of the designs.
        actuators: (T, B) float64 signed ratios.
        joints: (T, 12, J, 8, 3) corners of the joints.
        sections: (T, 12, B, 3, 4, 3) corners of the beams' sections.
        stress: (T, 12, B, 4, 4, 6), or None if it was not read.
        numbers: (T,) of the trials in the set.
        test: (T,) whether a trial is kept for testing.
        material: the material system that the trials were computed with, or the one whose family
            theirs are of.
        reference: name or path of it in the designs.
        materials: (T,) of each trial, where they differ.
        kinds: (T,) name of each trial's kind of grid, where there are several.
        mesh: 0 for the default mesh, 1 for a finer one.
        snapped: (T,) whether a trial snaps or leaves an unstable balance on its path.
    """

    beams: NDArray[np.int64]
    fixed: int
    flat: NDArray[np.float64]
    actuators: NDArray[np.float64]
    joints: Array
    sections: Array
    stress: Array | None
    numbers: NDArray[np.int64]
    test: NDArray[np.bool_]
    material: Material
    reference: str
    materials: tuple[Material, ...] = ()
    kinds: tuple[str, ...] = ()
    mesh: float = 0.0
    snapped: tuple[bool, ...] = ()

    def __len__(self) -> int:
        return len(self.numbers)

    def grid(self, t: int) -> Grid:
        """Return the design of trial t of the batch."""
        return Grid(self.flat[t], self.beams, self.actuators[t], self.fixed, self.reference)

    @property
    def dimensions(self) -> NDArray[np.float64]:
        """Grid dimension of each trial: largest distance from the fixed joint to another, mm."""
        return np.linalg.norm(self.flat - self.flat[:, [self.fixed]], axis=-1).max(axis=1)

    def take(self, which: Any) -> "Batch":
        """Return the trials of an index or mask over T."""
        names = ("flat", "actuators", "joints", "sections", "numbers", "test")
        stress = None if self.stress is None else self.stress[which]
        stay = np.arange(len(self))[which]
        lists: dict[str, Any] = {
            name: tuple(values[k] for k in stay)
            for name in ("materials", "kinds", "snapped")
            if (values := getattr(self, name))
        }
        arrays = {name: getattr(self, name)[which] for name in names}
        return replace(self, stress=stress, **lists, **arrays)


@dataclass(frozen=True, eq=False)
class Dataset:
    """A data set in memory.

    Attributes:
        config: what it was generated from.
        sha256: of its contents.
        batches: its trials, by topology.
        attributes: versions and material, as the file has them.
        failures: (trial, reason) of designs without result.
        redraws: how often designs were drawn again.
        records: for each trial by number, the solver's record.
    """

    config: Config
    sha256: str
    batches: list[Batch]
    attributes: dict[str, Any]
    failures: list[tuple[int, str]]
    redraws: int
    records: dict[int, dict[str, Any]]

    def __len__(self) -> int:
        return sum(len(batch) for batch in self.batches)


def read_dataset(path: Path | str, split: Split | None = None, stress: bool = True) -> Dataset:
    """Read a packed data set.

    Args:
        path: of the HDF5 file.
        split: only the trials to train or to test on.
        stress: whether stresses are needed; without them reading is quicker.

    Raises:
        InputError: the file is missing, damaged, or not a data set.
    """
    if not Path(path).is_file():
        raise InputError(f"{path}: there is no such file")
    try:
        with h5py.File(path, "r") as file:
            schema = file.attrs.get("schema")
            if schema != SCHEMA:
                raise InputError(
                    f"{path}: is an HDF5 file, but not a data set of this version "
                    f"(schema {schema!r}; this program reads {SCHEMA!r})"
                )
            material = Material.model_validate_json(file.attrs["material"])
            groups = file["topologies"].values()
            attributes = dict(file.attrs)
            failures = [(int(k), str(why)) for k, why in json.loads(attributes.pop("failures"))]
            records = _records(file)
            config = config_of(json.loads(attributes.pop("config")), str(path))
            mesh = float(config.solver.layout != COARSE)
            batches = [_batch(group, material, split, stress, mesh) for group in groups]
            sha256, redraws = str(attributes.pop("sha256")), int(attributes.pop("redraws"))
    except OSError as error:
        raise InputError(f"{path}: {_why_not(error)}") from error
    except (KeyError, ValueError, IndexError, TypeError) as error:
        raise InputError(f"{path}: is damaged: {error}") from error
    return Dataset(
        config,
        sha256,
        [batch for batch in batches if len(batch)],
        attributes,
        failures,
        redraws,
        records,
    )


def _why_not(error: OSError) -> str:
    """Return why HDF5 cannot open a file."""
    if "unable to lock file" in str(error):
        return (
            "is locked by another program, which may be writing it; close that first, or, where "
            "the disk knows no locks, set HDF5_USE_FILE_LOCKING=FALSE"
        )
    if isinstance(error, PermissionError):
        return f"cannot be read ({error.strerror})"
    return f"is not an HDF5 file, or is damaged ({error})"


def checksum(path: Path | str) -> tuple[str, str]:
    """Return the SHA-256 that a packed set states of its contents, and the one they have."""
    with h5py.File(path, "r") as file:
        return str(file.attrs["sha256"]), digest(file)


def digest(file: h5py.File) -> str:
    """Return the SHA-256 over the names, types, shapes and values of all arrays, and attributes."""
    sha = hashlib.sha256()

    def add(name: str, item: h5py.Group | h5py.Dataset) -> None:
        if isinstance(item, h5py.Dataset):
            values = np.ascontiguousarray(item[...])
            sha.update(f"{name} {values.dtype.str} {values.shape}\n".encode())
            # Texts of varying length are objects: their own bytes count.
            sha.update(b"\n".join(values) if values.dtype == object else values.tobytes())

    for key in sorted(file.attrs):
        if key != "sha256":
            sha.update(f"{key}={file.attrs[key]}\n".encode())
    file.visititems(add)
    return sha.hexdigest()


def _batch(
    group: h5py.Group, material: Material, split: Split | None, stress: bool, mesh: float
) -> Batch:
    test = group["test"][...].astype(bool)
    which = np.flatnonzero(np.ones_like(test) if split is None else test == (split == "test"))
    beams = group["beams"][...].astype(np.int64)
    return Batch(
        beams=beams,
        fixed=int(group.attrs["fixed"]),
        flat=group["flat"][...][which],
        actuators=group["actuators"][...][which],
        joints=_positions(group, "joints", which),
        sections=_positions(group, "sections", which),
        stress=_stress(group["stress"], which) if stress else None,
        numbers=group["numbers"][...].astype(np.int64)[which],
        test=test[which],
        material=material,
        reference=str(group.attrs["material"]),
        materials=tuple(Material.model_validate_json(x) for x in _texts(group, "materials", which)),
        kinds=_texts(group, "kinds", which),
        mesh=mesh,
        snapped=tuple(bool(json.loads(x).get("snaps")) for x in _texts(group, "records", which)),
    )


def _texts(group: h5py.Group, name: str, which: NDArray[np.int64]) -> tuple[str, ...]:
    """Return the texts of some trials, none where a set has none."""
    return tuple(group[name].asstr()[...][which]) if name in group else ()


def _positions(group: h5py.Group, name: str, which: NDArray[np.int64]) -> Array:
    first, steps = group[f"{name}_first"], group[f"{name}_increments"]
    size = float(first.attrs["step"])
    positions = np.empty((len(which), steps.shape[1] + 1, *first.shape[1:]), np.float32)
    at = first[...][which]
    positions[:, 0] = at * size
    moves = steps[...][which]
    for frame in range(moves.shape[1]):
        at += moves[:, frame]
        np.multiply(at, size, out=positions[:, frame + 1], casting="same_kind")
    return positions


def _stress(values: h5py.Dataset, which: NDArray[np.int64]) -> Array:
    return values[...][which].astype(np.float32) * np.float32(values.attrs["step"])


def _records(file: h5py.File) -> dict[int, dict[str, Any]]:
    return {
        int(k): json.loads(text)
        for group in file["topologies"].values()
        for k, text in zip(group["numbers"][...], group["records"].asstr()[...], strict=True)
    }

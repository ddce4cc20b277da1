"""Outcomes in files: JSON for the shape, NPZ for everything.

The JSON form holds what every program can use: design, corners, time, and what qualifies the
answer. The NPZ form adds the stresses, the solver's record and the solid mesh, each array with its
unit written beside it. A design without a result has a JSON form, too: the reason.
"""

import dataclasses
import json
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.collisions import Collision
from simulearn.errors import InputError, Message
from simulearn.files import read_text, replacing
from simulearn.grid import Grid, grid_from_dict, grid_to_dict
from simulearn.material import Identity, name_of
from simulearn.schedule import Snap
from simulearn.simulate.result import FRAMES, Failure, Outcome, Result
from simulearn.simulate.spread import spread_from_dict, spread_to_dict

SCHEMA = "simulearn.result/1"
FAILURE = "simulearn.failure/1"
DIGITS = 6  # of a mm: a nanometre, below what any engine resolves
SOLID = "solid_"
UNITS = {
    "joints": "mm; frame, joint, corner (bottom then top, counter-clockwise), xyz",
    "beams": "mm; frame, beam, section (start, middle, end), "
    "corner (right-bottom, left-bottom, right-top, left-top), xyz",
    "stress": "MPa; frame, beam, section (start, before middle, after middle, end), corner, "
    "component (11 22 33 12 13 23, global axes)",
    "seconds": "s; time the simulation took",
    "record": "JSON; of the solver's work",
    "qualities": "JSON; stable, bound_mm (mm), snaps (released fraction, frame), warnings, "
    "collisions (mm), material and model (name, SHA-256), scatter (mm)",
    "displacements": "mm; frame, node of the solid, xyz",
    "solid_nodes": "mm; node, xyz, in the flat grid",
    "solid_bricks": "node indices; brick, 20 nodes in the order of scikit-fem's ElementHexS2",
    "solid_parts": "what each brick belongs to: (beam, slab along it), or (-1, joint)",
    "solid_slabs": "slabs along each beam",
    "solid_points": "local coordinates 0 to 1 (along, across, up) of the integration points",
    "solid_weights": "of the integration points, adding to one",
    "solid_angle": "rad; direction of printing of each brick, from +x",
    "solid_growth": "strain; brick, integration point, (along, across, thickness)",
    "solid_stress": "MPa; brick, integration point, printed-in normal stress, the same axes",
    "solid_fixed": "node indices; held nodes (lower half of the fixed joint)",
    "solid_joints": "node indices; joint, corner",
    "solid_beams": "node indices; beam, section, corner",
}


def outcome_to_dict(outcome: Outcome) -> dict[str, Any]:
    """Return the machine form of a result or failure."""
    return failure_to_dict(outcome) if isinstance(outcome, Failure) else result_to_dict(outcome)


def failure_to_dict(failure: Failure) -> dict[str, Any]:
    """Return the machine form of a failure, schema `simulearn.failure/1`."""
    return {
        "schema": FAILURE,
        "code": failure.code,
        "where": failure.where,
        "message": failure.message,
        "hint": failure.hint,
    }


def result_to_dict(result: Result) -> dict[str, Any]:
    """Return the machine form of a result, schema `simulearn.result/1`; mm, s."""
    return {
        "schema": SCHEMA,
        "grid": grid_to_dict(result.grid),
        "engine": result.engine,
        "joints": _rounded(result.joints),
        "beams": _rounded(result.beams),
        "seconds": round(float(result.seconds), 3),
        **qualities(result),
    }


def qualities(result: Result) -> dict[str, Any]:
    """Return what qualifies an answer, as plain data."""
    model = result.model
    return {
        "stable": result.stable,
        "bound_mm": None if result.bound_mm is None else round(result.bound_mm, DIGITS),
        "snaps": [dataclasses.asdict(snap) for snap in result.snaps],
        "warnings": [dataclasses.asdict(message) for message in result.warnings],
        "collisions": [_collision_to_dict(one) for one in result.collisions],
        "material": {"name": result.material.name, "digest": result.material.digest},
        "model": None if model is None else {"name": model.name, "digest": model.digest},
        **({} if result.scatter is None else {"scatter": spread_to_dict(result.scatter)}),
    }


def result_from_dict(data: Any, *, paths: bool = False) -> Result:
    """Return the result of its machine form; stresses and mesh are not part of it.

    Args:
        data: such as JSON gives.
        paths: whether the grid's material may be the path of a file; if not, it must be a name.

    Raises:
        InputError: a key is missing or holds the wrong thing; the message names it.
    """
    if not isinstance(data, dict) or data.get("schema") != SCHEMA:
        raise InputError(f'schema: a result has "schema": "{SCHEMA}"')
    for key in ("grid", "engine", "joints", "beams", "seconds"):
        if key not in data:
            raise InputError(f"{key}: is missing", "result", key)
    if not isinstance(data["engine"], str):
        raise InputError("engine: is not a name", "result", "engine")
    if not isinstance(data["seconds"], int | float) or not np.isfinite(data["seconds"]):
        raise InputError("seconds: is not a number", "result", "seconds")
    grid = grid_from_dict(data["grid"], paths=paths)
    return Result(
        grid=grid,
        engine=data["engine"],
        joints=_numbers(data, "joints", (FRAMES, len(grid.joints), 8, 3)),
        beams=_numbers(data, "beams", (FRAMES, len(grid.beams), 3, 4, 3)),
        stress=None,
        seconds=float(data["seconds"]),
        **_qualities(data, grid),
    )


def _qualities(data: dict[str, Any], grid: Grid) -> dict[str, Any]:
    """Return the fields of a result that qualify it; files of earlier versions have none."""
    bound = data.get("bound_mm")
    if not isinstance(data.get("stable", True), bool):
        raise InputError("stable: is not true or false", "result", "stable")
    if bound is not None and not (isinstance(bound, int | float) and np.isfinite(bound)):
        raise InputError("bound_mm: is not a number", "result", "bound_mm")
    model = data.get("model")
    named = {"name": name_of(grid.material), "digest": ""}
    return {
        "material": _read(data, "material", Identity, named),
        "model": None if model is None else _read(data, "model", Identity, None),
        "stable": data.get("stable", True),
        "bound_mm": None if bound is None else float(bound),
        "snaps": _read_all(data, "snaps", Snap),
        "warnings": _read_all(data, "warnings", Message),
        "collisions": tuple(_collision(row) for row in _rows(data, "collisions")),
        "scatter": spread_from_dict(data["scatter"], grid) if data.get("scatter") else None,
    }


def _read(data: dict[str, Any], key: str, kind: type, default: Any) -> Any:
    """Return an object of a type with the fields that a key holds."""
    try:
        return kind(**data.get(key, default))
    except (TypeError, ValueError) as error:
        fields = ", ".join(kind.__annotations__)
        raise InputError(f"{key}: is not an object with {fields}", "result", key) from error


def _read_all(data: dict[str, Any], key: str, kind: type) -> tuple[Any, ...]:
    """Return the objects of a type that a key lists."""
    return tuple(_read({key: row}, key, kind, None) for row in _rows(data, key))


def _rows(data: dict[str, Any], key: str) -> list[Any]:
    """Return the list that a key holds, an empty one where there is none."""
    rows = data.get(key, [])
    if not isinstance(rows, list):
        raise InputError(f"{key}: is not a list", "result", key)
    return rows


def _collision_to_dict(one: Collision) -> dict[str, Any]:
    return {
        "parts": list(one.parts),
        "frame": one.frame,
        "share": round(one.share, DIGITS),
        "first": one.first,
        "depth_mm": round(one.depth_mm, DIGITS),
        "place": [round(x, DIGITS) + 0.0 for x in one.place],
    }


def _collision(row: Any) -> Collision:
    try:
        a, b = (str(part) for part in row["parts"])
        x, y, z = (float(x) for x in row["place"])
        share, depth = float(row["share"]), float(row["depth_mm"])
        return Collision((a, b), int(row["frame"]), share, int(row["first"]), depth, (x, y, z))
    except (KeyError, TypeError, ValueError) as error:
        fields = "parts, frame, share, first, depth_mm and place"
        raise InputError(
            f"collisions: is not a list of objects with {fields}", "result", "collisions"
        ) from error


def write_json(outcome: Outcome, path: Path | str) -> None:
    """Write the machine form of a result or failure."""
    with replacing(path) as temporary:
        temporary.write_text(json.dumps(outcome_to_dict(outcome), allow_nan=False), "utf-8")


def read_json(path: Path | str, *, paths: bool = False) -> Result:
    """Read a result from its JSON file.

    Args:
        path: of the file.
        paths: whether the grid's material may be the path of a file; if not, it must be a name.

    Raises:
        InputError: the file is missing or not a result.
    """
    try:
        return result_from_dict(json.loads(read_text(path)), paths=paths)
    except json.JSONDecodeError as error:
        raise InputError(f"{path}: is not valid JSON: {error}") from error
    except InputError as error:
        if str(path) in str(error):
            raise
        raise InputError(f"{path}: {error}", error.code, error.where) from error


def write_npz(result: Result, path: Path | str) -> None:
    """Write all that a result holds as compressed NumPy arrays; `units` describes them."""
    arrays: dict[str, Any] = {
        "schema": SCHEMA,
        "grid": json.dumps(grid_to_dict(result.grid)),
        "engine": result.engine,
        "joints": result.joints,
        "beams": result.beams,
        "seconds": result.seconds,
        "record": json.dumps(result.record, default=_plain),
        "qualities": json.dumps(qualities(result)),
    }
    if result.stress is not None:
        arrays["stress"] = result.stress
    if result.displacements is not None:
        arrays["displacements"] = result.displacements
    if result.solid is not None:
        for field in dataclasses.fields(result.solid):
            arrays[SOLID + field.name] = getattr(result.solid, field.name)
    arrays["units"] = json.dumps({key: UNITS[key] for key in arrays if key in UNITS})
    with replacing(path) as temporary, temporary.open("wb") as file:
        # NumPy adds an ending of its own to names such as A.NPZ.
        np.savez_compressed(file, **arrays)


def read_npz(path: Path | str, *, paths: bool = False) -> Result:
    """Read a result from its NPZ file.

    Args:
        path: of the file.
        paths: whether the grid's material may be the path of a file; if not, it must be a name.

    Raises:
        InputError: the file is missing or not a result.
    """
    try:
        # Opened here, since NumPy leaves a broken file open.
        with Path(path).open("rb") as stream, np.load(stream, allow_pickle=False) as file:
            arrays = {key: file[key] for key in file.files}
    except FileNotFoundError as error:
        raise InputError(f"{path}: there is no such file") from error
    except (OSError, ValueError, EOFError, AttributeError, zipfile.BadZipFile) as error:
        raise InputError(f"{path}: is not an NPZ file") from error
    solid = {
        k.removeprefix(SOLID): v if v.ndim else v.item()
        for k, v in arrays.items()
        if k.startswith(SOLID)
    }
    try:
        base = result_from_dict(
            {
                **{key: arrays[key].item() for key in ("schema", "engine", "seconds")},
                **{key: arrays[key] for key in ("joints", "beams")},
                "grid": json.loads(arrays["grid"].item()),
                **(json.loads(arrays["qualities"].item()) if "qualities" in arrays else {}),
            },
            paths=paths,
        )
        record = json.loads(arrays["record"].item())
    except (KeyError, ValueError) as error:
        raise InputError(f"{path}: is not a result: {error}") from error
    if solid:
        from simulearn.fea import Solid
    return dataclasses.replace(
        base,
        stress=arrays.get("stress"),
        record=record,
        solid=Solid(**solid) if solid else None,
        displacements=arrays.get("displacements"),
    )


def _rounded(array: NDArray[np.float64]) -> Any:
    return (np.round(array, DIGITS) + 0.0).tolist()  # + 0.0 turns -0.0 into 0.0


def _numbers(data: dict[str, Any], key: str, shape: tuple[int, ...]) -> NDArray[np.float64]:
    try:
        array = np.asarray(data[key], dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError(f"{key}: is not an array of numbers", "result", key) from error
    if array.shape != shape:
        raise InputError(
            f"{key}: has the shape {array.shape}; this grid's is {shape}", "result", key
        )
    if not np.isfinite(array).all():
        raise InputError(f"{key}: holds a number that is not finite", "result", key)
    return array


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    return str(value)

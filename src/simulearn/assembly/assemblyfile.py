"""The assembly file: parts, steps, obstacles and joined pairs; JSON, `simulearn.assembly/1`.

Grids and obstacles are named by paths from the folder of the file.
"""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from simulearn.assembly.assembly import (
    JOINED_MM,
    Assembly,
    Obstacle,
    Part,
    Step,
    rotation,
    wrong,
)
from simulearn.errors import InputError
from simulearn.files import parse_json, path_from, read_text, replacing
from simulearn.grid import Grid, grid_from_dict, grid_to_dict, read_grid
from simulearn.grid.arrays import shown
from simulearn.rigid import Place

SCHEMA = "simulearn.assembly/1"
DIGITS = 9  # of places in a file

Name = Annotated[str, Field(min_length=1, max_length=200)]
Length = Annotated[float, Field(ge=-1e6, le=1e6)]
Point = Annotated[list[Length], Field(min_length=3, max_length=3)]
Pair = Annotated[list[Name], Field(min_length=2, max_length=2)]


class _Entry(BaseModel):
    model_config = ConfigDict(frozen=True, strict=True, extra="forbid", allow_inf_nan=False)


class PlaceEntry(_Entry):
    """A place: rows of a rotation, and a shift in mm."""

    turn: Annotated[list[Point], Field(min_length=3, max_length=3)] = np.eye(3).tolist()
    shift: Point = [0.0, 0.0, 0.0]


class PartEntry(_Entry):
    """A part; its grid is a path, an object, or that of the part it is a copy of."""

    name: Name
    grid: str | dict[str, Any] | None = None
    place: PlaceEntry = PlaceEntry()
    copy_of: Name | None = None


class StepEntry(_Entry):
    """A step."""

    name: str = ""
    parts: list[Name] = []
    seconds: Annotated[float, Field(gt=0, le=3600)] = 1.0
    slide: dict[Name, Point] = {}
    sliding: Literal["before", "during"] = "before"


class ObstacleEntry(_Entry):
    """An obstacle; its file is a path."""

    name: Name
    file: Name
    place: PlaceEntry = PlaceEntry()
    unit: Name | None = None


class AssemblyEntry(_Entry):
    """An assembly as its file holds it."""

    schema_: Literal["simulearn.assembly/1"] = Field(alias="schema")
    name: str = ""
    parts: Annotated[list[PartEntry], Field(min_length=1)]
    steps: list[StepEntry] = []
    obstacles: list[ObstacleEntry] = []
    joined: list[Pair] = []
    joined_mm: Annotated[float, Field(ge=0, le=1000)] = JOINED_MM


ENTRIES: dict[str, type[BaseModel]] = {
    "parts": PartEntry,
    "place": PlaceEntry,
    "steps": StepEntry,
    "obstacles": ObstacleEntry,
}
KEYS = {
    "schema": f'this program reads "{SCHEMA}"',
    "name": "a name is text",
    "parts": "parts are a list of objects with name, grid and place, and in steps a list of names",
    "grid": "a grid is the path of a grid file or a grid itself",
    "copy_of": "it is the name of the part whose grid this one has",
    "place": "a place is an object with turn and shift",
    "turn": "a turn is a rotation: three rows of three numbers",
    "shift": "a shift is [x, y, z] in mm",
    "steps": "steps are a list of objects with parts, seconds and slide",
    "seconds": "seconds are a number more than 0 and at most 3600",
    "slide": "a slide has for a part's name [x, y, z], from where it comes, mm from its place",
    "sliding": 'sliding is "before" or "during"',
    "obstacles": "obstacles are a list of objects with name, file and place",
    "file": "a file is the path of a surface such as wall.stl",
    "unit": "a unit is a name such as mm",
    "joined": "joined is a list of pairs of parts, each [name, name]",
    "joined_mm": "joined_mm is a depth in mm, not negative",
}


def read_assembly(path: Path | str) -> Assembly:
    """Return the assembly in a file.

    Args:
        path: of the file.

    Raises:
        InputError: the file, or a grid that it names, cannot be read or describes none; one line
            says where.
    """
    path = Path(path)
    text = read_text(path)
    try:
        return assembly_from_dict(parse_json(text), path.parent)
    except InputError as error:
        raise InputError(f"{path}: {error}", error.code, error.where) from error


def assembly_from_dict(data: Any, folder: Path | None = None) -> Assembly:
    """Return the assembly that a dict with the file's keys describes.

    Args:
        data: such as JSON gives.
        folder: from which paths are; None: data that no file may be opened for.

    Raises:
        InputError: a key, type, name or number is wrong; one line says which.
    """
    if isinstance(data, dict) and "schema" not in data:
        raise wrong("schema", f"is missing; {KEYS['schema']}")
    try:
        entry = AssemblyEntry.model_validate(data)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        raise InputError(_line(first), "assembly", _place(first["loc"])) from error
    return Assembly(
        parts=_parts(entry.parts, folder),
        steps=tuple(
            Step(
                tuple(step.parts),
                step.seconds,
                {name: (x, y, z) for name, (x, y, z) in step.slide.items()},
                step.sliding,
                step.name,
            )
            for step in entry.steps
        ),
        obstacles=tuple(
            Obstacle(
                one.name,
                _path(one.file, folder, f"obstacles[{k}].file"),
                _placed(one.place, f"obstacles[{k}].place"),
                one.unit,
            )
            for k, one in enumerate(entry.obstacles)
        ),
        joined=tuple((a, b) for a, b in entry.joined),
        joined_mm=entry.joined_mm,
        name=entry.name,
    )


def write_assembly(assembly: Assembly, path: Path | str) -> None:
    """Write an assembly to a file, or leave the old one.

    Args:
        assembly: what to write; grid files that its parts name must be there already.
        path: the file.

    Raises:
        InputError: the file cannot be written.
    """
    data = assembly_to_dict(assembly, Path(path).parent)
    lines = (f"  {json.dumps(key)}: {_lines(value)}" for key, value in data.items())
    with replacing(path) as temporary:
        temporary.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


def assembly_to_dict(assembly: Assembly, folder: Path) -> dict[str, Any]:
    """Return an assembly under the file's keys, with paths from a folder."""
    data: dict[str, Any] = {"schema": SCHEMA, "name": assembly.name}
    data["parts"] = []
    for part in assembly.parts:
        grid = None
        if part.copy_of is None:
            grid = grid_to_dict(part.grid) if part.file is None else path_from(folder, part.file)
        own = {"copy_of": part.copy_of} if grid is None else {"grid": grid}
        data["parts"].append({"name": part.name, **own, "place": _written(part.place)})
    data["steps"] = []
    for step in assembly.steps:
        slides = {name: list(offset) for name, offset in step.slide.items()}
        entry = {"name": step.name, "parts": list(step.parts), "seconds": step.seconds}
        sliding = {"slide": slides, "sliding": step.sliding} if slides else {}
        data["steps"].append(entry | sliding)
    data["obstacles"] = [
        {"name": one.name, "file": path_from(folder, one.file), "place": _written(one.place)}
        | ({} if one.unit is None else {"unit": one.unit})
        for one in assembly.obstacles
    ]
    data["joined"] = [list(pair) for pair in assembly.joined]
    data["joined_mm"] = assembly.joined_mm
    return data


def _lines(value: Any) -> str:
    """Return a value as JSON, each entry of a list on a line of its own."""
    if not isinstance(value, list) or not value:
        return json.dumps(value, allow_nan=False)
    return "[\n" + ",\n".join(f"    {json.dumps(one, allow_nan=False)}" for one in value) + "\n  ]"


def _parts(entries: Sequence[PartEntry], folder: Path | None) -> tuple[Part, ...]:
    """Return the parts; each grid file is read once."""
    read: dict[Path, Grid] = {}
    own: dict[str, tuple[Grid, Path | None]] = {}
    for k, entry in enumerate(entries):
        where = f"parts[{k}].grid"
        if entry.grid is None:
            if entry.copy_of is None:
                raise wrong(where, f"is missing; {KEYS['grid']}, unless copy_of names a part")
            continue
        if entry.copy_of is not None:
            raise wrong(where, "stands beside copy_of; a copy has the grid of its part")
        try:
            if isinstance(entry.grid, dict):
                own[entry.name] = grid_from_dict(entry.grid, paths=folder is not None), None
                continue
            path = _path(entry.grid, folder, where)
            if path not in read:
                read[path] = read_grid(path, paths=True)
            own[entry.name] = read[path], path
        except InputError as error:
            if error.where == where:
                raise
            raise InputError(f"{where}: {error}", error.code, error.where or where) from error
    parts = []
    for k, entry in enumerate(entries):
        source = entry.copy_of or entry.name
        if source not in own:
            made = ", ".join(own) or "none"
            text = f"is {shown(source)}; parts with a grid of their own are {made}"
            raise wrong(f"parts[{k}].copy_of", text)
        grid, file = own[source]
        place = _placed(entry.place, f"parts[{k}].place")
        parts.append(Part(entry.name, grid, place, entry.copy_of, file))
    return tuple(parts)


def _path(name: str, folder: Path | None, where: str) -> Path:
    if folder is None:
        raise wrong(where, "is a path; here a grid is an object, and there are no obstacles")
    return folder / name


def _placed(entry: PlaceEntry, where: str) -> Place:
    return Place(rotation(entry.turn, f"{where}.turn"), np.array(entry.shift, dtype=np.float64))


def _written(place: Place) -> dict[str, Any]:
    turn, shift = (np.round(a, DIGITS) + 0.0 for a in (place.turn, place.shift))
    return {"turn": turn.tolist(), "shift": shift.tolist()}


def _line(error: Any) -> str:
    """Return one of pydantic's errors in our words."""
    place, value = error["loc"], error["input"]
    where = _place(place)
    if not place:
        return f"is {shown(value)}; an assembly is an object with {', '.join(_keys(AssemblyEntry))}"
    names = [k for k in _named(place) if isinstance(k, str)]
    hint = KEYS.get(names[-1]) or KEYS.get(names[-2] if len(names) > 1 else "", "")
    if error["type"] == "missing":
        return f"{where} is missing; {hint}"
    if error["type"] == "extra_forbidden":
        owner = ENTRIES.get(names[-2], AssemblyEntry) if len(names) > 1 else AssemblyEntry
        return f"{where} is not a key here; the keys are {', '.join(_keys(owner))}"
    return f"{where} is {shown(value)}; {hint}"


def _keys(model: type[BaseModel]) -> list[str]:
    return [field.alias or name for name, field in model.model_fields.items()]


def _named(place: Sequence[str | int]) -> list[str | int]:
    """Return a place without what pydantic adds for the kinds that a grid may be."""
    return [k for k in place if k not in ("str", "dict[str,any]", "[key]")]


def _place(place: Sequence[str | int]) -> str:
    """Return a path of keys and indices in words, as `parts[1].place.shift[2]`."""
    keys = _named(place)
    return "".join(f"[{k}]" if isinstance(k, int) else f".{k}" for k in keys).lstrip(".")

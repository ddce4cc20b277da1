"""The grid file: JSON with the keys schema, joints, beams, actuators, fixed and material."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError

from simulearn.errors import InputError
from simulearn.files import is_there, parse_json, read_text, replacing
from simulearn.grid.arrays import KEYS as KEYS_OF_GRID
from simulearn.grid.arrays import shown, whole
from simulearn.grid.grid import Grid
from simulearn.grid.structure import structure_errors
from simulearn.material.material import Material
from simulearn.material.reading import is_name, name_of

SCHEMA = "simulearn.grid/1"
MOST_BYTES = 2**24  # several times the largest grid that can be computed

# The type's bound; the grid's is checked later. Many programs write 1.0 for 1.
Index = Annotated[int, BeforeValidator(whole), Field(ge=0, lt=2**31)]


class GridFile(BaseModel):
    """A grid as its file holds it: mm, indices counted from 0, ratios in [-1, 1]."""

    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)

    schema_: Literal["simulearn.grid/1"] = Field(alias="schema")
    # Lists, since strict validation takes no list for a tuple.
    # A z is allowed here; whether it is 0 is for `Grid` to say.
    joints: list[Annotated[list[float], Field(min_length=2, max_length=3)]]
    beams: list[Annotated[list[Index], Field(min_length=2, max_length=2)]]
    actuators: list[float]
    fixed: Index
    material: Annotated[str, Field(min_length=1)] = "pla-hot-water"


KEYS = {"schema": f'this program reads "{SCHEMA}"', **KEYS_OF_GRID}
WHOLE = f"a grid is an object with the keys {', '.join(KEYS)}"


def read_grid(path: Path | str, *, paths: bool = False) -> Grid:
    """Return the grid in a file.

    Args:
        path: of the file.
        paths: whether its material may be the path of a file, as seen from here or else from the
            grid's folder; if not, it must be a name.

    Raises:
        InputError: the file cannot be read or does not describe a grid; one line says where.
    """
    try:
        data = _data(path)
        return grid_from_dict(
            with_material(data, Path(path).parent) if paths else data, paths=paths
        )
    except InputError as error:
        if str(error).startswith(f"{path}: "):
            raise
        raise InputError(f"{path}: {error}", error.code, error.where) from error


def with_material(data: Any, folder: Path) -> Any:
    """Return a grid's data, its material's path as found from here.

    Args:
        data: such as JSON gives.
        folder: of its file, in which the material is looked for if it is not seen from here.
    """
    path = data.get("material") if isinstance(data, dict) else None
    if not isinstance(path, str) or is_name(path) or is_there(path):
        return data
    beside = str(folder / path)
    return data | {"material": beside} if is_there(beside) else data


def _data(path: Path | str) -> Any:
    """Return what a grid file's JSON holds; what is a drawing or a graph has a code of its own."""
    try:
        text = read_text(path, MOST_BYTES)
    except InputError as error:
        if not isinstance(error.__cause__, UnicodeDecodeError):
            raise
        raise InputError("is not a grid file, which is text", "not-a-grid") from error
    try:
        data = parse_json(text)
    except InputError as error:
        if text.strip() and text.lstrip()[0] not in "{[":
            line = "is not a grid file, which is JSON and begins with {"
            raise InputError(line, "not-a-grid") from error
        raise
    if not isinstance(data, dict) or not {"schema", "joints", "beams"} & data.keys():
        raise InputError(f"is {shown(data)}; {WHOLE}", "not-a-grid")
    return data


def write_grid(grid: Grid, path: Path | str) -> None:
    """Write a grid to a file, completely or not at all.

    Raises:
        InputError: the file cannot be written, or the grid could not be read back.
    """
    data = grid_to_dict(grid)
    grid_from_dict(data, paths=True)
    lines = (f"  {json.dumps(key)}: {json.dumps(value)}" for key, value in data.items())
    with replacing(path) as temporary:
        temporary.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


def grid_from_dict(
    data: Any, *, paths: bool = False, materials: Mapping[str, Material] | None = None
) -> Grid:
    """Return the grid that a dict with the file's keys describes.

    Args:
        data: such as JSON gives.
        paths: whether its material may be the path of a file. From a source that is not trusted
            only names are safe: a path makes the program open what it names.
        materials: those that its material may name besides the ones that come along.

    Raises:
        InputError: a key, type, length, index or number is wrong; one line says which.
    """
    try:
        file = GridFile.model_validate(data)
    except ValidationError as error:
        raise InputError(_line(error.errors(include_url=False)[0]), "grid-file") from error
    if not file.material.isprintable():
        text = f"material is {shown(file.material)}; {KEYS['material']}"
        raise InputError(text, "material", "material")
    if not (paths or is_name(file.material)):
        text = f"material is a path; {shown(file.material)} is not the name of a material system"
        raise InputError(text, "material-path", "material")
    material = (materials or {}).get(file.material, file.material)
    grid = Grid(file.joints, file.beams, file.actuators, file.fixed, material)
    for wrong in structure_errors(grid):
        raise InputError(wrong.message, wrong.code, wrong.where)
    return grid


def grid_to_dict(grid: Grid) -> dict[str, Any]:
    """Return a grid as plain lists and numbers under the file's keys, its material by its name."""
    return {
        "schema": SCHEMA,
        "joints": grid.joints.tolist(),
        "beams": grid.beams.tolist(),
        "actuators": grid.actuators.tolist(),
        "fixed": grid.fixed,
        "material": name_of(grid.material),
    }


def _line(error: Any) -> str:
    """Return one of pydantic's errors in our words."""
    place, value = error["loc"], error["input"]
    if not place:
        return f"is {shown(value)}; {WHOLE}"
    key = str(place[0])
    if error["type"] == "missing":
        return f"{key} is missing; {KEYS[key]}"
    if key not in KEYS:
        return f"{shown(place[0])} is not a key of a grid; its keys are {', '.join(KEYS)}"
    where = key + "".join(f"[{k}]" for k in place[1:])
    return f"{where} is {shown(value)}; {KEYS[key]}"

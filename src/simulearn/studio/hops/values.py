"""The values of a request, read by the names of their classes in .NET, and those of an answer."""

import json
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.studio.hops import archives
from simulearn.studio.hops.parameters import (
    BOOLEAN,
    CURVE,
    INTEGER,
    MESH,
    NUMBER,
    POINT,
    TEXT,
    Kind,
)
from simulearn.studio.hops.schemas import Item, Tree

Path = tuple[int, ...]
Points = NDArray[np.float64]
DEEPEST = 16  # indices of a path


@dataclass(frozen=True)
class Inputs:
    """The values of one branch by the names of the inputs."""

    items: Mapping[str, Sequence[Item]]

    def has(self, name: str) -> bool:
        """Whether an input has a value."""
        return bool(self.items.get(name))

    def numbers(self, name: str) -> list[float]:
        """Return the numbers of an input."""
        return [number(one, _place(name, k)) for k, one in enumerate(self.items.get(name, ()))]

    def number(self, name: str, otherwise: float) -> float:
        """Return the number of an input, or what stands for it."""
        return next(iter(self.numbers(name)), otherwise)

    def text(self, name: str, otherwise: str = "") -> str:
        """Return the text of an input, or what stands for it."""
        given = self.items.get(name) or ()
        return text_of(given[0], name) if given else otherwise

    def texts(self, name: str) -> list[str]:
        """Return the texts of an input."""
        return [text_of(one, _place(name, k)) for k, one in enumerate(self.items.get(name, ()))]

    def points(self, name: str) -> Points:
        """Return the points (n, 3) of an input, in the model's unit."""
        given = self.items.get(name, ())
        rows = [point(one, _place(name, k)) for k, one in enumerate(given)]
        return np.array(rows, float).reshape(-1, 3)


def branches(trees: Iterable[Tree], first: str) -> dict[Path, Inputs]:
    """Return the inputs of each branch of the first input.

    Another input gives the branch of the same path; where it has only one, that goes with all.

    Raises:
        InputError: a path is none, or an input has no branch for one of the paths.
    """
    named = {
        tree.name: {path_of(key): items for key, items in (tree.branches or {}).items()}
        for tree in trees
    }
    paths = [path for path, items in named.get(first, {}).items() if items]
    found = {}
    for path in paths or [(0,)]:
        items = {}
        for name, tree in named.items():
            filled = {key: values for key, values in tree.items() if values}
            if name != first and len(filled) > 1 and path not in filled:
                text = f"{name} has no branch {path_text(path)}, as {first} has"
                raise InputError(text, "branches", name)
            values = filled.get(path)
            if values is None and len(filled) == 1:
                values = next(iter(filled.values()))
            items[name] = values or []
        found[path] = Inputs(items)
    return found


def path_of(text: str) -> Path:
    """Return a path of a tree: "{0;1}" of Grasshopper, "0" of older servers, "{ 0; 1; }"."""
    parts = [part.strip() for part in text.strip().strip("{}").split(";")]
    parts = [part for part in parts if part]
    if len(parts) > DEEPEST or not all(p.isascii() and p.isdigit() and len(p) < 10 for p in parts):
        raise InputError(f'"{text[:40]}" is no path of a tree, such as {{0;1}}', "path", "values")
    return tuple(int(part) for part in parts) or (0,)


def path_text(path: Path) -> str:
    """Return a path as Grasshopper writes it."""
    return "{" + ";".join(map(str, path)) + "}"


def number(item: Item, place: str) -> float:
    """Return a finite number of any of the types that Grasshopper has for it."""
    data = parsed(item)
    if isinstance(data, str):
        try:
            data = float(data)
        except ValueError:
            data = None
    if isinstance(data, bool) or not isinstance(data, int | float) or not _finite(data):
        raise InputError(f"{place} is {_shown(item)}; it is a number", "number", place)
    return float(data)


def text_of(item: Item, place: str) -> str:
    """Return a text; of a number, its digits."""
    data = parsed(item)
    if not isinstance(data, str | int | float) or isinstance(data, bool):
        raise InputError(f"{place} is {_shown(item)}; it is a text", "text", place)
    return str(data).strip()


def point(item: Item, place: str) -> list[float]:
    """Return x, y, z of a point."""
    data = parsed(item)
    if isinstance(data, Mapping) and "data" in data:
        found = archives.decoded(data, place)
        where = getattr(found, "Location", None)
        if where is None:
            raise InputError(f"{place} is a {type(found).__name__}; it is a point", "point", place)
        return [where.X, where.Y, where.Z]
    return coordinates(data, place)


def coordinates(data: Any, place: str) -> list[float]:
    """Return x, y, z of what .NET writes as {"X": 1, "Y": 2, "Z": 3}."""
    if isinstance(data, Mapping):
        by_name = {str(key).upper(): value for key, value in data.items()}
        xyz = [by_name.get("X"), by_name.get("Y"), by_name.get("Z", 0.0)]
        if all(isinstance(v, int | float) and not isinstance(v, bool) and _finite(v) for v in xyz):
            return [float(v) for v in xyz if v is not None]
    raise InputError(f"{place} is no point with finite X, Y and Z", "point", place)


def parsed(item: Item) -> Any:
    """Return what an item holds; a text that is no JSON stands for itself."""
    if not isinstance(item.data, str):
        return item.data
    try:
        return json.loads(item.data)
    except (ValueError, RecursionError):
        return item.data


def tree(name: str, branches: Mapping[Path, Sequence[Any]], kind: Kind) -> dict[str, Any]:
    """Return the values of an output as a tree."""
    write = WRITE[kind]
    inner = {
        path_text(path): [{"type": kind.type, "data": write(one)} for one in values]
        for path, values in branches.items()
    }
    return {"ParamName": name, "InnerTree": inner}


class Exact(str):
    """A text of which no letter may change."""


def _text(value: str) -> str:
    """Return a text so that Hops shows it as it is.

    Hops takes the quotes at the ends off and reads nothing else of JSON, unless the text is an
    object. So a text is one line without double quotes, which is JSON and stands for itself, too;
    one that must keep its quotes stands for itself only.
    """
    if value.startswith("{"):
        return json.dumps(value)
    if isinstance(value, Exact) and ('"' in value or "\\" in value):
        return f"{value} " if value.endswith('"') else value
    plain = value.replace("\n", " ").replace('"', "'").replace("\\", "/")
    return json.dumps(plain, ensure_ascii=False)


def _point(value: Sequence[float]) -> str:
    x, y, z = (float(v) for v in value)
    return json.dumps({"X": x, "Y": y, "Z": z}, allow_nan=False)


WRITE: dict[Kind, Callable[[Any], str]] = {
    BOOLEAN: lambda value: json.dumps(bool(value)),
    INTEGER: lambda value: json.dumps(int(value)),
    NUMBER: lambda value: json.dumps(float(value), allow_nan=False),
    TEXT: _text,
    POINT: _point,
    CURVE: archives.encoded,
    MESH: archives.encoded,
}


def _finite(value: float) -> bool:
    try:
        return math.isfinite(value)
    except OverflowError:
        return False


def _shown(item: Item) -> str:
    return f"{str(item.data)[:40]} ({item.type[:60]})"


def _place(name: str, index: int) -> str:
    return f"{name}[{index}]"

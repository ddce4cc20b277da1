"""Materials of others, as texts: read without any file, as requests and documents bring them.

A text is that of a material's TOML file. It has a name of its own, by which grids name it; the
names of the materials that come along are theirs.
"""

import re
import tomllib
from collections.abc import Iterable, Iterator
from functools import lru_cache
from typing import Any

from pydantic import ValidationError

from simulearn.errors import InputError
from simulearn.files import read_text
from simulearn.material.material import HERE, Material, is_name, names

MOST_MATERIALS = 16  # materials that anybody may send at once
MOST_TEXT = 2**16  # characters of one
MOST_NAME = 80  # characters
MOST_TITLE = 200
MOST_DOTS = 300  # on one line: reading tables so deep takes long
MOST_SHOWN = 60  # characters of a value in a message
# Numbers far beyond what anybody prints overflow, or make a print of millions of strokes.
SIZES = (1e-15, 1e9)  # of a number that is not 0
LENGTHS: dict[tuple[str | int, ...], tuple[float, float]] = {  # mm
    ("section", "width"): (0.1, 100.0),
    ("section", "thickness"): (0.1, 100.0),
    ("print", "layer"): (0.01, 10.0),
    ("print", "line_width"): (0.05, 10.0),
}


def material_text(name: str) -> str:
    """Return the TOML text of a material that comes along, to be changed.

    Raises:
        InputError: there is none of this name.
    """
    if name not in names():
        text = f'material "{name}" is not known; known are {", ".join(names())}'
        raise InputError(text, "material-unknown", "material")
    return read_text(HERE / f"{name}.toml")


def materials_of(texts: Any, place: str = "materials") -> dict[str, Material]:
    """Return the materials of some texts by their names.

    Args:
        texts: a list of TOML texts, such as JSON gives.
        place: of the list, for messages.

    Raises:
        InputError: they are too many, one is not a valid material system, or two have one name.
    """
    if not isinstance(texts, list) or not all(isinstance(text, str) for text in texts):
        raise InputError(f"{place} is not a list of TOML texts", "material-file", place)
    if len(texts) > MOST_MATERIALS:
        text = f"{place} has {len(texts)} entries; at most {MOST_MATERIALS} are taken"
        raise InputError(text, "material-file", place)
    found: dict[str, Material] = {}
    for k, text in enumerate(texts):
        material = own_material(text, f"{place}[{k}]")
        if material.name in found:
            again = f'{place}[{k}].name is "{material.name}", as another one; a name stands for one'
            raise InputError(again, "material-name", f"{place}[{k}].name")
        found[material.name] = material
    return found


@lru_cache(maxsize=64)  # a page sends the same with every change of a design
def own_material(text: str, place: str = "material") -> Material:
    """Return the material system that a text describes, which may come from anybody.

    Args:
        text: TOML of at most `MOST_TEXT` characters.
        place: of the text, for messages.

    Raises:
        InputError: it is not a valid material system, or its name is that of one that comes along;
            `where` is the key, or the line of what is no TOML.
    """
    data = _tables(text, place)
    try:
        material = Material.model_validate(data)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = _place(place, _keys(first["loc"], data))
        raise InputError(f"{where} {_reason(first)}", "material-file", where) from error
    for keys, number in _numbers(data):
        least, most = LENGTHS.get(keys, SIZES)
        if number and not least <= abs(number) <= most:
            where = _place(place, keys)
            line = f"{where} is {number:g}; its size lies between {least:g} and {most:g}"
            raise InputError(line, "material-file", where)
    name, where = material.name, f"{place}.name"
    if not (name and len(name) <= MOST_NAME and name.isprintable() and is_name(name)):
        line = f"{where} is {name[:MOST_SHOWN]!r}; it has 1 to {MOST_NAME} characters, no slash"
        raise InputError(line, "material-name", where)
    if name in names():
        line = f'{where} is "{name}", a material that comes along; give yours another name'
        raise InputError(line, "material-name", where)
    if not (len(material.title) <= MOST_TITLE and material.title.isprintable()):
        line = f"{place}.title is not one line of at most {MOST_TITLE} characters"
        raise InputError(line, "material-file", f"{place}.title")
    return material


def _tables(text: str, place: str) -> dict[str, Any]:
    """Return the tables of a TOML text."""
    if len(text) > MOST_TEXT:
        long = f"{place} has {len(text)} characters; a material has at most {MOST_TEXT}"
        raise InputError(long, "material-file", place)
    for k, line in enumerate(text.splitlines(), 1):
        if line.count(".") > MOST_DOTS:
            many = f"{place}: line {k} has more than {MOST_DOTS} dots; write it on several lines"
            raise InputError(many, "material-file", f"{place}, line {k}")
    try:
        return tomllib.loads(text)
    except ValueError as error:  # also of a number of thousands of digits
        line_found = re.search(r"line \d+", str(error))
        where = f"{place}, {line_found[0]}" if line_found else place
        raise InputError(f"{place} is not valid TOML: {error}", "material-file", where) from error
    except RecursionError as error:
        raise InputError(f"{place} is nested too deeply", "material-file", place) from error


def _numbers(
    data: Any, keys: tuple[str | int, ...] = ()
) -> Iterator[tuple[tuple[str | int, ...], float]]:
    """Yield the numbers of tables with their keys."""
    if isinstance(data, dict | list):
        pairs = data.items() if isinstance(data, dict) else enumerate(data)
        for key, value in pairs:
            yield from _numbers(value, (*keys, key))
    elif isinstance(data, int | float) and not isinstance(data, bool):
        yield keys, float(data)


def _keys(keys: Iterable[str | int], data: dict[str, Any]) -> list[str | int]:
    """Return a path of pydantic without the kind of law, which it names as if it were a key."""
    law = data.get("law")
    kind = law.get("kind") if isinstance(law, dict) else None
    return [key for key in keys if key != kind]


def _place(place: str, keys: Iterable[str | int]) -> str:
    return place + "".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in keys)


def _reason(error: Any) -> str:
    """Return one of pydantic's errors as the rest of a sentence."""
    if error["type"] == "missing":
        return "is missing"
    if error["type"] == "extra_forbidden":
        return "is not a key of a material"
    if error["type"] == "value_error":
        return f"is wrong: {error['ctx']['error']}"
    try:
        given = repr(error["input"])[:MOST_SHOWN]
    except RecursionError:
        given = "tables in tables"
    return f"is {given}; {error['msg'][:1].lower()}{error['msg'][1:]}"

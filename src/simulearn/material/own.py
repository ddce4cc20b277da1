"""Materials of others, as texts: read without any file, as requests and documents bring them.

A text is that of a material's TOML file. It has a name of its own, by which grids name it; the
names of the materials that come along are theirs.
"""

from functools import lru_cache
from typing import Any

from simulearn.errors import InputError
from simulearn.files import read_text
from simulearn.material.faults import MOST_SHOWN, MaterialError
from simulearn.material.material import Material
from simulearn.material.reading import HERE, NAMES, may_be_named, names, parsed

MOST_MATERIALS = 16  # materials that anybody may send at once
MOST_TEXT = 2**16  # characters of one


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
    if len(text) > MOST_TEXT:
        long = f"{place} has {len(text)} characters; a material has at most {MOST_TEXT}"
        raise InputError(long, "material-file", place)
    try:
        material = parsed(text)
    except MaterialError as fault:
        where = f"{place}.{fault.keys}" if fault.keys else place
        code = "material-name" if fault.keys == "name" else "material-file"
        at = f"{place}, {fault.line}" if fault.line else where
        raise InputError(f"{where} {fault.reason}", code, at) from fault
    check_name(material.name, f"{place}.name")
    return material


def check_name(name: str, place: str) -> None:
    """Make sure that a material of one's own may have a name.

    Args:
        name: of the material.
        place: of the name, for messages.

    Raises:
        InputError: it is none, or that of a material that comes along.
    """
    if not may_be_named(name):
        raise InputError(f"{place} is {name[:MOST_SHOWN]!r}; {NAMES}", "material-name", place)
    if name in names():
        line = f'{place} is "{name}", a material that comes along; give yours another name'
        raise InputError(line, "material-name", place)

"""Materials by name or from files, and the names that they may have."""

from functools import lru_cache
from pathlib import Path

from pydantic import ValidationError

from simulearn.errors import InputError
from simulearn.files import read_text
from simulearn.material.faults import MOST_SHOWN, MaterialError, fault_of, size_fault
from simulearn.material.material import Material
from simulearn.material.tables import tables

HERE = Path(__file__).parent
MOST_NAME = 80  # characters
MOST_TITLE = 200
NAMES = f"a name has 1 to {MOST_NAME} characters on one line, no slash and no colon"


def names() -> list[str]:
    """Return the names of the material systems that come with SimuLearn."""
    return sorted(path.stem for path in HERE.glob("*.toml"))


def is_name(text: str) -> bool:
    """Return whether a text can be the name of a material system, and not a path."""
    return not text.lower().endswith(".toml") and not set(text) & set("/\\:")


def may_be_named(name: str) -> bool:
    """Return whether a material may have a name; see `NAMES`."""
    return bool(name) and len(name) <= MOST_NAME and name.isprintable() and is_name(name)


def name_of(material: str | Material) -> str:
    """Return the name of what a grid is made of: a name or path, or the material itself."""
    return material.name if isinstance(material, Material) else material


def load_material(name: str | Path | Material) -> Material:
    """Return a material system by its name, or from a TOML file by its path.

    Args:
        name: name or path; a material itself is returned as it is.

    Raises:
        InputError: the name is unknown, or the file is not a valid material system.
    """
    if isinstance(name, Material):
        return name
    if not is_name(str(name)):
        return read_material(name)
    path = HERE / f"{name}.toml"
    try:
        found = path.stat()
    except (OSError, ValueError):  # no such file, or no name that a file may have
        known = ", ".join(names())
        raise InputError(
            f'material "{name}" is not known; known are {known}, or give a .toml file',
            code="material-unknown",
            where="material",
        ) from None
    return _shipped(path, found.st_mtime_ns, found.st_size)


def read_material(path: str | Path) -> Material:
    """Return the material system in a TOML file.

    Raises:
        InputError: the file cannot be read or is not a valid material system.
    """
    return _parsed(read_text(path), str(path))


@lru_cache(maxsize=16)
def _shipped(path: Path, changed: int, size: int) -> Material:
    """Return a material that comes with SimuLearn; a file that has not changed is read once."""
    return read_material(path)


@lru_cache(maxsize=64)
def _parsed(text: str, path: str) -> Material:
    """Return the material system of a text; the same text is parsed once."""
    try:
        return parsed(text)
    except MaterialError as fault:
        of_name = fault.keys == "name"
        raise InputError(
            f"{path}: {fault}", "material-name" if of_name else "material-file", fault.keys
        ) from fault


def parsed(text: str) -> Material:
    """Return the material system of a TOML text, whoever wrote it.

    Raises:
        MaterialError: it is none.
    """
    data = tables(text)
    try:
        material = Material.model_validate(data)
    except ValidationError as error:
        raise fault_of(error, data) from error
    if (fault := size_fault(data)) is not None:
        raise fault
    if not may_be_named(material.name):
        raise MaterialError("name", f"is {material.name[:MOST_SHOWN]!r}; {NAMES}")
    title = material.title
    if not (len(title) <= MOST_TITLE and title.isprintable()):
        raise MaterialError("title", f"is not one line of at most {MOST_TITLE} characters")
    return material

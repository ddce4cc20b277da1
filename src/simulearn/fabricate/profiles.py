"""Reading printers from profiles, those that come along and anybody's own.

A profile is a TOML file. It may begin from another one (`base`) and name only what differs.
"""

import re
import tomllib
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from simulearn.errors import InputError
from simulearn.fabricate.printer import Printer
from simulearn.files import read_text
from simulearn.grid.arrays import shown

HERE = Path(__file__).parent / "printers"
MOST_BASES = 8
MOST_TEXT = 2**16  # characters of a profile that anybody may send
MOST_DOTS = 300  # on one line of it


def printers() -> list[str]:
    """Return the names of the printers that come with SimuLearn."""
    return sorted(path.stem for path in HERE.glob("*.toml"))


def load_printer(name: str | Path) -> Printer:
    """Return a printer by its name, or from a TOML file by its path.

    Raises:
        InputError: the name is unknown, or the file is not a valid profile.
    """
    path = _path(name)
    return _printer(_with_base(path), str(path))


def read_profile(text: str) -> Printer:
    """Return the printer that the text of a profile describes, which may come from anybody.

    Its `base`, if it has one, names a printer that comes with SimuLearn; no file is read otherwise.

    Args:
        text: TOML of at most `MOST_TEXT` characters.

    Raises:
        InputError: it is not a valid profile; `where` is the key, or the line of what is no TOML.
    """
    if len(text) > MOST_TEXT:
        long = f"the profile has {len(text)} characters; at most {MOST_TEXT} are taken"
        raise InputError(long, "profile-too-large", "profile")
    for k, line in enumerate(text.splitlines(), 1):
        if line.count(".") > MOST_DOTS:  # reading tables so deep takes long
            raise InputError(
                f"profile: line {k} has more than {MOST_DOTS} dots; write long code on several "
                "lines, between three quotation marks",
                "profile",
                f"line {k}",
            )
    data = _tables(text, "profile")
    base = data.pop("base", None)
    if base is not None:
        if not isinstance(base, str) or base not in printers():
            known = ", ".join(printers())
            raise InputError(
                f"profile: base: is {shown(base)}; here it is one of {known}", "profile", "base"
            )
        below = _with_base(_path(base))
        data = _merged(_kept(below, data), data)
    return _printer(data, "profile")


def profile_text(name: str) -> str:
    """Return the TOML text of a printer that comes with SimuLearn, to be edited."""
    return read_text(_path(name))


def _printer(data: dict[str, Any], place: str) -> Printer:
    """Return the printer of tables; messages name their place."""
    try:
        return Printer.model_validate(data)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(str(part) for part in first["loc"]) or "profile"
        raise InputError(f"{place}: {where}: {_reason(first)}", "profile", where) from error


def _path(name: str | Path) -> Path:
    path = Path(name)
    if path.suffix == ".toml":
        return path
    if str(name) not in printers():
        known = ", ".join(printers())
        raise InputError(f'printer "{name}" is not known; known are {known}, or give a .toml file')
    return HERE / f"{name}.toml"


def _with_base(path: Path, depth: int = 0) -> dict[str, Any]:
    """Return the tables of a profile over those that it begins from."""
    if depth > MOST_BASES:
        raise InputError(f"{path}: more than {MOST_BASES} profiles begin from one another")
    data = _tables(read_text(path), str(path))
    base = data.pop("base", None)
    if base is None:
        return data
    if not isinstance(base, str):
        raise InputError(f"{path}: base: is not the name of a printer or the path of its file")
    beside = path.parent / base
    below = _with_base(beside if beside.suffix == ".toml" else _path(base), depth + 1)
    return _merged(_kept(below, data), data)


def _kept(below: dict[str, Any], above: dict[str, Any]) -> dict[str, Any]:
    """Return what a profile takes over from the one it begins from.

    That somebody has printed with a profile says nothing about another one, the shape and the zones
    of a bed nothing about one whose origin lies elsewhere, the reach nothing about one of another
    size.
    """
    below = {key: value for key, value in below.items() if key != "tried"}
    old, new = below.get("bed"), above.get("bed")
    if not isinstance(old, dict) or not isinstance(new, dict):
        return below
    if new.get("origin", old.get("origin")) != old.get("origin"):
        old = {key: value for key, value in old.items() if key not in ("shape", "excluded")}
    if new.keys() & {"origin", "width", "depth", "height"}:
        below = {key: value for key, value in below.items() if key != "reach"}
    return below | {"bed": old}


def _tables(text: str, place: str) -> dict[str, Any]:
    """Return the tables of a TOML text; messages name its place."""
    try:
        return tomllib.loads(text)
    except ValueError as error:  # also of a number of thousands of digits
        line = re.search(r"line \d+", str(error))
        where = line[0] if line else "profile"
        raise InputError(f"{place}: is not valid TOML: {error}", "profile", where) from error
    except RecursionError as error:
        text = f"{place}: is not a profile; its tables are nested too deeply"
        raise InputError(text, "profile", "profile") from error


def _merged(below: dict[str, Any], above: dict[str, Any]) -> dict[str, Any]:
    both = dict(below)
    for key, value in above.items():
        old = both.get(key)
        inner = isinstance(old, dict) and isinstance(value, dict)
        both[key] = _merged(old, value) if inner else value  # type: ignore[arg-type]
    return both


def _reason(error: Any) -> str:
    """Return one of pydantic's errors with what was given."""
    if error["type"] == "extra_forbidden":
        return "is not a key of a printer profile"
    if error["type"] == "missing":
        return "is missing"
    if error["type"] == "value_error":
        return str(error["ctx"]["error"])
    try:
        given = repr(error["input"])
    except RecursionError:
        given = "tables in tables"
    given = given if len(given) <= 40 else given[:37] + "..."
    return f"is {given}; {error['msg'][0].lower()}{error['msg'][1:]}"

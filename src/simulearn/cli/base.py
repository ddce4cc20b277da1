"""What all commands share: the application, its consoles, and how a grid is named."""

import json
import os
from collections.abc import Iterable, Sequence
from dataclasses import replace
from fnmatch import fnmatch
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.markup import escape

from simulearn.errors import InputError, Message
from simulearn.files import replacing
from simulearn.grid import Grid, Validation, library, make, read_grid, validate
from simulearn.material import load_material, read_material

app = typer.Typer(
    name="simulearn",
    help="The shape a flat 4D-printed grid takes in hot water.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
out = Console(soft_wrap=True, highlight=False)  # a message is one line, whoever reads it
err = Console(stderr=True, soft_wrap=True, highlight=False)

ALIKE = 5  # so many messages of one kind are one line
NAMED = 8  # places of them that are named

GridArgument = Annotated[
    str, typer.Argument(metavar="GRID", help="A grid file (.json), or a name from the library.")
]
Json = Annotated[bool, typer.Option("--json", help="Print the machine form.")]
MaterialOption = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="A material (.toml) in place of the grid's own."),
]


def grid_of(name: str, material: Path | None = None) -> Grid:
    """Return the grid of a file, or of the library if there is no such file.

    Args:
        name: of the file, or from the library.
        material: TOML file of a material in place of the grid's own.
    """
    if name in library() and not Path(name).exists():
        return of_material(make(name), material)
    try:
        return of_material(read_grid(name, paths=True), material)
    except InputError as error:
        if isinstance(error.__cause__, FileNotFoundError) and not Path(name).suffix:
            raise InputError(f"{name}: is neither a file nor a grid of the library") from error
        raise


def of_material(grid: Grid, material: Path | None) -> Grid:
    """Return a grid made of the material in a file, or as it is if none is given.

    Raises:
        InputError: the file is no material system.
    """
    if material is None:
        return grid
    read_material(material)
    if material.suffix.lower() != ".toml":
        raise InputError(f"{material}: a material is a file that ends in .toml")
    return replace(grid, material=str(material))


def validated(grid: Grid) -> Validation:
    """Return what validation says of a grid, by the limits of its material."""
    return validate(grid, load_material(grid.material))


def warn(messages: Iterable[Message], already: Iterable[Message] = ()) -> None:
    """Print warnings, but for those that are printed already; many alike as one line."""
    for message in grouped([message for message in messages if message not in already]):
        err.print(f"[yellow]warning:[/] {escape(message.message)}")


def grouped(messages: Iterable[Message]) -> list[Message]:
    """Return messages with those of one code, where they are many, made into one.

    The first of them stands for all, with the places of the others behind it.
    """
    alike: dict[tuple[str, str], list[Message]] = {}
    for message in messages:
        alike.setdefault((message.code, message.where.rpartition(" ")[0]), []).append(message)
    lines: list[Message] = []
    for (code, part), some in alike.items():
        if len(some) < ALIKE:
            lines += some
            continue
        first, *others = some
        numbers = [one.where.rpartition(" ")[2] for one in others[:NAMED]]
        places = f": {part}s {', '.join(numbers)}" if part else ""
        dots = ", ..." if part and len(others) > NAMED else ""
        text = f"{first.message} (and {len(others)} more{places}{dots})"
        lines.append(Message(code, first.where, text))
    return lines


def print_files(paths: Iterable[Path | str]) -> None:
    """Print which files were written."""
    for path in paths:
        out.print(f"wrote {escape(str(path))}")


def folder_of(path: Path) -> None:
    """Make a folder, or say why it cannot be made."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{path}: cannot be made ({error.strerror})") from error


def keep_sources(folder: Path, names: Sequence[str], sources: Sequence[Path]) -> None:
    """Make sure that no file which is read will be written over.

    Args:
        folder: into which files are written.
        names: of these, with * as in a shell.
        sources: files that are read.

    Raises:
        InputError: one of them is in the folder and has such a name.
    """
    for source in sources:
        place = Path(os.path.realpath(source))
        if place.parent == Path(os.path.realpath(folder)) and any(
            fnmatch(place.name, name) for name in names
        ):
            raise InputError(
                f"{source}: is what is read, and would be replaced; name another folder"
            )


def write_json(path: Path, data: dict[str, Any]) -> None:
    """Write data for machines."""
    with replacing(path) as temporary:
        temporary.write_text(json.dumps(data, indent=1, allow_nan=False) + "\n", "utf-8")

"""What all commands share: the application, its consoles, and how a grid is named."""

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from simulearn.errors import InputError
from simulearn.grid import Grid, Validation, library, make, read_grid, validate
from simulearn.material import load_material

app = typer.Typer(
    name="simulearn",
    help="The shape a flat 4D-printed grid takes in hot water.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
out = Console(soft_wrap=True, highlight=False)  # a message is one line, whoever reads it
err = Console(stderr=True, soft_wrap=True, highlight=False)

GridArgument = Annotated[
    str, typer.Argument(metavar="GRID", help="A grid file (.json), or a name from the library.")
]
Json = Annotated[bool, typer.Option("--json", help="Print the machine form.")]


def grid_of(name: str) -> Grid:
    """Return the grid of a file, or of the library if there is no such file."""
    if name in library() and not Path(name).exists():
        return make(name)
    try:
        return read_grid(name, paths=True)
    except InputError as error:
        if isinstance(error.__cause__, FileNotFoundError) and not Path(name).suffix:
            raise InputError(f"{name}: is neither a file nor a grid of the library") from error
        raise


def validated(grid: Grid) -> Validation:
    """Return what validation says of a grid, by the limits of its material."""
    return validate(grid, load_material(grid.material))

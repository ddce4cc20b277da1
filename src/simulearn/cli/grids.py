"""Commands about one grid: validate, library."""

import json
from pathlib import Path
from typing import Annotated

import typer
from rich.markup import escape
from rich.table import Table

from simulearn.cli.base import (
    GridArgument,
    Json,
    MaterialOption,
    app,
    grid_of,
    grouped,
    out,
    validated,
)
from simulearn.errors import InputError
from simulearn.grid import (
    Grid,
    Message,
    Validation,
    grid_to_dict,
    library,
    make,
    validate,
    write_grid,
)
from simulearn.material import load_material

ModelOption = Annotated[
    str | None,
    typer.Option(help="A learned model: default, paper, or its folder; its training ranges warn."),
]


@app.command("validate")
def validate_(
    grid: GridArgument,
    model: ModelOption = None,
    material: MaterialOption = None,
    as_json: Json = False,
) -> None:
    """Check a grid: errors keep it from being simulated, warnings do not."""
    try:
        design = grid_of(grid, material)
        report = validation_of(design, model)
        if model is not None and (remark := _remark(design, model)):
            report = Validation(report.errors, (*report.warnings, remark))
    except InputError as error:
        if as_json:  # machines get the same form, whatever is wrong
            print(json.dumps(Validation((Message("input", "grid", str(error)),), ()).to_dict()))
        raise
    if as_json:
        print(json.dumps(report.to_dict()))
    else:
        for message in grouped(report.errors):
            out.print(f"[red]error[/] {escape(message.message)} [dim]({message.code})[/]")
        for message in grouped(report.warnings):
            out.print(f"[yellow]warning[/] {escape(message.message)} [dim]({message.code})[/]")
        if report.valid:
            out.print("[green]valid[/]")
    if not report.valid:
        raise typer.Exit(1)


@app.command("library")
def library_(
    name: Annotated[str | None, typer.Argument(help="A grid of the library.")] = None,
    cells: Annotated[str, typer.Option(help="Cells along x and y.")] = "2x2",
    length: Annotated[float, typer.Option(help="Length of the beams, mm.")] = 65.0,
    output: Annotated[Path | None, typer.Option("-o", "--output", help="Write it here.")] = None,
    as_json: Json = False,
) -> None:
    """List the library of grids, or make one of them."""
    if name is None:
        if as_json:
            print(json.dumps(library()))
            return
        table = Table("name", "what it does", box=None)
        for title, words in library().items():
            table.add_row(title, words)
        out.print(table)
        return
    grid = make(name, _cells(cells), length)
    if output is not None:
        write_grid(grid, output)
        out.print(f"wrote {escape(str(output))}")
    if as_json or output is None:
        print(json.dumps(grid_to_dict(grid)))


def validation_of(grid: Grid, model: str | None) -> Validation:
    """Return what validation says, by the training ranges of a model if one is named."""
    if model is None:
        return validated(grid)
    from simulearn.learn.common.bundle import bundle_of

    bundle = bundle_of(model)
    bundle.check()
    material = load_material(grid.material)
    return validate(grid, material, training=bundle.card.range.of(material))


def _remark(grid: Grid, model: str) -> Message | None:
    """Return that the material is outside what a model has learnt; None if it is within."""
    from simulearn.simulate.learned import Learned

    try:
        return Learned.of(model).remark(load_material(grid.material))
    except InputError:  # what the model needs is not installed here; its ranges hold all the same
        return None


def _cells(text: str) -> tuple[int, int]:
    parts = text.lower().split("x")
    if len(parts) != 2 or not all(part.isdecimal() and int(part) > 0 for part in parts):
        raise InputError(f'--cells is "{text}"; it is two numbers as in 2x3')
    return int(parts[0]), int(parts[1])

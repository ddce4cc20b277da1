"""Commands about one grid: simulate, validate, library."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.markup import escape
from rich.table import Table

from simulearn.cli.base import GridArgument, Json, app, err, grid_of, out, validated
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

if TYPE_CHECKING:
    from simulearn.simulate import Progress, Result

ModelOption = Annotated[
    str | None,
    typer.Option(help="A learned model: default, paper, or its folder; its training ranges warn."),
]


@app.command()
def simulate(
    grid: GridArgument,
    engine: Annotated[
        str, typer.Option(help="Who answers: fea, calculix, beams or learned.")
    ] = "fea",
    model: ModelOption = None,
    output: Annotated[
        list[Path] | None,
        typer.Option(
            "-o",
            "--output",
            help="A file to write (repeat for more); its ending picks the format: "
            ".json .npz .png .pdf .svg .gif .glb .stl .vtu .pvd",
        ),
    ] = None,
    as_json: Json = False,
) -> None:
    """Simulate a grid: twelve frames, from flat through release to creep."""
    from simulearn import outputs
    from simulearn.simulate import engine as engine_of
    from simulearn.simulate import result_to_dict, summary

    files = output or []
    design = grid_of(grid)
    outputs.check(files, Path(grid))
    answering = engine_of(engine, model)
    for warning in _validated(design, _model_of(engine, model)).warnings:
        err.print(f"[yellow]warning:[/] {escape(warning.message)}")
    with _progress(quiet=as_json) as progress:
        result = answering.simulate([design], progress)[0]
    if not result.record.get("stable", True):
        err.print("[yellow]note:[/] the shape is in unstable balance and may snap into another")
    for path in files:
        outputs.write(result, path)
    if as_json:
        written = {"files": [str(p) for p in files], "engine": engine, "summary": summary(result)}
        print(json.dumps(written if files else result_to_dict(result), allow_nan=False))
        return
    out.print(_table(result))
    for path in files:
        out.print(f"wrote {escape(str(path))}")


@app.command("validate")
def validate_(grid: GridArgument, model: ModelOption = None, as_json: Json = False) -> None:
    """Check a grid: errors keep it from being simulated, warnings do not."""
    try:
        report = _validated(grid_of(grid), model)
    except InputError as error:
        if as_json:  # machines get the same form, whatever is wrong
            print(json.dumps(Validation((Message("input", "grid", str(error)),), ()).to_dict()))
        raise
    if as_json:
        print(json.dumps(report.to_dict()))
    else:
        for message in report.errors:
            out.print(f"[red]error[/] {escape(message.message)} [dim]({message.code})[/]")
        for message in report.warnings:
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


def _model_of(engine: str, model: str | None) -> str | None:
    """Return the model whose training ranges an engine warns by."""
    return {"learned": model or "default", "beams": "beams"}.get(engine)


def _validated(grid: Grid, model: str | None) -> Validation:
    """Return what validation says, by the training ranges of a model if one is named."""
    if model is None:
        return validated(grid)
    from simulearn.learn.common.bundle import bundle_of

    training = bundle_of(model).card.range
    return validate(grid, load_material(grid.material), training=training)


def _cells(text: str) -> tuple[int, int]:
    parts = text.lower().split("x")
    if len(parts) != 2 or not all(part.isdecimal() and int(part) > 0 for part in parts):
        raise InputError(f'--cells is "{text}"; it is two numbers as in 2x3')
    return int(parts[0]), int(parts[1])


@contextmanager
def _progress(quiet: bool) -> "Iterator[Progress | None]":
    """Yield what an engine tells its frames to: a bar on the terminal, or nothing."""
    if quiet or not err.is_terminal:
        yield None
        return
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("frames"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=err, transient=True) as bar:
        task = bar.add_task("frames", total=12)
        yield lambda done, total: bar.update(task, completed=done, total=total)


def _table(result: "Result") -> Table:
    """Return where the joints are, flat and at the end."""
    from simulearn.simulate import summary

    numbers: dict[str, Any] = summary(result)
    fall = "rise" if numbers["rise_mm"] > 0 else "fall"
    work = f", {numbers['iterations']} iterations" if "iterations" in numbers else ""
    caption = f"{result.engine}, {_seconds(result.seconds)}{work}; millimetres, +z up"
    if "bound_mm" in numbers:
        caption += f"\nnine of ten such answers are off by less than {numbers['bound_mm']:.2f} mm"
    table = Table(
        box=None,
        title=(
            f"{len(result.grid.joints)} joints, {len(result.grid.beams)} beams, "
            f"dimension {numbers['dimension_mm']:.1f} mm\n"
            f"largest {fall} {abs(numbers['rise_mm']):.1f} mm (joint {numbers['joint_risen']}), "
            f"z from {numbers['lowest_mm']:.1f} to {numbers['highest_mm']:.1f} mm"
        ),
        caption=caption,
        title_justify="left",
        caption_justify="left",
    )
    for name in ("joint", "flat x", "y", "morphed x", "y", "z", "moved"):
        table.add_column(name, justify="right")
    for k, (a, b) in enumerate(zip(result.centres[0], result.centres[-1], strict=True)):
        places = [*a[:2], *b, float(((b - a) ** 2).sum() ** 0.5)]
        # + 0.0 turns -0.0 into 0.0
        words = [f"{round(x, 1) + 0.0:.1f}" for x in places]
        table.add_row(f"fixed {k}" if k == result.grid.fixed else str(k), *words)
    return table


def _seconds(seconds: float) -> str:
    return f"{seconds:.1f} s" if seconds >= 0.95 else f"{1000 * seconds:.0f} ms"

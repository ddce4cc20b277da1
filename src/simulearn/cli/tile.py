"""The command that tiles a surface with modules."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.markup import escape
from rich.table import Table

from simulearn.cli.base import Json, app, err, folder_of, keep_sources, out, warn, write_json
from simulearn.cli.progress import bar, counting, preparing
from simulearn.errors import InputError
from simulearn.files import replacing
from simulearn.grid import write_grid
from simulearn.material import read_material

if TYPE_CHECKING:
    from collections.abc import Callable

    from simulearn.fabricate import Printer
    from simulearn.fabricate.bill import Row
    from simulearn.tile import Stage, Tiled
    from simulearn.tile.pieces import Piece


WRITTEN = ("assembly.*", "deviation.png", "bill.csv", "tile.json")


@app.command("tile")
def tile_(
    surface: Annotated[
        str,
        typer.Argument(
            metavar="SURFACE",
            help="A quad mesh with a quad for each module (.obj .ply), any mesh or Rhino file, or "
            "a profile, heights or two edges (.json).",
        ),
    ],
    output: Annotated[Path, typer.Option("-o", "--output", help="The folder of the tiling.")],
    modules: Annotated[
        str | None,
        typer.Option(metavar="AxB", help="How many modules along the surface, or around and up."),
    ] = None,
    size: Annotated[
        float | None, typer.Option(min=1, metavar="MM", help="Of about what size they are.")
    ] = None,
    cells: Annotated[str, typer.Option(metavar="AxB", help="Cells of a module.")] = "2x2",
    onto: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="The surface onto which a quad mesh is put."),
    ] = None,
    unit: Annotated[str | None, typer.Option(help="Of a mesh file: mm, cm, m, in ...")] = None,
    printer: Annotated[
        str | None, typer.Option(help="For print files, hours and grams; see simulearn printers.")
    ] = None,
    gap: Annotated[
        float, typer.Option(min=0.01, metavar="MM", help="Gap at which the rounds end.")
    ] = 1.0,
    rounds: Annotated[
        int, typer.Option(min=0, help="In which borders are brought together, at most.")
    ] = 3,
    inset: Annotated[
        float | None,
        typer.Option(
            min=0.0,
            max=50,
            metavar="MM",
            help="How far modules keep from their borders; by default half the width of a beam, "
            "so that beams of neighbours lie side by side.",
        ),
    ] = None,
    alike: Annotated[
        float,
        typer.Option(min=0.0, metavar="MM", help="Modules that differ by less are one design."),
    ] = 0.25,
    ratio: Annotated[
        float, typer.Option(min=0.001, max=1, help="Step of the actuators' ratios.")
    ] = 0.05,
    seconds: Annotated[
        float | None, typer.Option(min=1, help="After so long no further round is begun.")
    ] = None,
    engine: Annotated[str, typer.Option(help="learned or beams.")] = "learned",
    model: Annotated[
        str | None, typer.Option(help="A learned model: default, or its folder.")
    ] = None,
    material: Annotated[
        Path | None, typer.Option(metavar="FILE", help="A material (.toml); PLA if not given.")
    ] = None,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Processes; by default one for each core.")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option(help="Address of a Dask scheduler, as tcp://host:8786.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Cover a surface with modules that fit it and each other; the same command goes on later."""
    from simulearn import dataset as sets
    from simulearn.fabricate import load_printer
    from simulearn.tile import Settings, read_tiling, tile
    from simulearn.tile.pieces import pieces, tiling_figures
    from simulearn.tile.running import LONGEST
    from simulearn.tile.searching import run

    if scheduler and workers:
        raise InputError("--workers is for this machine; the cluster of --scheduler has its own")
    machine = load_printer(printer) if printer else None
    if material is not None:
        read_material(material)
    count = None if modules is None else _pair(modules, "--modules", "5x3")
    own = _pair(cells, "--cells", "2x2")
    tiling = read_tiling(surface, count, size, own, unit, onto)
    sources = [Path(name) for name in (surface, onto, material) if name is not None]
    keep_sources(output, WRITTEN, sources)
    settings = Settings(
        alike_mm=alike,
        gap_mm=gap,
        inset_mm=inset,
        rounds=rounds,
        seconds=seconds,
        engine=engine,
        model=model,
        material=Settings.material if material is None else str(material),
        ratio=ratio,
    )
    folder_of(output)
    team = None
    if scheduler:
        team = sets.cluster_workers(scheduler, work=run)
    elif workers:
        team = sets.local_workers(workers, LONGEST, run)
    try:
        with preparing(quiet=as_json), _stages(quiet=as_json) as progress:
            tiled = tile(tiling, settings, output, team, progress)
    except InputError:
        warn(tiling.warnings)  # they may say why
        raise
    except KeyboardInterrupt:
        err.print("stopped; what is finished is kept, and the same command goes on")
        raise
    figures = tiling_figures(tiled)
    with counting("writing", quiet=as_json) as progress_of_files:
        rows = _write(tiled, figures, output, Path(surface).stem, machine, progress_of_files)
    warn(tiled.warnings)
    if as_json:
        print(json.dumps(figures, allow_nan=False))
        return
    for line in _words(figures):
        out.print(line)
    out.print(_bill(rows, {piece.name: piece for piece in pieces(tiled)}))
    out.print(f"wrote {escape(str(output))}/{', '.join(_names(machine is not None))}")


def _pair(text: str, option: str, example: str) -> tuple[int, int]:
    parts = text.lower().replace("×", "x").split("x")
    if len(parts) != 2 or not all(part.strip().isdecimal() and int(part) > 0 for part in parts):
        raise InputError(f'{option} is "{text}"; it is two numbers such as {example}')
    return int(parts[0]), int(parts[1])


def _names(printed: bool) -> list[str]:
    names = ["assembly.json", "modules/", *(["prints/"] if printed else [])]
    return [*names, "assembly.png", "deviation.png", "assembly.glb", "bill.csv", "tile.json"]


def _write(
    tiled: "Tiled",
    figures: dict[str, Any],
    folder: Path,
    name: str,
    machine: "Printer | None",
    progress: "Callable[[int, int], None]",
) -> "list[Row]":
    """Write all files but those of the search; return the bill."""
    from simulearn.assembly import simulate_assembly, write_assembly
    from simulearn.fabricate.bill import bill_of, bill_text
    from simulearn.interop.assembled import write_assembled
    from simulearn.show.assembly import assembled_picture
    from simulearn.show.tiling import deviation_map
    from simulearn.simulate import engine as engine_of
    from simulearn.tile.pieces import assembled, pieces

    grids = _emptied(folder / "modules")
    own = pieces(tiled)
    files = {}
    for piece in own:
        files[piece.name] = grids / f"{piece.name}.json"
        write_grid(piece.grid, files[piece.name])
    together = assembled(tiled, files, name)
    write_assembly(together, folder / "assembly.json")
    write_json(folder / "tile.json", figures)
    shapes = simulate_assembly(together, engine_of(tiled.settings.engine, tiled.settings.model))
    with replacing(folder / "assembly.png") as temporary:
        assembled_picture(shapes).savefig(temporary)
    with replacing(folder / "deviation.png") as temporary:
        deviation_map(tiled).savefig(temporary)
    write_assembled(shapes, folder / "assembly.glb")
    named = tiled.tiling.names
    rows = bill_of(
        [(p.name, p.grid, tuple(named[m] for m in p.modules)) for p in own], machine, progress
    )
    if machine is not None:
        rows = _printed(rows, _emptied(folder / "prints"), machine)
    with replacing(folder / "bill.csv") as temporary:
        temporary.write_text(bill_text(rows), "utf-8")
    return rows


def _emptied(folder: Path) -> Path:
    """Return a folder without the pieces of an earlier tiling."""
    folder_of(folder)
    for old in folder.glob("k[0-9]*.*"):
        old.unlink(missing_ok=True)
    return folder


def _printed(rows: "list[Row]", folder: Path, machine: "Printer") -> "list[Row]":
    """Write a print file for each piece, its copies in its name."""
    from dataclasses import replace

    from simulearn.fabricate import write_gcode, write_package

    written = []
    for row in rows:
        assert row.job is not None
        package = machine.firmware == "bambu"
        name = f"{row.piece}-x{row.copies}" + (".gcode.3mf" if package else ".gcode")
        if package:
            write_package(row.job, folder / name)
        else:
            write_gcode(row.job.gcode, folder / name)
        written.append(replace(row, file=f"{folder.name}/{name}"))
    return written


def _words(figures: dict[str, Any]) -> Iterator[str]:
    by = "finite elements" if figures["checked"] else "the engine"
    yield (
        f"{figures['modules']} modules of {figures['kinds']} kinds, {figures['pieces']} pieces to "
        f"print; alike within {figures['alike_mm']:.2f} mm"
    )
    yield (
        f"[bold]{figures['error_mm']:.2f} mm[/] from targets in the mean, "
        f"{figures['error_max_mm']:.2f} mm at most, by {by}; from the surface "
        f"{figures['deviation_mm']:.2f} and {figures['deviation_max_mm']:.2f} mm"
    )
    before = figures["rounds"][0]["gap_mm"]
    yield (
        f"[bold]{figures['gap_mm']:.2f} mm[/] largest gap between neighbours "
        f"({before:.2f} mm before the {len(figures['rounds']) - 1} rounds), "
        f"{figures['gap_mean_mm']:.2f} mm in the mean; {figures['seconds']:.0f} s"
    )


def _bill(rows: "list[Row]", own: "dict[str, Piece]") -> Table:
    from simulearn.fabricate.bill import totals

    table = Table("piece", "copies", "hours", "grams", "for", box=None)
    for row in rows:
        names = ", ".join(row.modules[:6]) + (" ..." if len(row.modules) > 6 else "")
        figures = (_each(row.hours), _each(row.grams))
        table.add_row(row.piece, str(row.copies), *figures, names)
    copies, hours, grams = totals(rows)
    words = "of all" if hours is not None else "--printer says hours and grams"
    table.add_row("all", str(copies), _each(hours), _each(grams), words)
    return table


def _each(value: float | None) -> str:
    return "" if value is None else f"{value:.1f}"


@contextmanager
def _stages(quiet: bool) -> "Iterator[Callable[[Stage], None]]":
    """Yield a function that shows how far a tiling is: a bar, or lines without a terminal."""
    if quiet:
        yield lambda stage: None
        return
    if not err.is_terminal:
        yield _line
        return
    with bar() as shown:
        task: list[Any] = []

        def show(stage: "Stage") -> None:
            title = f"round {stage.round}" if stage.round else "modules"
            if not task:
                task.append(shown.add_task(title, total=stage.total, words=""))
            words: dict[str, Any] = {} if stage.gap_mm is None else {"words": _gap(stage)}
            shown.update(
                task[0], description=title, total=stage.total, completed=stage.done, **words
            )

        yield show


def _line(stage: "Stage") -> None:
    if stage.gap_mm is not None:
        err.print(f"round {stage.round}: {_gap(stage)}")
    elif stage.done and (stage.done == stage.total or stage.done % 10 == 0):
        err.print(f"round {stage.round}: {stage.done} of {stage.total} kinds of modules")


def _gap(stage: "Stage") -> str:
    return f"gap {stage.gap_mm:.2f} mm, error {stage.error_mm:.2f} mm"

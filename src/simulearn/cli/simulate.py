"""The command simulate: one grid into files, or many grids into a folder."""

import json
import os
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.markup import escape
from rich.table import Table

from simulearn import outputs
from simulearn.cli.base import (
    Json,
    MaterialOption,
    app,
    err,
    folder_of,
    grid_of,
    out,
    print_files,
    warn,
)
from simulearn.cli.grids import ModelOption, validation_of
from simulearn.cli.progress import counting, preparing
from simulearn.cli.scatter import SimulatedPrints, spread_table
from simulearn.errors import InputError

if TYPE_CHECKING:
    from simulearn.grid import Grid
    from simulearn.simulate import Failure, Outcome, Result
    from simulearn.simulate.engines import StreamingSimulator


COLLISIONS = 5  # that the terminal names


@app.command()
def simulate(
    grids: Annotated[
        list[str],
        typer.Argument(metavar="GRID...", help="Grid files (.json), or names from the library."),
    ],
    engine: Annotated[
        str, typer.Option(help="The engine: fea, calculix, beams or learned.")
    ] = "fea",
    model: ModelOption = None,
    mesh: Annotated[
        str | None,
        typer.Option(help="The mesh of the engine fea: default, or fine, which takes longer."),
    ] = None,
    material: MaterialOption = None,
    output: Annotated[
        list[str] | None,
        typer.Option(
            "-o",
            "--output",
            help="A file to write (repeat for more); its ending picks the format: "
            f"{' '.join(outputs.WRITERS)}. For several grids: a folder, which gets a .json for "
            "each.",
        ),
    ] = None,
    scatter: Annotated[
        bool,
        typer.Option("--scatter", help="Simulate prints of each grid, too: how far they differ."),
    ] = False,
    prints: Annotated[
        int | None,
        typer.Option(min=4, help="With --scatter: how many prints; so many that it is quick."),
    ] = None,
    as_json: Json = False,
) -> None:
    """Simulate grids: twelve frames, from flat through release to creep."""
    targets = output or []
    files = [Path(target) for target in targets]
    names = list(dict.fromkeys(grids))
    if prints is not None and not scatter:
        raise InputError("--prints goes with --scatter: how many prints are simulated")
    spread = SimulatedPrints(prints, as_json) if scatter else None
    a_folder = any(target.endswith(("/", os.sep)) for target in targets)
    if len(names) == 1 and not a_folder:
        design = grid_of(names[0], material)
        outputs.check(files, Path(names[0]))
        answering = _engine(engine, model, mesh)
        _one(design, answering, engine, model, files, spread, as_json)
        return
    if len(files) > 1 or (files and not a_folder and files[0].suffix and not files[0].is_dir()):
        raise InputError(f"{files[-1]}: several grids go to one folder, whose name ends in /")
    answering = _engine(engine, model, mesh)
    _many(names, answering, engine, material, files[0] if files else None, spread, as_json)


def _engine(name: str, model: str | None, mesh: str | None) -> "StreamingSimulator":
    from simulearn.simulate import engine

    return engine(name, model, mesh)


def _one(
    design: "Grid",
    answering: "StreamingSimulator",
    engine: str,
    model: str | None,
    files: list[Path],
    spread: SimulatedPrints | None,
    as_json: bool,
) -> None:
    """Simulate one grid, and write it to files."""
    from simulearn.simulate import one, remarks, result_to_dict, summary

    if spread is not None:
        spread.check(design)
    before = validation_of(design, {"learned": model or "default"}.get(engine)).warnings
    warn(before)
    with preparing(quiet=as_json), counting("frames", quiet=as_json) as progress:
        (outcome,) = answering.simulate([design], progress)
    result = one(outcome)
    warn(result.warnings, before)
    if not as_json:
        for line in remarks(result):
            err.print(f"[yellow]note:[/] {escape(line)}")
    if spread is not None:
        result = spread.added(result, answering)
    for path in files:
        outputs.write(result, path)
    if as_json:
        written = {"files": [str(p) for p in files], "engine": engine, "summary": summary(result)}
        print(json.dumps(written if files else result_to_dict(result), allow_nan=False))
        return
    out.print(_table(result))
    if result.scatter is not None:
        out.print(spread_table(result.scatter, result.grid.fixed))
    print_files(files)


def _many(
    names: list[str],
    answering: "StreamingSimulator",
    engine: str,
    material: Path | None,
    folder: Path | None,
    spread: SimulatedPrints | None,
    as_json: bool,
) -> None:
    """Simulate many grids; each outcome is written as soon as it is there."""
    from simulearn.simulate import Failure, Result, outcome_to_dict, write_json

    if folder is not None:
        _check_names(names)
    designs: dict[str, Grid] = {}
    outcomes: dict[str, Outcome] = {}
    unread: dict[str, InputError] = {}
    for name in names:
        try:
            designs[name] = grid_of(name, material)
            if spread is not None:
                spread.check(designs[name])
        except InputError as error:
            unread[name] = error
    if folder is not None:
        folder_of(folder)
        targets = {name: folder / f"{Path(name).stem}.json" for name in names}
        for name, path in targets.items():
            outputs.check_place(path, [Path(name)])
        for name, wrong in unread.items():
            _write_unread(wrong, targets[name])
    places = list(designs)
    with preparing(quiet=as_json), counting("frames", quiet=as_json) as progress:
        for k, outcome in answering.stream(list(designs.values()), progress):
            if spread is not None and isinstance(outcome, Result):
                outcome = spread.added(outcome, answering)
            if folder is not None:
                write_json(outcome, targets[places[k]])
                if isinstance(outcome, Result):  # what is written need not stay in memory
                    outcome = replace(outcome, stress=None, solid=None, displacements=None)
            outcomes[places[k]] = outcome
    rows = {name: unread.get(name) or outcomes[name] for name in names}
    failed = sum(not _answered(row) for row in rows.values())
    if as_json:
        listed: list[dict[str, Any]] = []
        for name, row in rows.items():
            data = _unread(row) if isinstance(row, InputError) else outcome_to_dict(row)
            if folder is not None:
                kept = ("schema", "code", "where", "message", "hint", "seconds", "stable",
                        "bound_mm", "snaps", "warnings", "collisions", "material",
                        "model", "scatter")  # fmt: skip
                data = {"file": str(targets[name])} | {k: data[k] for k in kept if k in data}
            listed.append({"name": name} | data)
        print(json.dumps({"engine": engine, "failed": failed, "results": listed}, allow_nan=False))
    else:
        out.print(_overview(rows), soft_wrap=False)
        for name, row in rows.items():
            if isinstance(row, Failure | InputError):
                reason = _reason(row)
                reason = reason if reason.startswith(f"{name}:") else f"{name}: {reason}"
                err.print(f"[red]failed:[/] {escape(reason)}")
        if folder is not None:
            out.print(f"wrote {len(rows)} files to {escape(str(folder))}")
    if failed:
        raise typer.Exit(3)


def _check_names(names: list[str]) -> None:
    """Raise where two grids would be written to one file; some file systems ignore case."""
    by_stem: dict[str, list[str]] = {}
    for name in names:
        by_stem.setdefault(Path(name).stem.casefold(), []).append(name)
    for same in by_stem.values():
        if len(same) > 1:
            raise InputError(
                f"{' and '.join(same)} would both be written to {Path(same[0]).stem}.json; "
                "rename one of them"
            )


def _unread(error: InputError) -> dict[str, Any]:
    return {
        "schema": "simulearn.failure/1",
        "code": error.code,
        "where": error.where,
        "message": str(error),
        "hint": "",
    }


def _write_unread(error: InputError, path: Path) -> None:
    from simulearn.cli.base import write_json

    write_json(path, _unread(error))


def _answered(row: "Outcome | InputError") -> bool:
    from simulearn.simulate import Result

    return isinstance(row, Result)


def _reason(row: "Failure | InputError") -> str:
    if isinstance(row, InputError):
        return str(row)
    return f"{row.message}; {row.hint}" if row.hint else row.message


def _overview(rows: "dict[str, Outcome | InputError]") -> Table:
    """Return what became of each grid."""
    from simulearn.simulate import Result, summary

    table = Table(box=None, pad_edge=False)
    table.add_column("grid", overflow="fold")
    of_prints = any(isinstance(row, Result) and row.scatter is not None for row in rows.values())
    spread = ("prints ±, mm",) if of_prints else ()
    for name in ("z lowest", "highest, mm", "bound, mm", *spread, "snaps", "time"):
        table.add_column(name, justify="right", no_wrap=True)
    table.add_column("")
    for name, row in rows.items():
        title = escape(Path(name).stem)
        if not isinstance(row, Result):
            blank = [""] * (len(table.columns) - 2)
            table.add_row(title, *blank, f"failed ({row.code})")
            continue
        numbers = summary(row)
        bound = "" if row.bound_mm is None else f"{row.bound_mm:.2f}"
        notes = [] if row.stable else ["unstable"]
        notes += ["collides"] if row.collisions else []
        differ = [] if not of_prints else [""] if row.scatter is None else [
            f"{row.scatter.overall:.2f}"
        ]  # fmt: skip
        if row.scatter is not None and row.scatter.groups:
            notes.append(f"prints come to {len(row.scatter.groups)} shapes")
        count = len(row.warnings)
        notes += [f"{count} warning" + "s" * (count > 1)] if count else []
        table.add_row(
            title,
            f"{numbers['lowest_mm']:.1f}",
            f"{numbers['highest_mm']:.1f}",
            bound,
            *differ,
            str(len(row.snaps) or ""),
            _seconds(row.seconds),
            ", ".join(notes),
        )
    return table


def _table(result: "Result") -> Table:
    """Return where the joints are, flat and at the end, and what collides."""
    from simulearn.simulate import collision_text, summary

    numbers: dict[str, Any] = summary(result)
    motion = "rise" if numbers["rise_mm"] > 0 else "fall"
    work = f", {numbers['iterations']} iterations" if "iterations" in numbers else ""
    mesh = ""
    if "mesh" in numbers:
        mesh = f", {numbers['mesh']} mesh of {numbers['bricks']:,} bricks"
    caption = f"{result.engine}{mesh}, {_seconds(result.seconds)}{work}; millimetres, +z up"
    caption += f"\nmaterial {escape(str(result.material))}"
    if result.model is not None:
        caption += f", model {escape(str(result.model))}"
    if result.bound_mm is not None:
        caption += f"\nnine of ten such answers are off by less than {result.bound_mm:.2f} mm"
    for collision in result.collisions[:COLLISIONS]:
        caption += f"\ncollision: {collision_text(collision)}"
    if len(result.collisions) > COLLISIONS:
        caption += f"\nand {len(result.collisions) - COLLISIONS} more collisions"
    table = Table(
        box=None,
        title=(
            f"{len(result.grid.joints)} joints, {len(result.grid.beams)} beams, "
            f"dimension {numbers['dimension_mm']:.1f} mm\n"
            f"largest {motion} {abs(numbers['rise_mm']):.1f} mm (joint {numbers['joint_risen']}), "
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

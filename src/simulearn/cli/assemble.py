"""The command assemble: parts put together in their order, checked and drawn."""

import json
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape
from rich.table import Table

from simulearn.cli.base import Json, app, err, out, print_files, warn
from simulearn.cli.grids import ModelOption
from simulearn.cli.progress import counting, preparing
from simulearn.errors import InputError

if TYPE_CHECKING:
    from simulearn.assembly import Assembled

MOST = 12  # collisions that are printed
VIEW = (-62.0, 18.0)  # degrees
ENDINGS = ".json .png .pdf .svg .strip.png .gif .mp4 .webm .glb .html"


@app.command()
def assemble(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="An assembly file (.json).")],
    engine: Annotated[
        str, typer.Option(help="The engine: fea, calculix, beams or learned.")
    ] = "fea",
    model: ModelOption = None,
    mesh: Annotated[
        str | None, typer.Option(help="The mesh of the engine fea: default or fine.")
    ] = None,
    view: Annotated[
        tuple[float, float],
        typer.Option(
            metavar="AZIMUTH ELEVATION",
            help="Where the viewer of pictures is, in degrees: from +x about z, and above.",
        ),
    ] = VIEW,
    output: Annotated[
        list[Path] | None,
        typer.Option(
            "-o",
            "--output",
            help=f"A file to write (repeat for more); its ending picks the format: {ENDINGS}.",
        ),
    ] = None,
    as_json: Json = False,
) -> None:
    """Simulate parts put together, in their order: what runs into what."""
    from simulearn import outputs
    from simulearn.assembly import assembled_to_dict, checked, read_assembly, simulated
    from simulearn.show import Camera
    from simulearn.simulate import engine as engine_of

    if not all(map(isfinite, view)):
        raise InputError(f"--view is {view[0]:g} {view[1]:g}; it is two angles in degrees")
    files = output or []
    outputs.check(files, file, outputs.ASSEMBLED)
    assembly = read_assembly(file)
    grids = [part.file for part in assembly.parts if part.file is not None]
    for path in files:
        outputs.check_place(path, [*grids, *(one.file for one in assembly.obstacles)])
    answering = engine_of(engine, model, mesh)
    with preparing(quiet=as_json):
        with counting("frames", quiet=as_json) as progress:
            assembled = simulated(assembly, answering, progress)
        with counting("steps checked", quiet=as_json) as progress:
            assembled = checked(assembled, progress)
    for name, failure in assembled.failures.items():
        reason = f"{failure.message}; {failure.hint}" if failure.hint else failure.message
        err.print(f"[red]failed:[/] {escape(f'part {name}: {reason}')}")
    assembled.require()
    warn(assembled.warnings)
    for path in files:
        with counting(path.suffix.removeprefix("."), quiet=as_json) as progress:
            outputs.write_assembled(assembled, path, Camera(*view), progress)
    if as_json:
        data = assembled_to_dict(assembled)
        if files:
            data["files"] = [str(path) for path in files]
            del data["timeline"]
        print(json.dumps(data, allow_nan=False))
    else:
        out.print(_parts(assembled))
        out.print(_steps(assembled))
        _collisions(assembled)
        print_files(files)
    if assembled.failures:
        raise typer.Exit(3)


def _parts(assembled: "Assembled") -> Table:
    """Return the grids: which parts have them, and what qualifies their results."""
    from simulearn.simulate import Result

    table = Table(box=None, pad_edge=False)
    for name in ("grid of", "parts", "bound, mm", ""):
        table.add_column(name, overflow="fold", justify="right" if name == "bound, mm" else "left")
    distinct = assembled.assembly.distinct
    for k in dict.fromkeys(distinct):
        outcome = assembled.outcomes[k]
        name = escape(assembled.assembly.parts[k].name)
        many = str(distinct.count(k))
        if not isinstance(outcome, Result):
            table.add_row(name, many, "", f"failed ({outcome.code})")
            continue
        notes = [] if outcome.stable else ["unstable"]
        count = len(outcome.warnings)
        notes += [f"{count} warning" + "s" * (count > 1)] if count else []
        bound = "" if outcome.bound_mm is None else f"{outcome.bound_mm:.2f}"
        table.add_row(name, many, bound, ", ".join(notes))
    return table


def _steps(assembled: "Assembled") -> Table:
    """Return the steps: when, who slides, who morphs."""
    table = Table(box=None, pad_edge=False)
    for name in ("step", "from, s", "to", "", "collisions"):
        table.add_column(name, justify="left" if not name else "right")
    moments = assembled.timeline
    for k, step in enumerate(assembled.assembly.order):
        own = moments.times[moments.of_step(k)]
        count = sum(one.step == k for one in assembled.collisions)
        table.add_row(
            str(k + 1), f"{own[0]:.1f}", f"{own[-1]:.1f}", escape(step.title), str(count or "")
        )
    return table


def _collisions(assembled: "Assembled") -> None:
    """Print what collides, the deepest first."""
    found = assembled.collisions
    for one in found[:MOST]:
        x, y, z = one.place
        err.print(f"[yellow]collision:[/] {escape(one.words)}, at {x:.0f}, {y:.0f}, {z:.0f} mm")
    if len(found) > MOST:
        err.print(f"[yellow]and {len(found) - MOST} more collisions[/]")
    if not found:
        out.print("no collisions")

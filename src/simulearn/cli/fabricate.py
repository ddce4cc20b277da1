"""Commands about printing: gcode, printers."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape
from rich.table import Table

from simulearn import outputs
from simulearn.cli.base import Json, MaterialOption, app, grid_of, out, print_files, warn
from simulearn.errors import InputError
from simulearn.files import replacing

if TYPE_CHECKING:
    from simulearn.fabricate import Job, Printer


@app.command("gcode")
def gcode_(
    grids: Annotated[
        list[str],
        typer.Argument(
            metavar="GRID...", help="Grid files (.json) or names from the library; one bed for all."
        ),
    ],
    printer: Annotated[
        str, typer.Option(help="A printer's name (see simulearn printers), or a profile (.toml).")
    ],
    output: Annotated[
        list[Path] | None,
        typer.Option(
            "-o",
            "--output",
            help="A file to write (repeat for more); its ending picks what: .gcode .gco .g the "
            "print; .gcode.3mf the print as a package for a Bambu Lab printer; .png .pdf .svg a "
            "picture of its layers; .json the toolpath; .3dm grids and toolpath for Rhino.",
        ),
    ] = None,
    layer: Annotated[
        int | None, typer.Option(min=1, help="Picture this layer alone, with its travels.")
    ] = None,
    material: MaterialOption = None,
    as_json: Json = False,
) -> None:
    """Make the file that prints a grid, and say how long it takes."""
    from simulearn.fabricate import load_printer, prepare

    files = output or []
    _check(files, [Path(name) for name in grids])
    names = [Path(name).stem for name in grids]
    machine = load_printer(printer)
    _check_machine(files, machine)
    job = prepare([grid_of(name, material) for name in grids], machine, names)
    if layer is not None and layer > len(job.path.layers):
        raise InputError(f"--layer is {layer}; the print has layers 1 to {len(job.path.layers)}")
    job.gcode  # noqa: B018  (whatever is wrong with it keeps all files from being written)
    if not as_json:
        warn(job.warnings)
    for path in files:
        WRITERS[outputs.ending_of(path, WRITERS)](job, path, layer)
    if as_json:
        print(json.dumps({"files": [str(path) for path in files]} | job.facts, allow_nan=False))
        return
    out.print(_table(job))
    print_files(files)


@app.command("printers")
def printers_(
    name: Annotated[str | None, typer.Argument(help="A printer, to see its profile.")] = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Write its profile here, to be edited.")
    ] = None,
    as_json: Json = False,
) -> None:
    """List the printers, or show the profile of one."""
    from simulearn.fabricate import load_printer, printers, profile_text

    if name is None:
        if output is not None:
            raise InputError("name the printer whose profile is to be written")
        known = {title: load_printer(title) for title in printers()}
        if as_json:
            print(json.dumps({title: p.model_dump() for title, p in known.items()}))
            return
        table = Table("name", "printer", "bed, mm", "firmware", "E", "nozzle, mm", box=None)
        table.add_column("tried")
        for title, p in known.items():
            bed, nozzle = f"{p.bed.width:g} x {p.bed.depth:g}", str(p.print.get("nozzle", ""))
            bed = f"{p.bed.width:g}, round" if p.bed.round else bed
            tried, firmware = p.tried or "by nobody", p.firmware
            words = (title, p.title, bed, firmware, p.extruder.extrusion, nozzle, tried)
            table.add_row(*map(escape, words))
        out.print(table)
        return
    profile = load_printer(name)
    text = profile_text(name)
    if output is not None:
        outputs.check_place(output, [Path(name)])
        with replacing(output) as temporary:
            temporary.write_text(text, encoding="utf-8")
        if not as_json:
            out.print(f"wrote {escape(str(output))}")
    if as_json:
        print(json.dumps(profile.model_dump()))
    elif output is None:
        print(text, end="")


def _print(job: "Job", path: Path, layer: int | None) -> None:
    from simulearn.fabricate import write_gcode

    write_gcode(job.gcode, path)


def _package(job: "Job", path: Path, layer: int | None) -> None:
    from simulearn.fabricate import write_package

    write_package(job, path)


def _picture(job: "Job", path: Path, layer: int | None) -> None:
    from simulearn.show import toolpath

    if layer is None:
        picture = toolpath.layers(job.path, _words(job))
    else:
        number = f"layer {layer} of {len(job.path.layers)}, {job.printer.title}"
        picture = toolpath.layer(job.path, layer - 1, number)
    with replacing(path) as temporary:
        picture.savefig(temporary)


def _data(job: "Job", path: Path, layer: int | None) -> None:
    from simulearn.fabricate import toolpath_to_dict

    data = toolpath_to_dict(job.path) | {"print": job.facts}
    with replacing(path) as temporary:
        temporary.write_text(json.dumps(data, allow_nan=False) + "\n", encoding="utf-8")


def _rhino(job: "Job", path: Path, layer: int | None) -> None:
    from simulearn.interop import write_job_3dm

    write_job_3dm(job, path)


Writer = Callable[["Job", Path, int | None], None]
WRITERS: dict[str, Writer] = {
    ".gcode": _print,
    ".gco": _print,
    ".g": _print,
    ".gcode.3mf": _package,
    ".png": _picture,
    ".pdf": _picture,
    ".svg": _picture,
    ".json": _data,
    ".3dm": _rhino,
}


def _check(files: list[Path], grids: list[Path]) -> None:
    """Make sure that all files can be written before anything is computed."""
    for path in files:
        outputs.check_package(path, outputs.ending_of(path, WRITERS))
        outputs.check_place(path, grids)


def _check_machine(files: list[Path], machine: "Printer") -> None:
    """Make sure that a printer reads the files before anything is computed."""
    from simulearn.fabricate import model_number

    for path in files:
        if WRITERS[outputs.ending_of(path, WRITERS)] is _package:
            try:
                model_number(machine)
            except InputError as error:
                raise InputError(f"{path}: {error}") from error


def _words(job: "Job") -> str:
    from simulearn.fabricate.header import clock

    needs = job.estimate
    return f"{job.printer.title}, {clock(needs.seconds)}, {needs.filament_g:.1f} g"


def _table(job: "Job") -> Table:
    """Return what a print takes."""
    from simulearn.fabricate.header import clock

    needs, settings = job.estimate, job.settings
    table = Table(
        box=None,
        show_header=False,
        title=escape(f"{', '.join(job.names)} on {job.printer.title}"),
        title_justify="left",
    )
    table.add_row(
        "time", f"{clock(needs.seconds)}, after {clock(needs.heating_seconds)} of heating"
    )
    length = f"{needs.filament_mm / 1000:.2f} m of {settings.filament:g} mm"
    table.add_row("filament", f"{length}, {needs.filament_cm3:.1f} cm3, {needs.filament_g:.1f} g")
    bed = f"bed {settings.bed:g} C" if settings.bed else "bed off"
    table.add_row("material", escape(str(job.material.identity)))
    table.add_row("heat", f"nozzle {settings.temperature:g} C, {bed}")
    table.add_row(
        "layers", f"{settings.layers} of {settings.layer:g} mm, rows {settings.line:g} mm"
    )
    return table

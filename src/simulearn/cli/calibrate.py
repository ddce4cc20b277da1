"""Commands that fit a material to measured prints: plate, fit, and those of photos."""

import json
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.markup import escape
from rich.table import Table

from simulearn import outputs
from simulearn.cli import calibrate_photo
from simulearn.cli.base import Json, app, err, out, print_files, warn
from simulearn.errors import InputError
from simulearn.files import replacing

if TYPE_CHECKING:
    from simulearn.calibrate import Fit
    from simulearn.material import Material

calibrate = typer.Typer(
    help="Fit a material to your printer and bath: print strips, measure, fit.",
    no_args_is_help=True,
)
app.add_typer(calibrate, name="calibrate")
calibrate_photo.register(calibrate)

PRINTS = (".gcode", ".gco", ".g", ".gcode.3mf")
MAPS = (".svg", ".png", ".pdf")


@calibrate.command()
def plate(
    printer: Annotated[
        str, typer.Option(help="A printer's name (see simulearn printers), or a profile (.toml).")
    ],
    output: Annotated[
        Path,
        typer.Option(
            "-o",
            "--output",
            help="The print (.gcode .gco .g .gcode.3mf). Beside it come NAME.svg, a map of the "
            "strips, and NAME-form.toml, the form to fill in.",
        ),
    ],
    material: Annotated[
        str, typer.Option(metavar="NAME", help="The base material: a name or a file (.toml).")
    ] = "pla-hot-water",
    repeats: Annotated[
        int, typer.Option(min=1, max=9, help="How often each strip is printed.")
    ] = 3,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="Replace a form that is there.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Make the print of strips that tell what your material does, with a map and a form."""
    from simulearn.calibrate import make_plate, write_form
    from simulearn.fabricate import load_printer, model_number, write_gcode, write_package
    from simulearn.show.plate import plate_map

    ending = outputs.ending_of(output, PRINTS)
    stem = output.name[: -len(ending)]
    files = [output, output.with_name(f"{stem}.svg"), output.with_name(f"{stem}-form.toml")]
    for path in files:
        outputs.check_place(path, [Path(printer), Path(material)])
    if files[2].exists() and not overwrite:
        raise InputError(
            f"{files[2]}: is there already and may be filled in; name another plate, or add "
            "--overwrite",
            "calibration-form-there",
            str(files[2]),
        )
    machine = load_printer(printer)
    if ending == PRINTS[-1]:
        model_number(machine)
    made = make_plate(machine, material, repeats)
    made.job.gcode  # noqa: B018  (whatever is wrong with it keeps all files from being written)
    picture = plate_map(made)
    if ending == PRINTS[-1]:
        write_package(made.job, output)
    else:
        write_gcode(made.job.gcode, output)
    with replacing(files[1]) as temporary:
        picture.savefig(temporary)
    write_form(made.form, files[2])
    if as_json:
        facts = made.job.facts | {"lengths_mm": made.length}
        print(json.dumps({"files": [str(path) for path in files]} | facts, allow_nan=False))
        return
    from simulearn.fabricate.header import clock

    warn(made.job.warnings)
    needs = made.job.estimate
    count = len(made.job.grids)
    out.print(f"{count} strips, {clock(needs.seconds)}, {needs.filament_g:.0f} g of filament")
    print_files(files)


@calibrate.command("fit")
def fit_(
    form: Annotated[Path, typer.Argument(metavar="FORM", help="The form (.toml), filled in.")],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="The material (.toml) to write; named by its file."),
    ] = None,
    as_json: Json = False,
) -> None:
    """Fit a material to the form's readings, and say how sure each of its numbers is."""
    from simulearn.calibrate import fit, read_form, write_material
    from simulearn.material import check_name, load_material
    from simulearn.material.reading import is_name

    if output is not None:
        outputs.ending_of(output, (".toml",))
        outputs.check_place(output, [form])
    filled = read_form(form)
    base = load_material(filled.material)
    if output is not None:
        if not is_name(filled.material):
            outputs.check_place(output, [Path(filled.material)])
        check_name(output.stem, f"{output}: the material's name")
    with err.status("fitting") if err.is_terminal and not as_json else _nothing():
        found = fit(filled, base)
    made = found.material
    if output is not None:
        made = write_material(found, output, form.name)
    if as_json:
        data = facts(found, made) | {"file": None if output is None else str(output)}
        print(json.dumps(data, allow_nan=False))
        return
    warn(found.messages)
    out.print(_strips(found))
    out.print(_numbers(found))
    noise = found.noise
    out.print(
        f"readings differ by {noise.reading:.2f} mm; strips by {100 * noise.scatter:.1f} % of "
        f"their strain ({100 * noise.low:.1f} to {100 * noise.high:.1f})"
    )
    size, low, high = found.size
    out.print(f"printed over designed length: {size:.4f} ({low:.4f} to {high:.4f})")
    if output is not None:
        out.print(f"material {escape(str(made.identity))}")
        print_files([output])


def facts(found: "Fit", made: "Material") -> dict[str, Any]:
    """Return a fit as plain data, with the material as it was written."""
    noise = found.noise
    return {
        "material": made.model_dump(mode="json"),
        "digest": made.digest,
        "numbers": [asdict(one) for one in found.estimates],
        "strips": [asdict(one) | {"difference": one.difference} for one in found.differences],
        "reading_mm": noise.reading,
        "scatter": {"value": noise.scatter, "low": noise.low, "high": noise.high},
        "size": dict(zip(("value", "low", "high"), found.size, strict=True)),
        "singular_values": list(found.singular),
        "covariance": found.covariance.tolist(),
        "spread": found.spread,
        "warnings": [asdict(message) for message in found.messages],
    }


def _strips(found: "Fit") -> Table:
    """Return what was measured and simulated, mm."""
    table = Table("strip", "", "readings", box=None, title="strips, mm", title_justify="left")
    for head in ("measured", "base", "fitted", "difference"):
        table.add_column(head, justify="right")
    for one in found.differences:
        values = (one.measured, one.before, one.simulated)
        words = [f"{value:.2f}" for value in values]
        table.add_row(
            escape(one.strip),
            one.key,
            str(one.count),
            *words,
            f"{one.difference:+.2f} ± {one.sd:.2f}",
        )
    return table


def _numbers(found: "Fit") -> Table:
    """Return the fitted numbers with their intervals."""
    table = Table("number", box=None, title="numbers, 90 % intervals", title_justify="left")
    for head in ("base", "fitted", "from", "to"):
        table.add_column(head, justify="right")
    table.add_column("determined")
    table.add_column("what it is")
    for one in found.estimates:
        values = (one.base, one.value, one.low, one.high)
        table.add_row(one.name, *(f"{value:.3f}" for value in values), one.determined, one.words)
    return table


def _nothing() -> Any:
    from contextlib import nullcontext

    return nullcontext()

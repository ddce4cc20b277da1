"""The command import: a drawing of another program becomes a grid file."""

import json
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer
from rich.markup import escape
from rich.table import Table

from simulearn.cli.base import app, err, out, print_files, validated
from simulearn.errors import InputError, Message
from simulearn.grid import grid_to_dict, write_grid

if TYPE_CHECKING:
    from simulearn.drawings.importing import Imported

# Messages that a person should look at; the others only say what was taken.
WARNINGS = ("size-odd", "actuator-near-miss", "actuators-mixed", "curves", "reader")


@app.command("import")
def import_(
    file: Annotated[Path, typer.Argument(help="DXF, SVG, Rhino (.3dm), JSON, CSV or OBJ.")],
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="GRID", help="Write the grid here (.json).")
    ],
    unit: Annotated[
        str | None, typer.Option(help="Unit of the drawing: mm, cm, m, in, ft, pt, px, um, ...")
    ] = None,
    width: Annotated[
        float | None, typer.Option(metavar="MM", help="How wide the whole drawing is.")
    ] = None,
    layers: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="Read this layer only (with * and ?); may be repeated."),
    ] = None,
    flatten: Annotated[
        float | None,
        typer.Option(metavar="MM", help="Make curves straight pieces, at most so far from them."),
    ] = None,
    actuators: Annotated[
        Literal["auto", "layers", "colours", "none"],
        typer.Option(help="What says which beams have actuators."),
    ] = "auto",
    tolerance: Annotated[
        float, typer.Option(metavar="MM", help="How far lines may miss each other.")
    ] = 1.0,
    without: Annotated[
        list[str] | None,
        typer.Option(metavar="CODE", help="Leave this as drawn, as gap or leaf; may be repeated."),
    ] = None,
    place: Annotated[
        Literal["corner", "drawn"],
        typer.Option(help="Lower left corner at the origin, or where it is drawn."),
    ] = "corner",
    material: Annotated[str, typer.Option(help="Name of the material.")] = "pla-hot-water",
    as_json: Annotated[bool, typer.Option("--json", help="Print the machine form.")] = False,
) -> None:
    """Make a grid of a drawing: mended, with a report of all that was mended and left out."""
    from simulearn.drawings.importing import Options, imported
    from simulearn.drawings.units import UnitError

    options = Options(
        unit=unit,
        width=width,
        layers=tuple(layers or ()),
        flatten=flatten,
        actuators=actuators,
        tolerance=tolerance,
        without=frozenset(code.strip() for codes in without or () for code in codes.split(",")),
        material=material,
        place=place,
    )
    data = _contents(file)
    if _same(file, output):
        raise InputError(f"{output}: is the drawing itself; name another file for the grid")
    try:
        result = imported(data, file.name, options)
    except UnitError as error:
        raise UnitError(f"{file}: {error}", error.guess, error.size) from error
    except InputError as error:
        raise InputError(f"{file}: {error}", error.code, error.where) from error
    report = validated(result.grid)
    write_grid(result.grid, output)
    if as_json:
        errors = [replace(error, message=_not_yet(error.message)) for error in report.errors]
        messages = [*result.messages, *errors, *report.warnings]
        data_out = {
            "grid": grid_to_dict(result.grid),
            "format": result.format,
            "unit": asdict(result.unit),
            "layers": [asdict(layer) for layer in result.layers],
            "mends": [asdict(mend) for mend in result.mends],
            "messages": [asdict(message) for message in messages],
        }
        print(json.dumps(data_out))
        return
    _print(result)
    for message in result.messages:
        _say(message.message, message.code in WARNINGS)
    if any(message.code == "curves" for message in result.messages):
        _say("--flatten 0.5 makes curves straight pieces that keep within 0.5 mm", False)
    for text in (*map(_not_yet, _in_short(report.errors)), *_in_short(report.warnings)):
        _say(text, True)
    print_files([output])


def _contents(file: Path) -> bytes:
    from simulearn.drawings.reading import MOST_BYTES

    try:
        with file.open("rb") as stream:
            return stream.read(MOST_BYTES + 1)  # the reader refuses what is larger
    except FileNotFoundError as error:
        raise InputError(f"{file}: there is no such file") from error
    except OSError as error:
        raise InputError(f"{file}: cannot be read ({error.strerror})") from error


def _same(file: Path, output: Path) -> bool:
    try:
        return output.exists() and output.samefile(file)
    except OSError:
        return False


def _not_yet(text: str) -> str:
    """Return the text of a grid's error for an import: it does not keep the grid from a file."""
    return f"cannot be simulated yet: {text}"


def _in_short(messages: Sequence[Message]) -> Iterator[str]:
    """Yield the first message of each kind, and how many more there are."""
    count = Counter(message.code for message in messages)
    for message in {message.code: message for message in reversed(messages)}.values():
        more = count[message.code] - 1
        yield f"{message.message} (and {more} more of this kind)" if more else message.message


def _say(text: str, warning: bool) -> None:
    if warning:
        err.print(f"[yellow]warning:[/] {escape(text)}")
    else:
        out.print(escape(text))


def _print(result: "Imported") -> None:
    """Print what was read and mended."""
    grid = result.grid
    joints = "1 joint" if len(grid.joints) == 1 else f"{len(grid.joints)} joints"
    beams = "1 beam" if len(grid.beams) == 1 else f"{len(grid.beams)} beams"
    out.print(f"{escape(result.format)}: {joints}, {beams}")
    if any(layer.name for layer in result.layers):
        table = Table("layer", "colour", "lines", "read", "actuator", box=None)
        for layer in result.layers:
            ratio = "" if layer.ratio is None else f"{layer.ratio:g}"
            read = "yes" if layer.taken else "no"
            name, colour = escape(layer.name or "(none)"), layer.colour or ""
            table.add_row(name, colour, str(layer.lines), read, ratio)
        out.print(table)
    for mend in result.mends:
        out.print(f"mended: {escape(mend.message)} [dim]({mend.code})[/]")

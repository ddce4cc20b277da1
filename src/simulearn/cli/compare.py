"""The command compare: a measured print beside its simulation."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import numpy as np
import typer
from rich.markup import escape
from rich.table import Table

from simulearn.cli.base import (
    GridArgument,
    Json,
    MaterialOption,
    app,
    grid_of,
    out,
    print_files,
    validated,
    warn,
    write_json,
)
from simulearn.cli.grids import ModelOption
from simulearn.cli.progress import counting, preparing
from simulearn.errors import InputError
from simulearn.files import replacing
from simulearn.outputs import check_place, ending_of

if TYPE_CHECKING:
    from simulearn.compare import Comparison

ENDINGS = (".png", ".pdf", ".svg", ".json", ".csv")
PLACES = ("centre", "top", "bottom")
SHOWN = 30  # rows of a table on the terminal; files have all


@app.command()
def compare(
    grid: GridArgument,
    measured: Annotated[
        Path,
        typer.Argument(
            metavar="MEASURED",
            help="A table of joints (joint, x, y, z: .csv .tsv .txt), or a scan (.stl .ply .obj, "
            ".xyz).",
        ),
    ],
    engine: Annotated[
        str, typer.Option(help="The engine: fea, calculix, beams or learned.")
    ] = "fea",
    model: ModelOption = None,
    material: MaterialOption = None,
    unit: Annotated[
        str | None, typer.Option(help="Unit of the measurement: mm, cm, m, in; else by its size.")
    ] = None,
    at: Annotated[
        str, typer.Option(help="Where the joints of a table were measured: centre, top, bottom.")
    ] = "centre",
    output: Annotated[
        list[Path] | None,
        typer.Option(
            "-o",
            "--output",
            help="A file to write (repeat for more): .png .pdf .svg the picture; .json all "
            "figures; .csv the measured joints, which compare reads again.",
        ),
    ] = None,
    as_json: Json = False,
) -> None:
    """Compare a print with its simulation, and say what change of the material explains it."""
    from simulearn.compare import compare as compared
    from simulearn.compare import read_measurement
    from simulearn.compare.report import figures
    from simulearn.simulate import engine as engine_of

    if at not in PLACES:
        raise InputError(f'--at is "{at}"; it is one of {", ".join(PLACES)}')
    files = output or []
    for path in files:
        ending_of(path, ENDINGS)
        check_place(path, [measured, Path(grid)])
    design = grid_of(grid, material)
    before = validated(design).warnings
    warn(before)
    measurement = read_measurement(measured, len(design.joints))
    simulator = engine_of(engine, model)
    with preparing(quiet=as_json), counting("stages", quiet=as_json) as progress:
        found = compared(
            design, measurement, simulator, unit=unit, at=at, progress=progress  # type: ignore[arg-type]
        )  # fmt: skip
    warn([*found.result.warnings, *found.messages], before)
    for path in files:
        _write(found, path)
    if as_json:
        print(json.dumps(figures(found), allow_nan=False))
        return
    _print(found)
    print_files(files)


def _write(found: "Comparison", path: Path) -> None:
    from simulearn.compare.report import figures, write_joints

    ending = ending_of(path, ENDINGS)
    if ending == ".json":
        write_json(path, figures(found))
    elif ending == ".csv":
        write_joints(found, path)
    else:
        from simulearn.show.compare import compared

        picture = compared(found)
        with replacing(path) as temporary:
            picture.savefig(temporary)


def _print(found: "Comparison") -> None:
    from simulearn.compare.report import qualified, verdict

    off, size = found.deviation, found.result.grid.dimension
    worst = off.distances[off.worst]
    out.print(
        f"{off.measured.sum()} of {len(off.joints)} joints measured; mean deviation "
        f"{off.mean:.2f} mm ({off.mean / size:.1%} of the dimension), worst {worst:.2f} mm "
        f"({worst / size:.1%}, joint {found.joint_numbers[off.worst]})"
    )
    out.print(_joints(found))
    out.print(_beams(found))
    out.print(f"simulated by {found.result.engine} with {escape(str(found.result.material))}")
    for line in qualified(found):
        out.print(escape(line))
    out.print(escape(verdict(found)))
    out.print("[dim]`simulearn calibrate` fits a material to printed strips[/]")


def _joints(found: "Comparison") -> Table:
    off, size = found.deviation, found.result.grid.dimension
    table = _table(("joint", "off, mm", "%", "in plane", "up"))
    worst_first = np.argsort(-np.nan_to_num(off.distances, nan=-1.0), kind="stable")
    for j in sorted(worst_first[:SHOWN].tolist()):
        if not off.measured[j]:
            table.add_row(str(found.joint_numbers[j]), "", "", "", "")
            continue
        x, y, z = off.moves[j]
        table.add_row(
            str(found.joint_numbers[j]),
            f"{off.distances[j]:.2f}",
            f"{100 * off.distances[j] / size:.1f}",
            f"{float(np.hypot(x, y)):.2f}",
            f"{z:+.2f}",
        )
    if len(off.joints) > SHOWN:
        table.caption = f"the {SHOWN} joints that are farthest off; files have all"
    return table


def _beams(found: "Comparison") -> Table:
    off = found.deviation
    heads = ("beam", "mean, mm", "largest")
    table = _table((*heads, "curl, deg/mm", "simulated") if found.scanned else heads)
    curls = np.degrees(off.curvature)
    worst_first = np.argsort(-np.nan_to_num(off.beams[:, 1], nan=-1.0), kind="stable")
    for b in sorted(worst_first[:SHOWN].tolist()):
        cells = [*off.beams[b], *(curls[b] if found.scanned else ())]
        table.add_row(
            str(found.beam_numbers[b]), *("" if np.isnan(x) else f"{x:.2f}" for x in cells)
        )
    if len(off.beams) > SHOWN:
        table.caption = f"the {SHOWN} beams that are farthest off; files have all"
    return table


def _table(heads: tuple[str, ...]) -> Table:
    table = Table(box=None, caption_justify="left")
    for name in heads:
        table.add_column(name, justify="right", no_wrap=True)
    return table

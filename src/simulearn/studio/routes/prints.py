"""Prints of designs: the G-code, the toolpath to draw, and what both take."""

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, Any, Literal

import numpy as np
from fastapi import APIRouter, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from simulearn.errors import InputError
from simulearn.fabricate import (
    Job,
    Printer,
    prepare,
    settings_of,
    toolpath_to_dict,
    write_package,
)
from simulearn.fabricate.moves import RESTORE
from simulearn.grid import Grid, grid_from_dict
from simulearn.material import load_material, materials_of
from simulearn.studio.bodies import GridBody, JsonRoute, OwnMaterials, json_response
from simulearn.studio.downloads import attachment, safe_stem
from simulearn.studio.problems import MessageBody
from simulearn.studio.routes.designs import BUSY, check_size
from simulearn.studio.routes.printers import chosen
from simulearn.studio.settings import Settings
from simulearn.studio.turns import Turns

MEDIA_TYPE = "text/x.gcode"
PACKAGE = "gcode.3mf"  # for Bambu Lab printers
PACKAGE_TYPE = "model/3mf"
MOST_GRIDS = 64  # on one bed
MOST_STROKES = 200_000  # of a print
FILES: dict[int | str, Any] = {
    200: {
        "content": {
            MEDIA_TYPE: {"schema": {"type": "string"}},
            PACKAGE_TYPE: {"schema": {"type": "string", "format": "binary"}},
        },
        "description": "The print.",
    }
}

router = APIRouter(route_class=JsonRoute, tags=["prints"])


class ToolpathBody(BaseModel):
    """Designs to print together on one bed, and the printer: its name or its profile."""

    model_config = ConfigDict(strict=True, extra="forbid")

    grids: Annotated[list[GridBody], Field(min_length=1, max_length=MOST_GRIDS)]
    printer: Annotated[str | None, Field(description="the name of one")] = None
    profile: Annotated[str | None, Field(description="TOML text, in place of a name")] = None
    names: Annotated[
        list[str] | None, Field(description="of the designs, for the file and its messages")
    ] = None
    materials: OwnMaterials = []


class GcodeBody(ToolpathBody):
    """The same, and which file: G-code, or a package of it for a Bambu Lab printer."""

    format: Literal["gcode", "gcode.3mf"] = "gcode"


class PrintedGrid(BaseModel):
    """A design where it lies on the bed, mm."""

    name: str
    joints: list[list[float]]


class PrintFacts(BaseModel):
    """What a print takes; mm, s, g."""

    printer: str
    material: str
    grids: list[PrintedGrid]
    layers: int
    bounds_mm: list[list[float]]
    seconds: float
    heating_seconds: float
    filament_mm: float
    filament_cm3: float
    filament_g: float
    part_g: Annotated[float, Field(description="of the grids, without skirt and brim")]
    brim: Annotated[bool, Field(description="whether there is one, to be cut off before the bath")]
    warnings: list[MessageBody]


class GcodeAnswer(PrintFacts):
    """A print as G-code."""

    gcode: str
    file: Annotated[str, Field(description="a name for the file")]


class ToolpathAnswer(BaseModel):
    """All beads of a print, `simulearn.toolpath/1`; see `toolpath_to_dict`."""

    model_config = ConfigDict(extra="allow")

    print: PrintFacts
    bed: Annotated[dict[str, Any], Field(description="as a printer's, and its low and high corner")]
    drawn: Annotated[
        list[bool],
        Field(description="of each bead, whether filament is drawn back on the way to it"),
    ]


@router.post("/api/gcode", response_model=GcodeAnswer, responses=BUSY | FILES)
async def gcode(body: GcodeBody, request: Request) -> Response:
    """Return the file that prints designs, and what the print takes.

    Where the Accept header names text/x.gcode, the answer is the file alone; so is a package.
    """
    state = request.app.state
    turns: Turns = state.turns
    plain = MEDIA_TYPE in request.headers.get("accept", "")
    return await turns.run(request, lambda _: _gcode(body, state.settings, plain))


@router.post("/api/toolpath", response_model=ToolpathAnswer, responses=BUSY)
async def toolpath(body: ToolpathBody, request: Request) -> Response:
    """Return the strokes of a print, layer by layer, to be drawn."""
    state = request.app.state
    turns: Turns = state.turns
    return await turns.run(request, lambda _: _toolpath(body, state.settings))


def _gcode(body: GcodeBody, settings: Settings, plain: bool) -> Response:
    job = _prepared(body, settings)
    name = safe_stem("-".join(job.names) if len(job.names) < 3 else f"{len(job.names)}-grids")
    file = f"{name}.{body.format}"
    headers = {"Vary": "Accept"}
    if body.format == PACKAGE:
        headers |= attachment(file)
        return Response(_packed(job), media_type=PACKAGE_TYPE, headers=headers)
    if plain:
        headers |= attachment(file)
        return Response(job.gcode, media_type=MEDIA_TYPE, headers=headers)
    response = json_response({"gcode": job.gcode, "file": file, **job.facts})
    response.headers.update(headers)
    return response


def _packed(job: Job) -> bytes:
    """Return a print as a package for a Bambu Lab printer."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / PACKAGE
        write_package(job, path)
        return path.read_bytes()


def _toolpath(body: ToolpathBody, settings: Settings) -> Response:
    job = _prepared(body, settings)
    bed = job.printer.bed
    corners = {"low": list(bed.low), "high": list(bed.high)}
    path = toolpath_to_dict(job.path)
    drawn = np.isin(np.arange(len(path["role"])), job.moves.bead[job.moves.kind == RESTORE])
    more = {"print": job.facts, "bed": bed.model_dump() | corners, "drawn": drawn.tolist()}
    return json_response(path | more)


def _prepared(body: ToolpathBody, settings: Settings) -> Job:
    """Return the print that a request describes.

    Raises:
        InputError: a design or the printer is wrong, or the print is too large.
    """
    printer = chosen(body.printer, body.profile)
    names = body.names
    if names is None:
        names = [f"grid {k}" for k in range(len(body.grids))] if len(body.grids) > 1 else ["grid"]
    if len(names) != len(body.grids):
        text = f"names has {len(names)} entries for {len(body.grids)} grids; give one for each"
        raise InputError(text, "names", "names")
    names = [safe_stem(name) for name in names]
    materials = materials_of(body.materials)
    grids, beams = [], 0
    for k, entry in enumerate(body.grids):
        grid = grid_from_dict(entry, materials=materials)
        check_size(grid, settings)
        grids.append(grid)
        beams += len(grid.beams)
        if beams > settings.beams_in_all:
            text = f"the grids have more than {settings.beams_in_all} beams in all; send fewer"
            raise InputError(text, "too-large", f"grids[{k}]")
    _check_strokes(grids, printer)
    return prepare(grids, printer, names)


def _check_strokes(grids: Sequence[Grid], printer: Printer) -> None:
    """Raise InputError where a profile's layers and lines are so fine that a print takes long."""
    for k, grid in enumerate(grids):
        material = load_material(grid.material)
        settings, _ = settings_of(material, printer)
        rows = material.section.width / settings.line
        strokes = settings.layers * rows * sum(len(grid.beams) for grid in grids)
        if strokes > MOST_STROKES:
            text = (
                f"the print would have about {strokes:.0f} strokes; at most {MOST_STROKES} are "
                "made here; take thicker layers, wider lines or fewer beams"
            )
            raise InputError(text, "too-large", f"grids[{k}]")

"""Prints of designs: the G-code, the toolpath to draw, and what both take."""

from typing import Annotated, Any

from fastapi import APIRouter, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from simulearn.errors import InputError
from simulearn.fabricate import Job, load_printer, prepare, printers, toolpath_to_dict
from simulearn.grid import grid_from_dict
from simulearn.studio.bodies import GridBody, JsonRoute, json_response
from simulearn.studio.downloads import attachment, safe_stem
from simulearn.studio.problems import MessageBody
from simulearn.studio.routes.designs import BUSY, check_size
from simulearn.studio.settings import Settings
from simulearn.studio.turns import Turns

MEDIA_TYPE = "text/x.gcode"
MOST_GRIDS = 64  # on one bed
ENDING = ".gcode"
TEXT: dict[int | str, Any] = {
    200: {"content": {MEDIA_TYPE: {"schema": {"type": "string"}}}, "description": "The print."}
}

router = APIRouter(route_class=JsonRoute, tags=["prints"])


class ToolpathBody(BaseModel):
    """Designs to print together on one bed, and the name of the printer."""

    model_config = ConfigDict(strict=True, extra="forbid")

    grids: Annotated[list[GridBody], Field(min_length=1, max_length=MOST_GRIDS)]
    printer: str
    names: Annotated[
        list[str] | None, Field(description="of the designs, for the file and its messages")
    ] = None


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
    warnings: list[MessageBody]


class GcodeAnswer(PrintFacts):
    """A print as G-code."""

    gcode: str
    file: Annotated[str, Field(description="a name for the file")]


class ToolpathAnswer(BaseModel):
    """All beads of a print, `simulearn.toolpath/1`; see `toolpath_to_dict`."""

    model_config = ConfigDict(extra="allow")

    print: PrintFacts
    bed: Annotated[dict[str, Any], Field(description="its size, and its low and high corner")]


@router.post("/api/gcode", response_model=GcodeAnswer, responses=BUSY | TEXT)
async def gcode(body: ToolpathBody, request: Request) -> Response:
    """Return the file that prints designs, and what the print takes.

    Where the Accept header names text/x.gcode, the answer is the file alone.
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


def _gcode(body: ToolpathBody, settings: Settings, plain: bool) -> Response:
    job = _prepared(body, settings)
    name = safe_stem("-".join(job.names) if len(job.names) < 3 else f"{len(job.names)}-grids")
    file = f"{name}{ENDING}"
    headers = {"Vary": "Accept"}
    if plain:
        headers |= attachment(file)
        return Response(job.gcode, media_type=MEDIA_TYPE, headers=headers)
    response = json_response({"gcode": job.gcode, "file": file, **job.facts})
    response.headers.update(headers)
    return response


def _toolpath(body: ToolpathBody, settings: Settings) -> Response:
    job = _prepared(body, settings)
    bed = job.printer.bed
    corners = {"low": list(bed.low), "high": list(bed.high)}
    more = {"print": job.facts, "bed": bed.model_dump() | corners}
    return json_response(toolpath_to_dict(job.path) | more)


def _prepared(body: ToolpathBody, settings: Settings) -> Job:
    """Return the print that a request describes.

    Raises:
        InputError: a design or the printer is wrong; a printer is named, never a path.
    """
    if body.printer not in printers():
        text = f'printer "{body.printer}" is not known; known are {", ".join(printers())}'
        raise InputError(text, "printer-unknown", "printer")
    names = body.names
    if names is None:
        names = [f"grid {k}" for k in range(len(body.grids))] if len(body.grids) > 1 else ["grid"]
    if len(names) != len(body.grids):
        text = f"names has {len(names)} entries for {len(body.grids)} grids; give one for each"
        raise InputError(text, "names", "names")
    names = [safe_stem(name) for name in names]
    grids, beams = [], 0
    for k, entry in enumerate(body.grids):
        grid = grid_from_dict(entry)
        check_size(grid, settings)
        grids.append(grid)
        beams += len(grid.beams)
        if beams > settings.beams_in_all:
            text = f"the grids have more than {settings.beams_in_all} beams in all; send fewer"
            raise InputError(text, "too-large", f"grids[{k}]")
    return prepare(grids, load_printer(body.printer), names)

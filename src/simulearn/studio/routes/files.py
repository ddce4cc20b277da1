"""Files: what a person opens, and a result in the format that they want."""

from functools import partial
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Query, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from simulearn.errors import Cancel
from simulearn.grid import Grid, grid_from_dict
from simulearn.simulate import Result, one
from simulearn.studio.bodies import GridBody, JsonRoute, json_response
from simulearn.studio.documentfile import DocumentGoal, Drawing
from simulearn.studio.downloads import attachment, safe_stem
from simulearn.studio.exports import check_format, exported
from simulearn.studio.opening import opened
from simulearn.studio.problems import MessageBody
from simulearn.studio.routes.designs import BUSY, check_fea, check_size
from simulearn.studio.simulations import Simulations, engine_of
from simulearn.studio.turns import Turns

router = APIRouter(route_class=JsonRoute, tags=["files"])

FILE: dict[int | str, Any] = {
    200: {
        "description": "The file; several are one ZIP archive.",
        "content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}},
    }
}
ANY_FILE = {
    "requestBody": {
        "required": True,
        "content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}},
    }
}


class OpenedFile(BaseModel):
    """The parts of a document that a file holds, and what was not taken over."""

    kind: Literal["grid", "task", "result", "document"]
    name: str
    grid: Drawing
    goals: list[DocumentGoal]
    printer: str | None
    messages: list[MessageBody]


class ExportBody(BaseModel):
    """A design, the format of its result, and a name for the file."""

    model_config = ConfigDict(strict=True, extra="forbid")

    grid: GridBody
    format: Annotated[str, Field(description="an ending such as .png; see /api/version")]
    engine: Annotated[str, Field(description="learned, beams or fea")] = "learned"
    name: Annotated[str, Field(max_length=1000)] = "grid"


@router.post("/api/open", response_model=OpenedFile, responses=BUSY, openapi_extra=ANY_FILE)
async def open_(
    request: Request,
    name: Annotated[str, Query(description="of the file", max_length=1000)] = "",
) -> Response:
    """Read a grid, a task, a result or a document, known by its contents."""
    turns: Turns = request.app.state.turns
    data = await request.body()
    return await turns.run(request, lambda _: json_response(opened(data, name)))


@router.post("/api/export", response_class=Response, responses=BUSY | FILE)
async def export(body: ExportBody, request: Request) -> Response:
    """Return a design's result as a file, as `simulearn simulate -o` writes it."""
    state = request.app.state
    simulations: Simulations = state.simulations
    exports: Turns = state.exports
    check_format(body.format)
    grid = grid_from_dict(body.grid)
    check_size(grid, state.settings)
    if body.engine == "fea":
        check_fea([grid], state.settings)
    result = await simulations.run(request, partial(_simulated, grid, body.engine))
    stem = safe_stem(body.name)
    work = partial(exported, result, body.format, stem)
    data, file, kind = await exports.run(request, work)
    return Response(data, media_type=kind, headers=attachment(file))


def _simulated(grid: Grid, engine: str, cancel: Cancel) -> Result:
    return one(engine_of(engine).simulate([grid], cancel=cancel)[0])

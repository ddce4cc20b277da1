"""Files: what a person opens, and a result in the format that they want."""

from dataclasses import asdict
from functools import partial
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Query, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from simulearn.drawings.importing import Options
from simulearn.drawings.mending import MENDS
from simulearn.drawings.units import UnitError
from simulearn.errors import Cancel
from simulearn.grid import Grid, grid_from_dict
from simulearn.grid.structure import FARTHEST
from simulearn.material import materials_of
from simulearn.simulate import Result, one
from simulearn.studio.bodies import GridBody, JsonRoute, OwnMaterials, json_response
from simulearn.studio.documentfile import (
    DocumentGoal,
    DocumentPrinter,
    DocumentSurface,
    Drawing,
)
from simulearn.studio.downloads import attachment, safe_stem
from simulearn.studio.exports import check_format, exported
from simulearn.studio.opening import opened
from simulearn.studio.problems import MessageBody, Problem
from simulearn.studio.routes.designs import BUSY, check_fea, check_size
from simulearn.studio.simulations import Simulations, engine_of
from simulearn.studio.turns import Turns
from simulearn.units import LENGTHS

Place = Annotated[list[float], Field(min_length=2, max_length=2)]
Point = Annotated[list[float], Field(min_length=3, max_length=3)]

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


class Reading(BaseModel):
    """The name of a file that is opened, and how it is to be read where it is a drawing."""

    name: Annotated[str, Field(description="of the file", max_length=1000)] = ""
    meant: Annotated[
        Literal["surface", "drawing"] | None,
        Field(description="of a file that holds lines and triangles"),
    ] = None
    unit: Annotated[
        str | None,
        Field(
            description="goes before what the file says", json_schema_extra={"enum": list(LENGTHS)}
        ),
    ] = None
    width: Annotated[float | None, Field(description="of all, mm", gt=0, le=FARTHEST)] = None
    layers: Annotated[list[str], Field(description="names or patterns", max_length=1000)] = []
    flatten: Annotated[
        float | None, Field(description="mm, of chords from curves", gt=0, le=FARTHEST)
    ] = None
    actuators: Literal["auto", "layers", "colours", "none"] = "auto"
    tolerance: Annotated[float, Field(description="mm", gt=0, le=FARTHEST)] = 1.0
    without: Annotated[
        list[Literal[MENDS]],  # type: ignore[valid-type]
        Field(description="mends that are not done", max_length=len(MENDS)),
    ] = []

    def options(self) -> Options:
        """Return how a drawing is to be read."""
        chosen = self.model_dump(exclude={"name", "meant"})
        layers, without = tuple(self.layers), frozenset(self.without)
        return Options(**chosen | {"layers": layers, "without": without})


class DrawingUnit(BaseModel):
    """The unit of a drawing: its length (mm), its name and what says so."""

    mm: float
    name: str
    source: str


class DrawingLayer(BaseModel):
    """A layer: whether it was read, and the ratio of the actuator that it stands for."""

    name: str
    colour: str | None
    lines: int
    taken: bool
    ratio: float | None


class DrawingMend(BaseModel):
    """Something that was done to a drawing so that it became a grid, and where (mm)."""

    code: str
    count: int
    message: str
    places: list[Place]


class DrawingFacts(BaseModel):
    """What is reported of a drawing of another program."""

    format: str
    unit: DrawingUnit
    layers: list[DrawingLayer]
    mends: list[DrawingMend]


class OpenedFile(BaseModel):
    """The parts of a document that a file holds, and what was not taken over."""

    kind: Literal["grid", "task", "result", "document", "drawing"]
    name: str
    grid: Drawing
    goals: list[DocumentGoal]
    surfaces: list[DocumentSurface]
    pose: Literal["fixed", "free"]
    printer: DocumentPrinter | None
    materials: Annotated[OwnMaterials, Field(description="of a document only")]
    messages: list[MessageBody]
    drawing: Annotated[DrawingFacts | None, Field(description="of a drawing only")]


class SurfaceMessage(MessageBody):
    """What was mended, guessed or changed in a surface, and where (mm)."""

    places: list[Point]


class SurfaceFacts(BaseModel):
    """A surface as a document takes it, and what is to be told of its file; mm."""

    vertices: list[Point]
    faces: list[list[int]]
    format: str
    triangles: Annotated[int, Field(description="of the file")]
    apart_mm: Annotated[float, Field(description="from the file's surface, where simplified")]
    unit: str
    unit_by: Literal["given", "format", "file", "guess"]
    size: Point
    messages: list[SurfaceMessage]


class OpenedSurface(BaseModel):
    """A file that holds no design but a surface."""

    kind: Literal["surface"]
    name: str
    surface: SurfaceFacts


class ExportBody(BaseModel):
    """A design, the format of its result, and a name for the file."""

    model_config = ConfigDict(strict=True, extra="forbid")

    grid: GridBody
    format: Annotated[str, Field(description="an ending such as .png; see /api/version")]
    engine: Annotated[str, Field(description="learned, beams or fea")] = "learned"
    name: Annotated[str, Field(max_length=1000)] = "grid"
    materials: OwnMaterials = []


@router.post(
    "/api/open",
    response_model=OpenedFile | OpenedSurface,
    responses=BUSY,
    openapi_extra=ANY_FILE,
)
async def open_(request: Request, reading: Annotated[Reading, Query()]) -> Response:
    """Read a grid, task, result, document, drawing or surface, known by its contents.

    A file that may be a drawing or a surface is refused with the code `surface-or-drawing`, unless
    `meant` says which. One whose unit is not known, or makes no sense, is refused with the code
    `unit-unknown`.
    The problem then has two more members: `size`, width and height (and depth) in units of the
    file, and `guess`, the likely unit or null.
    """
    turns: Turns = request.app.state.turns
    data = await request.body()
    return await turns.run(request, lambda _: _opened(data, reading))


def _opened(data: bytes, reading: Reading) -> Response:
    try:
        return json_response(opened(data, reading.name, reading.options(), reading.meant))
    except UnitError as error:
        more = {"guess": error.guess and asdict(error.guess), "size": list(error.size)}
        raise Problem(422, error.code, str(error), error.where, more=more) from error


@router.post("/api/export", response_class=Response, responses=BUSY | FILE)
async def export(body: ExportBody, request: Request) -> Response:
    """Return a design's result as a file, as `simulearn simulate -o` writes it."""
    state = request.app.state
    simulations: Simulations = state.simulations
    exports: Turns = state.exports
    check_format(body.format)
    grid = grid_from_dict(body.grid, materials=materials_of(body.materials))
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

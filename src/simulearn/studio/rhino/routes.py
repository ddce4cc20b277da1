"""What the script for Rhino needs: the script itself, and lines of a model made into a grid."""

from importlib.resources import files
from typing import Annotated

import numpy as np
from fastapi import APIRouter, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from simulearn.drawings.drawing import Curve, Line
from simulearn.errors import InputError
from simulearn.grid import grid_to_dict
from simulearn.studio.bodies import JsonRoute, json_response
from simulearn.studio.downloads import attachment
from simulearn.studio.hops.design import Design, design_from
from simulearn.studio.settings import Settings
from simulearn.studio.turns import Turns

SCRIPT = "simulearn_rhino.py"

Point = Annotated[list[float], Field(min_length=3, max_length=3)]

router = APIRouter(route_class=JsonRoute, include_in_schema=False)


class ModelLine(BaseModel):
    """A polyline of a model, its layer's full name, its colour, and what messages call it."""

    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)

    points: Annotated[list[Point], Field(min_length=2)]
    layer: str = ""
    colour: str | None = None
    name: str = ""


class ModelBody(BaseModel):
    """Lines of a model, the model's unit in Rhino, and a point at the joint that is held."""

    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)

    lines: list[ModelLine]
    units: str | None = None
    fixed: Point | None = None


@router.api_route(f"/rhino/{SCRIPT}", methods=["GET", "HEAD"])
def script() -> Response:
    """Return the script for Rhino 8."""
    text = files("simulearn.studio.rhino").joinpath(SCRIPT).read_text(encoding="utf-8")
    media_type = "text/x-python; charset=utf-8"
    return Response(text, media_type=media_type, headers=attachment(SCRIPT))


@router.post("/rhino/grid")
async def grid(body: ModelBody, request: Request) -> Response:
    """Return the grid that lines of a model show, where it lies, and what was mended."""
    state = request.app.state
    turns: Turns = state.turns
    return await turns.run(request, lambda _: _grid(body, state.settings))


def _grid(body: ModelBody, settings: Settings) -> Response:
    if not body.lines:
        text = "there are no lines; pick lines or polylines, the beams' axes"
        raise InputError(text, "no-lines", "lines")
    lines: list[Line | Curve] = [
        Line(np.array(one.points), one.layer, one.colour, one.name) for one in body.lines
    ]
    fixed = np.array([body.fixed] if body.fixed else [], float).reshape(-1, 3)
    return json_response(_described(design_from(lines, fixed, body.units, settings)))


def _described(design: Design) -> dict[str, object]:
    """Return a design as data; a point of a result is at origin + point / mm @ axes."""
    placement = design.placement
    places = design.points([one.place for one in design.remarks]).tolist()
    return {
        "grid": grid_to_dict(design.grid),
        "mm": placement.unit.mm,
        "unit": placement.unit.name,
        "origin": placement.outside(design.anchor).tolist(),
        "axes": placement.axes.tolist(),
        "joints": design.points(design.grid.joints.tolist()).tolist(),
        "remarks": [
            {"text": one.text, "code": one.code, "quiet": one.quiet, "point": point}
            for one, point in zip(design.remarks, places, strict=True)
        ],
    }

"""How far shapes are from goals, of which kind these may be."""

from typing import Annotated, Any

import numpy as np
from fastapi import APIRouter, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from simulearn.errors import Cancel
from simulearn.grid.structure import FARTHEST
from simulearn.inverse import task_from_dict
from simulearn.inverse.measuring import Measured, entries, measure
from simulearn.studio.answers import MeasureAnswer
from simulearn.studio.bodies import JsonRoute, TaskBody, json_response, parted
from simulearn.studio.routes.designs import BUSY, check_size
from simulearn.studio.settings import Settings
from simulearn.studio.turns import Turns

MOST_SHAPES = 4
Coordinate = Annotated[float, Field(ge=-FARTHEST, le=FARTHEST)]
Point = Annotated[list[Coordinate], Field(min_length=3, max_length=3)]
Corners = Annotated[list[Point], Field(min_length=8, max_length=8)]
Section = Annotated[list[Point], Field(min_length=4, max_length=4)]
Sections = Annotated[list[Section], Field(min_length=3, max_length=3)]

router = APIRouter(route_class=JsonRoute, tags=["designs"])


class ShapeBody(BaseModel):
    """Corners of the joints and of the beams' sections in the last frame, mm, as in a result."""

    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)

    joints: list[Corners]
    beams: list[Sections]


class MeasureBody(BaseModel):
    """A task, and shapes of designs with its joints and beams; a search begins with the first."""

    model_config = ConfigDict(strict=True, extra="forbid")

    task: TaskBody
    shapes: Annotated[list[ShapeBody], Field(min_length=1, max_length=MOST_SHAPES)]


@router.post("/api/measure", response_model=MeasureAnswer, responses=BUSY)
async def measure_(body: MeasureBody, request: Request) -> Response:
    """Return how far shapes are from the goals of a task, and where they are compared."""
    turns: Turns = request.app.state.turns
    settings: Settings = request.app.state.settings
    return await turns.run(request, lambda cancel: _measured(body, settings, cancel))


def _measured(body: MeasureBody, settings: Settings, _: Cancel) -> Response:
    data, materials = parted(body.task)
    task = task_from_dict(data, materials=materials)
    check_size(task.start, settings)
    shapes = [
        (np.array(one.joints).reshape(-1, 8, 3), np.array(one.beams).reshape(-1, 3, 4, 3))
        for one in body.shapes
    ]
    found = measure(task, shapes)
    names, kinds = task.aims.names, task.aims.kinds
    goals = [
        {"entry": entry, "name": name, "kind": kind}
        for entry, name, kind in zip(entries(task), names, kinds, strict=True)
    ]
    return json_response({"goals": goals, "shapes": [_shape(one) for one in found]})


def _shape(one: Measured) -> dict[str, Any]:
    return {
        "error_mm": one.error_mm,
        "distances_mm": one.distances.tolist(),
        "degrees": list(one.degrees),
        "lines": one.lines.tolist(),
        "place": {"turn": one.place.turn.tolist(), "shift": one.place.shift.tolist()},
    }

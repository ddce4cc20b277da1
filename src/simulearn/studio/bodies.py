"""Requests with JSON, read strictly, and what they hold.

A design in a request is checked by the library itself, which says best what is wrong with it; here
its model only describes it.
"""

import json
from collections.abc import Callable, Coroutine
from typing import Annotated, Any

from anyio import to_thread
from fastapi import Request, Response
from fastapi.routing import APIRoute
from pydantic import BaseModel, ConfigDict, Field, SkipValidation

from simulearn.errors import InputError
from simulearn.files import parse_json
from simulearn.grid import grid_to_dict, make
from simulearn.grid.gridfile import GridFile
from simulearn.inverse import Task
from simulearn.learn.common.bundle import shipped
from simulearn.material import Material, materials_of
from simulearn.material.own import MOST_MATERIALS, MOST_TEXT
from simulearn.studio.problems import Problem
from simulearn.studio.simulations import AT_ONCE

MOST_PRINTS = 300  # as many as a model answers in a moment
SHORT = 2**16  # bytes of JSON that take a millisecond or less; more are read beside the loop

OwnMaterials = Annotated[
    list[Annotated[str, Field(max_length=MOST_TEXT)]],
    Field(
        max_length=MOST_MATERIALS,
        description="TOML texts of materials that do not come along; grids name them by name",
    ),
]
GridBody = Annotated[GridFile, SkipValidation]


class _GridFile(GridFile):
    """A grid, and the materials that it may name besides those that come along."""

    materials: OwnMaterials = Field(default=[])


class _TaskFile(Task):
    """A grid, goals, what may change, how to search, and materials that the grid may name."""

    grid: GridFile  # type: ignore[assignment]
    materials: OwnMaterials = Field(default=[])


GridAlone = Annotated[_GridFile, SkipValidation]
TaskBody = Annotated[_TaskFile, SkipValidation]


def _one_of(*names: str) -> Any:
    """Return a field that is described as one of some names; who reads it says it better."""
    return Field(json_schema_extra={"enum": list(names)})


class SimulateBody(BaseModel):
    """Designs to simulate, by which engine, by which model where that is `learned`, materials."""

    model_config = ConfigDict(
        strict=True,
        extra="forbid",
        json_schema_extra={"examples": [{"grids": [grid_to_dict(make("saddle", (1, 1)))]}]},
    )

    grids: Annotated[list[GridBody], Field(min_length=1)]
    engine: Annotated[str, _one_of(*AT_ONCE)] = "learned"
    model: Annotated[str, _one_of("default", *shipped())] | None = None
    materials: OwnMaterials = []
    prints: Annotated[
        int,
        Field(
            ge=0,
            le=MOST_PRINTS,
            description="to be drawn from the material's scatter, of the one grid; 0: none",
        ),
    ] = 0


class JsonRoute(APIRoute):
    """A route whose body, if it has one, is strict JSON; to be named as a router's route class."""

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        """Return the function that answers a request."""
        handle = super().get_route_handler()
        if self.body_field is None:
            return handle

        async def handle_json(request: Request) -> Response:
            kind = request.headers.get("content-type", "").partition(";")[0]
            if kind.strip().lower() != "application/json":
                text = "the body is JSON; its Content-Type is application/json"
                raise Problem(415, "content-type", text, "Content-Type")
            strict = _StrictRequest(request.scope, request.receive)
            if not await strict.body():
                raise Problem(400, "json", "the body is empty; it is a JSON object", "body")
            return await handle(strict)

        return handle_json


class _StrictRequest(Request):
    """A request that refuses what JSON does not allow."""

    async def json(self) -> Any:
        """Return what the body holds."""
        body = await self.body()
        if len(body) <= SHORT:
            return _parsed(body)
        return await to_thread.run_sync(_parsed, body)


def parted(data: Any) -> tuple[Any, dict[str, Material]]:
    """Return a grid or task of a request without its materials, and these by their names.

    Raises:
        InputError: one is not a material; see `materials_of`.
    """
    if not isinstance(data, dict) or "materials" not in data:
        return data, {}
    rest = {key: value for key, value in data.items() if key != "materials"}
    return rest, materials_of(data["materials"])


def json_response(content: Any) -> Response:
    """Return an answer in JSON; ASCII, so that any text can be in it."""
    return Response(json.dumps(content, allow_nan=False), media_type="application/json")


def _parsed(body: bytes) -> Any:
    try:
        return parse_json(body.decode())
    except UnicodeDecodeError as error:
        text = f"the body is not UTF-8 at byte {error.start}"
        raise Problem(400, "json", text, f"byte {error.start}") from error
    except InputError as error:
        raise Problem(400, error.code, f"the body {error}", error.where) from error

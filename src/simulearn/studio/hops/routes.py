"""Where Hops asks: the list of components, what each takes and gives, and what it computes.

Hops reads the description of a component at the address that a person types, and sends what is to
be computed to /solve on the same host, with the address's path as the pointer; versions before 0.7
send it to the same folder instead.
"""

import asyncio
import base64
from functools import cache
from importlib.resources import files
from time import monotonic
from typing import Annotated, Any

from fastapi import APIRouter, FastAPI, Query, Request, Response
from fastapi.responses import PlainTextResponse

from simulearn import __version__
from simulearn.errors import Cancel, CancelledError
from simulearn.studio.bodies import JsonRoute, json_response
from simulearn.studio.hops.components import COMPONENTS
from simulearn.studio.hops.components.shared import Deadline
from simulearn.studio.hops.parameters import Component
from simulearn.studio.hops.schemas import Solve, description, entry
from simulearn.studio.hops.solving import Answer, solve
from simulearn.studio.problems import Problem
from simulearn.studio.simulations import Simulations

WARMING = 20.0  # s that a request waits for kernels to be compiled
LOOK = 0.05  # s between looks whether they are
READ = ["GET", "HEAD"]

router = APIRouter(route_class=JsonRoute, include_in_schema=False)


@router.api_route("/hops", methods=READ)
@router.api_route("/hops/", methods=READ)
async def listed() -> Response:
    """Return all components, as Hops lists those of a source of functions."""
    return json_response([entry(one, _icon()) for one in COMPONENTS.values()])


@router.api_route("/hops/{name}", methods=READ)
@router.api_route("/hops/{name}/", methods=READ)
async def described(name: str) -> Response:
    """Return what a component takes and gives."""
    return json_response(description(_component(name), _icon()))


@router.api_route("/io", methods=READ)
async def io(pointer: Annotated[str, Query()] = "") -> Response:
    """Return what the component that a pointer names takes and gives."""
    return json_response(description(_component(pointer), _icon()))


@router.post("/io")
async def io_posted(body: Solve) -> Response:
    """Return what the component that a pointer names takes and gives."""
    return json_response(description(_component(body.pointer or ""), _icon()))


@router.post("/solve")
@router.post("/hops/solve")
async def solve_pointed(body: Solve, request: Request) -> Response:
    """Compute the component that a pointer names."""
    return await _solved(_component(body.pointer or ""), body, request)


@router.post("/hops/{name}")
@router.post("/hops/{name}/")
async def solve_named(name: str, body: Solve, request: Request) -> Response:
    """Compute the component at an address."""
    return await _solved(_component(name), body, request)


@router.api_route("/healthcheck", methods=READ)
async def healthcheck() -> Response:
    """Say that the server answers."""
    return PlainTextResponse("healthy")


@router.api_route("/version", methods=READ)
async def version() -> Response:
    """Return versions, as a server for Rhino's geometry does."""
    return json_response({"rhino": "", "compute": __version__, "git_sha": None})


def _component(pointer: str) -> Component:
    """Return the component that a path or its last part names.

    Raises:
        Problem: there is none.
    """
    name = pointer.split("?")[0].strip("/ ").lower().removeprefix("hops/")
    found = COMPONENTS.get(name)
    if found is None:
        text = f"there is no component {name[:40]!r}; there are {', '.join(COMPONENTS)}"
        raise Problem(404, "component-unknown", text, "pointer")
    return found


async def _solved(component: Component, body: Solve, request: Request) -> Response:
    simulations: Simulations = request.app.state.simulations
    begun = monotonic()
    await _ready(simulations)

    def work(cancel: Cancel) -> Answer:
        return _within_time(component, body, request.app, Deadline(cancel, begun))

    answer = await simulations.run(request, work)
    response = json_response(answer.body)
    response.status_code = answer.status
    return response


def _within_time(component: Component, body: Solve, app: FastAPI, deadline: Deadline) -> Answer:
    """Return the answer, or say that it takes too long."""
    try:
        return solve(component, body, app, deadline)
    except CancelledError as error:
        if not deadline.overdue:
            raise
        raise deadline.problem() from error


async def _ready(simulations: Simulations) -> None:
    """Wait a while for the kernels, which are compiled only once on a machine.

    Raises:
        Problem: that takes longer.
    """
    if simulations.ready:
        return
    simulations.start_warming()
    for _ in range(int(WARMING / LOOK)):
        await asyncio.sleep(LOOK)
        if simulations.ready:
            return
    text = "the studio prepares itself, which takes a minute or two the first time; solve again"
    raise Problem(503, "not-ready", text, headers={"Retry-After": "20"})


@cache
def _icon() -> str:
    """Return the icon of 24 x 24 pixels (PNG) in base64."""
    data: Any = files("simulearn.studio.hops").joinpath("icon.png").read_bytes()
    return base64.b64encode(data).decode()

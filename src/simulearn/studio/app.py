"""The studio's server: the page's files and the REST API on one address."""

import threading
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from functools import cache
from typing import Any

from fastapi import FastAPI, Request, Response
from starlette.middleware.gzip import GZipMiddleware
from starlette.types import ASGIApp, Receive, Scope, Send

from simulearn.interop import frames
from simulearn.studio.bodies import json_response
from simulearn.studio.documents import Documents
from simulearn.studio.hops import routes as hops
from simulearn.studio.hops.searches import Searches
from simulearn.studio.hops.words import SOLVING, InWordsOfHops
from simulearn.studio.jobs import Jobs
from simulearn.studio.openapi import describe
from simulearn.studio.page import serve_page
from simulearn.studio.problems import LastResort, answer_errors
from simulearn.studio.rhino import routes as rhino
from simulearn.studio.routes import (
    about,
    designs,
    documents,
    files,
    goals,
    jobs,
    materials,
    printers,
    prints,
)
from simulearn.studio.safety import BodyLimit, OwnOriginOnly, SecurityHeaders
from simulearn.studio.settings import Settings
from simulearn.studio.simulations import Simulations
from simulearn.studio.turns import Turns

ROUTERS = (
    about.router,
    materials.router,
    designs.router,
    goals.router,
    jobs.router,
    printers.router,
    prints.router,
    files.router,
    documents.router,
    hops.router,
    rhino.router,
)
ROOM = 2**14  # bytes of text that are worth compressing
EFFORT = 4  # of compressing; more takes longer than it saves


def create_app(settings: Settings | None = None) -> FastAPI:
    """Return the server's application.

    Args:
        settings: hosts, folder of the documents and limits.

    Raises:
        InputError: a package of the studio is missing.
    """
    settings = settings or Settings()
    # Without /docs: its scripts come from another site, which the page's policy does not allow.
    app = FastAPI(openapi_url=None, redirect_slashes=False, lifespan=_lifespan)
    app.state.settings = settings
    app.state.simulations = Simulations(settings)
    app.state.jobs = Jobs(settings)
    app.state.searches = Searches(app.state.jobs)
    app.state.documents = Documents(settings)
    app.state.turns = Turns("file", 2, settings.waiting)
    app.state.exports = Turns("export", 1, settings.waiting, settings.export_seconds)
    for router in ROUTERS:
        app.include_router(router)
    serve_page(app)
    _serve_description(app)
    answer_errors(app)
    # From the inside out.
    app.add_middleware(_Compression)
    larger = dict.fromkeys(("/api/open", *SOLVING), settings.file_bytes)
    app.add_middleware(BodyLimit, settings.body_bytes, larger)
    app.add_middleware(OwnOriginOnly, settings.hosts)
    app.add_middleware(LastResort)
    app.add_middleware(InWordsOfHops)
    app.add_middleware(SecurityHeaders)
    return app


@asynccontextmanager
async def _lifespan(app: FastAPI) -> AsyncIterator[None]:
    simulations: Simulations = app.state.simulations
    simulations.start_warming()
    yield
    stop(app)


def stop(app: FastAPI) -> list[threading.Thread]:
    """Stop all that an application computes; return threads that may take a while to end."""
    state = app.state
    threads = state.jobs.close()
    for service in (state.simulations, state.turns, state.exports):
        threads += service.close()
    return threads


def _serve_description(app: FastAPI) -> None:
    """Add /openapi.json to an application."""

    @cache
    def description() -> dict[str, Any]:
        return describe(app)

    async def answer(request: Request) -> Response:
        return json_response(description())

    app.openapi = description  # type: ignore[method-assign]
    app.add_route("/openapi.json", answer, include_in_schema=False)


class _Compression:
    """ASGI: compresses long text, and no frames, whose answer must not wait."""

    def __init__(self, app: ASGIApp) -> None:
        self._plain = app
        self._compressing = GZipMiddleware(app, minimum_size=ROOM, compresslevel=EFFORT)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request."""
        accepted = dict(scope.get("headers", ())).get(b"accept", b"")
        binary = frames.MEDIA_TYPE.encode() in accepted
        await (self._plain if binary else self._compressing)(scope, receive, send)

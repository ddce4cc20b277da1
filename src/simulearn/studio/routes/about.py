"""What the server is and has: its version and the library."""

from functools import cache
from typing import Any

from fastapi import APIRouter, Request

from simulearn import __version__
from simulearn.grid import grid_to_dict, library, make
from simulearn.learn.common.bundle import bundle_of
from simulearn.outputs import WRITERS
from simulearn.studio.answers import Library, Version
from simulearn.studio.bodies import JsonRoute
from simulearn.studio.simulations import AT_ONCE

API = 1  # rises when a change breaks other programs

router = APIRouter(route_class=JsonRoute, tags=["about"])


@router.get("/api/version", response_model=Version)
async def version(request: Request) -> Any:
    """Return what the server is, and whether its kernels are compiled."""
    state = request.app.state
    settings = state.settings
    limits = ("grids", "joints", "beams", "beams_in_all", "body_bytes")
    return {
        "version": __version__,
        "api": API,
        "ready": state.simulations.ready,
        "engines": list(AT_ONCE),
        "model": _model(),
        "formats": list(WRITERS),
        "limits": {name: getattr(settings, name) for name in limits},
    }


@router.get("/api/library", response_model=Library, response_model_exclude_none=True)
async def library_() -> Any:
    """Return the grids of the library."""
    return _library()


@cache
def _model() -> dict[str, str]:
    return bundle_of("default").identity.model_dump()


@cache
def _library() -> dict[str, Any]:
    designs = [
        {"name": name, "description": words, "grid": grid_to_dict(make(name))}
        for name, words in library().items()
    ]
    return {"designs": designs}

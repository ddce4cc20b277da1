"""The studio's server: the page's files and the REST API on one address."""

from pathlib import Path

from fastapi import FastAPI, Request, Response
from fastapi.responses import FileResponse
from fastapi.staticfiles import StaticFiles

from simulearn.grid import grid_from_dict, library, make, grid_to_dict
from simulearn.simulate import engine, outcome_to_dict
from simulearn.studio import frames
from simulearn.studio.libraries import libraries

PAGE = Path(__file__).parent / "page"


def create_app() -> FastAPI:
    """Return the server's application."""
    app = FastAPI(title="SimuLearn studio")
    found = libraries()

    @app.get("/")
    def index() -> FileResponse:
        return FileResponse(PAGE / "index.html")

    @app.get("/libraries/{name}")
    def library_file(name: str) -> FileResponse:
        return FileResponse(found[name], media_type="text/javascript")

    @app.get("/api/library")
    def library_() -> dict:
        return {"designs": [{"name": n, "description": d, "grid": grid_to_dict(make(n))} for n, d in library().items()]}

    @app.post("/api/simulate")
    async def simulate(request: Request) -> Response:
        body = await request.json()
        grids = [grid_from_dict(grid) for grid in body["grids"]]
        outcomes = engine(body.get("engine", "learned")).simulate(grids)
        if frames.MEDIA_TYPE in request.headers.get("accept", ""):
            return Response(frames.to_bytes(grids, outcomes), media_type=frames.MEDIA_TYPE)
        import json
        return Response(json.dumps({"results": [outcome_to_dict(o) for o in outcomes]}), media_type="application/json")

    app.mount("/page", StaticFiles(directory=PAGE))
    return app

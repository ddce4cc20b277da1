"""The page's files: always the newest of ours, the libraries kept by the browser for an hour."""

import os
from collections.abc import Mapping
from pathlib import Path

from fastapi import FastAPI, Request, Response
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

from simulearn.interop.libraries import libraries

PAGE = Path(__file__).parent / "page"
NEWEST = "no-cache"  # kept, but asked about each time: a 304 takes a millisecond
AN_HOUR = "max-age=3600"  # their addresses stay the same when the package is upgraded
# What the system says of these endings differs, and scripts of another type are not run.
TYPES = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".svg": "image/svg+xml",
}


class _Files(StaticFiles):
    """Files of a folder with types and cache headers of their own."""

    def __init__(self, folder: Path, cache: str) -> None:
        super().__init__(directory=folder)
        self._cache = cache

    def file_response(
        self,
        full_path: str | os.PathLike[str],
        stat_result: os.stat_result,
        scope: Scope,
        status_code: int = 200,
    ) -> Response:
        response = super().file_response(full_path, stat_result, scope, status_code)
        response.headers["cache-control"] = self._cache
        kind = TYPES.get(Path(full_path).suffix.lower())
        if kind is not None and "content-type" in response.headers:
            response.headers["content-type"] = kind
        return response


class _Named(_Files):
    """Files by names that are not their places."""

    def __init__(self, files: Mapping[str, Path], cache: str) -> None:
        super().__init__(PAGE, cache)
        self._named = dict(files)

    def lookup_path(self, path: str) -> tuple[str, os.stat_result | None]:
        file = self._named.get(path)
        return ("", None) if file is None else (str(file), file.stat())


def serve_page(app: FastAPI) -> None:
    """Add the page to an application: at `/`, and at `/d/ID` for a document that is saved."""
    page = _Files(PAGE, NEWEST)

    async def index(request: Request) -> Response:
        return await page.get_response("index.html", request.scope)

    for path in ("/", "/d/{id}"):
        app.add_route(path, index, include_in_schema=False)
    app.mount("/page", page)
    app.mount("/libraries", _Named(libraries(), AN_HOUR))

"""Errors as Hops shows them: whatever refuses a request of Hops, its balloon says why."""

import json
from collections.abc import MutableMapping
from typing import Any

from starlette.datastructures import MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from simulearn.studio.hops.schemas import Solve, io_schema, solved
from simulearn.studio.problems import MEDIA_TYPE

ROOT = "/hops"
SOLVING = ("/solve", "/hops/solve")  # where Hops sends what is to be computed
OTHERS = ("/solve", "/io")


class InWordsOfHops:
    """ASGI: turns problems into what the classes of Hops can hold.

    Hops reads every answer into one of its two classes, whatever the status is. A problem has
    other fields of the same names there, on which it stops without a word.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request."""
        if scope["type"] != "http" or not _is_of_hops(scope["path"]):
            await self._app(scope, receive, send)
            return
        # Hops asks for no compression, and a problem must be read here.
        headers = [head for head in scope["headers"] if head[0] != b"accept-encoding"]
        scope = {**scope, "headers": headers}
        begin: Message | None = None
        content = b""

        async def sending(event: Message) -> None:
            nonlocal begin, content
            if event["type"] == "http.response.start" and _is_problem(event):
                begin = event
                return
            if begin is None:
                await send(event)
                return
            content += event.get("body", b"")
            if not event.get("more_body"):
                body = _answer(scope["method"], scope["path"], json.loads(content))
                changed = MutableHeaders(scope=begin)
                changed["content-type"] = "application/json"
                changed["content-length"] = str(len(body))
                await send(begin)
                await send({"type": "http.response.body", "body": body})

        await self._app(scope, receive, sending)


def _is_of_hops(path: str) -> bool:
    path = path.rstrip("/")
    return path in OTHERS or path == ROOT or path.startswith(f"{ROOT}/")


def _is_problem(event: MutableMapping[str, Any]) -> bool:
    kind = MutableHeaders(scope=event).get("content-type", "")
    return kind.startswith(MEDIA_TYPE)


def _answer(method: str, path: str, problem: dict[str, Any]) -> bytes:
    """Return what a request gets in place of a problem."""
    texts = problem.get("messages") or [one["message"] for one in problem.get("errors", ())]
    texts = texts or [problem["detail"]]
    describing = method in ("GET", "HEAD") or path.rstrip("/") == "/io"
    content = io_schema("", [], [], "", texts) if describing else solved(Solve(), [], [], texts)
    return json.dumps(content).encode()

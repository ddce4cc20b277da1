"""Every error as `application/problem+json` (RFC 9457): what is wrong, and where."""

import json
import logging
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from http import HTTPStatus
from typing import Any

from fastapi import FastAPI, Request, Response
from fastapi.exceptions import RequestValidationError
from pydantic import BaseModel
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect
from starlette.types import ASGIApp, Receive, Scope, Send
from starlette.types import Message as Event

from simulearn.errors import CancelledError, ComputationError, InputError, Message
from simulearn.grid.arrays import shown

MEDIA_TYPE = "application/problem+json"
STATUS = {  # of errors that are not simply wrong input (422), by their code
    "document-unknown": 404,
    "job-unknown": 404,
    "changed-elsewhere": 409,
    "too-many": 429,
}
MOST_NAMED = 20  # wrong places of a request
GONE = 499  # the client closed the connection: nobody reads the answer

logger = logging.getLogger("simulearn.studio")


class MessageBody(BaseModel):
    """One thing that is wrong or unusual."""

    code: str
    where: str
    message: str


class ProblemBody(BaseModel):
    """Why a request has no answer."""

    type: str = "about:blank"
    title: str
    status: int
    code: str
    where: str
    detail: str
    errors: list[MessageBody] = []


class Problem(HTTPException):
    """A request that gets no answer.

    Args:
        status: of HTTP.
        code: short name of the reason, for programs.
        detail: the reason, for people.
        where: the place in the request.
        errors: all that is wrong, where there is more than one.
        headers: of the response.
        more: further members of the problem.
    """

    def __init__(
        self,
        status: int,
        code: str,
        detail: str,
        where: str = "",
        errors: Sequence[Message] = (),
        headers: Mapping[str, str] | None = None,
        more: Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(status, detail, dict(headers or {}))
        self.code, self.where, self.errors = code, where, tuple(errors)
        self.more = dict(more or {})

    @classmethod
    def of(cls, error: InputError | ComputationError) -> "Problem":
        """Return the problem of an error of the library."""
        if isinstance(error, InputError):
            status = STATUS.get(error.code, 422)
            return cls(status, error.code, str(error), error.where, error.messages)
        hint = f"; {error.hint}" if error.hint else ""
        # The request is well-formed and what it describes has no answer: not the server's fault.
        return cls(422, error.code, f"{error}{hint}", error.where)

    def response(self) -> Response:
        """Return the answer that says it."""
        content: dict[str, Any] = {
            "type": "about:blank",
            "title": _title(self.status_code),
            "status": self.status_code,
            "code": self.code,
            "where": self.where,
            "detail": self.detail,
            **self.more,
        }
        if self.errors:
            content["errors"] = [asdict(message) for message in self.errors]
        text = json.dumps(content, allow_nan=False)  # ASCII: a lone surrogate has no UTF-8
        return Response(text, self.status_code, self.headers, MEDIA_TYPE)


def too_many(detail: str, seconds: int = 1) -> Problem:
    """Return the problem of a server that has enough to do; try again after some seconds."""
    return Problem(429, "too-many", detail, headers={"Retry-After": str(seconds)})


def answer_errors(app: FastAPI) -> None:
    """Make an application answer every error that its routes raise with a problem."""

    @app.exception_handler(HTTPException)
    async def _(request: Request, error: HTTPException) -> Response:
        return (error if isinstance(error, Problem) else _plain(request, error)).response()

    @app.exception_handler(RequestValidationError)
    async def _(request: Request, error: RequestValidationError) -> Response:
        return _invalid(error).response()

    @app.exception_handler(InputError)
    async def _(request: Request, error: InputError) -> Response:
        return Problem.of(error).response()

    @app.exception_handler(ComputationError)
    async def _(request: Request, error: ComputationError) -> Response:
        return Problem.of(error).response()

    @app.exception_handler(CancelledError)
    async def _(request: Request, error: CancelledError) -> Response:
        return Problem(GONE, "cancelled", "the request was cancelled").response()


class LastResort:
    """ASGI: an error that nobody expected is logged, and answered without its text."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request."""
        begun = False

        async def sending(event: Event) -> None:
            nonlocal begun
            begun = True
            await send(event)

        try:
            await self._app(scope, receive, sending)
        except ClientDisconnect:  # while it sent its body: nobody reads an answer
            return
        except Exception:
            if scope["type"] != "http":
                raise
            logger.exception("%s %s failed", scope["method"], scope["path"])
            if begun:
                raise  # the server closes the connection: half an answer must not look complete
            text = "the server made a mistake; its log says more"
            await Problem(500, "internal", text).response()(scope, receive, send)


def _title(status: int) -> str:
    try:
        return HTTPStatus(status).phrase
    except ValueError:
        return "Error"


def _plain(request: Request, error: HTTPException) -> Problem:
    """Return the problem of an error that the framework raised."""
    path = request.url.path
    known = {
        404: ("not-found", f"there is nothing at {path}"),
        405: ("method", f"{path} does not answer {request.method}"),
    }
    code, detail = known.get(error.status_code, ("http", str(error.detail)))
    return Problem(error.status_code, code, detail, path, headers=error.headers)


def _invalid(error: RequestValidationError) -> Problem:
    """Return the problem of a request whose keys or types are wrong."""
    messages = [_message(one) for one in error.errors()[:MOST_NAMED]]
    first = messages[0]
    more = f" (and {len(error.errors()) - 1} more errors)" if len(error.errors()) > 1 else ""
    return Problem(422, first.code, first.message + more, first.where, messages)


def place_of(keys: Iterable[str | int]) -> str:
    """Return a path of keys and indices in words, as `grid.joints[2]`."""
    return "".join(f"[{k}]" if isinstance(k, int) else f".{k}" for k in keys).lstrip(".")


def _message(error: Any) -> Message:
    """Return one of pydantic's errors in our words."""
    source, *keys = error["loc"]
    where = place_of(keys) or str(source)
    if error["type"] == "missing":
        text = f"{where} is missing"
    elif error["type"] == "extra_forbidden":
        text = f"{shown(keys[-1])} is not a key here"
    else:
        reason = error["msg"][:1].lower() + error["msg"][1:]
        text = f"{where} is {shown(error['input'])}; {reason}"
    return Message("request", where, text)

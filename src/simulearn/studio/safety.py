"""What protects a server on the user's own machine from web pages that it does not belong to.

A page of another site can send requests to 127.0.0.1, or give its own name this address (DNS
rebinding). So the name in the request must be ours, and what changes something must come from our
page or from a program. Written as plain ASGI, which costs microseconds.
"""

import ipaddress
from collections.abc import Collection, Mapping
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from simulearn.studio.problems import Problem

POLICY = {
    "default-src": "'none'",
    "script-src": "'self'",
    "style-src": "'self'",
    "img-src": "'self' data: blob:",
    "connect-src": "'self'",
    "font-src": "'self'",
    "frame-ancestors": "'none'",
    "base-uri": "'none'",
    "form-action": "'none'",
}
HEADERS = {
    "content-security-policy": "; ".join(f"{key} {value}" for key, value in POLICY.items()),
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
}
OWN = ("localhost", "127.0.0.1", "::1")
EVERYWHERE = ("0.0.0.0", "::")
HARMLESS = ("GET", "HEAD", "OPTIONS")


class SecurityHeaders:
    """ASGI: adds the headers that tell a browser what our pages may do."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request."""

        async def sending(event: Message) -> None:
            if event["type"] == "http.response.start":
                headers = MutableHeaders(scope=event)
                for key, value in HEADERS.items():
                    headers[key] = value
            await send(event)

        await self._app(scope, receive, sending)


class OwnOriginOnly:
    """ASGI: refuses requests to foreign names, and changes that foreign pages ask for.

    Args:
        app: the application.
        hosts: names under which the server may be reached, besides this machine's own.
    """

    def __init__(self, app: ASGIApp, hosts: Collection[str] = ()) -> None:
        self._app = app
        self._hosts = {_bare(host) for host in (*OWN, *hosts)}
        self._any_address = not self._hosts.isdisjoint(EVERYWHERE)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        problem = self._refusal(scope)
        if problem is None:
            await self._app(scope, receive, send)
        else:
            await problem.response()(scope, receive, send)

    def _refusal(self, scope: Scope) -> Problem | None:
        headers = Headers(scope=scope)
        given = headers.getlist("host")
        if len(given) != 1 or not self._is_ours(given[0]):
            text = "the server is not reached under this name; use http://localhost or 127.0.0.1"
            return Problem(400, "host", text, "Host")
        if scope.get("method") in HARMLESS:
            return None
        origins = headers.getlist("origin")
        foreign = any(_authority(origin) != given[0].lower() for origin in origins)
        # A page on another port of this machine is "same-site", and foreign all the same.
        if foreign or headers.get("sec-fetch-site", "none") not in ("same-origin", "none"):
            text = "a page of another site may not change anything here"
            return Problem(403, "foreign-origin", text, "Origin")
        return None

    def _is_ours(self, host: str) -> bool:
        name = _bare(host)
        # An address is no name that another site could point at this machine.
        return name in self._hosts or (self._any_address and _is_address(name))


class BodyLimit:
    """ASGI: ends a request whose body is too large, by its header or while it arrives.

    Args:
        app: the application.
        most: bytes of a body.
        others: the same for paths that differ.
    """

    def __init__(self, app: ASGIApp, most: int, others: Mapping[str, int] | None = None) -> None:
        self._app, self._most, self._others = app, most, dict(others or {})

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        most = self._others.get(scope["path"], self._most)
        length = Headers(scope=scope).get("content-length", "0")
        if not (length.isascii() and length.isdigit()):
            problem = Problem(400, "length", "Content-Length is not a number", "Content-Length")
            await problem.response()(scope, receive, send)
            return
        if len(length) > 18 or int(length) > most:
            await _too_large(most).response()(scope, receive, send)
            return
        received = 0

        async def receiving() -> Message:
            nonlocal received
            event = await receive()
            if event["type"] == "http.request":
                received += len(event.get("body", b""))
                if received > most:
                    raise _too_large(most)
            return event

        await self._app(scope, receiving, send)


def _too_large(most: int) -> Problem:
    text = f"the body is too large; it has at most {most / 2**20:g} MiB"
    # The rest of the body is not read, so that the connection cannot go on.
    return Problem(413, "too-large", text, "body", headers={"Connection": "close"})


def _bare(host: str) -> str:
    """Return the name in a Host header or of a host: without port and brackets, lower case."""
    host = host.strip().lower()
    if host.startswith("["):
        return host[1:].partition("]")[0]
    return host if host.count(":") > 1 else host.partition(":")[0]


def _authority(origin: str) -> str:
    try:
        return urlsplit(origin).netloc.lower()
    except ValueError:
        return ""


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True

"""A client that asks the studio's application without a network."""

import asyncio
from concurrent.futures import ThreadPoolExecutor

import httpx

from simulearn.studio import create_app
from simulearn.studio.settings import Settings

HOME = "http://127.0.0.1:8000"


def awaited(coroutine):
    """Return what a coroutine returns; it runs in a thread of its own."""
    with ThreadPoolExecutor(1) as pool:
        return pool.submit(asyncio.run, coroutine).result()


class Client:
    """Asks an application one question after another."""

    def __init__(self, settings=None, home=HOME):
        self.app = create_app(settings or Settings())
        self._home = home

    def request(self, method, path, **options):
        return awaited(self._request(method, path, options))

    def get(self, path, **options):
        return self.request("GET", path, **options)

    def post(self, path, json=None, **options):
        return self.request("POST", path, json=json, **options)

    def post_text(self, path, text, kind="application/json", **headers):
        return self.post(path, content=text, headers={"Content-Type": kind, **headers})

    async def _request(self, method, path, options):
        transport = httpx.ASGITransport(self.app, raise_app_exceptions=False)
        async with httpx.AsyncClient(transport=transport, base_url=self._home) as client:
            return await client.request(method, path, **options)


async def raw(app, method, path, received, headers=None):
    """Return the events that an application sends for a list of events that it receives.

    A coroutine function among them is called for its event.
    """
    given = {"host": "localhost", **(headers or {})}
    scope = {
        "type": "http",
        "asgi": {"version": "3.0"},
        "http_version": "1.1",
        "method": method,
        "path": path,
        "raw_path": path.encode(),
        "root_path": "",
        "scheme": "http",
        "query_string": b"",
        "client": None,
        "server": None,
        "headers": [(key.encode(), value.encode()) for key, value in given.items()],
    }
    events, left = [], list(received)

    async def receive():
        event = left.pop(0)
        return await event() if callable(event) else event

    async def send(event):
        events.append(event)

    await app(scope, receive, send)
    return events


def problem(response, status, code=None):
    """Return a response's problem, which must have this status and code."""
    assert response.headers["content-type"] == "application/problem+json", response.text
    body = response.json()
    assert response.status_code == body["status"] == status, body
    assert {"type", "title", "status", "code", "where", "detail"} <= body.keys()
    assert code is None or body["code"] == code, body
    return body

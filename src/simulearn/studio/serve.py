"""The server as a program: a port, a start that says when it answers, and an end at once.

The port is opened first, so that a wrong one is an error before anything is loaded. An end first
stops what is computed, so that requests that wait for it are answered, and then the server.
"""

import errno
import ipaddress
import os
import signal
import socket
import threading
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager, suppress
from time import monotonic

import uvicorn
from fastapi import FastAPI

from simulearn.errors import InputError
from simulearn.studio.app import create_app, stop
from simulearn.studio.settings import Settings

HOST = "127.0.0.1"
PORT = 8765
MORE_PORTS = 20  # tried after it; then any that is free
WAIT = 2.0  # s for computations to end; those of a large mesh look at their token less often


def serve(
    settings: Settings,
    listener: socket.socket,
    on_start: Callable[[], None] | None = None,
) -> bool:
    """Serve the studio until Ctrl-C or a request of the system to end.

    Args:
        settings: hosts, folder of the documents and limits.
        listener: of `listen`; it is closed at the end.
        on_start: called when the server answers.

    Returns:
        Whether all computations have ended; if not, their threads keep the program from ending.

    Raises:
        InputError: a package of the studio is missing.
    """
    with listener:
        app = create_app(settings)
        config = uvicorn.Config(
            app,
            log_level="warning",
            access_log=False,
            server_header=False,
            lifespan="on",
            ws="none",
            timeout_graceful_shutdown=int(WAIT),
        )
        server = _Server(app, config, on_start)
        with _ending_quietly():
            server.run(sockets=[listener])
    return _have_ended(server.computing)


def listen(host: str = HOST, port: int | None = None) -> socket.socket:
    """Return a socket that listens on an address of this machine.

    Args:
        host: name or address.
        port: if not given, the usual one, or another one where that is taken.

    Raises:
        InputError: the host is not known or not of this machine, or the port is taken or not
            allowed.
    """
    if port is not None:
        return _listener(host, port)
    for one in (*range(PORT, PORT + 1 + MORE_PORTS), 0):
        try:
            return _listener(host, one)
        except InputError as error:
            if error.code not in ("port-taken", "port-forbidden"):
                raise
    raise InputError("no port is free", "port-taken", "port")


def address_of(listener: socket.socket) -> str:
    """Return the address of the page for a browser on this machine."""
    host, port = listener.getsockname()[:2]
    address = ipaddress.ip_address(host)
    if address.is_unspecified:  # listens on all addresses; this one is always there
        host = HOST if address.version == 4 else "::1"
    return f"http://[{host}]:{port}/" if ":" in host else f"http://{host}:{port}/"


def is_local(listener: socket.socket) -> bool:
    """Whether only programs on this machine can reach a socket."""
    return ipaddress.ip_address(listener.getsockname()[0]).is_loopback


class _Server(uvicorn.Server):
    """A server that says when it answers, and stops computations before it waits for requests."""

    def __init__(
        self, app: FastAPI, config: uvicorn.Config, on_start: Callable[[], None] | None
    ) -> None:
        super().__init__(config)
        self._app, self._on_start = app, on_start
        self.computing: list[threading.Thread] = []  # what could not be stopped at once

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        if self.started and self._on_start is not None:
            self._on_start()

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        self.computing = stop(self._app)
        await super().shutdown(sockets)


def _listener(host: str, port: int) -> socket.socket:
    try:
        found = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)
    except (OSError, UnicodeError) as error:
        raise InputError(f'host "{host}" is not known', "host-unknown", "host") from error
    family, kind, protocol, _, address = found[0]
    listener = socket.socket(family, kind, protocol)
    try:
        if os.name == "posix":  # a port that was just given up can be had at once
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        elif hasattr(socket, "SO_EXCLUSIVEADDRUSE"):
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_EXCLUSIVEADDRUSE, 1)
        listener.bind(address)
        listener.listen(socket.SOMAXCONN)
    except OSError as error:
        listener.close()
        raise _not_opened(error, host, port) from error
    return listener


def _not_opened(error: OSError, host: str, port: int) -> InputError:
    """Return why a port could not be opened."""
    if error.errno == errno.EADDRINUSE:
        return InputError(f"port {port} is taken by another program", "port-taken", "port")
    if error.errno == errno.EACCES:
        text = f"port {port} is not allowed for this user; those from 1024 on usually are"
        return InputError(text, "port-forbidden", "port")
    if error.errno == errno.EADDRNOTAVAIL:
        return InputError(f'host "{host}" is not an address of this machine', "host", "host")
    return InputError(f"port {port} cannot be opened ({error.strerror})", "port", "port")


@contextmanager
def _ending_quietly() -> Iterator[None]:
    """Let Ctrl-C and a request to end be an end like any other."""
    if threading.current_thread() is not threading.main_thread():  # signals come to that one
        yield
        return
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        with suppress(KeyboardInterrupt):  # the server raises it once more when it has ended
            yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _have_ended(threads: Collection[threading.Thread]) -> bool:
    """Wait a moment for threads to end, and return whether they have."""
    deadline = monotonic() + WAIT
    for thread in threads:
        thread.join(max(0.0, deadline - monotonic()))
    return not any(thread.is_alive() for thread in threads)

"""The command studio: the page in the browser, and the server that answers it."""

import os
import sys
import threading
import webbrowser
from pathlib import Path
from typing import Annotated

import typer
from rich.markup import escape

from simulearn.cli.base import app, err, out
from simulearn.errors import InputError
from simulearn.extras import require
from simulearn.files import data_folder


@app.command()
def studio(
    port: Annotated[
        int | None,
        typer.Option(min=0, max=65535, help="The port; if not given, 8765 or one that is free."),
    ] = None,
    host: Annotated[
        str, typer.Option(help="The address to listen on; 0.0.0.0 is every one of this machine.")
    ] = "127.0.0.1",
    browser: Annotated[
        bool, typer.Option("--browser/--no-browser", help="Open the page in the browser.")
    ] = True,
    data: Annotated[
        Path | None, typer.Option(metavar="FOLDER", help="Where designs are saved by themselves.")
    ] = None,
    allow: Annotated[
        list[str] | None,
        typer.Option(
            metavar="HOST",
            help="A name under which others reach the server, as behind a proxy (repeat for more).",
        ),
    ] = None,
) -> None:
    """Draw grids in the browser and watch them morph."""
    require("the studio needs", "fastapi", "uvicorn", "nicegui")
    from simulearn.studio.serve import PORT, address_of, is_local, listen, serve
    from simulearn.studio.settings import Settings

    listener = listen(host, port)
    with listener:
        settings = Settings(hosts=(host, *(allow or ())), data=_folder(data))
        address = address_of(listener)
        if port is None and listener.getsockname()[1] != PORT:
            err.print(f"port {PORT} is taken by another program; using a free one")
        if not is_local(listener):
            err.print(_exposed())

        def started() -> None:
            out.print(f"the studio is at [bold]{address}[/] (Ctrl-C ends it)")
            sys.stdout.flush()  # at once also for a program that reads it
            if browser:
                _open(address)

        ended = serve(settings, listener, started)
    err.print("stopped")
    if not ended:  # a computation cannot be stopped at once, and Python would wait for it
        sys.stderr.flush()
        os._exit(0)


def _folder(given: Path | None) -> Path | None:
    """Return the folder of the documents; None where this user can have none.

    Raises:
        InputError: the folder that was given cannot be made or written.
    """
    base = data_folder()
    if given is not None:
        folder = given.absolute()
    elif base is not None:
        folder = base / "studio"
    else:
        err.print("[yellow]warning:[/] no home folder is known; only the browser keeps designs")
        return None
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if not os.access(folder, os.W_OK):
            raise PermissionError(13, "no permission to write")
    except OSError as error:
        reason = f"{folder}: cannot be written ({error.strerror})"
        if given is not None:
            raise InputError(reason) from error
        err.print(f"[yellow]warning:[/] {escape(reason)}; only the browser keeps designs")
    return folder


def _exposed() -> str:
    """Return what to know about a server that others can reach."""
    everyone = "everyone who can reach this machine over the network"
    return f"[yellow]warning:[/] {everyone} can use this studio, without a password"


def _open(address: str) -> None:
    """Open a page in the browser, if there is a screen for one."""
    screen = any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER"))
    if sys.platform.startswith("linux") and not screen:
        return  # what is found then is a browser for terminals, which would take this one
    threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()

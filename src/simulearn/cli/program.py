"""The program behind the command line: its commands, how it ends, and what it says then.

Exit codes: 0 done, 1 the input is wrong, 2 usage, 3 the computation failed, 130 interrupted.
Solvers and plotting are imported only by the command that needs them, so that the others are quick.
"""

import _thread
import errno
import logging
import os
import sys
import threading
import warnings
from contextlib import suppress
from typing import Annotated, Any

import typer
from rich.markup import escape

from simulearn import __version__
from simulearn.cli import (  # noqa: F401  (they add their commands)
    assemble,
    calibrate,
    compare,
    dataset,
    drawings,
    fabricate,
    grids,
    inverse,
    learn,
    simulate,
    studio,
    tile,
)
from simulearn.cli.base import app, err
from simulearn.errors import CancelledError, ComputationError, InputError
from simulearn.files import NO_ROOM, cache_folder

HINTS = {  # what helps on the command line, by the code of an error
    "no-answer": "--engine fea may have one",
    "not-a-grid": "`simulearn import` makes grids of drawings, lists of lines and graphs",
    "joints-in-space": "`simulearn import` makes grids of drawings in any plane",
    "material-not-learnt": "--engine fea simulates any material, and `simulearn train` learns one",
    "engine-not-differentiable": "--method default takes any engine",
    "unit-unknown": "--unit says which it is, or --width how many mm the drawing is wide",
    "unit-name": "--unit mm and --unit in are examples",
    "curves-only": "--flatten 0.5 keeps them within 0.5 mm",
    "not-flat": "--without plane reads the lines as seen from above",
    "photo-markers": "--scale measures without the sheet",
    "photo-up": "--up inside or --up outside says it",
    "port-taken": "without --port a free one is found",
}


@app.callback(invoke_without_command=True)
def root(
    version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False,
) -> None:
    """Simulate, validate and draw 4D-printed grids."""
    if version:
        print(f"simulearn {__version__}")
        raise typer.Exit


def run() -> None:
    """Run the command line; every failure is one line and an exit code."""
    code, hook = None, sys.unraisablehook
    _keep_kernels()
    _quiet_libraries()
    _print_anything()
    sys.unraisablehook = _interrupt_again
    try:
        code = app(standalone_mode=False)  # of typer.Exit; it makes an interrupt one of 130
        if sys.stdout is not None:
            sys.stdout.flush()  # what cannot be written is reported now and not at Python's end
    except (typer.Abort, KeyboardInterrupt):
        code = 130
    except InputError as error:
        _fail(_with_hint(str(error), HINTS.get(error.code, "")), 1)
    except ComputationError as error:
        _fail(_with_hint(str(error), HINTS.get(error.code, error.hint)), 3)
    except CancelledError:
        code = 130
    except Exception as error:
        if hasattr(error, "exit_code") and hasattr(error, "format_message"):  # usage
            _fail(f"{error.format_message()} (see simulearn --help)", int(error.exit_code))
        if os.environ.get("SIMULEARN_DEBUG"):
            raise
        if isinstance(error, OSError) and (reason := _of_output(error)) is not None:
            _fail(reason, 1)
        what = f"{type(error).__name__}: {error}"
        _fail(f"unexpected {what} (SIMULEARN_DEBUG=1 shows where)", 3)
    finally:
        sys.unraisablehook = hook
    if code == 130:
        _fail("interrupted", 130)
    sys.exit(code)


def _keep_kernels() -> None:
    """Let JAX, if a command needs it, keep its kernels in the user's cache folder.

    JAX reads these variables when it is imported; they hold for this program's process only.
    """
    base = cache_folder()
    if base is None or "JAX_COMPILATION_CACHE_DIR" in os.environ:
        return
    folder = base / "compiled"
    with suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
        if os.access(folder, os.W_OK):  # else every run compiles for itself
            os.environ["JAX_COMPILATION_CACHE_DIR"] = str(folder)
            os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS", "0.2")


def _quiet_libraries() -> None:
    """Keep what other libraries say of their own caches from the user, who can do without."""
    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # a home that cannot be written
    os.environ.setdefault("DASK_LOGGING__DISTRIBUTED", "critical")  # read when Dask is imported
    for doing in ("reading", "writing"):  # kernels are compiled anew
        warnings.filterwarnings("ignore", f"Error {doing} persistent compilation cache entry")


def _print_anything() -> None:
    """Let no character fail that a terminal's encoding does not have."""
    for stream in (sys.stdout, sys.stderr):
        with suppress(AttributeError, ValueError):  # where it is no text stream of Python's own
            stream.reconfigure(errors="replace")  # type: ignore[union-attr]


def _of_output(error: OSError) -> str | None:
    """Return why the output could not be written, "" if its reader has left; None otherwise.

    Files are written by `files.replacing`, whose errors are others, so one without a file's name is
    of the output.
    """
    left = error.errno == errno.EPIPE
    if error.filename is not None or not (left or error.errno in NO_ROOM):
        return None
    with suppress(OSError, ValueError, AttributeError):  # Python would try again at its end
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return "" if left else f"the output cannot be written ({error.strerror})"


def _interrupt_again(lost: Any) -> None:
    """Bring back an interrupt that met a library in a callback and was lost there, as in JAX's."""
    if lost.exc_type is KeyboardInterrupt:
        threading.Timer(0.02, _thread.interrupt_main).start()
    else:
        sys.__unraisablehook__(lost)


def _with_hint(text: str, hint: str) -> str:
    return f"{text}; {hint}" if hint else text


def _fail(message: str, code: int) -> None:
    line = " ".join(message.split())
    if line:
        err.print(f"[red]simulearn:[/] {escape(line)}")
    sys.exit(code)

"""The command line: what a user types, with errors of one line and an exit code for machines.

Exit codes: 0 done, 1 the input is wrong, 2 usage, 3 the computation failed, 130 interrupted.
Solvers and plotting are imported only by the command that needs them, so that the others are quick.
"""

import _thread
import os
import sys
import threading
from contextlib import suppress
from typing import Annotated, Any

import typer
from rich.markup import escape

from simulearn import __version__
from simulearn.cli import (  # noqa: F401  (they add their commands)
    dataset,
    drawings,
    fabricate,
    grids,
    inverse,
    learn,
    simulate,
    studio,
)
from simulearn.cli.base import app, err
from simulearn.errors import CancelledError, ComputationError, InputError
from simulearn.files import cache_folder

HINTS = {  # what helps on the command line, by the code of an error
    "no-answer": "--engine fea may have one",
    "material-not-learnt": "--engine fea simulates any material, and `simulearn train` learns one",
    "engine-not-differentiable": "--method default takes any engine",
    "unit-unknown": "--unit says which it is, or --width how many mm the drawing is wide",
    "unit-name": "--unit mm and --unit in are examples",
    "curves-only": "--flatten 0.5 keeps them within 0.5 mm",
    "not-flat": "--without plane reads the lines as seen from above",
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


def main() -> None:
    """Run the command line; every failure is one line and an exit code."""
    code, hook = None, sys.unraisablehook
    _keep_kernels()
    sys.unraisablehook = _interrupt_again
    try:
        code = app(standalone_mode=False)  # of typer.Exit; it makes an interrupt one of 130
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
    err.print(f"[red]simulearn:[/] {escape(line)}")
    sys.exit(code)

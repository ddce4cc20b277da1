"""Progress of long work on the terminal: bars, and one line when something is prepared."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from simulearn.cli.base import err

if TYPE_CHECKING:
    from rich.progress import Progress

Count = Callable[[int, int], None]  # (done, in all)


def bar_columns(remaining: bool = False) -> list[Any]:
    """Return the columns of a bar; its tasks have a field `words`.

    Args:
        remaining: whether the bar shows the time that is left.
    """
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    columns = [
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[words]}"),
        TimeElapsedColumn(),
    ]
    if remaining:
        columns += [TextColumn("left"), TimeRemainingColumn(elapsed_when_finished=False)]
    return columns


@contextmanager
def bar(remaining: bool = False, period: float = 30.0) -> "Iterator[Progress]":
    """Yield a bar on stderr that vanishes at the end.

    Args:
        remaining: whether it shows the time that is left.
        period: s over which the rate is averaged.
    """
    from rich.progress import Progress

    columns = bar_columns(remaining)
    with Progress(*columns, console=err, transient=True, speed_estimate_period=period) as shown:
        yield shown


@contextmanager
def counting(title: str, quiet: bool) -> Iterator[Count]:
    """Yield a function of (done, in all) that moves a bar, or does nothing without a terminal."""
    if quiet or not err.is_terminal:
        yield _nothing
        return
    with bar() as shown:
        task = shown.add_task(title, total=None, words="")

        def count(done: int, total: int) -> None:
            shown.update(task, completed=done, total=total)

        yield count


def _nothing(done: int, total: int) -> None:
    pass


@contextmanager
def preparing(quiet: bool) -> Iterator[None]:
    """Say once on stderr that kernels are compiled, if they are."""
    if quiet:
        yield
        return
    from simulearn.native import on_compile

    with on_compile(_say_preparing):
        yield


def _say_preparing() -> None:
    err.print("[dim]preparing the solver, once on this machine; this takes some seconds[/]")

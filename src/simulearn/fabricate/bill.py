"""The bill of several prints: how many copies of each piece, and what they take."""

import csv
import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from simulearn.fabricate.job import Job, prepare
from simulearn.fabricate.printer import Printer
from simulearn.grid import Grid

COLUMNS = ("piece", "copies", "modules", "hours_each", "grams_each", "hours", "grams", "file")


@dataclass(frozen=True, eq=False)
class Row:
    """A line of a bill.

    Attributes:
        piece: its name.
        copies: to print.
        modules: names of what they are for.
        job: the print of one; None where no printer is given.
        file: of the print; empty where there is none.
    """

    piece: str
    copies: int
    modules: tuple[str, ...]
    job: Job | None = None
    file: str = ""

    @property
    def hours(self) -> float | None:
        """Of one copy, with heating."""
        if self.job is None:
            return None
        return (self.job.estimate.seconds + self.job.estimate.heating_seconds) / 3600

    @property
    def grams(self) -> float | None:
        """Of filament, of one copy."""
        return None if self.job is None else self.job.estimate.filament_g


def bill_of(
    pieces: Sequence[tuple[str, Grid, tuple[str, ...]]],
    printer: Printer | None,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> list[Row]:
    """Return the bill of pieces.

    Args:
        pieces: name, grid, and what its copies are for.
        printer: on what each is printed, alone; None: copies are counted only.
        progress: called with the pieces done and in all.

    Raises:
        InputError: the printer cannot print a piece.
    """
    rows = []
    for k, (name, grid, modules) in enumerate(pieces):
        job = None if printer is None else prepare([grid], printer, [name])
        rows.append(Row(name, len(modules), modules, job))
        progress(k + 1, len(pieces))
    return rows


def totals(rows: Sequence[Row]) -> tuple[int, float | None, float | None]:
    """Return copies, hours and grams of all; None where no printer is given."""
    copies = sum(row.copies for row in rows)
    if any(row.job is None for row in rows):
        return copies, None, None
    hours = sum(row.copies * (row.hours or 0.0) for row in rows)
    return copies, hours, sum(row.copies * (row.grams or 0.0) for row in rows)


def bill_text(rows: Sequence[Row]) -> str:
    """Return a bill as CSV, its last line the sum."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for row in rows:
        each = (row.hours, row.grams)
        all_ = (None if one is None else row.copies * one for one in each)
        writer.writerow(
            [row.piece, row.copies, " ".join(row.modules), *map(_figure, (*each, *all_)), row.file]
        )
    copies, hours, grams = totals(rows)
    writer.writerow(["all", copies, "", "", "", _figure(hours), _figure(grams), ""])
    return text.getvalue()


def _figure(value: float | None) -> str:
    return "" if value is None else f"{value:.2f}"

"""Prints of a grid on the command line: simulated on request, their spread as a table."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rich.table import Table

from simulearn.cli.progress import counting
from simulearn.material import load_material

if TYPE_CHECKING:
    from simulearn.grid import Grid
    from simulearn.simulate import Result, Simulator
    from simulearn.simulate.spread import Spread


@dataclass(frozen=True)
class SimulatedPrints:
    """How many prints of each grid are simulated; as many as is quick if no number is given."""

    count: int | None
    quiet: bool

    def check(self, design: "Grid") -> None:
        """Raise InputError before anything is computed where nothing is known of prints."""
        from simulearn.simulate.scatter import require_scatter

        require_scatter(load_material(design.material))

    def added(self, result: "Result", engine: "Simulator") -> "Result":
        """Return the result of an engine with its spread."""
        from simulearn.simulate.scatter import scattered

        with counting("prints", quiet=self.quiet) as progress:
            return scattered(result, self.count, engine=engine, progress=progress)


def spread_table(spread: "Spread", fixed: int) -> Table:
    """Return how far prints differ at each joint."""
    scatter = spread.scatter
    table = Table(
        box=None,
        title="\n" + spread.words,
        caption=(
            f"strains differ by {scatter.print:.1%} between prints, {scatter.beam:.1%} between "
            f"beams of one; {spread.law}, seed {spread.seed}"
        ),
        title_justify="left",
        caption_justify="left",
    )
    for name in ("joint", "mean x", "y", "z", "± plane", "± up"):
        table.add_column(name, justify="right")
    for name in ("9 of 10: plane", "z from", "to"):
        table.add_column(name, justify="right")
    for k, mean in enumerate(spread.mean):
        words = [f"{round(x, 1) + 0.0:.1f}" for x in mean.tolist()]
        words += [f"{spread.plane[k]:.2f}", f"{spread.up[k]:.2f}", f"{spread.plane_90[k]:.1f}"]
        words += [f"{round(z, 1) + 0.0:.1f}" for z in spread.up_90[k].tolist()]
        table.add_row(f"fixed {k}" if k == fixed else str(k), *words)
    return table

"""How searches and rankings are told: to people in words, tables and pictures, and to machines."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.markup import escape
from rich.table import Table

from simulearn.cli.base import err
from simulearn.files import replacing
from simulearn.grid import grid_to_dict

if TYPE_CHECKING:
    from simulearn.inverse import Outcome, Ranking, Task
    from simulearn.inverse.keeping import Step
    from simulearn.inverse.search import Tell

BARS = "▁▂▃▄▅▆▇█"


def search_figures(task: "Task", found: "Outcome") -> dict[str, Any]:
    """Return what summary.json holds."""
    check = found.check
    return {
        "method": task.method,
        "engine": task.engine,
        "error_mm": found.error_mm,
        "error_fea_mm": check.error_fea_mm if check else None,
        "apart_mm": check.apart_mm if check else None,
        "bound_mm": check.bound_mm if check else None,
        "agrees": check.agrees if check else None,
        "start_mm": found.steps[0].error_mm,
        "designs": found.designs,
        "iterations": found.iterations,
        "corrections": found.steps[-1].phase,
        "seconds": round(found.seconds, 3),
        "interrupted": found.interrupted,
        "goals": [
            {"vertex": str(vertex), "distance_mm": distance}
            for vertex, distance in _distances(task, found)
        ],
        "history": [step.row() for step in found.steps],
    }


def _distances(task: "Task", found: "Outcome") -> list[tuple[str, float]]:
    """Return how far each vertex is from its target, by finite elements where they answered."""
    if found.check is None:
        return []
    aims, result = task.aims, found.check.fea or found.check.result
    away = aims.distances(aims.points(result.joints[-1], result.beams[-1]))
    return [(str(v), float(d)) for v, d in zip(aims.vertices, away, strict=True)]


def search_words(figures: dict[str, Any], found: "Outcome") -> Iterator[str]:
    """Yield what a person wants to know."""
    yield (
        f"{figures['start_mm']:.2f} mm to begin with, [bold]{found.error_mm:.2f} mm[/] by the "
        f"engine {figures['engine']} after {found.iterations} iterations and {found.designs} "
        f"designs, {found.seconds:.1f} s"
    )
    check = found.check
    if check is None:
        return
    if check.error_fea_mm is None:
        yield f"[yellow]finite elements have no answer:[/] {escape(check.why or '')}"
        return
    yield (
        f"[bold]{check.error_fea_mm:.2f} mm[/] by finite elements; the two shapes are "
        f"{check.apart_mm:.2f} mm apart"
    )
    if check.agrees is False:
        yield (
            f"[yellow]that is beyond the {check.bound_mm:.2f} mm that the engine vouches for:[/] "
            "trust finite elements, or go on with more --corrections"
        )


def search_pictures(task: "Task", found: "Outcome", folder: Path, model: str | None) -> None:
    """Draw the error curve, the shape beside its targets, and the design changing."""
    from simulearn.show.inverse import changing, error_curve, wanted
    from simulearn.simulate import engine as engine_of

    assert found.check is not None
    with replacing(folder / "error.png") as temporary:
        error_curve(found.steps, found.check.error_fea_mm).savefig(temporary)
    result = found.check.fea or found.check.result
    with replacing(folder / "shape.png") as temporary:
        wanted(result, task.aims, found.check.error_fea_mm or found.error_mm).savefig(temporary)
    kept = _turns(found)
    grids = [step.grid(task.start) for step in kept]
    answering = engine_of(task.engine, model)
    if task.engine not in ("learned", "beams"):
        # Every frame by a slow engine would take as long as the search did.
        answering = engine_of("beams")
    results = answering.simulate(grids)
    changing(results, kept, task.aims, folder / "changing.gif")


def _turns(found: "Outcome", most: int = 40) -> "list[Step]":
    """Return the steps at which the best design changed, at most so many, the last one always."""
    kept: list[Step] = []
    for step in found.steps:
        if not kept or (step.joints, step.actuators) != (kept[-1].joints, kept[-1].actuators):
            kept.append(step)
    final = replace(
        kept[-1],
        joints=found.grid.joints.tolist(),
        actuators=found.grid.actuators.tolist(),
        error_mm=found.error_mm,
    )
    stride = max(1, -(-len(kept) // most))
    return [*kept[:-1][::stride], final]


def ranking_figures(found: "Ranking", engine: str) -> dict[str, Any]:
    """Return a ranking for machines."""

    def row(one: Any) -> dict[str, Any]:
        return {
            "change": one.change.words,
            "part": one.change.part,
            "indices": list(one.change.indices),
            "error_mm": one.error_mm,
            "moved_mm": one.moved_mm,
        }

    return {
        "engine": engine,
        "error_mm": found.error_mm,
        "modifications": [row(one) for one in found.suggestions],
        "suggestions": [{**row(one), "grid": grid_to_dict(one.grid)} for one in found.best],
    }


def ranking_table(found: "Ranking", goals: bool) -> Table:
    """Return the suggestions."""
    count = len(found.suggestions)
    shown = "five that differ" if count > len(found.best) else "the best first"
    title = f"{found.error_mm:.2f} mm as it is; " if goals else ""
    table = Table(
        box=None,
        title=f"{title}{count} valid modifications, {shown}",
        title_justify="left",
    )
    table.add_column("", justify="right")
    table.add_column("change")
    if goals:
        table.add_column("error, mm", justify="right")
        table.add_column("gain", justify="right")
    table.add_column("moves, mm", justify="right")
    for k, one in enumerate(found.best, 1):
        gain = found.error_mm - one.error_mm
        errors = [f"{one.error_mm:.2f}", f"{gain:+.2f}"] if goals else []
        table.add_row(str(k), one.change.words, *errors, f"{one.moved_mm:.2f}")
    return table


@contextmanager
def live(task: "Task", quiet: bool) -> "Iterator[Tell]":
    """Yield what is told each iteration: a line that changes on a terminal, else one for each."""
    if quiet:
        yield lambda step: None
        return
    if not err.is_terminal:

        def line(step: "Step") -> None:
            err.print(f"{step.iteration}: {_progress(step)}, {escape(step.words)}")

        yield line
        return
    errors: list[float] = []
    with err.status("getting ready") as status:

        def tell(step: "Step") -> None:
            errors.append(step.error_mm)
            status.update(f"{_bars(errors)} {_progress(step)}  [dim]{escape(step.words)}[/]")

        yield tell
        sys.stderr.flush()


def _progress(step: "Step") -> str:
    corrected = f", correction {step.phase}" if step.phase else ""
    return (
        f"{step.error_mm:.2f} mm, {step.designs} designs, iteration {step.iteration}{corrected}, "
        f"{step.seconds:.0f} s"
    )


def _bars(errors: list[float], width: int = 24) -> str:
    """Return the last errors as a row of bars."""
    most = max(errors)
    return "".join(BARS[min(7, int(8 * e / max(most, 1e-9)))] for e in errors[-width:])

"""Commands about inverse and hybrid design: optimize, rank."""

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.markup import escape
from rich.table import Table

from simulearn.cli.base import Json, app, err, grid_of, out
from simulearn.cli.learn import folder_of
from simulearn.errors import InputError
from simulearn.files import read_text, replacing
from simulearn.grid import grid_to_dict, library, write_grid

if TYPE_CHECKING:
    from simulearn.inverse import Outcome, Ranking, Task
    from simulearn.inverse.keeping import Step
    from simulearn.inverse.search import Tell

EngineOption = Annotated[
    str | None, typer.Option(help="Another engine than the task's: fea, calculix, beams, learned.")
]
ModelOption = Annotated[
    str | None, typer.Option(help="A learned model: default, paper, or its folder.")
]
BARS = "▁▂▃▄▅▆▇█"


@app.command()
def optimize(
    task: Annotated[str, typer.Argument(metavar="TASK", help="A task file (.json).")],
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", help="The folder of the search; searches/TASK if not given."
        ),
    ] = None,
    method: Annotated[
        str | None,
        typer.Option(help="Another method than the task's: default, brute-force, gradient, cma."),
    ] = None,
    engine: EngineOption = None,
    model: ModelOption = None,
    seconds: Annotated[float | None, typer.Option(min=0.01, help="Another limit, s.")] = None,
    iterations: Annotated[int | None, typer.Option(min=1, help="Another limit.")] = None,
    corrections: Annotated[
        int | None,
        typer.Option(min=0, help="How often to go on from targets that FEA has corrected."),
    ] = None,
    afresh: Annotated[
        bool, typer.Option("--afresh", help="Forget what an earlier run in the folder found.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Search for a grid that comes where it is wanted; the same command goes on later."""
    from simulearn.inverse import optimize as search
    from simulearn.inverse import read_task
    from simulearn.inverse.keeping import identity, read_steps, write_steps

    asked = read_task(task)
    limits = {"seconds": seconds, "iterations": iterations, "corrections": corrections}
    named = {"method": method, "engine": engine}
    asked = asked.model_copy(
        update={
            **{key: value for key, value in named.items() if value is not None},
            "limits": asked.limits.model_copy(
                update={key: value for key, value in limits.items() if value is not None}
            ),
        }
    )
    folder = output or Path("searches") / Path(task).stem
    folder_of(folder)
    name = identity(asked, model)
    before = [] if afresh else read_steps(folder, name)
    steps = list(before)
    with _live(asked, quiet=as_json) as show:

        def tell(step: "Step") -> None:
            steps.append(step)
            write_steps(folder, name, steps)
            show(step)

        found = search(asked, model, tell, tuple(before))
    write_steps(folder, name, list(found.steps))
    figures = _figures(asked, found)
    write_grid(found.grid, folder / "best.json")
    _write_json(folder / "summary.json", figures)
    if found.interrupted:
        err.print(
            f"stopped at {found.error_mm:.2f} mm; {escape(str(folder))} has the best so far, "
            "and the same command goes on"
        )
        raise KeyboardInterrupt
    _pictures(asked, found, folder, model)
    if as_json:
        print(json.dumps(figures, allow_nan=False))
        return
    for line in _words(figures, found):
        out.print(line)
    names = "best.json, summary.json, history.csv, error.png, shape.png, changing.gif"
    out.print(f"wrote {escape(str(folder))}/{names}")


@app.command()
def rank(
    design: Annotated[
        str,
        typer.Argument(
            metavar="GRID|TASK",
            help="A task file; or a grid (file or library), whose changes are ranked by how far "
            "they move its joints.",
        ),
    ],
    engine: EngineOption = None,
    model: ModelOption = None,
    output: Annotated[
        list[Path] | None,
        typer.Option(
            "-o",
            "--output",
            help="A file to write (repeat for more): .png .pdf .svg the suggestions as cards; "
            ".json all modifications.",
        ),
    ] = None,
    pick: Annotated[
        int | None, typer.Option(min=1, help="Apply this suggestion and write what comes of it.")
    ] = None,
    to: Annotated[
        Path | None,
        typer.Option(help="The file for it: a task if one was given, else a grid."),
    ] = None,
    as_json: Json = False,
) -> None:
    """Score every single modification of a grid, and suggest five that differ."""
    from simulearn.inverse import explore, rank, read_task, write_task
    from simulearn.simulate import engine as engine_of

    if (pick is None) != (to is None):
        raise InputError("--pick and --to go together: which suggestion, and where to write it")
    files = output or []
    for path in files:
        if path.suffix.lower() not in (".png", ".pdf", ".svg", ".json"):
            raise InputError(f"{path}: the ending is not one of .png .pdf .svg .json")
    task = read_task(design) if _is_task(design) else None
    name = engine or (task.engine if task else "learned")
    answering = engine_of(name, model)
    found = rank(task, answering) if task else explore(grid_of(design), answering)
    if pick is not None and to is not None:
        if pick > len(found.best):
            raise InputError(f"--pick is {pick}; there are {len(found.best)} suggestions")
        after = found.best[pick - 1].grid
        if task:
            write_task(task.with_grid(after), to)
        else:
            write_grid(after, to)
    figures = _ranking(found, name)
    for path in files:
        if path.suffix.lower() == ".json":
            _write_json(path, figures)
        else:
            from simulearn.show.inverse import cards

            results = answering.simulate([one.grid for one in found.best])
            picture = cards(found, results, task.aims if task else None)
            with replacing(path) as temporary:
                picture.savefig(temporary)
    if as_json:
        print(json.dumps(figures, allow_nan=False))
        return
    out.print(_table(found, goals=task is not None))
    for path in [*files, *([to] if to else [])]:
        out.print(f"wrote {escape(str(path))}")


def _is_task(name: str) -> bool:
    """Whether a name is of a file that calls itself a task."""
    if name in library() and not Path(name).exists():
        return False
    try:
        data = json.loads(read_text(name))
    except (InputError, ValueError, RecursionError):
        return False  # whoever reads it as a grid says what is wrong
    return isinstance(data, dict) and str(data.get("schema", "")).startswith("simulearn.task/")


def _write_json(path: Path, data: dict[str, Any]) -> None:
    with replacing(path) as temporary:
        temporary.write_text(json.dumps(data, indent=1, allow_nan=False) + "\n", "utf-8")


def _figures(task: "Task", found: "Outcome") -> dict[str, Any]:
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


def _words(figures: dict[str, Any], found: "Outcome") -> Iterator[str]:
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


def _pictures(task: "Task", found: "Outcome", folder: Path, model: str | None) -> None:
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


def _ranking(found: "Ranking", engine: str) -> dict[str, Any]:
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


def _table(found: "Ranking", goals: bool) -> Table:
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
def _live(task: "Task", quiet: bool) -> "Iterator[Tell]":
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

"""Commands about inverse and hybrid design: optimize, rank."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.markup import escape

from simulearn.cli.base import Json, app, err, grid_of, out
from simulearn.cli.learn import folder_of
from simulearn.cli.telling import (
    live,
    ranking_figures,
    ranking_table,
    search_figures,
    search_pictures,
    search_words,
)
from simulearn.errors import InputError
from simulearn.files import read_text, replacing
from simulearn.grid import library, write_grid

if TYPE_CHECKING:
    from simulearn.inverse.keeping import Step

EngineOption = Annotated[
    str | None, typer.Option(help="Another engine than the task's: fea, calculix, beams, learned.")
]
ModelOption = Annotated[
    str | None, typer.Option(help="A learned model: default, paper, or its folder.")
]


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

    asked = read_task(task, paths=True)
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
    with live(asked, quiet=as_json) as show:

        def tell(step: "Step") -> None:
            steps.append(step)
            write_steps(folder, name, steps)
            show(step)

        found = search(asked, model, tell, tuple(before))
    write_steps(folder, name, list(found.steps))
    figures = search_figures(asked, found)
    write_grid(found.grid, folder / "best.json")
    _write_json(folder / "summary.json", figures)
    if found.interrupted:
        err.print(
            f"stopped at {found.error_mm:.2f} mm; {escape(str(folder))} has the best so far, "
            "and the same command goes on"
        )
        raise KeyboardInterrupt
    search_pictures(asked, found, folder, model)
    if as_json:
        print(json.dumps(figures, allow_nan=False))
        return
    for line in search_words(figures, found):
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
    task = read_task(design, paths=True) if _is_task(design) else None
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
    figures = ranking_figures(found, name)
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
    out.print(ranking_table(found, goals=task is not None))
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

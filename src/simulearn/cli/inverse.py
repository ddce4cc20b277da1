"""Commands about inverse and hybrid design: optimize, rank."""

import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape

from simulearn.cli.answers_report import answer_files, answers_picture, answers_table
from simulearn.cli.base import (
    Json,
    MaterialOption,
    app,
    err,
    folder_of,
    grid_of,
    keep_sources,
    of_material,
    out,
    print_files,
    warn,
    write_json,
)
from simulearn.cli.progress import counting, preparing
from simulearn.cli.search_report import (
    live,
    ranking_figures,
    ranking_table,
    search_pictures,
    search_words,
)
from simulearn.errors import ComputationError, InputError
from simulearn.files import read_text, replacing
from simulearn.grid import library, write_grid
from simulearn.outputs import check_place

if TYPE_CHECKING:
    from simulearn.inverse import Step, Task

MOST, MOST_TIMES = 1e6, 2**31 - 1  # mm or s, and times, which a task may name
WRITTEN = (
    *("best.json", "summary.json", "search.json", "history.csv", "error.png", "shape.png"),
    *("shape.3dm", "changing.gif", "answers.json", "answers.png", "answer-*.json"),
)

EngineOption = Annotated[
    str | None, typer.Option(help="Another engine than the task's: fea, calculix, beams, learned.")
]
ToleranceOption = Annotated[
    float | None,
    typer.Option(
        min=1e-6,
        max=MOST,
        metavar="MM",
        help="How far a print may be from goals that say nothing of it: with what probability it "
        "is nearer is reported.",
    ),
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
    seconds: Annotated[
        float | None, typer.Option(min=0.01, max=MOST, help="Another limit, s.")
    ] = None,
    iterations: Annotated[
        int | None, typer.Option(min=1, max=MOST_TIMES, help="Another limit.")
    ] = None,
    corrections: Annotated[
        int | None,
        typer.Option(
            min=0, max=MOST_TIMES, help="How often to go on from targets that FEA has corrected."
        ),
    ] = None,
    tolerance: ToleranceOption = None,
    robust: Annotated[
        bool | None,
        typer.Option(
            "--robust/--no-robust",
            help="Whether prints of the design shall come close, and not only the design.",
        ),
    ] = None,
    answers: Annotated[
        int | None,
        typer.Option(
            min=1,
            max=20,
            help="How many designs that differ; several take up to three times the seconds.",
        ),
    ] = None,
    printer: Annotated[
        str | None,
        typer.Option(help="A printer's name, or a profile (.toml), for print times of answers."),
    ] = None,
    afresh: Annotated[
        bool, typer.Option("--afresh", help="Do not go on from an earlier run in the folder.")
    ] = False,
    material: MaterialOption = None,
    as_json: Json = False,
) -> None:
    """Search for a grid that comes where it is wanted; the same command goes on later."""
    from simulearn.fabricate import load_printer
    from simulearn.inverse import Past, read_task, search_figures
    from simulearn.inverse import optimize as search
    from simulearn.inverse.keeping import identity, read_past, write_past

    wanted = _of_material(read_task(task, paths=True), material)
    limits = {
        "seconds": seconds,
        "iterations": iterations,
        "corrections": corrections,
        "answers": answers,
    }
    named = {"method": method, "engine": engine, "tolerance": tolerance, "robust": robust}
    wanted = wanted.model_copy(
        update={
            **{key: value for key, value in named.items() if value is not None},
            "limits": wanted.limits.model_copy(
                update={key: value for key, value in limits.items() if value is not None}
            ),
        }
    )
    machine = load_printer(printer) if printer else None
    folder = output or Path("searches") / Path(task).stem
    keep_sources(folder, WRITTEN, [Path(task), *wanted.files])
    folder_of(folder)
    name = identity(wanted, model)
    past = Past() if afresh else read_past(folder, name)
    steps = list(past.steps)
    with preparing(quiet=as_json), live(quiet=as_json) as show:

        def progress(step: "Step") -> None:
            steps.append(step)
            write_past(folder, name, steps, past.checks)
            show(step)

        result = search(wanted, model=model, progress=progress, before=past, printer=machine)
    write_past(folder, name, result.steps, result.checks)
    figures = search_figures(wanted, result)
    write_grid(result.grid, folder / "best.json")
    write_json(folder / "summary.json", figures)
    of_answers = answer_files(result.answers, folder) if result.answers else []
    warn(result.warnings)
    if result.interrupted:
        err.print(
            f"stopped at {result.error_mm:.2f} mm; {escape(str(folder))} has the best so far, "
            "and the same command goes on"
        )
        raise KeyboardInterrupt
    try:
        names = search_pictures(wanted, result, folder, model)
        if result.answers:
            names += answers_picture(wanted, result, folder, model)
    except (ComputationError, InputError) as error:  # the search itself has succeeded
        names = []
        err.print(f"[yellow]the pictures could not be drawn:[/] {escape(str(error))}")
    if as_json:
        print(json.dumps(figures, allow_nan=False))
        return
    for line in search_words(figures, result):
        out.print(line)
    if result.answers:
        out.print(answers_table(result.answers))
    names = ["best.json", "summary.json", "history.csv", *of_answers, *names]
    out.print(f"wrote {escape(str(folder))}/{', '.join(names)}")


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
    tolerance: ToleranceOption = None,
    material: MaterialOption = None,
    as_json: Json = False,
) -> None:
    """Score every single modification of a grid, and suggest five that differ."""
    from simulearn.inverse import rank, read_task, write_task
    from simulearn.simulate import Result, one
    from simulearn.simulate import engine as engine_of

    if (pick is None) != (to is None):
        raise InputError("--pick and --to go together: which suggestion, and where to write it")
    files = output or []
    for path in files:
        if path.suffix.lower() not in (".png", ".pdf", ".svg", ".json"):
            raise InputError(f"{path}: the ending is not one of .png .pdf .svg .json")
        check_place(path, [Path(design)])
    task = _of_material(read_task(design, paths=True), material) if _is_task(design) else None
    name = engine or (task.engine if task else "learned")
    simulator = engine_of(name, model)
    if tolerance is not None:
        if task is None:
            raise InputError("--tolerance is of goals; give a task, which has some")
        task = task.model_copy(update={"tolerance": tolerance})
    with preparing(quiet=as_json), counting("prints", quiet=as_json) as progress:
        ranking = rank(task or grid_of(design, material), simulator, progress=progress)
    warn(ranking.warnings)
    if pick is not None and to is not None:
        if pick > len(ranking.best):
            raise InputError(f"--pick is {pick}; there are {len(ranking.best)} suggestions")
        after = ranking.best[pick - 1].grid
        if task:
            write_task(task.with_grid(after), to)
        else:
            write_grid(after, to)
    figures = ranking_figures(ranking, name)
    for path in files:
        if path.suffix.lower() == ".json":
            write_json(path, figures)
        else:
            from simulearn.show.inverse import cards

            outcomes = simulator.simulate([suggestion.grid for suggestion in ranking.best])
            drawn = [k for k, outcome in enumerate(outcomes) if isinstance(outcome, Result)]
            shown = replace(ranking, best=tuple(ranking.best[k] for k in drawn))
            picture = cards(shown, [one(outcomes[k]) for k in drawn], ranking.goals)
            with replacing(path) as temporary:
                picture.savefig(temporary)
    if as_json:
        print(json.dumps(figures, allow_nan=False))
        return
    out.print(ranking_table(ranking, goals=task is not None))
    print_files([*files, *([to] if to else [])])


def _of_material(task: "Task", material: Path | None) -> "Task":
    """Return a task whose grid is made of the material in a file."""
    return task if material is None else task.with_grid(of_material(task.start, material))


def _is_task(name: str) -> bool:
    """Whether a name is of a file that calls itself a task."""
    if name in library() and not Path(name).exists():
        return False
    try:
        data = json.loads(read_text(name))
    except (InputError, ValueError, RecursionError):
        return False  # whoever reads it as a grid says what is wrong
    return isinstance(data, dict) and str(data.get("schema", "")).startswith("simulearn.task/")

"""Reports of several answers: a table and a picture for people, files for programs."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rich.table import Table

from simulearn.cli.base import write_json
from simulearn.cli.search_report import share_words
from simulearn.files import replacing
from simulearn.grid import write_grid

if TYPE_CHECKING:
    from simulearn.inverse import Answer, SearchResult, Task


def answers_table(answers: "Sequence[Answer]") -> Table:
    """Return several answers side by side, those on the front marked."""
    table = Table(
        box=None,
        title="Answers that differ; those with a * no other beats in all",
        title_justify="left",
    )
    heads = ["", "by finite elements, mm", "by the engine, mm", "actuators", "their length, mm"]
    of_prints = any(one.share is not None for one in answers)
    heads += [f"print by {answers[0].printer or 'a printer'}", *["prints within"] * of_prints]
    collide = any(one.collides for one in answers)
    for head in [*heads, "differs by", *["collides"] * collide]:
        table.add_column(head, justify="right")
    for k, one in enumerate(answers, 1):
        fea, seconds = one.check.error_fea_mm, one.print_seconds
        table.add_row(
            f"{k}{'*' if one.on_front else ' '}",
            "not known" if fea is None else f"{fea:.2f}",
            f"{one.check.error_mm:.2f}",
            str(one.actuators),
            f"{one.actuator_mm:.0f}",
            "not known" if seconds is None else f"{seconds / 60:.0f} min",
            *([share_words(one.probability)] if of_prints else []),
            "" if one.nearest is None else f"{one.nearest:.2f}",
            *([("yes" if one.collides else "no")] if collide else []),
        )
    return table


def answer_files(answers: "Sequence[Answer]", folder: Path) -> list[str]:
    """Write the answers as one file and as a grid each; return the names of the files."""
    from simulearn.inverse.archive import LEAST

    rows = [one.to_dict() for one in answers]
    write_json(
        folder / "answers.json",
        {"schema": "simulearn.answers/1", "least_distance": LEAST, "answers": rows},
    )
    names = [f"answer-{k}.json" for k in range(1, len(answers) + 1)]
    for path in folder.glob("answer-*.json"):  # of an earlier run that found more
        if path.name not in names and path.stem.removeprefix("answer-").isdigit():
            path.unlink()
    for name, one in zip(names, answers, strict=True):
        write_grid(one.grid, folder / name)
    return ["answers.json", *names]


def answers_picture(
    task: "Task", result: "SearchResult", folder: Path, model: str | None
) -> list[str]:
    """Draw the answers as cards, and the front; return the name of the file."""
    from simulearn.show.answers import answers_figure
    from simulearn.simulate import Result
    from simulearn.simulate import engine as engine_of

    answers = result.answers
    known = [one.check.shape for one in answers]
    quick = task.engine in ("learned", "beams")
    simulator = engine_of(task.engine, model) if quick else engine_of("beams")
    missing = [one.grid for one, shape in zip(answers, known, strict=True) if shape is None]
    outcomes = iter(simulator.simulate(missing) if missing else [])
    shapes = [shape or next(outcomes) for shape in known]
    drawn = [shape if isinstance(shape, Result) else None for shape in shapes]
    with replacing(folder / "answers.png") as temporary:
        answers_figure(answers, drawn, result.goals).savefig(temporary)
    return ["answers.png"]

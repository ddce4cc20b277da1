"""Reports of searches and rankings: words, tables and pictures for people, figures for machines."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, replace
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.markup import escape
from rich.table import Table

from simulearn.cli.base import err
from simulearn.files import replacing
from simulearn.grid import grid_to_dict
from simulearn.material import load_material
from simulearn.simulate.summary import remarks

if TYPE_CHECKING:
    from simulearn.inverse import Ranking, SearchResult, Step, Suggestion, Task
    from simulearn.inverse.probability import Probability
    from simulearn.inverse.search import Progress

BARS = "▁▂▃▄▅▆▇█"


def search_words(figures: dict[str, Any], result: "SearchResult") -> Iterator[str]:
    """Yield what a person wants to know."""
    yield from _design_words(figures, result)
    yield f"of material {escape(str(load_material(result.grid.material).identity))}"
    yield from _goal_words(figures)
    yield from _print_words(result)


def _goal_words(figures: dict[str, Any]) -> Iterator[str]:
    """Yield how far goals of each kind are from being met, where not all are points."""
    kinds = dict.fromkeys(goal["kind"] for goal in figures["goals"])
    for kind in kinds if {*kinds} != {"point"} else ():
        goals = [goal for goal in figures["goals"] if goal["kind"] == kind]
        away = [goal["distance_mm"] for goal in goals]
        angles = [goal["angle_deg"] for goal in goals if "angle_deg" in goal]
        many = f"{len(goals)} goals" if len(goals) > 1 else goals[0]["vertex"]
        words = f"  {kind} ({many}): "
        if len(away) > 1:
            words += (
                f"{sorted(away)[len(away) // 2]:.2f} mm in the median, {max(away):.2f} mm at most"
            )
        else:
            words += f"{away[0]:.2f} mm"
        if angles:
            words += f", {max(angles):.1f} degrees" + (" at most" if len(angles) > 1 else "")
        yield words


def _design_words(figures: dict[str, Any], result: "SearchResult") -> Iterator[str]:
    yield (
        f"{figures['start_mm']:.2f} mm to begin with, [bold]{result.error_mm:.2f} mm[/] by the "
        f"engine {figures['engine']} after {result.iterations} iterations and {result.designs} "
        f"designs, {result.seconds:.1f} s"
    )
    check = result.check
    if check is None:
        return
    if check.error_fea_mm is None:
        yield f"[yellow]finite elements have no answer:[/] {escape(check.why)}"
        return
    yield (
        f"[bold]{check.error_fea_mm:.2f} mm[/] by finite elements; the two shapes are "
        f"{check.apart_mm:.2f} mm apart"
    )
    if check.fea is not None:
        yield from (escape(line) for line in remarks(check.fea))
    if check.agrees is False:
        yield (
            f"[yellow]that is beyond the {check.bound_mm:.2f} mm of the engine's bound:[/] "
            "trust finite elements, or go on with more --corrections"
        )


def _print_words(result: "SearchResult") -> Iterator[str]:
    """Yield how often prints meet the goals, where that was computed."""
    probability, before = result.probability, result.nominal
    if probability is None:
        return
    yield f"prints: [bold]{probability.words}[/]"
    yield f"[dim]{probability.assumes}[/]"
    if before is not None and probability is before:
        begun = all(message.code != "robust-not-begun" for message in result.warnings)
        if begun:  # else a warning says that none was looked for
            yield (
                "[yellow]no robust design was found:[/] prints of the best one meet the goals as "
                "often"
            )
    elif before is not None:
        yield f"of the best design without regard to prints: {before.words}"
    rows = zip(result.goals.names, probability.goals, probability.tolerances, strict=True)
    for k, (name, share, most) in enumerate(rows):
        if share is not None:
            yield f"  goal {k} ({name}): {100 * share:.0f} % within {most:g} mm"


def search_pictures(
    task: "Task", result: "SearchResult", folder: Path, model: str | None
) -> list[str]:
    """Draw the error curve, the shape beside its targets, and the design changing.

    The shape and its targets are written for Rhino, too, where its package is installed.

    Returns:
        The files that were written; a shape without an answer has no picture.
    """
    from simulearn.interop import write_3dm
    from simulearn.show.inverse import changing, error_curve, wanted
    from simulearn.simulate import Result
    from simulearn.simulate import engine as engine_of

    check, goals = result.check, result.goals
    names = ["error.png"]
    with replacing(folder / "error.png") as temporary:
        error_curve(result.steps, check.error_fea_mm if check else None).savefig(temporary)
    # Every design by a slow engine would take as long as the search did.
    quick = task.engine in ("learned", "beams")
    simulator = engine_of(task.engine, model) if quick else engine_of("beams")
    # A search that used up its time is not followed by pictures that take as long again.
    steps = _changes(result, 40 if result.seconds < task.limits.seconds else 10)
    outcomes = simulator.simulate([step.grid(task.start) for step in steps])
    shape = None if check is None else check.shape
    if shape is None and isinstance(outcomes[-1], Result):
        shape = outcomes[-1]
    if shape is not None:
        error = goals.error(goals.points(shape.joints[-1], shape.beams[-1]))
        with replacing(folder / "shape.png") as temporary:
            wanted(shape, goals, float(error)).savefig(temporary)
        names.append("shape.png")
        if find_spec("rhino3dm") is not None:
            write_3dm(shape, folder / "shape.3dm", goals)
            names.append("shape.3dm")
    pairs = [(r, step) for r, step in zip(outcomes, steps, strict=True) if isinstance(r, Result)]
    if pairs:
        results, drawn = zip(*pairs, strict=True)
        changing(results, drawn, goals, folder / "changing.gif")
        names.append("changing.gif")
    return names


def _changes(result: "SearchResult", most: int) -> "list[Step]":
    """Return the steps at which the best design changed, at most so many, the last one always."""
    from simulearn.inverse.keeping import ANSWERS

    kept: list[Step] = []
    for step in result.steps:
        if step.phase == ANSWERS:
            continue
        if not kept or (step.joints, step.actuators) != (kept[-1].joints, kept[-1].actuators):
            kept.append(step)
    final = replace(
        kept[-1],
        joints=result.grid.joints.tolist(),
        actuators=result.grid.actuators.tolist(),
        error_mm=result.error_mm,
    )
    stride = max(1, -(-len(kept) // most))
    return [*kept[:-1][::stride], final]


def ranking_figures(ranking: "Ranking", engine: str) -> dict[str, Any]:
    """Return a ranking for machines."""
    return {
        "engine": engine,
        "material": load_material(ranking.grid.material).identity.model_dump(),
        "error_mm": ranking.error_mm,
        **_probability(ranking),
        "modifications": [_modification(one) for one in ranking.suggestions],
        "suggestions": [
            {**_modification(one), **_probability(one), "grid": grid_to_dict(one.grid)}
            for one in ranking.best
        ],
        **({"warnings": [asdict(one) for one in ranking.warnings]} if ranking.warnings else {}),
    }


def _probability(part: "Ranking | Suggestion") -> dict[str, Any]:
    return {} if part.probability is None else {"probability": part.probability.to_dict()}


def _modification(one: "Suggestion") -> dict[str, Any]:
    return {
        "change": one.change.words,
        "part": one.change.part,
        "indices": list(one.change.indices),
        "error_mm": one.error_mm,
        "moved_mm": one.moved_mm,
    }


def ranking_table(ranking: "Ranking", goals: bool) -> Table:
    """Return the suggestions; to tenths of a mm, since engines are not sure of hundredths."""
    count = len(ranking.suggestions)
    shown = "five that differ" if count > len(ranking.best) else "the best first"
    title = f"{ranking.error_mm:.1f} mm as it is; " if goals else ""
    table = Table(
        box=None,
        title=f"{title}{count} valid modifications, {shown}; material "
        + escape(str(load_material(ranking.grid.material).identity)),
        title_justify="left",
    )
    table.add_column("", justify="right")
    table.add_column("change")
    if goals:
        table.add_column("error, mm", justify="right")
        table.add_column("gain", justify="right")
    of_prints = ranking.probability
    if of_prints is not None:
        table.add_column("prints within", justify="right")
        table.caption_justify = "left"
        table.caption = (
            f"within the tolerances of all goals, of {of_prints.drawn} prints by "
            f"{of_prints.engine}; {share_words(of_prints)} as it is\n{of_prints.assumes}"
        )
    table.add_column("moves, mm", justify="right")
    for k, one in enumerate(ranking.best, 1):
        gain = ranking.error_mm - one.error_mm
        errors = [f"{one.error_mm:.1f}", f"{gain:+.1f}"] if goals else []
        shares = [] if of_prints is None else [share_words(one.probability)]
        table.add_row(str(k), one.change.words, *errors, *shares, f"{one.moved_mm:.1f}")
    return table


def share_words(probability: "Probability | None") -> str:
    """Return how many prints are within all tolerances."""
    if probability is None or probability.together is None:
        return "not known"
    return f"{100 * probability.together:.0f} %"


@contextmanager
def live(quiet: bool) -> "Iterator[Progress]":
    """Yield a function that shows a step: a line that changes on a terminal, else one for each."""
    if quiet:
        yield _nothing
        return
    if not err.is_terminal:
        yield _line
        return
    errors: list[float] = []
    with err.status("getting ready") as status:

        def show(step: "Step") -> None:
            errors.append(step.error_mm)
            status.update(f"{_bars(errors)} {_progress(step)}  [dim]{escape(step.words)}[/]")

        yield show
        sys.stderr.flush()


def _nothing(step: "Step") -> None:
    pass


def _line(step: "Step") -> None:
    err.print(f"{step.iteration}: {_progress(step)}, {escape(step.words)}")


def _progress(step: "Step") -> str:
    from simulearn.inverse.keeping import ANSWERS, ROBUST

    corrected = f", correction {step.phase}" if step.phase > 0 else ""
    corrected = {ROBUST: ", prints", ANSWERS: ", another answer"}.get(step.phase, corrected)
    return (
        f"{step.error_mm:.2f} mm, {step.designs} designs, iteration {step.iteration}{corrected}, "
        f"{step.seconds:.0f} s"
    )


def _bars(errors: list[float], width: int = 24) -> str:
    """Return the last errors as a row of bars."""
    most = max(errors)
    return "".join(BARS[min(7, int(8 * e / max(most, 1e-9)))] for e in errors[-width:])

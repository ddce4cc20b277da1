"""Commands about learned models: train, evaluate."""

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.markup import escape
from rich.table import Table

from simulearn.cli.base import Json, app, err, folder_of, out
from simulearn.cli.progress import bar, counting
from simulearn.errors import InputError
from simulearn.extras import require
from simulearn.files import replacing
from simulearn.material import Material, read_material

if TYPE_CHECKING:
    from simulearn.learn.common.bundle import Bundle
    from simulearn.learn.common.evaluate import Evaluation
    from simulearn.learn.equilibrium.config import EquilibriumConfig


@app.command()
def train(
    config: Annotated[
        str,
        typer.Argument(metavar="CONFIG", help="A TOML file, or equilibrium, beams, paper, small."),
    ],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="The folder of the run; runs/NAME if not given."),
    ] = None,
    data: Annotated[
        Path | None,
        typer.Option(
            help="A packed data set to learn from alone, in place of all that CONFIG names."
        ),
    ] = None,
    search: Annotated[
        int | None,
        typer.Option(
            min=1, metavar="RUNS", help="Search noise, penalty and data size in so many short runs."
        ),
    ] = None,
    bound_of: Annotated[
        str | None,
        typer.Option(
            metavar="MODEL",
            help="Fit no more than the error estimate of a model anew, to the calibration sets.",
        ),
    ] = None,
    begin: Annotated[
        str | None,
        typer.Option(
            "--from", metavar="MODEL", help="Go on from a model, its networks alone, by the polish."
        ),
    ] = None,
    as_json: Json = False,
) -> None:
    """Train a model; the same command goes on where it was stopped."""
    require("training needs", "jax", "equinox", "optax")
    from simulearn.dataset import read_dataset
    from simulearn.learn.config import read_config
    from simulearn.learn.equilibrium.config import EquilibriumConfig

    wanted = read_config(config)
    suffix = "-search" if search else "-bound" if bound_of else ""
    folder = output or Path("runs") / (wanted.name + suffix)
    if bound_of is not None:
        if search or not isinstance(wanted, EquilibriumConfig):
            raise InputError("--bound-of is for the kinds equilibrium and beams, without --search")
        if begin is not None:
            raise InputError("--from and --bound-of exclude each other")
        if data is not None:
            update = {"calibration": str(data), "unfamiliar": None}
            wanted = wanted.model_copy(update=update)
        _fit_bound(bound_of, wanted, folder, as_json)
        return
    source = data or Path(wanted.data)
    if not source.is_file():
        raise InputError(
            f"{source}: there is no such data set; make one with `simulearn dataset generate` "
            "and `pack`, or name another with --data"
        )
    folder_of(folder)
    trials = read_dataset(source, "train")
    if data is not None and isinstance(wanted, EquilibriumConfig):
        wanted = wanted.of_own(str(data), sum(int((~b.test).sum()) for b in trials.batches))
        err.print(f"{escape(str(data))} alone is learnt from; {_aside(wanted.validation)}")
    if search:
        if begin is not None:
            raise InputError("--from and --search exclude each other")
        if isinstance(wanted, EquilibriumConfig):
            raise InputError("--search is for the kind paper; this configuration has no noise")
        from simulearn.learn.paper.search import search as search_for
        from simulearn.show.learning import search_picture

        with counting("runs", quiet=as_json) as progress:
            figures = search_for(wanted, trials, folder, search, progress)
        with replacing(folder / "search.png") as temporary:
            search_picture(figures).savefig(temporary)
        if as_json:
            print(json.dumps(figures))
        else:
            out.print(_best(figures))
            out.print(f"wrote {escape(str(folder))}/search.png, search.csv, search.json")
        return
    from simulearn.learn.common.bundle import bundle_of
    from simulearn.learn.run import run
    from simulearn.show.learning import loss_picture, stages_picture

    first = bundle_of(begin) if begin is not None else None
    picture: Callable[[Any, str], Any] = (
        stages_picture if isinstance(wanted, EquilibriumConfig) else loss_picture
    )

    def draw(rows: Any, path: Path) -> None:
        with replacing(path) as temporary:
            picture(rows, wanted.name).savefig(temporary)

    try:
        with _epochs(quiet=as_json) as show:
            bundle, rows, percent = run(wanted, trials, folder, show, draw, first)
    except KeyboardInterrupt:
        err.print("stopped; what is finished is kept, and the same command goes on")
        raise
    if as_json:
        figures = {"model": str(bundle.path), "validation_percent": percent}
        print(json.dumps({**figures, "epochs": len(rows), "loss": rows[-1].loss}))
        return
    out.print(f"mean vertex error of the trials set aside {percent:.2f} % of dimension")
    out.print(f"wrote {escape(str(bundle.path))} and {escape(str(folder))}/loss.png, loss.csv")


def _aside(count: int) -> str:
    """Return what becomes of trials set aside from a set that alone is learnt from."""
    from simulearn.learn.equilibrium.bound_fit import LEAST_TRIALS

    if count < LEAST_TRIALS:
        return f"{count} of its trials are set aside, too few for an error estimate"
    return f"{count} of its trials are set aside, to which the error estimate is fitted"


def _fit_bound(model: str, config: "EquilibriumConfig", folder: Path, as_json: bool) -> None:
    """Fit the error estimate of a model anew, into FOLDER/model."""
    from simulearn.learn.common.bundle import bundle_of
    from simulearn.learn.run import new_bound

    bundle = bundle_of(model)
    folder_of(folder)
    made = new_bound(bundle, config, folder)
    if as_json:
        print(json.dumps({"model": str(made.path)}))
    else:
        out.print(f"wrote {escape(str(made.path))}")


@app.command()
def evaluate(
    model: Annotated[
        str, typer.Argument(metavar="MODEL", help="A model's folder, paper, or default.")
    ],
    dataset: Annotated[Path, typer.Argument(metavar="DATASET", help="A packed data set (.h5).")],
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="A folder for figures and pictures.")
    ] = None,
    record: Annotated[
        bool, typer.Option("--record", help="Keep the figures in the model's card.")
    ] = False,
    material: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE", help="A material (.toml) in place of the one that the trials have."
        ),
    ] = None,
    as_json: Json = False,
) -> None:
    """Compare a model with the trials of a data set that are kept for testing."""
    from simulearn.dataset import read_dataset
    from simulearn.learn.common.bundle import bundle_of
    from simulearn.learn.common.evaluate import evaluate as evaluate_
    from simulearn.learn.common.evaluate import for_testing
    from simulearn.learn.common.saving import add_metrics

    bundle = bundle_of(model)
    trained = bundle.model
    if output is not None:
        folder_of(output)
    data = read_dataset(dataset, stress=False)
    batches = for_testing(data)
    if material is not None:
        given = read_material(material)
        batches = [replace(batch, material=given, materials=()) for batch in batches]
    for batch in batches:
        for own in batch.materials or (batch.material,):
            _check_material(bundle, own)
    with counting("trials", quiet=as_json) as progress:
        evaluation = evaluate_(trained, batches, progress)
    figures = {
        "model": bundle.card.name,
        "kind": bundle.card.kind,
        "dataset": data.config.name,
        "sha256": data.sha256,
        **evaluation.errors.summary(),
    }
    if record:
        add_metrics(bundle, data.config.name, figures)
    if output is not None:
        _write(evaluation, figures, output)
    if as_json:
        print(json.dumps(figures, allow_nan=False))
        return
    out.print(_table(figures))
    for part in ("kinds", "members"):
        if part in figures:
            out.print(_parts_table(figures[part], part))
    if output is not None:
        out.print(f"wrote {escape(str(output))}/figures.json, trials.csv, errors.png, grids.png")


def _check_material(bundle: "Bundle", given: Material) -> None:
    """Raise where trials are not of a material that a model has learnt."""
    learnt, family = bundle.card.material, getattr(bundle.model, "learnt", None)
    if given.physics != learnt.physics and (family is None or family.wrong(given, learnt)):
        raise InputError(
            f'the trials are of {given.identity}; the model "{bundle.card.name}" has learnt '
            f"{learnt.identity}; name another with --material",
            "material-not-evaluated",
            "material",
        )


def _write(evaluation: "Evaluation", figures: dict[str, Any], folder: Path) -> None:
    from simulearn.show.learning import error_picture, grids_picture

    with replacing(folder / "figures.json") as temporary:
        temporary.write_text(json.dumps(figures, indent=1) + "\n", "utf-8")
    e = evaluation.errors
    lines = ["trial,dimension_mm,error_mm,error_percent,rotation_deg,gap_mm,motion_mm"]
    rows = zip(
        e.numbers, e.dimension, e.vertex[:, -1], e.percent[:, -1], e.rotation[:, -1], e.gap[:, -1],
        e.motion, strict=True,
    )  # fmt: skip
    lines += [f"{row[0]}," + ",".join(f"{x:.4f}" for x in row[1:]) for row in rows]
    with replacing(folder / "trials.csv") as temporary:
        temporary.write_text("\n".join(lines) + "\n", "utf-8")
    for name, picture in (("errors", error_picture), ("grids", grids_picture)):
        with replacing(folder / f"{name}.png") as temporary:
            picture(evaluation, figures["model"]).savefig(temporary)


def _table(figures: dict[str, Any]) -> Table:
    table = Table(
        box=None,
        title=f"{figures['model']} on {figures['trials']} trials of {figures['dataset']}\n"
        f"vertex error of the last frame: mean {figures['mean_percent']:.2f} % of dimension, "
        f"median {figures['median_percent']:.2f}, 97th percentile {figures['p97_percent']:.2f}, "
        f"worst {figures['worst_percent']:.2f} (trial {figures['worst_trial']})\n"
        f"mean {figures['mean_mm']:.2f} mm, 97th percentile {figures['p97_mm']:.2f}, "
        f"worst {figures['worst_mm']:.2f}; the corners move by {figures['motion_mm']:.1f}"
        f"{_bound_sentence(figures)}",
        title_justify="left",
    )
    names = ("frame", "mean %", "97 % %", "mean mm", "joints turned deg", "gap mm")
    for name in names:
        table.add_column(name, justify="right")
    for row in figures["frames"]:
        values = [row[k] for k in row if k != "frame"]
        table.add_row(str(row["frame"]), *(f"{x:.3f}" for x in values))
    return table


def _bound_sentence(figures: dict[str, Any]) -> str:
    """Return how many answers are below the model's own bound, where it has one."""
    if "below_bound_percent" not in figures:
        return ""
    return (
        f"\n{figures['below_bound_percent']:.0f} % are below their 90 % bound, which is "
        f"{figures['bound_over_error']:.1f} times the error in the median"
    )


def _parts_table(parts: dict[str, Any], title: str) -> Table:
    """Return the figures of kinds of grids, or of thirds of the materials' numbers."""
    table = Table(box=None, title=f"by {title[:-1]}", title_justify="left")
    table.add_column(title[:-1])
    for name in ("trials", "mean %", "median %", "worst %", "below bound %", "bound / error"):
        table.add_column(name, justify="right")
    rows = parts if title == "kinds" else _thirds(parts)
    keys = ("mean_percent", "median_percent", "worst_percent")
    for name, row in rows.items():
        bound = [f"{row[k]:.0f}" if "per" in k else f"{row[k]:.1f}"
                 for k in ("below_bound_percent", "bound_over_error") if k in row]  # fmt: skip
        table.add_row(name, str(row["trials"]), *(f"{row[k]:.3f}" for k in keys), *bound)
    return table


def _thirds(parts: dict[str, Any]) -> dict[str, Any]:
    rows = {}
    for name, two in parts.items():
        rows[f"{name} to {two['low']['most']:.3g}"] = two["low"]
        rows[f"{name} from {two['high']['least']:.3g}"] = two["high"]
    return rows


def _best(figures: dict[str, Any]) -> str:
    best = figures["best"]
    return (
        f"{len(figures['runs'])} runs; best: noise {best['noise']:g}, penalty {best['penalty']:g}, "
        f"{best['trials']} trials, vertex error {best['validation_percent']:.2f} %, "
        f"gap {best['gap_mm']:.3f} mm"
    )


@contextmanager
def _epochs(quiet: bool) -> Iterator[Callable[[Any, int, int], None]]:
    """Yield a function that shows a run: a bar on a terminal, a line for each epoch elsewhere."""
    if quiet:
        yield lambda row, done, total: None
        return
    if not err.is_terminal:

        def line(row: Any, done: int, total: int) -> None:
            if row is not None:
                err.print(_words(row) + f", {row.seconds:.0f} s")

        yield line
        return
    with bar(remaining=True, period=600) as shown:
        task = shown.add_task("updates", total=None, words="")

        def show(row: Any, done: int, total: int) -> None:
            shown.update(task, completed=done, total=total)
            if row is not None:
                shown.update(task, words=_words(row))

        yield show


def _words(row: Any) -> str:
    if hasattr(row, "stage"):
        return f"{row.stage} {row.update}: loss {row.loss:.4g}"
    return (
        f"epoch {row.epoch}: loss {row.loss:.4g}, vertex error {row.validation_percent:.2f} % "
        "of dimension"
    )

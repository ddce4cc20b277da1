"""Commands about data sets: generate, pack, info."""

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.markup import escape

from simulearn.cli.base import Json, app, err, out
from simulearn.cli.progress import bar, counting
from simulearn.errors import InputError
from simulearn.files import cores

if TYPE_CHECKING:
    from simulearn.dataset import Dataset, Tally

dataset = typer.Typer(help="Generate, pack and inspect data sets.", no_args_is_help=True)
app.add_typer(dataset, name="dataset")

Packed = Annotated[Path, typer.Argument(metavar="FILE", help="A packed data set (.h5).")]


@dataset.command()
def generate(
    config: Annotated[
        str,
        typer.Argument(
            metavar="CONFIG",
            help="A TOML file, or the name of a set that comes along, such as default or family.",
        ),
    ],
    output: Annotated[Path, typer.Option("-o", "--output", help="The folder of the set.")],
    trials: Annotated[
        int | None, typer.Option(min=1, help="How many designs, other than the file says.")
    ] = None,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Processes; by default one for each core.")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option(help="Address of a Dask scheduler, as tcp://host:8786.")
    ] = None,
    retry: Annotated[bool, typer.Option("--retry", help="Try failed designs again.")] = False,
    as_json: Json = False,
) -> None:
    """Simulate random designs; the same command goes on where it was stopped."""
    from simulearn import dataset as sets
    from simulearn.dataset.generate import Folder

    if scheduler and workers:
        raise InputError("--workers is for this machine; the cluster of --scheduler has its own")
    wanted = sets.read_config(config)
    if trials is not None:
        wanted = wanted.model_copy(update={"trials": trials})
    if retry:
        Folder(output, wanted).forget_failures()
    team = sets.cluster_workers(scheduler) if scheduler else sets.local_workers(workers or cores())
    try:
        with _rate(quiet=as_json) as progress:
            tally = sets.generate(wanted, output, team, progress)
    except KeyboardInterrupt:
        err.print("stopped; what is finished is kept, and the same command goes on")
        raise
    if as_json:
        print(json.dumps(_plain(tally)))
        return
    if tally.torn:
        err.print(f"[yellow]made anew:[/] {tally.torn} files of trials that were torn or empty")
    for reason in tally.reasons[:10]:
        err.print(f"[yellow]failed:[/] {escape(reason)}")
    trials = tally.present + tally.done + len(tally.reasons) - tally.failed
    out.print(
        f"{escape(str(output))}: {trials:,} "
        f"trials, {tally.failed} failed ({tally.done:,} new, {tally.per_minute:.0f} a minute)"
    )


@dataset.command()
def pack(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="The folder of the set.")],
    output: Annotated[Path, typer.Option("-o", "--output", help="The packed file (.h5).")],
    partial: Annotated[
        bool, typer.Option("--partial", help="Pack what is there, though trials are missing.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Pack a generated folder into one HDF5 file."""
    from simulearn import dataset as sets

    with counting("packing", quiet=as_json) as progress:
        count = sets.pack(folder, output, partial, progress)
    size = output.stat().st_size
    if as_json:
        print(json.dumps({"file": str(output), "trials": count, "bytes": size}))
    else:
        out.print(f"wrote {escape(str(output))}: {count:,} trials, {size / 1e6:.1f} MB")


@dataset.command()
def info(
    file: Packed,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="A picture (.png .pdf .svg).")
    ] = None,
    as_json: Json = False,
) -> None:
    """Say what is in a packed data set, and how near it is to the paper's."""
    from simulearn import dataset as sets
    from simulearn.dataset.statistics import summary
    from simulearn.files import replacing

    if output is not None and output.suffix not in (".png", ".pdf", ".svg"):
        raise InputError(f"{output}: a picture ends in .png, .pdf or .svg")
    data = sets.read_dataset(file, stress=False)
    stored, actual = sets.checksum(file)
    if stored != actual:
        raise InputError(
            f"{file}: is damaged (its SHA-256 is {actual[:12]}..., not {stored[:12]}...)"
        )
    figures = summary(data)
    if output is not None:
        from simulearn.show.dataset import dataset_picture

        with replacing(output) as temporary:
            dataset_picture(data).savefig(temporary)
    if as_json:
        print(json.dumps(figures))
        return
    out.print(_heading(data, figures))
    for line in (*_quantities(figures["quantities"]), *_of_paper(figures["quantities"])):
        out.print(line)
    if output is not None:
        out.print(f"wrote {escape(str(output))}")


def _heading(data: "Dataset", figures: dict[str, Any]) -> str:
    joints, beams = (
        "-".join(map(str, sorted({figures[name][0], figures[name][-1]})))
        for name in ("joints", "beams")
    )
    lines = [
        f"{escape(figures['name'])}: {figures['trials']:,} trials "
        f"({figures['train']:,} to learn, {figures['test']:,} to test), "
        f"{figures['topologies']} topologies of {joints} joints and {beams} beams",
        f"{figures['failed']} failed, {figures['redrawn']} designs redrawn, "
        f"{figures['unstable']} unstable, {figures['halved']} with halved increments, "
        f"{figures['iterations']['median']:.0f} iterations (median)",
        f"SHA-256 {figures['sha256']}",
        *(f"trial {k} failed: {escape(reason)}" for k, reason in data.failures[:10]),
    ]
    return "\n".join(lines)


def _quantities(figures: dict[str, dict[str, Any]]) -> Iterator[str]:
    """Yield the lines of a table; a table of Rich's would cut figures off on a narrow terminal."""
    titles = {name: f"{_title(name)} {q['unit']}".strip() for name, q in figures.items()}
    wide = max(map(len, titles.values()))
    heads = ("mean", "least", "3 %", "median", "97 %", "most")
    yield " " * wide + "".join(f"{head:>8}" for head in heads)
    for name, q in figures.items():
        row = [q[key] for key in ("mean", "p0", "p3", "p50", "p97", "p100")]
        yield f"{titles[name]:<{wide}}" + "".join(f"{value:>8.2f}" for value in row)


def _of_paper(figures: dict[str, dict[str, Any]]) -> Iterator[str]:
    """Yield what the paper says of its own data set."""
    for name, q in figures.items():
        if q["paper"]:
            parts = [
                f"{key if key == 'mean' else key[1:] + ' %'} {value:g}"
                for key, value in q["paper"].items()
            ]
            yield f"the paper's {_title(name)}: {', '.join(parts)} {q['unit']}"


def _title(name: str) -> str:
    return name.removesuffix("_percent").replace("_", " ")


def _plain(tally: "Tally") -> dict[str, Any]:
    return {
        "trials": tally.trials,
        "kept": tally.present,
        "new": tally.done,
        "failed": tally.failed,
        "torn": tally.torn,
        "reasons": tally.reasons,
        "per_minute": round(tally.per_minute, 2),
    }


@contextmanager
def _rate(quiet: bool) -> "Iterator[Callable[[Tally], None]]":
    """Yield a function that shows a tally: as a bar, or as lines where there is no terminal."""
    if quiet:
        yield lambda tally: None
        return
    if not err.is_terminal:
        yield _lines
        return
    # The rate of a long run settles; the last quarter of an hour is what remaining time goes by.
    with bar(remaining=True, period=900) as shown:
        task: list[Any] = []

        def show(tally: "Tally") -> None:
            done = tally.trials - tally.left
            words = f"{tally.per_minute:.0f}/min" + (
                f", {tally.failed} failed" if tally.failed else ""
            )
            if not task:
                task.append(shown.add_task("trials", total=tally.trials, completed=done, words=""))
            shown.update(task[0], completed=done, words=words)

        yield show


def _lines(tally: "Tally") -> None:
    """Print every hundredth trial, for logs."""
    new = tally.done + len(tally.reasons)
    if new % 100 == 0 or tally.left == 0:
        err.print(
            f"{tally.trials - tally.left:,} of {tally.trials:,} trials, {tally.failed} failed, "
            f"{tally.per_minute:.0f} a minute"
        )
